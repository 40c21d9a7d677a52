// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms learned from the scans of a laser that moves: a map of occupied and free cells, then a
// room.
//
// Poses are those of the log, the corrected ones before odometry, and are taken as true: scans are
// not matched here, so that a log with drift gives double walls.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/budget.h"
#include "geom/pose.h"
#include "io/map/cell_map.h"

namespace ispace::calibration {

/// A level scan at a known pose. Beam k has bearing first + k * step; ranges at or beyond max_range
/// are no returns.
struct PosedScan {
    Pose2 pose;  ///< of the laser
    Angle first, step;
    double max_range = 0;
    std::vector<float> ranges;
};

/// Metres a cell unless a resolution is requested.
constexpr double kLearnedCell = 0.05;

/// Computes the map of occupied and free cells that scans see: each cell has the log odds of being
/// occupied, which rise with each return in it and fall with each beam through it (Moravec and
/// Elfes, High resolution maps from wide angle sonar, 1985; Thrun, Burgard and Fox, Probabilistic
/// Robotics, 9.2). Beams without return do not count, and the last cell before a return neither is
/// hit nor free: the surface may lie in it. O(beams * range / resolution)
/// \param file for messages \throws FormatError as checkCellMap(); without returns
CellMap occupancyOf(std::span<const PosedScan> scans, double resolution, const std::string& file,
                    const WorkLimit& limit = {});

/// Reads a log of scans with poses as a room: the map of its level scans, cells of
/// ImportOptions::resolution (default kLearnedCell), then as writeCellMap(). Features of up to
/// three cells are noise unless `clean` says otherwise: scans of a moving laser see legs of tables
/// often enough. \throws FormatError as parseLog() and occupancyOf(); no scan has a pose
Document readLogRoom(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas);

}  // namespace ispace::calibration
