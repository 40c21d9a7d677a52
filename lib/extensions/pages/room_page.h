// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a room or building without coverage: envc --report.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "cli/report_group.h"
#include "drawing/plan/found_rooms.h"
#include "report/page.h"
#include "scene/scene.h"

namespace ispace::pages {

struct RoomPageInput {
    const Scene& scene;
    std::string name;                       ///< base name of the input; "" from stdin
    std::string command;                    ///< as in histories
    const FoundRooms* found = nullptr;      ///< of an import; null: no import
    std::vector<Diagnostic> warnings = {};  ///< of the import
};

/// Builds the report of a room: its measures, plan, findings, zones, doors and windows, the rooms
/// of an import, and the records that are short enough to read.
ReportPage roomPage(const RoomPageInput& input);

/// Builds the page of a room alone, or of a building: of each storey that of its room, on sheets of
/// its own.
ReportPage pageOf(const RoomReport& report);

}  // namespace ispace::pages
