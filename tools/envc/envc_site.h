// SPDX-License-Identifier: GPL-3.0-or-later
// What envc reads, and what it makes of it: a room, or a building.
#pragma once

#include <string>
#include <vector>

#include "drawing/plan/found_rooms.h"
#include "envc/envc_options.h"
#include "io/importers.h"
#include "site/storeys.h"

namespace ispace {

/// The inputs as one site, with their edits and zones.
struct EnvcSite {
    StoreyedDocument document;  ///< of a room alone: a storey without an id
    FoundRooms found;           ///< of plans, maps and buildings, if requested
    ImportReport report;
    std::vector<Diagnostic> other_rooms = {};  ///< layouts of another room
    std::vector<std::string> files = {};       ///< all that were read, for -MD
};

/// Reads the inputs. \throws UsageError for options that do not fit them, and as readInputs() and
/// readBuilding()
EnvcSite readEnvcSite(const EnvcOptions& options);

/// Reports the findings of the site, and moves that resolve some. \throws FormatError with all
void checkSite(const EnvcOptions& options, const EnvcSite& site);

/// Describes, draws or writes the site, as the options say.
void writeSite(const EnvcOptions& options, const EnvcSite& site);

}  // namespace ispace
