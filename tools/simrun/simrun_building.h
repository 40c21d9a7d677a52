// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/batch.h"
#include "simrun/simrun_options.h"

namespace ispace {

/// Runs a building whole if ENV is one and no storey of it is chosen; returns false otherwise.
/// \throws UsageError for options that a building has not
bool runBuilding(const SimrunCommand& command);

}  // namespace ispace
