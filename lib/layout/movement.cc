// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/movement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "layout/bodies.h"

namespace ispace {

double shareOfSwing(double speed) {
    constexpr double kFullSwing = 0.5;  // m/s
    return std::min(1.0, std::abs(speed) / kFullSwing);
}

Angle limbSwing(double phase, double speed) {
    return Angle::degrees(kMaxSwingDegrees * shareOfSwing(speed) *
                          std::sin(2 * std::numbers::pi * phase));
}

Pose3 poseOn(const Pose2& carrier, const Pose3& pose) {
    const Vec2 way = pose.position.onFloor() - carrier.position;
    const auto [c, s] = cosSin(carrier.heading);
    return {{way.x * c + way.y * s, way.y * c - way.x * s, pose.position.z},
            pose.heading - carrier.heading,
            pose.tilt,
            pose.roll};
}

}  // namespace ispace
