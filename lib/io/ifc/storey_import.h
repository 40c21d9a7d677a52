// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "io/ifc/building.h"
#include "io/import_records.h"
#include "io/importers.h"

namespace ispace {

/// Writes the records of a storey: walls, doors, windows, zones, furniture and inside points.
/// \throws FormatError (without a file) if it has neither walls nor spaces, and as NearSegments
void writeStorey(const Building& building, std::size_t storey, const ImportOptions& options,
                 Budget& work, ImportRecords& out);

}  // namespace ispace
