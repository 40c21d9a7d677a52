// SPDX-License-Identifier: GPL-3.0-or-later
// scan of all storeys of a building.
#pragma once

#include "scan/scan_options.h"

namespace ispace {

/// Reads the sensors of all storeys, the lowest first. \return false, without having done anything,
/// if ENV is a room or a storey is chosen
/// \throws UsageError for options about one room, and for a format that holds one storey
bool scanBuilding(const ScanCommand& command);

}  // namespace ispace
