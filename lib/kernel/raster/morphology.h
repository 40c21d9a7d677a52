// SPDX-License-Identifier: GPL-3.0-or-later
// Morphology of sets of cells (J. Serra, Image Analysis and Mathematical Morphology, 1982); sets do
// not extend beyond the grid. All functions take O(cells), whatever the size of the square, and are
// pure: thread-safe, exact in whole cells.
//
//     const MapCells wide = opened(free, 6);         // passages of six cells and more
//     const CellIndex middle = widestPlace(wide);
#pragma once

#include <vector>

#include "raster/cells.h"

namespace ispace {

/// Returns the union of all squares of `side` cells that lie in the set.
/// \pre side >= 1
MapCells opened(const MapCells& cells, int side);

/// Returns the cells with one of the set at most `reach` rows and columns away.
MapCells grown(const MapCells& cells, int reach);

/// Finds for each piece the cell with the most steps by sides to all cells outside the set; of
/// equal ones the lowest, then leftmost.
/// \pre the pieces are joined by sides
std::vector<CellIndex> deepestPlaces(const MapCells& cells, const CellPieces& pieces);

/// Rule that counts cells beyond the grid as inside or outside the set.
enum class BorderRule { In, Out };

/// The distance if every cell is in the set.
constexpr int kNoDistance = 2'000'000'000;

/// Computes the squared Euclidean distance, in cells, from the middle of each cell to that of the
/// nearest cell outside the set; in the order of MapCells::index. Exact (A. Meijster, J. B. T. M.
/// Roerdink, W. H. Hesselink, A general algorithm for computing distance transforms in linear time,
/// 2000), O(cells).
std::vector<int> squaredDistances(const MapCells& cells, BorderRule beyond);

/// Finds the cell furthest from all cells outside the set, in steps to any of eight neighbours;
/// ties go to the lowest, then leftmost. O(cells).
/// \pre not empty
CellIndex widestPlace(const MapCells& cells);

}  // namespace ispace
