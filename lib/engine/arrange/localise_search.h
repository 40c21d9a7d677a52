// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: layouts by the errors of positions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/coverage_model.h"
#include "arrange/search/search.h"
#include "base/error.h"

namespace ispace {

/// Value of a cell of weight 1 without an error; one at the limit, or above, has none.
constexpr std::uint64_t kNoError = std::uint64_t{1} << 20U;

/// Returns the value of these sensors and the standing ones: over all cells, the sum of weights
/// times kNoError (1 - error / limit), rounded down. \pre a view for each placement
std::uint64_t localisedValue(const CoverageModel& model, std::span<const CountedView> views,
                             std::span<const Placement> sensors);

/// Searches for the layout with the highest localisedValue().
///
/// Starts with greedy search, and with the layout found for coverage; Swap and Exact then move
/// single sensors while the value grows. The bound is the lower of two. The errors of a cell are at
/// least 2 / sqrt(t), t the sum of the traces of all information; the least concave function above
/// 1 - error / limit of t is submodular over the sensors, and no layout exceeds its value for the
/// layout found by more than the largest gains of so many sensors (Nemhauser, Wolsey, Fisher 1978).
/// And no cell has a value without cover, nor more than the best candidate gives it if all sensors
/// stand there, which is a problem of coverage. A gap remains in general.
/// \pre no budget, target or multiplicity is required
SearchResult searchLocalised(const CoverageModel& model, Progress& progress);

}  // namespace ispace
