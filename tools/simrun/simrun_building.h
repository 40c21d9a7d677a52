// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "simrun/simrun_options.h"

namespace ispace {

class RunSite;

/// Reads a building, or its record, and warns of it; null if ENV is none, or one storey of it is
/// chosen. \throws UsageError for options that a building has not, and as the readers do
std::unique_ptr<RunSite> openBuilding(const SimrunCommand& command);

}  // namespace ispace
