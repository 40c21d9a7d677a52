// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/slice.h"
#include "io/plan/plan_lines.h"

namespace ispace {

/// The cut through meshes as lines of a plan, straight within 1 mm. Solids whose edges meet, as
/// walls that run into each other, are united; one inside another stays, as furniture in a room
/// modelled by its inner surface.
std::vector<PlanPath> cutPaths(Slice slice);

/// Joins sheets that meet within 1 mm, and makes solids of the closed ones: where openings are cut
/// out, faces of assimp's solids no longer share edges.
void closeLoops(Slice& slice);

}  // namespace ispace
