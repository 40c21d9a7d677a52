// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/grid.h"

namespace ispace {

/// The outlines of a set of cells along the lines of the grid: counter-clockwise around cells,
/// clockwise around holes, corners only; cells that touch at a corner are apart. By the even-odd
/// rule they fill exactly the cells. Deterministic; O(cells of the grid).
std::vector<Polygon> contours(const Grid& grid, const CellSet& cells);

/// The same as pieces, each with its holes.
std::vector<Region> cellRegions(const Grid& grid, const CellSet& cells);

}  // namespace ispace
