// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "cover/sector_cells.h"
#include "raster/grid.h"
#include "sensor/field_of_view.h"
#include "trace/ray_world.h"

namespace ispace {

/// Sets part k of `parts` to the cells that view k sees of a level plane: the same as cellsSeen()
/// of a ranger and cellsSeen() of a receiver give, but what several views look at is looked at
/// once. O(cells in reach * views + rays) \pre the views differ in the direction in which they face
/// only
void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts);

}  // namespace ispace
