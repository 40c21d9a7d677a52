// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_device.h"

#include <cstdint>

#include "trace/embree_query.h"

namespace ispace {

void EmbreeRelease::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeRelease::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

EmbreeDevice makeEmbreeDevice() { return EmbreeDevice(rtcNewDevice("ignore_config_files=1")); }

std::size_t nativeWidthOf(RTCDeviceTy* device) {
    const auto has = [device](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device, property) != 0;
    };
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    return has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) ? 8 : 4;
}

EmbreeSceneHandle buildTriangles(RTCDeviceTy* device, const TriangleSet& triangles,
                                 unsigned geometry_id,
                                 const std::function<void()>& throw_if_failed) {
    const std::size_t count = triangles.size();
    return buildScene(device, RTC_GEOMETRY_TYPE_TRIANGLE, count, geometry_id, throw_if_failed,
                      [&](RTCGeometry geometry) {
                          using Corners = TriangleSet::FloatTriangle;
                          auto* const corners = static_cast<Corners*>(rtcSetNewGeometryBuffer(
                              geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Corners) / 3, 3 * count));
                          auto* const indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
                              geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), count));
                          throw_if_failed();
                          triangles.enlarge({corners, count});
                          for (std::size_t i = 0; i < 3 * count; ++i)
                              indices[i] = static_cast<std::uint32_t>(i);
                      });
}

}  // namespace ispace
