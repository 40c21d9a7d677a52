// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/occupancy.h"

namespace ispace {

/// Whether cells beyond the grid count as if they were in the set.
enum class Beyond { In, Out };

/// Stands for "no cell is outside the set".
constexpr int kNoDistance = 2'000'000'000;

/// The squared Euclidean distance, in cells, from the middle of each cell to that of the nearest
/// cell outside the set; in the order of MapCells::index. Exact (Meijster et al. 2000), O(cells).
std::vector<int> squaredDistances(const MapCells& cells, Beyond beyond);

/// What a disc reaches that stays in the set and can be moved, by steps to neighbours by sides,
/// from where it covers one of `from`; without any of them, from the widest stretch.
/// Empty if the disc does not fit anywhere (there).
/// \param radius in cells; cells whose middles come nearer than it to the set's edge are no place
/// for the disc's middle
MapCells reachedByDisc(const MapCells& cells, double radius, const std::vector<CellPlace>& from);

}  // namespace ispace
