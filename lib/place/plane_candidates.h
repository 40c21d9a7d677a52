// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cover/sector_cells.h"
#include "raster/grid.h"
#include "sensor/field_of_view.h"
#include "trace/ray_world.h"

namespace ispace {

/// Sets part k of `parts` to the cells that view k sees of a level plane, the same as cellsSeen()
/// for a ranger or receiver; a cell in several views is traced once. O(cells in reach * views +
/// rays) \pre the views differ only in the direction they face
void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts);

}  // namespace ispace
