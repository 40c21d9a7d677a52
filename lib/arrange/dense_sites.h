// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange only: the walls that candidates stand along.
#pragma once

#include <span>
#include <vector>

#include "env/environment.h"

namespace ispace {

/// The part of the slice that belongs to walls, fences, rooms, doors and windows.
Slice wallSlice(const Environment& environment, double height);

/// The closed curves with the floor on their left: the boundaries of its regions, joined with the
/// sheets that stand in it, which are followed along both sides. A sheet that touches nothing is a
/// curve of two vertices. Other sheets are left out. Deterministic. O(n log n)
std::vector<Polygon> wallCurves(const std::vector<Region>& floor, std::span<const Segment2> sheets);

/// The corners of a closed curve: its vertices without repeated ones and without those at which it
/// goes straight on, to within kWeldDistance (where another wall ends). Begins at the first corner
/// of the curve. O(n + squares of the pieces of each wall)
Polygon wallCorners(const Polygon& curve);

}  // namespace ispace
