// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: finds the walls along which candidates stand.
//
// A wall is a straight stretch of a curve with floor on its left, whatever elements it consists of.
// The order of lines about a vertex is decided exactly; a vertex within kWeldDistance of a straight
// line is no corner. Pure functions.
#pragma once

#include <span>
#include <vector>

#include "env/environment.h"

namespace ispace {

/// Returns the part of the slice at a height, metres, that belongs to walls, fences, rooms, doors
/// and windows. O(n) once the level is known
Slice wallSlice(const Environment& environment, double height);

/// Returns the closed curves with the floor on their left: the boundaries of its regions, joined
/// with the sheets that stand in it, which are followed along both sides. A sheet that touches no
/// other line is a curve of two vertices. Sheets outside the floor are skipped. Ends of sheets
/// within kWeldDistance of a boundary are welded to it; if any crosses a boundary, all become
/// curves by themselves. Deterministic. O(n log n)
std::vector<Polygon> wallCurves(const std::vector<Region>& floor, std::span<const Segment2> sheets);

/// Returns the corners of a closed curve: its vertices without duplicates and without those at
/// which it goes straight on, to within kWeldDistance (where another wall ends). Begins at the
/// first corner of the curve. O(n + squares of the pieces of each wall)
Polygon wallCorners(const Polygon& curve);

}  // namespace ispace
