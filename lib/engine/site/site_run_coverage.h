// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coverage/run_coverage.h"
#include "site/site_coverage.h"

namespace ispace {

/// The coverage of a building's run: of each storey, and of all floors together.
struct SiteRunCoverage {
    std::vector<RunCoverage> storeys;  ///< without members where no mover came
    RunCoverage sum;
};

/// Adds up the metrics of each mover over the storeys on which it was; the time in lifts and on
/// stairs, where no sensors stand, is left out. The longest unseen interval is one on a storey.
/// Ways stay with the storeys. \param ids of the storeys
RunCoverage sumOverStoreys(std::span<const RunCoverage> storeys, std::span<const std::string> ids);

/// Adds the sections of a run, which outlives them. \param building whose run it is
void addRun(SiteParts& parts, const SiteScene& building, const SiteRunCoverage& run);

}  // namespace ispace
