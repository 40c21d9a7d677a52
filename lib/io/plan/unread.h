// SPDX-License-Identifier: GPL-3.0-or-later
// The one rule for parts of a drawing that a reader cannot read but that may be walls: they are
// reported in a warning, so that a check fails, whatever else encloses a room.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/point.h"
#include "io/import_records.h"

namespace ispace {

/// An entity or element that was not read and may be a wall.
struct UnreadThing {
    std::string kind;               ///< as the file names it: 3DSOLID
    std::string layer = {};         ///< "": none
    std::optional<Point2> at = {};  ///< in the drawing's coordinates and units
    int line = 0;                   ///< of the file
    std::string block = {};         ///< around it; "": the drawing itself
};

/// Adds one warning for all: kinds with their counts, the first place of each kind, and `advice`.
/// \param advice for the user, as "explode them to lines first"
void warnOfUnread(const std::vector<UnreadThing>& things, const std::string& advice,
                  ImportRecords& out);

}  // namespace ispace
