// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "raster/cell_cleaning.h"

namespace ispace {

/// Makes slits of unknown floor that are one cell wide and end in the floor; see cleanRoom().
/// \return how many cells
std::size_t fillSlits(RoomCells& room);

/// Flattens bumps and dents of straight walls, one cell deep and up to three long. O(cells)
void flattenWalls(MapCells& floor);

}  // namespace ispace
