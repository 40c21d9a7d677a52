// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cli/batch.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Returns the building in a folder of its record; "" for a folder without one, as of one room.
/// \throws as fileOfRecord()
std::string recordedBuilding(const std::string& folder);

/// Runs a building whole, or replays its record, if ENV is one and no storey of it is chosen;
/// returns false otherwise. \throws UsageError for options that a building has not, and as
/// conclude()
bool runBuilding(const SimrunCommand& command, JunitFile& junit);

}  // namespace ispace
