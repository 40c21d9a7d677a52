// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of rangers, a ray for each pixel. Limits, ambiguity and noise apply to what the ranger
// measures: depths, or distances along rays, which are stored as multiples of the rays either way.
// Thread-safe; O(pixels) rays and 4 bytes a pixel.
//
//     const DepthFrame frame = castDepth(worlds.mesh(), bodies, sensor, sensor.pose, 0, {});
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sense/scan.h"

namespace ispace {

struct ReadingKind;

/// One picture of a ranger: for each pixel, row by row, the multiple of its ray() at which the ray
/// hits a surface. For a pinhole it is the depth along the axis, for a spherical ranger the
/// distance. +infinity is no return.
struct DepthFrame {
    double time = 0;
    int frame = 0;
    Pose3 pose;
    std::vector<float> depths;
    static const ReadingKind kKind;
};

/// Computes a ranger's picture at `pose`, with its limits, its ambiguity and, if requested, its
/// noise.
/// \pre `environment` is a mesh, not a slice
DepthFrame castDepth(const RayWorld& environment, const MovingBodies& bodies, const Sensor& sensor,
                     const Pose3& pose, int frame, const ReadingOptions& options);

}  // namespace ispace
