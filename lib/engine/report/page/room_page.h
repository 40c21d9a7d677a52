// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "drawing/plan/found_rooms.h"
#include "report/page/page.h"
#include "scene/scene.h"

namespace ispace {

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

}  // namespace ispace
