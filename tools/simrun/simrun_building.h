// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/batch.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Runs a building whole, or replays its record, if ENV is one and no storey of it is chosen;
/// returns false otherwise. \throws UsageError for options that a building has not, and as
/// conclude()
bool runBuilding(const SimrunCommand& command, JunitFile& junit);

}  // namespace ispace
