// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only: the walls that candidates stand along.
#pragma once

#include <span>
#include <vector>

#include "env/environment.h"

namespace ispace {

/// The part of the slice that belongs to walls, fences, rooms, doors and windows.
Slice wallSlice(const Environment& environment, double height);

/// The closed curves along which one walks with the floor on the left: the boundaries of its
/// regions, and the sheets that stand in it, once along each side, joined with what they end on. A
/// sheet that touches nothing is a curve of two corners. Other sheets are left out. The same for
/// the same floor and sheets. O(n log n)
std::vector<Polygon> wallCurves(const std::vector<Region>& floor, std::span<const Segment2> sheets);

/// The corners between the walls of a closed curve: its vertices without those at which it goes
/// straight on, to within the weld distance (pieces of a wall on which others end), and without
/// doubles. They begin with the first corner of the curve. O(n + squares of the pieces of each
/// wall)
Polygon wallCorners(const Polygon& curve);

}  // namespace ispace
