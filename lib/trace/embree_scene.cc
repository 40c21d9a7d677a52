// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cassert>
#include <stdexcept>
#include <string>

namespace ispace {

namespace {

#if RTC_VERSION_MAJOR >= 4
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

void throwOnError(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    throw std::runtime_error(code == RTC_ERROR_OUT_OF_MEMORY
                                 ? "Embree has no memory left for the scene"
                                 : "Embree failed with error " + std::to_string(code));
}

}  // namespace

void EmbreeScene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeScene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

EmbreeScene::EmbreeScene(const FacetSoup& soup) {
    assert(soup.vertices.size() == soup.vertices_each * soup.facets.size());
    // Nothing but this line decides how Embree works: no file in the user's home does.
    device_.reset(rtcNewDevice("ignore_config_files=1"));
    throwOnError(device_.get());
    scene_.reset(rtcNewScene(device_.get()));
    throwOnError(device_.get());
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST | kFilterFlag);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    if (!soup.facets.empty()) addGeometry(soup);
    rtcCommitScene(scene_.get());
    throwOnError(device_.get());
}

void EmbreeScene::addGeometry(const FacetSoup& soup) {
    const bool quads = soup.vertices_each == 4;
    const RTCGeometry geometry =
        rtcNewGeometry(device_.get(), quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    throwOnError(device_.get());
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);  // the scene holds it
    auto* const positions = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), soup.vertices.size()));
    auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
        soup.vertices_each * sizeof(unsigned), soup.facets.size()));
    throwOnError(device_.get());
    for (std::size_t i = 0; i < soup.vertices.size(); ++i) {
        positions[3 * i] = static_cast<float>(soup.vertices[i].x);
        positions[3 * i + 1] = static_cast<float>(soup.vertices[i].y);
        positions[3 * i + 2] = static_cast<float>(soup.vertices[i].z);
        indices[i] = static_cast<unsigned>(i);
    }
    rtcCommitGeometry(geometry);
}

int EmbreeScene::widestPacket() const {
    const auto has = [this](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device_.get(), property) != 0;
    };
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) return 8;
    return has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED) ? 4 : 1;
}

}  // namespace ispace
