// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of buildings: several rooms, passages between them.
#pragma once

#include <memory>

#include "simrun/simrun_options.h"

namespace ispace {

class RunSite;
struct SiteInput;

/// Returns the run of a building. \throws as the readers of its record and its script
std::unique_ptr<RunSite> openBuilding(const SimrunCommand& command, SiteInput building);

}  // namespace ispace
