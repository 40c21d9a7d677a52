// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/cell_cleaning.h"

namespace ispace {

/// Takes strips of floor away that are one cell wide, or two where no occupied cell is near, with
/// what hangs on them; see cleanRoom(). O(cells)
void removeSpikes(RoomCells& room, double resolution, const std::vector<CellPlace>& keep,
                  Cleaning& done);

}  // namespace ispace
