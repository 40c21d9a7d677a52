// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that level lasers see, for all headings at once: one visibility polygon is rasterised row
// by row, and its runs are cut where directions pass from one sector to the next. A cell counts by
// its centre. Thread-safe for different `parts`; each thread keeps its scratch memory.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/cell_set.h"
#include "env/level.h"
#include "raster/grid.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// Directions from `first` counter-clockwise to before `beyond`, both in (-180, 180] degrees.
struct Sector {
    Angle first, beyond;
    friend bool operator==(const Sector&, const Sector&) = default;
};
/// Returns the directions in which a level laser sees cells: Laser::sweptSpan(), widened by 1e-9
/// degrees on either side, so that rounding loses no cell on its outermost beams. Empty: all
/// directions.
std::optional<Sector> sectorOf(const Laser& laser, Angle heading);

/// Splits the cells that a level laser at `place` would see all around by direction: part i holds
/// the cells from limits[i] counter-clockwise to before limits[i + 1] (the last one: to before
/// limits[0]), with centres strictly inside the visibility polygon and within max_range (see
/// withinRange). The last part, limits.size(), holds the cell centred at the position, if there is
/// one. A laser with a sector from limits[i] to limits[j] sees parts i to j - 1 (around the end of
/// the list if j < i) and the last part, as VisibleArea::cellsOf() returns them. Without limits,
/// the last part holds all cells.
///
/// Reuses the memory of `parts`. O(query + rows * limits + runs)
/// \pre limits are in (-180, 180] degrees, ascending, all different
void cellsBySector(const Grid& grid, const LevelViews& views, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts);

}  // namespace ispace
