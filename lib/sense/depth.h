// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sense/scan.h"

namespace ispace {

/// One picture of a ranger: for each pixel, row by row, the multiple of its ray() at which it meets
/// a surface. That is the depth along the axis for a pinhole, and the distance for a spherical
/// ranger. +infinity is no return.
struct DepthFrame {
    double time = 0;
    int frame = 0;
    Pose3 pose;
    std::vector<float> depths;
};

/// What a ranger sees at `pose`, with its limits, its ambiguity and, if wanted, its noise.
/// \pre `environment` is a mesh, not a slice
DepthFrame castDepth(const RayWorld& environment, const MovingBodies& bodies, const Sensor& sensor,
                     const Pose3& pose, int frame, const ReadingOptions& options);

}  // namespace ispace
