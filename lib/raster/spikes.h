// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "raster/cleaning.h"

namespace ispace {

/// Removes strips of floor that are one cell wide, or at most `width` metres where no occupied cell
/// is near, with what is connected only through them; see cleanRoom(). O(cells)
void removeSpikes(MapRoom& room, double resolution, double width,
                  const std::vector<CellPlace>& keep, Cleaning& done);

}  // namespace ispace
