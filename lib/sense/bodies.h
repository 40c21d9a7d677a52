// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "layout/scene.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// The robots and people of a scene where they start; those of a robot are owned by its index in
/// Scene::robots.
std::vector<MovingBody> bodiesOf(const Scene& scene);

MovingBody robotBody(const RobotModel& model, const Pose2& pose, std::uint32_t owner);
/// A person's legs, trunk, arms and head.
std::vector<MovingBody> humanBodies(double height, const Pose2& pose, std::uint32_t owner);

}  // namespace ispace
