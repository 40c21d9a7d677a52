// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <set>
#include <string>
#include <vector>

#include "io/dxf_shapes.h"
#include "io/import_options.h"
#include "io/import_records.h"

namespace ispace {

/// Writes the plan that the shapes of a drawing are, by layer, as readDxf does with those of its
/// file: walls, doors and windows of the largest region.
/// \throws FormatError: no line on the layers of walls
void writeLinePlan(std::vector<PlanShape> shapes, const std::set<std::string>& hidden_layers,
                   const std::string& name, const ImportOptions& options, ImportRecords& out);

}  // namespace ispace
