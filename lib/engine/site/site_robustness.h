// SPDX-License-Identifier: GPL-3.0-or-later
// How much the coverage of a building suffers: as coverage/robustness.h and coverage/crowd.h have
// it of a room, over the floor of all storeys.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "coverage/crowd.h"
#include "coverage/requirement.h"
#include "coverage/robustness.h"
#include "site/site_coverage.h"

namespace ispace {

/// People on each storey at the same time.
using SiteCrowd = std::vector<Crowd>;

/// Returns the seed of a storey: that of the building for the first one, so that it draws what its
/// room alone draws.
std::uint64_t seedOfStorey(std::uint64_t seed, std::size_t storey);

/// Divides a number of people among the storeys by their free floor: largest remainders. Without
/// free floor all stand on the first storey.
std::vector<std::size_t> spreadOverStoreys(const SiteCoverage& coverage, std::size_t people);
/// The same without measuring coverage. \param plane as in CoverageOptions
std::vector<std::size_t> spreadOverStoreys(const SiteScene& building, double plane,
                                           std::size_t people);

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

}  // namespace ispace
