// SPDX-License-Identifier: GPL-3.0-or-later
// For tests and benchmarks: creates many robots in a room, and drives them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "sim/world.h"

namespace ispace::testing {

/// Creates `count` robots of one model at points drawn from a seed: on the indoor floor, `gap` away
/// from bodies and from each other. Fewer if the room is full.
std::vector<PlacedRobot> crowd(const Environment& environment, const RobotModel& model,
                               std::size_t count, double gap, std::uint64_t seed);

/// Inserts `count` people 1.7 m tall at such points, clear of the scene's robots as well. Fewer if
/// the room is full.
void addPeople(Scene& scene, std::size_t count, double gap, std::uint64_t seed);

/// Gives each robot of the scene a laser of this kind at its centre of rotation, in the scene's
/// order.
void mountLasers(Scene& scene, const Laser& laser);

/// Wanders about as Stage's controller of that name does: ahead while the laser of the same index
/// sees room, else turning to the side with more of it. To be called after every step.
void wander(World& world);

/// The same without looking: robots and people without a motion plan move blindly, with a new
/// random speed and turn now and then.
void stumble(World& world, std::uint64_t seed);

}  // namespace ispace::testing
