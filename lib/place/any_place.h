// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "cover/grid.h"
#include "layout/scene.h"
#include "place/problem.h"

namespace ispace {

/// No sensor like this, wherever it stands and however it looks, sees more cells of the grid: the
/// area within half a cell's diagonal of its field of view (Steiner's formula), by the area of a
/// cell. Of a laser the sector of its fan (seen from above a tilted one is smaller), of swept ones,
/// rangers and receivers the disc of their range.
std::uint64_t mostCellsInView(const SensorDevice& device, const Grid& grid);

/// An upper bound of the value of sensors at any places, on the grid that the problem's weights are
/// of: with what stands already, the dearest cells that as many as they can see together might be.
/// `devices` are those of the problem's kinds, `most` how many of each there are at most; with a
/// budget those that see most for their cost, the last one in part. `unit`: the share of what is no
/// receiver.
std::uint64_t mostFromAnyPlace(const Problem& problem, const Grid& grid,
                               std::span<const SensorDevice> devices, std::span<const int> most,
                               int unit);

}  // namespace ispace
