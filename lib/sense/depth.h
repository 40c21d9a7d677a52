// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "sense/scan.h"
#include "sensor/sensor.h"

namespace ispace {

/// One picture of a ranger: per pixel, row by row, how many times the pixel's ray() leads to what
/// is seen. That is the depth along the axis of a pinhole, the distance of a spherical one.
/// +infinity is no return.
struct DepthFrame {
    double time = 0;
    int frame = 0;
    Pose3 pose;
    std::vector<float> depths;
};

/// What a ranger sees at `pose`, with its limits, its ambiguity and, if wanted, its noise.
/// `environment` is that of the mesh.
DepthFrame castDepth(const RayWorld& environment, const MovingBodies& bodies, const Sensor& sensor,
                     const Pose3& pose, int frame, const ReadingOptions& options);

}  // namespace ispace
