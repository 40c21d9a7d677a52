// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/error.h"
#include "layout/scene.h"

namespace ispace {

/// What is wrong with a scene though it can be compiled: each finding with its place and a cure, in
/// the order of the records, one for each pair, at most Diagnostics::kMax (looking ends there).
///
/// - Objects (furniture, pillars, ceiling frames, meshes) that share space with each other or with
///   a wall, in 3-D: a chair under a table is fine, and so is what touches within 1 um. What
///   belongs to the building may run into each other: pillars, ceiling frames and walls. Files of
///   meshes are compared at some heights that both sides share.
/// - Objects, robots, people, sensors, mats and gates that are not, or not wholly, in the room;
///   zones of which nothing is in it.
/// - Robots and people (as circles) that stand in things or in each other; sensors and tags inside
///   solids.
/// - Walls that cross, and ends of walls that hang in the room less than 0.2 m before another.
///
/// What is placed and cannot work where it stands is an error; what the environment allows but is
/// probably not meant is a warning.
///
/// O(n log n) for n things that stand beside each other.
Diagnostics checkScene(const Scene& scene);

}  // namespace ispace
