// SPDX-License-Identifier: GPL-3.0-or-later
// Creates Embree's devices and triangle scenes for lib/kernel/trace and lib/kernel/trace/render.
#pragma once

#include <cstddef>
#include <memory>

#include "trace/triangle_set.h"

struct RTCDeviceTy;
struct RTCSceneTy;

namespace ispace {

/// Releases handles of Embree, which counts references.
struct EmbreeRelease {
    void operator()(RTCDeviceTy* device) const;
    void operator()(RTCSceneTy* scene) const;
};
using EmbreeDevice = std::unique_ptr<RTCDeviceTy, EmbreeRelease>;
using EmbreeSceneHandle = std::unique_ptr<RTCSceneTy, EmbreeRelease>;

/// Creates a device that ignores configuration files in the user's home, so that results depend on
/// the program alone; some 50 microseconds. \throws as throwIfEmbreeFailed()
EmbreeDevice makeEmbreeDevice();

/// Throws the first error of this thread's calls since the last check.
/// \throws std::runtime_error with Embree's message, std::bad_alloc if it is out of memory
void throwIfEmbreeFailed(RTCDeviceTy* device);

/// Number of rays that the processor traces together: 4, 8 or 16. Results do not depend on it
/// except near edges, see EmbreeScene.
std::size_t nativeWidthOf(RTCDeviceTy* device);

/// Builds a scene of the enlarged triangles and of the round bodies, ROBUST and of high quality;
/// hits hold this geometry id and the number of the surface. O(n log n)
/// \pre the round bodies stay at the same address while the scene lives
/// \throws as throwIfEmbreeFailed()
EmbreeSceneHandle buildSurfaces(RTCDeviceTy* device, const TriangleSet& surfaces,
                                unsigned geometry_id);

}  // namespace ispace
