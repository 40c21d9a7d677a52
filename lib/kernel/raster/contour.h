// SPDX-License-Identifier: GPL-3.0-or-later
// From cells to polygons: boundaries along cell edges, exact in units of cells, and smooth ones
// within a tolerance. In metres, corners round. Results depend on the cells alone: pure functions,
// thread-safe.
//
//     const std::vector<Region> rooms = cellRegions(grid, cells);  // areas are those of the cells
#pragma once

#include <vector>

#include "raster/cells.h"
#include "raster/grid.h"

namespace ispace {

/// Computes the boundary of a set of cells as closed curves along cell edges, corners only, in
/// cells (cell (x, y) is the square from (x, y) to (x + 1, y + 1)), the set on their left: outlines
/// run counter-clockwise, holes clockwise, in the order of their lowest, then leftmost edge.
///
/// At a corner shared by two diagonal cells, each curve stays with its cell, so 4-connected
/// components stay separate; curves may touch there but never cross. O(cells).
std::vector<Polygon> boundaryCurves(const MapCells& cells);

/// Replaces staircases of unit steps by lines through the midpoints of the steps, so a slanted wall
/// is straight again. Points move by at most half a cell. Corners of faces more than a few cells
/// long stay, and so do steps next to a run that is long enough to be a separate wall.
///
/// \param curves as of boundaryCurves
/// \param rigid cells with fixed corners; null: no fixed corners
std::vector<Polygon> withoutStairs(const std::vector<Polygon>& curves,
                                   const MapCells* rigid = nullptr);

/// Vectorises a 4-connected set of cells, in cell units: no edge is further than `tolerance` cells
/// from the cell edges; 0 returns the cell edges themselves. From half a cell on, staircases are
/// straightened first. Every hole remains.
/// \pre not empty
/// \param rigid cells, set or not, with fixed corners; null: no fixed corners
Region vectorised(const MapCells& cells, double tolerance, const MapCells* rigid = nullptr);

/// Returns boundaryCurves() of a set of cells, in the grid's metres: counter-clockwise around
/// cells, clockwise around holes. Filled by the even-odd rule they give exactly these cells.
/// O(cells of the grid).
std::vector<Polygon> contours(const Grid& grid, const CellSet& cells);

/// Returns the same, each outline with its holes.
std::vector<Region> cellRegions(const Grid& grid, const CellSet& cells);

}  // namespace ispace
