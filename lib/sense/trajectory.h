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

/// One line of a TUM trajectory: `t x y z qx qy qz qw`, metres and seconds; the quaternion turns
/// the sensor's frame (x forward, z up) into the world's and need not be quite normal. One without
/// x and y parts is exactly level. Nothing for blank lines and comments. \throws FormatError
/// without place: wrong number of columns, no numbers, NaN, a null quaternion
std::optional<TimedPose> parseTumLine(std::string_view line);

/// The pose between two at a share of the way, 0..1: places on the straight line, turned by the
/// shortest way at an even speed (slerp).
Pose3 between(const Pose3& a, const Pose3& b, double share);

/// Where something is at a time; before and after its way at the ends of that. \pre not empty,
/// times grow
Pose3 poseAlong(std::span<const TimedPose> way, double time);

}  // namespace ispace
