// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/cells.h"

namespace ispace {

// Morphology of sets of cells; nothing beyond the grid is in a set. All take O(cells).

/// The union of all squares of `side` cells that lie in the set. \pre side >= 1
MapCells opened(const MapCells& cells, int side);

/// The cells with one of the set at most `reach` rows and columns away.
MapCells grown(const MapCells& cells, int reach);

/// For each piece its cell that is the most steps by sides from all cells outside the set; of equal
/// ones the lowest, then leftmost. \pre the pieces are joined by sides
std::vector<CellIndex> deepestPlaces(const MapCells& cells, const CellPieces& pieces);

/// Whether cells beyond the grid count as if they were in the set.
enum class BorderRule { In, Out };

/// The distance where no cell is outside the set.
constexpr int kNoDistance = 2'000'000'000;

/// The squared Euclidean distance, in cells, from the middle of each cell to that of the nearest
/// cell outside the set; in the order of MapCells::index. Exact (Meijster et al. 2000), O(cells).
std::vector<int> squaredDistances(const MapCells& cells, BorderRule beyond);

/// The cell furthest from all cells outside the set, in steps to any of eight neighbours; ties go
/// to the lowest, then leftmost. O(cells). \pre not empty
CellIndex widestPlace(const MapCells& cells);

}  // namespace ispace
