// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/pose.h"

#include "geom/rotation.h"

namespace ispace {

Point2 Pose2::operator*(Point2 local) const { return position + *this * Vec2{local.x, local.y}; }

Vec2 Pose2::operator*(Vec2 local) const {
    const double c = cos(heading), s = sin(heading);
    return {c * local.x - s * local.y, s * local.x + c * local.y};
}

Vec3 Pose3::beam(Angle bearing) const {
    const auto [c, s] = cosSin(bearing);
    return Frame3(*this) * Vec3{c, s, 0};
}

Frame3::Frame3(const Pose3& pose) : origin(pose.position) {
    const Eigen::Matrix3d axes = isometryOf(pose).linear();
    forward = vecOf(axes.col(0));
    left = vecOf(axes.col(1));
    up = vecOf(axes.col(2));
}

}  // namespace ispace
