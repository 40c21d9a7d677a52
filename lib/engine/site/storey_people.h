// SPDX-License-Identifier: GPL-3.0-or-later
// People at random places of a site: how many stand on each storey, and by which seed.
// Deterministic.
//
//     const auto people = spreadOverStoreys(building, 0, 30);  // in sum 30
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "site/site_coverage.h"
#include "site/site_scene.h"

namespace ispace {

/// Returns the seed of a storey: that of the building for the first one, so that it draws what its
/// room alone draws.
std::uint64_t seedOfStorey(std::uint64_t seed, std::size_t storey);

/// Divides a number of people among the storeys by their free floor: largest remainders. Without
/// free floor all stand on the first storey.
std::vector<std::size_t> spreadOverStoreys(const SiteCoverage& coverage, std::size_t people);
/// The same without measuring coverage. \param plane as in CoverageOptions
std::vector<std::size_t> spreadOverStoreys(const SiteScene& building, double plane,
                                           std::size_t people);

}  // namespace ispace
