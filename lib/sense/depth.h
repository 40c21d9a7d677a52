// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sense/point_cloud.h"
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

/// Which frame the points of a cloud are in.
enum class Coordinates { World, Sensor };

/// The picture as an organised cloud, columns wide and rows high.
PointCloud cloudOf(const Ranger& ranger, const DepthFrame& frame, Coordinates in);
/// Scans of one laser as one cloud: a row a scan. In the sensor's frame that of the first scan.
PointCloud cloudOf(const Laser& laser, std::span<const Scan> scans, Coordinates in);

}  // namespace ispace
