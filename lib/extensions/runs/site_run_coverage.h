// SPDX-License-Identifier: GPL-3.0-or-later
// Coverage of recorded motion in a site: of each storey, with what its sensors see of others, and
// in sum.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "extensions/runs/run_coverage.h"
#include "sense/detection.h"
#include "site/site_coverage.h"
#include "site/site_scene.h"

namespace ispace::runs {

/// The coverage of a building's run: of each storey, and of all floors together.
struct SiteRunCoverage {
    std::vector<RunCoverage> storeys;  ///< without members where no mover came
    RunCoverage sum;
};

/// Adds up the metrics of each mover over the storeys on which it was; the time in lifts and on
/// stairs, where no sensors stand, is left out. The longest unseen interval is one on a storey.
/// Ways stay with the storeys. \param ids of the storeys
RunCoverage sumOverStoreys(std::span<const RunCoverage> storeys, std::span<const std::string> ids);

/// Measures the record of a building's run, storey by storey and in sum. \param max_work of changes
/// \param warnings gets what could not be read or repeated \throws as measureRun()
SiteRunCoverage measureSiteRun(const SiteScene& building, const std::string& folder,
                               const WatchOptions& watch, std::optional<std::uint64_t> max_work,
                               std::vector<std::string>& warnings);

/// Adds the sections of a run, which outlives them. \param building whose run it is
void addRun(SiteParts& parts, const SiteScene& building, const SiteRunCoverage& run);

}  // namespace ispace::runs
