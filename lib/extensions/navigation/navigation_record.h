// SPDX-License-Identifier: GPL-3.0-or-later
// A robot's run out of the records of one or more rooms, with the gaps to people.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "extensions/navigation/navigation_metrics.h"
#include "scene/run/run_reader.h"
#include "scene/scene.h"

namespace ispace::navigation {

/// The record of a room, whose moments are read one after another.
struct RoomRecord {
    std::string room;  ///< of a building: a storey, a lift, a flight of stairs; else ""
    RunReader reader;
};

/// A robot's part of a record.
struct RecordedNavigation {
    std::string robot;  ///< id in the record
    NavigationRun run;
    std::vector<std::string> rooms;  ///< by NavigationMoment::room
    bool is_cut = false;             ///< the record ends in the midst of a step
};

/// Radii of robots and people by their ids in the record.
using MoverRadii = std::map<std::string, double>;

/// Adds the radii of the movers of a scene.
void addRadii(const Scene& scene, MoverRadii& radii);

/// Reads a robot's run among people. Movers without a radius count as points. Moments at which the
/// robot is in no room are left out.
/// \param robot id; "": the only robot of the record
/// \throws FormatError as RunReader, and for a record without moments; UsageError for an unknown
/// robot, and without an id if there are several, which lists them
RecordedNavigation recordedNavigation(std::vector<RoomRecord> records, const std::string& robot,
                                      const MoverRadii& radii);

}  // namespace ispace::navigation
