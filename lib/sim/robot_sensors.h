// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: what robots feel by themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "geom/pose.h"
#include "layout/robot.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

constexpr std::size_t kSonarRays = 37;

/// What each sonar of a robot at a pose measures: the nearest surface that one of 37 rays meets,
/// its axis and three circles about it up to the rim of the cone (6, 12 and 18 rays). +infinity: no
/// echo within the range; a nearer one than the least reads as the least. They are at three
/// quarters of the body's height. The floor sends sound away, never back. \param own owner of the
/// robot's body
std::vector<float> sonarRanges(const RobotModel& model, const Pose2& pose,
                               const RayWorld& environment, const MovingBodies& bodies,
                               std::uint32_t own);

/// Which bumpers touch something after a step along `bump` was cancelled: those with a place on the
/// rim (the circle of the model's radius, every quarter of a degree) that would have come to a
/// surface on that way. \param nearest distance to the nearest surface, up to the second argument
std::vector<bool> pressedBumpers(
    const RobotModel& model, const Pose2& pose, Vec2 bump,
    const std::function<double(Point2 place, double farthest)>& nearest);

}  // namespace ispace
