// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/cell_set.h"
#include "cover/slice_sight.h"
#include "raster/grid.h"

namespace ispace {

/// Sets `parts` to what a level sensor sees from a place up to max_range, if it may face anywhere,
/// in cells by their direction, which is directionOf() to the bit. Part i holds cells in directions
/// from limits[i] counter-clockwise to before limits[i + 1] (the last one: to before limits[0]),
/// and one more part, limits.size(), the cell whose centre is the place, if there is one: it is in
/// every direction. A fan whose fanArc() goes from limits[i] to limits[j] then sees parts i to j -
/// 1 (around the end of the list where j < i) and that one: the same cells as cellsSeen(), always.
/// Without limits that part is all that is seen.
///
/// The memory of `parts` is used again. O(look + rows * limits + runs), mostly no arc tangent.
/// \pre limits are in (-180, 180] degrees, ascending, all different
void cellsBySector(const Grid& grid, const SliceSight& sight, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts);

}  // namespace ispace
