// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/cells.h"

namespace ispace {

/// Whether cells beyond the grid count as if they were in the set.
enum class Beyond { In, Out };

/// The distance where no cell is outside the set.
constexpr int kNoDistance = 2'000'000'000;

/// The squared Euclidean distance, in cells, from the middle of each cell to that of the nearest
/// cell outside the set; in the order of MapCells::index. Exact (Meijster et al. 2000), O(cells).
std::vector<int> squaredDistances(const MapCells& cells, Beyond beyond);

/// The cell furthest from all cells outside the set, in steps to any of eight neighbours; ties go
/// to the lowest, then leftmost. O(cells). \pre not empty
CellPlace widestPlace(const MapCells& cells);

}  // namespace ispace
