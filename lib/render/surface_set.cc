// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/surface_set.h"

#include <array>
#include <new>
#include <stdexcept>
#include <string>

#include "trace/embree_query.h"

namespace ispace {

namespace {

void throwIfFailed(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error("Embree failed with error " + std::to_string(static_cast<int>(code)));
}

}  // namespace

void FinishedSoup::add(const Mesh& mesh, Finish finish, Vec3 shift) {
    const auto first = static_cast<std::uint32_t>(triangles.vertices.size());
    for (const Point3& vertex : mesh.vertices) triangles.add(vertex + shift);
    for (const auto& [a, b, c] : mesh.triangles)
        triangles.triangles.push_back({first + a, first + b, first + c});
    triangles.round_of.resize(triangles.triangles.size(), TriangleSoup::kFlat);
    finishes.resize(triangles.triangles.size(), finish);
}

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

EmbreeDevice makeEmbreeDevice() {
    EmbreeDevice device(rtcNewDevice("ignore_config_files=1"));
    throwIfFailed(device.get());
    return device;
}

std::size_t nativeWidthOf(const EmbreeDevice& device) {
    const auto has = [&device](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device.get(), property) != 0;
    };
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

SurfaceSet::SurfaceSet(RTCDeviceTy* device, const FinishedSoup& soup, unsigned geometry_id)
    : triangles_(soup.triangles) {
    finishes_.reserve(triangles_.size());
    for (std::size_t i = 0; i < triangles_.size(); ++i)
        finishes_.push_back(soup.finishes[triangles_.source(i)]);
    scene_.reset(rtcNewScene(device));
    throwIfFailed(device);
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST | kFilterFlag);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    if (!empty()) {
        using Corner = std::array<float, 3>;
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        throwIfFailed(device);
        rtcAttachGeometryByID(scene_.get(), geometry, geometry_id);
        rtcReleaseGeometry(geometry);  // the scene holds it
        auto* const corners = static_cast<std::array<Corner, 3>*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Corner), 3 * triangles_.size()));
        auto* const indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), triangles_.size()));
        throwIfFailed(device);
        for (std::size_t i = 0; i < triangles_.size(); ++i) corners[i] = triangles_.enlarged(i);
        for (std::size_t i = 0; i < 3 * triangles_.size(); ++i)
            indices[i] = static_cast<std::uint32_t>(i);
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(scene_.get());
    throwIfFailed(device);
}

}  // namespace ispace
