// SPDX-License-Identifier: GPL-3.0-or-later
// coverage of all storeys of a building.
#pragma once

#include "cli/batch.h"
#include "coverage/coverage_options.h"

namespace ispace {

/// Reports on a building, draws its maps and judges its requirements. \return false, without having
/// done anything, if ENV is a room or a storey is chosen
/// \throws UsageError for options about one room; UnmetError
bool coverBuilding(const CoverageToolOptions& options, JunitFile& junit);

/// Reports on the building of a job of --batch. \return false as coverBuilding()
bool coverBuildingOf(const BatchJob& job, const CoverageToolOptions& options, JobOutcome& outcome);

}  // namespace ispace
