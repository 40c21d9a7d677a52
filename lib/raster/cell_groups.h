// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "raster/grid.h"

namespace ispace {

/// A piece of a set of cells that are joined by sides.
struct CellGroup {
    std::size_t cells = 0;   ///< how many
    std::size_t middle = 0;  ///< one as far from the rim of the piece as any, the first of them
};

/// The pieces of a set, the largest first; of equal ones the one that comes first. Deterministic.
/// O(cells of the grid)
std::vector<CellGroup> piecesOf(const Grid& grid, const CellSet& cells);

}  // namespace ispace
