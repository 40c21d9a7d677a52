// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "raster/occupancy.h"

namespace ispace {

/// The boundary of a set of cells as closed curves along cell edges, corners only, in cells
/// (cell (x, y) is the square from (x, y) to (x + 1, y + 1)), the set on their left: outlines run
/// counter-clockwise, holes clockwise, in the order of their lowest, then leftmost edge.
///
/// Where two cells touch by a corner alone the curves pass each on its own side, so that what is
/// not 4-connected stays apart; curves touch there, none crosses. O(cells).
std::vector<Polygon> boundaryCurves(const MapCells& cells);

/// The curves with stairs of unit steps replaced by the lines through the middles of the steps, so
/// that a slanted wall is a straight line again. Nothing moves by more than half a cell. The
/// corners of faces that are no bump of a few cells stay, and so do steps beside runs long enough
/// to be a wall of their own.
/// \param curves as of boundaryCurves
/// \param rigid cells whose corners keep their places; null: none
std::vector<Polygon> withoutStairs(const std::vector<Polygon>& curves,
                                   const MapCells* rigid = nullptr);

/// The region that a 4-connected set of cells stands for, in cells, no edge further than
/// `tolerance` cells from the cell edges; 0 gives the cell edges themselves. From half a cell on
/// stairs go first. No hole is lost. \pre not empty
/// \param rigid cells, set or not, whose corners keep their places; null: none
Region vectorised(const MapCells& cells, double tolerance, const MapCells* rigid = nullptr);

}  // namespace ispace
