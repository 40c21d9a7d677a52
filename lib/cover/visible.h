// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cover/slice_sight.h"
#include "raster/grid.h"
#include "sensor/sensor.h"

namespace ispace {

/// True for a laser whose scans all lie in the slice at its height: level, and turning about the
/// vertical if it sweeps. Others are a matter of plane_view.h.
bool scansSlice(const Laser& laser, const Pose3& pose);
bool scansSlice(const Sensor& sensor);

/// The directions that a laser sees as it stands: those of Laser::sweptSpan().
struct FanLimits {
    Angle first;  ///< in the world
    Angle span;   ///< at most a full turn
};
FanLimits fanLimits(const Laser& laser, Angle heading);

/// The exact region of a laser: disjoint curves, what is seen on their left. What lies in a solid
/// that the sensor touches is not seen. \pre scansSlice(sensor), the sight is of its height
std::vector<Curve> regionSeen(const SliceSight& sight, const Sensor& sensor);

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

/// Centres within max_range (end included) strictly inside what a place sees.
VisibleCells visibleCells(const Grid& grid, const SliceSight& sight, Point2 place,
                          double max_range);

/// The cells of `visible` that lie in the fan of a level laser with this heading.
CellSet cellsInFan(const Grid& grid, const VisibleCells& visible, const Laser& laser,
                   Angle heading);

/// The region of a placed laser in cells: the same as cellsInFan() gives, without directions being
/// computed. \pre as regionSeen
CellSet cellsSeen(const Grid& grid, const SliceSight& sight, const Sensor& sensor);

/// Cells whose centre lies in the polygon through the sensor and the ends of its beams, seen from
/// above; a beam without return ends at max_range (thesis, section 4.5.2). `beams` as of castBeams.
CellSet cellsAmongBeams(const Grid& grid, const Sensor& sensor, std::span<const float> beams);

}  // namespace ispace
