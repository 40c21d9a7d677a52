// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cover/grid.h"
#include "layout/laser.h"
#include "trace/ray_world.h"

namespace ispace {

/// The cells that a level laser at one place sees when it may face anywhere, with their
/// directions: one look per place, then a heading is a sector of it.
struct VisibleCells {
    struct Entry {
        std::uint32_t cell;
        float distance;    ///< metres from the sensor to the centre
        double direction;  ///< degrees in the world frame, (-180, 180]
    };
    std::vector<Entry> entries;  // by cell index
};

/// Centres within max_range (end included) that `world` lets `origin` see.
VisibleCells visibleCells(const Grid& grid, const RayWorld& world, Point3 origin, double max_range);

/// The cells of `visible` that lie in the fan of a level laser with this heading.
CellSet cellsInFan(const Grid& grid, const VisibleCells& visible, const Laser& laser,
                   Angle heading);

/// The region of a placed laser in cells: centres from first to last beam, within max_range, in
/// sight; the blind zone is not cut out. A tilted laser covers the floor below or above which its
/// scan plane passes in sight, above the floor.
CellSet cellsSeen(const Grid& grid, const RayWorld& world, const PlacedLaser& sensor);

}  // namespace ispace
