// SPDX-License-Identifier: GPL-3.0-or-later
// How much the coverage of a building suffers: as figure_samples.h and failures.h have it of
// a room, over the floor of all storeys.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "coverage/requirement.h"
#include "extensions/robustness/crowd.h"
#include "extensions/robustness/failures.h"
#include "extensions/robustness/figure_samples.h"
#include "site/site_coverage.h"

namespace ispace::robustness {

/// People on each storey at the same time.
using SiteCrowd = std::vector<Crowd>;

/// As perturbMounting(). \param planned coverage of the building by `measure`
SampledFigures perturbSite(const SiteScene& building, const SiteCoverage& planned,
                           const CoverageOptions& measure, const MountingTolerance& tolerance,
                           int mountings, std::uint64_t seed,
                           std::span<const Requirement> requirements, Progress& progress);

/// As measureCrowds().
SampledFigures crowdSite(const SiteScene& building, const SiteCoverage& planned,
                         const CoverageOptions& measure, std::span<const SiteCrowd> crowds,
                         std::span<const Requirement> requirements, Progress& progress);

/// As worstFailures(): a sensor that sees several storeys fails for all of them.
std::vector<FigureLoss> worstFailuresOfSite(const SiteCoverage& coverage, int count,
                                            std::span<const Requirement> requirements);

}  // namespace ispace::robustness
