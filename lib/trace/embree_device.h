// SPDX-License-Identifier: GPL-3.0-or-later
// How lib/trace and lib/render set Embree up.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "trace/triangle_set.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ispace {

struct EmbreeRelease {
    void operator()(RTCDeviceTy* device) const;
    void operator()(RTCSceneTy* scene) const;
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeSceneHandle = std::unique_ptr<RTCSceneTy, EmbreeRelease>;

/// Nothing but the program decides how Embree works: no file in the user's home does. Null if it
/// fails.
EmbreeDevice makeEmbreeDevice();

/// Rays that the processor traces together: 4, 8 or 16.
std::size_t nativeWidthOf(RTCDeviceTy* device);

/// A scene of the enlarged triangles, ROBUST and of high quality, hits of which have this geometry
/// id. `throw_if_failed` is asked after each step that may fail. O(n log n)
EmbreeSceneHandle buildTriangles(RTCDeviceTy* device, const TriangleSet& triangles,
                                 unsigned geometry_id,
                                 const std::function<void()>& throw_if_failed);

}  // namespace ispace
