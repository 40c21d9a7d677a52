// SPDX-License-Identifier: GPL-3.0-or-later
// scan of all storeys of a building.
#pragma once

#include <cstdint>
#include <optional>

#include "cli/building_operands.h"
#include "scan/scan_options.h"

namespace ispace {

/// Reads the sensors of all storeys, the lowest first. Returns the number of readings; nullopt,
/// without having done anything, if ENV is a room or one storey is chosen.
/// \throws UsageError for options about one room, and for a format that holds one storey
std::optional<std::int64_t> scanBuilding(const ScanCommand& command,
                                         const ScanToolOptions& options);

/// Draws the views of a building: those from above of each storey, orbits of the whole, others on
/// the storey that they name, with others as seen through shafts and over stairs.
/// \throws UsageError for a view from a position or an id without a storey
void takeBuildingViews(const ScanToolOptions& options, const BuildingInput& input);

}  // namespace ispace
