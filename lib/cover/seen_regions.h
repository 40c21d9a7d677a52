// SPDX-License-Identifier: GPL-3.0-or-later
// Covered floor as regions, for formats of areas: exact where that is known (see withArcAreas()),
// else outlines of cells.
#pragma once

#include <cstdint>
#include <vector>

#include "cover/coverage.h"

namespace ispace {

/// The most sensors that see one place. \param cell_times timesSeen()
std::uint32_t mostSeen(const Coverage& coverage, const std::vector<std::uint32_t>& cell_times);

/// What one sensor sees.
std::vector<Region> viewRegions(const SensorView& view, const Grid& grid);

/// Indoor floor seen by exactly so many sensors; 0: the unseen. \param cell_times timesSeen()
std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times);

}  // namespace ispace
