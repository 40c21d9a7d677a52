// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/cells.h"

namespace ispace {

/// Morphology of sets of cells, by OpenCV; nothing beyond the grid is in a set.
/// \throws std::bad_alloc

/// The union of all squares of `side` cells that lie in the set. \pre side >= 1
MapCells opened(const MapCells& cells, int side);

/// The cells with one of the set at most `reach` rows and columns away.
MapCells grown(const MapCells& cells, int reach);

/// For each piece its cell that is the most steps by sides from all cells outside the set; of equal
/// ones the lowest, then leftmost. \pre the pieces are joined by sides
std::vector<CellPlace> deepestPlaces(const MapCells& cells, const CellPieces& pieces);

}  // namespace ispace
