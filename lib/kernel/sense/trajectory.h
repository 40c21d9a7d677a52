// SPDX-License-Identifier: GPL-3.0-or-later
// Poses by time, and the text format of TUM's benchmark for them (J. Sturm et al., A benchmark for
// the evaluation of RGB-D SLAM systems, 2012). Pure functions.
//
//     const auto timed = parseTumLine("12.5 2 1 0.3 0 0 0 1");  // at (2, 1, 0.3), level,
//     after 12.5 s const Pose3 half = between(from, to, 0.5);
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
/// without a line number: wrong number of columns, no numbers, NaN, a null quaternion, positions
/// farther than 1000 km away, times beyond 285 years
std::optional<TimedPose> parseTumLine(std::string_view line);

/// Interpolates between two poses: positions linearly, rotations along the shortest arc at constant
/// speed (K. Shoemake, Animating rotation with quaternion curves, 1985). Level poses stay exactly
/// level. \param share 0 to 1
Pose3 between(const Pose3& a, const Pose3& b, double share);

/// Returns the pose at a time, clamped to the ends of the path. \pre not empty, times increase
Pose3 poseAlong(std::span<const TimedPose> way, double time);

}  // namespace ispace
