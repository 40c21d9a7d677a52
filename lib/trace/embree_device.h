// SPDX-License-Identifier: GPL-3.0-or-later
// How lib/trace and lib/trace/render set Embree up.
#pragma once

#include <cstddef>
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

/// A device that reads no configuration file in the user's home.
/// \throws as throwIfEmbreeFailed()
EmbreeDevice makeEmbreeDevice();

/// Reports the first error of this thread's calls since the last report.
/// \throws std::runtime_error with Embree's own text, std::bad_alloc if it has no memory
void throwIfEmbreeFailed(RTCDeviceTy* device);

/// Rays that the processor traces together: 4, 8 or 16.
std::size_t nativeWidthOf(RTCDeviceTy* device);

/// A scene of the enlarged triangles, ROBUST and of high quality, hits of which have this geometry
/// id. O(n log n)
/// \throws as throwIfEmbreeFailed()
EmbreeSceneHandle buildTriangles(RTCDeviceTy* device, const TriangleSet& triangles,
                                 unsigned geometry_id);

}  // namespace ispace
