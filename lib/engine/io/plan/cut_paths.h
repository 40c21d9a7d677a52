// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts through meshes of buildings as plans of lines.
#pragma once

#include <vector>

#include "base/budget.h"
#include "env/slice.h"
#include "io/plan/plan_lines.h"

namespace ispace {

/// Cuts of meshes are straight within this, in metres: floats of a file vary by less.
constexpr double kMeshStraight = 0.001;

/// Returns the cut through meshes as lines of a plan, straight within kMeshStraight: closed paths
/// of solids, then open ones of sheets. Walls that run into each other are united. A solid wider
/// than a wall, such as the inner surface of a room, and what stands at it or in it remain apart.
/// \param work pays for outlines that cross each other often
/// \throws FormatError (without file and line) if the work is used up
std::vector<PlanPath> cutPaths(Slice slice, Budget& work);

}  // namespace ispace
