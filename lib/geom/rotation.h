// SPDX-License-Identifier: GPL-3.0-or-later
// Poses as Eigen has them, for those who compute with rotations. Apart from pose.h, which
// everything includes: <Eigen/Geometry> takes most of a second to compile.
#pragma once

#include <Eigen/Geometry>

#include "geom/pose.h"

namespace ispace {

/// Takes points of the pose's frame to the outer one; exact where angles are multiples of 90
/// degrees.
Eigen::Isometry3d isometryOf(const Pose3& pose);
/// A unit quaternion; exact at multiples of 180 degrees.
Eigen::Quaterniond quaternionOf(const Pose3& pose);
/// A turn about one of the axes 0 (x), 1 (y), 2 (z).
Eigen::Quaterniond turnAbout(int axis, Angle angle);

/// Heading, tilt and roll of a rotation (not 0, need not be normal), at `position`; without x and y
/// parts exactly level.
Pose3 poseOf(Point3 position, const Eigen::Quaterniond& rotation);

inline Eigen::Vector3d vectorOf(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 vecOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace ispace
