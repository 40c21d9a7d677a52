// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "geom/pose.h"

namespace ispace {

/// A pose at a time.
struct TimedPose {
    double time = 0;  ///< seconds
    Pose3 pose;
};

/// Parses one line of a TUM trajectory: `t x y z qx qy qz qw`, metres and seconds; the quaternion
/// rotates the sensor's frame (x forward, z up) to the world's and is normalised. A quaternion
/// without x and y parts is exactly level. Empty for blank lines and comments. \throws FormatError
/// without a line number: wrong number of columns, no numbers, NaN, a null quaternion
std::optional<TimedPose> parseTumLine(std::string_view line);

/// Interpolates between two poses: positions linearly, rotations along the shortest arc at constant
/// speed (slerp).
Pose3 between(const Pose3& a, const Pose3& b, double share);

/// Returns the pose at a time, clamped to the ends of the path. \pre not empty, times increase
Pose3 poseAlong(std::span<const TimedPose> way, double time);

}  // namespace ispace
