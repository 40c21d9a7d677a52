// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "raster/occupancy.h"

namespace ispace {

/// Cells of a grid through which wall lines pass, so that no step by a side leads across a line.
/// \param lines in cells, cell (x, y) being the square from (x, y) to (x + 1, y + 1)
MapCells barrierCells(const std::vector<Segment2>& lines, int width, int height);

/// Cells to take away from the free ones so that what is open to the grid's border and what is not
/// are apart, where openings between cells that are not free count as closed if they are at most
/// `width` cells wide, give or take one. Floor to which a disc of that diameter does not come
/// belongs to the side from which the way to it is widest, so an opening is cut where it is
/// narrowest; openings between inner rooms stay. O(cells + width squared).
MapCells gapCells(const MapCells& free, double width);

}  // namespace ispace
