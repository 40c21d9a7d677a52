// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/pose.h"

#include <algorithm>
#include <cmath>

#include "geom/rotation.h"

namespace ispace {

Point2 Pose2::operator*(Point2 local) const { return position + *this * Vec2{local.x, local.y}; }

Vec2 Pose2::operator*(Vec2 local) const {
    const auto [c, s] = cosSin(heading);
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

namespace {

/// About one of the axes; Eigen's AngleAxis would not be exact at quarter turns.
Eigen::Matrix3d matrixAbout(int axis, Angle angle) {
    const auto [c, s] = cosSin(angle);
    const int next = (axis + 1) % 3, last = (axis + 2) % 3;
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    m(next, next) = m(last, last) = c;
    m(next, last) = -s;
    m(last, next) = s;
    return m;
}

}  // namespace

Eigen::Isometry3d isometryOf(const Pose3& pose) {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.linear() =
        matrixAbout(2, pose.heading) * (matrixAbout(1, -pose.tilt) * matrixAbout(0, pose.roll));
    frame.translation() = vectorOf(pose.position - Point3());
    return frame;
}

Eigen::Quaterniond turnAbout(int axis, Angle angle) {
    const auto [c, s] = cosSin(0.5 * angle);
    Eigen::Quaterniond turn(c, 0, 0, 0);
    turn.coeffs()[axis] = s;
    return turn;
}

Eigen::Quaterniond quaternionOf(const Pose3& pose) {
    return turnAbout(2, pose.heading) * turnAbout(1, -pose.tilt) * turnAbout(0, pose.roll);
}

Pose3 poseOf(Point3 position, const Eigen::Quaterniond& rotation) {
    const Eigen::Quaterniond q = rotation.normalized();
    if (q.x() == 0 && q.y() == 0)
        return {position, wrapped(Angle::radians(2 * std::atan2(q.z(), q.w()))), {}, {}};
    const Eigen::Matrix3d m = q.toRotationMatrix();  // columns: forward, left, up
    const double rise = m(2, 0);
    // Straight up or down heading and roll turn about the same axis: all is heading then.
    constexpr double kStraight = 1 - 1e-12;
    if (std::fabs(rise) >= kStraight)
        return {position, directionOf(m(1, 1), -m(0, 1)), Angle::degrees(rise > 0 ? 90 : -90), {}};
    const Angle tilt = Angle::radians(std::asin(std::clamp(rise, -1.0, 1.0)));
    return {position, directionOf(m(0, 0), m(1, 0)), tilt, directionOf(m(2, 2), m(2, 1))};
}

}  // namespace ispace
