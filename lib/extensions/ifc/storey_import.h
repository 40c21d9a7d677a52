// SPDX-License-Identifier: GPL-3.0-or-later
// A storey of a building as the records of a room.
#pragma once

#include <cstddef>
#include <vector>

#include "extensions/ifc/reader/building.h"
#include "io/import_records.h"
#include "io/importers.h"
#include "io/plan/plan_rooms.h"

namespace ispace::ifc {

/// Writes the records of a storey: walls, doors, windows, zones, furniture and inside points.
/// \return the rooms that are kept
/// \throws FormatError (without a file) if it has neither walls nor spaces, and as NearSegments
std::vector<PlanRegion> writeStorey(const Building& building, std::size_t storey,
                                    const ImportOptions& options, Budget& work, ImportRecords& out);

}  // namespace ispace::ifc
