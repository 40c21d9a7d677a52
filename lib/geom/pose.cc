// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/pose.h"

namespace ispace {

Point2 Pose2::operator*(Point2 local) const { return position + *this * Vec2{local.x, local.y}; }

Vec2 Pose2::operator*(Vec2 local) const {
    const double c = cos(heading), s = sin(heading);
    return {c * local.x - s * local.y, s * local.x + c * local.y};
}

namespace {

/// The three turns of a pose.
struct Turns {
    CosSin heading, tilt, roll;

    explicit Turns(const Pose3& pose)
        : heading(cosSin(pose.heading)), tilt(cosSin(pose.tilt)), roll(cosSin(pose.roll)) {}
    /// Rx(roll), then Ry(-tilt), then Rz(heading), applied to (x, y, 0).
    [[nodiscard]] Vec3 turn(double x, double y) const {
        const Vec3 rolled{x, roll.cos * y, roll.sin * y};
        const Vec3 tilted{tilt.cos * rolled.x - tilt.sin * rolled.z, rolled.y,
                          tilt.sin * rolled.x + tilt.cos * rolled.z};
        return {heading.cos * tilted.x - heading.sin * tilted.y,
                heading.sin * tilted.x + heading.cos * tilted.y, tilted.z};
    }
};

}  // namespace

Vec3 Pose3::beam(Angle bearing) const {
    const auto [c, s] = cosSin(bearing);
    return Turns(*this).turn(c, s);
}

Frame3::Frame3(const Pose3& pose) : origin(pose.position) {
    const Turns turns(pose);
    forward = turns.turn(1, 0);
    left = turns.turn(0, 1);
    up = cross(forward, left);
}

}  // namespace ispace
