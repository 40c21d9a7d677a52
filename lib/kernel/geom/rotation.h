// SPDX-License-Identifier: GPL-3.0-or-later
// Poses as transforms and rotations of Eigen. Apart from pose.h, which nearly every source
// includes: Eigen takes a third of the time to compile a small one.
#pragma once

#include <Eigen/Geometry>

#include "geom/pose.h"

namespace ispace {

/// Maps points of the pose's frame to the outer frame; exact where angles are multiples of 90
/// degrees, else orthonormal up to rounding.
Eigen::Isometry3d isometryOf(const Pose3& pose);
/// A unit quaternion, up to rounding; exact at multiples of 180 degrees.
Eigen::Quaterniond quaternionOf(const Pose3& pose);
/// A rotation about one of the axes 0 (x), 1 (y), 2 (z).
Eigen::Quaterniond turnAbout(int axis, Angle angle);

/// The pose at `position` with this rotation, which is not 0 and need not be normalised. Exactly
/// level if its x and y parts are 0. Heading and roll in (-180, 180], tilt in [-90, 90] degrees;
/// within 1e-12 of straight up or down (sine of the tilt) all turn about the vertical is heading,
/// roll is 0.
///
///     const Pose3 same = poseOf(pose.position, quaternionOf(pose));  // but for rounding
Pose3 poseOf(Point3 position, const Eigen::Quaterniond& rotation);

inline Eigen::Vector3d vectorOf(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 vecOf(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace ispace
