// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "layout/scene.h"
#include "raster/grid.h"
#include "solve/problem.h"

namespace ispace {

/// No sensor like this, wherever it stands and however it looks, sees more cells of the grid, of a
/// plane at whatever height: the area within half a cell's diagonal of what may be in view, by the
/// area of a cell. That area is at most A + L d + pi d^2 (Steiner's formula) of a connected piece
/// of plane with area A and outline L, here at most those
/// - of the sector of its fan for a laser that does not sweep: a tilted or rolled one has it seen
///   from above, where nothing is longer or larger;
/// - of the disc of its range for swept lasers, receivers and spherical rangers: what they see of a
///   plane is nowhere farther away;
/// - for pinholes of any plane section of the pyramid of their view, down to the depth of their
///   range, and of the disc of the farthest that is in view: of those that measure depth the
///   corners of the picture, beyond the range. A plane figure's area is the root of the sum of
///   squares of its three projections' areas, here at most the rectangle and two triangles of the
///   pyramid; a convex one's outline is at most pi times its diameter.
std::uint64_t mostCellsInView(const SensorModel& device, const Grid& grid);

/// An upper bound of the value of sensors at any places, on the grid that the problem's weights are
/// of: with what stands already, the dearest cells that as many as they can see together might be.
/// `devices` are those of the problem's kinds, `most` how many of each there are at most; with a
/// budget those that see most for their cost, the last one in part. `unit`: the share of what is no
/// receiver.
std::uint64_t mostFromAnyPlace(const Problem& problem, const Grid& grid,
                               std::span<const SensorModel> devices, std::span<const int> most,
                               int unit);

}  // namespace ispace
