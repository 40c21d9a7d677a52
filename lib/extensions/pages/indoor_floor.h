// SPDX-License-Identifier: GPL-3.0-or-later
// Floor of its room that each sensor sees, without the floor beyond open doors.
#pragma once

#include <optional>
#include <vector>

#include "coverage/coverage.h"
#include "scene/scene.h"

namespace ispace::pages {

/// The indoor floor of a sensor, m2. SensorMetrics also counts floor beyond open doors and windows,
/// which is none of a client's room.
struct IndoorFloor {
    double seen = 0;
    double alone = 0;  ///< seen by no other one; of receivers by no other kind
};

/// Computes the floor of each of Coverage::sensors: exact where regions are known, else by cells.
std::vector<IndoorFloor> indoorFloors(const Scene& scene, const Coverage& coverage);

}  // namespace ispace::pages
