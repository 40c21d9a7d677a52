// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_device.h"

#include <array>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "trace/embree_query.h"
#include "trace/round_view.h"

namespace ispace {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

namespace {

/// Text of the first error of this thread's calls that is not yet reported.
thread_local std::array<char, 200> embree_error_text{};

void keepEmbreeError(void* /*user*/, RTCError /*code*/, const char* text) {
    if (embree_error_text[0] == 0 && text != nullptr)
        std::string_view(text).copy(embree_error_text.data(), embree_error_text.size() - 1);
}

}  // namespace

EmbreeDevice makeEmbreeDevice() {
    EmbreeDevice device(rtcNewDevice("ignore_config_files=1"));
    if (device) rtcSetDeviceErrorFunction(device.get(), keepEmbreeError, nullptr);
    throwIfEmbreeFailed(device.get());
    return device;
}

void throwIfEmbreeFailed(RTCDeviceTy* device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE && device != nullptr) return;
    const std::array<char, 200> text = std::exchange(embree_error_text, {});
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(text[0] != 0 ? "Embree: " + std::string(text.data())
                                          : "Embree failed with error " +
                                                std::to_string(static_cast<int>(code)));
}

std::size_t nativeWidthOf(RTCDeviceTy* device) {
    const auto has = [device](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device, property) != 0;
    };
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

EmbreeSceneHandle buildSurfaces(RTCDeviceTy* device, const TriangleSet& surfaces,
                                unsigned geometry_id) {
    const std::size_t count = surfaces.triangles();
    const auto fill = [&](RTCGeometry geometry) {
        using Corners = TriangleSet::FloatTriangle;
        auto* const corners = static_cast<Corners*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Corners) / 3, 3 * count));
        auto* const indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), count));
        throwIfEmbreeFailed(device);
        surfaces.enlarge({corners, count});
        for (std::size_t i = 0; i < 3 * count; ++i) indices[i] = static_cast<std::uint32_t>(i);
    };
    return buildScene(device, [&](RTCScene scene) {
        if (count > 0) attachGeometry(device, scene, RTC_GEOMETRY_TYPE_TRIANGLE, geometry_id, fill);
        attachRounds(device, scene, surfaces.rounds(), geometry_id);
    });
}

}  // namespace ispace
