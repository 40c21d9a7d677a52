// SPDX-License-Identifier: GPL-3.0-or-later
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
/// The directions in which a level laser sees cells: Laser::sweptSpan() and 1e-9 degrees more on
/// either side, so that rounding loses no cell on its outermost beams. None: it sees all around.
std::optional<Sector> sectorOf(const Laser& laser, Angle heading);

/// The cells that a level laser at `place` would see if it could face anywhere, split by direction:
/// part i holds those from limits[i] counter-clockwise to before limits[i + 1] (the last one: to
/// before limits[0]): centres strictly inside what the place sees and within max_range (see
/// withinRange); and one more part, limits.size(), the cell whose centre is the place itself,
/// if there is one. A laser whose sector goes from limits[i] to limits[j] sees parts i to j - 1
/// (around the end of the list where j < i) and that one, just as Sight::cellsOf() has it. Without
/// limits there is that part alone, with everything in it.
///
/// Reuses the memory of `parts`. O(query + rows * limits + runs)
/// \pre limits are in (-180, 180] degrees, ascending, all different
void cellsBySector(const Grid& grid, const Level& level, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts);

}  // namespace ispace
