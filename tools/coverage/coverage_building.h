// SPDX-License-Identifier: GPL-3.0-or-later
// coverage of all storeys of a building.
#pragma once

#include <string>
#include <vector>

#include "cli/batch.h"
#include "cli/operands.h"
#include "coverage/coverage_options.h"

namespace ispace {

/// Returns the operands, or what a record of --run holds: its scene, or its building.
std::vector<std::string> operandsOf(const CoverageToolOptions& options);

/// For a room that may be a storey of a building: names the product, for %s, as roomFile() does.
/// \throws UsageError for records of buildings
void takeStorey(CoverageToolOptions& options, const SceneInput& input);

/// Reports on a building, draws its maps and judges its requirements. \return false, without having
/// done anything, if ENV is a room or a storey is chosen
/// \throws UsageError for options about one room; UnmetError
bool coverBuilding(const CoverageToolOptions& options, JunitFile& junit);

/// Reports on the building of a job of --batch. \return false as coverBuilding()
bool coverBuildingOf(const BatchJob& job, const CoverageToolOptions& options, JobOutcome& outcome);

}  // namespace ispace
