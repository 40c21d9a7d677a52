// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "solve/search.h"

namespace ispace {

/// Per kind, the candidates that may still be part of something worth more than `value`, ascending:
/// the others are ruled out by the multipliers of the bound (reduced-cost fixing), or were before.
std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value);

/// Branch and bound over what is left: best and bound of `known` are improved until they are within
/// `gap`, the best is worth `enough`, or progress says stop. Each node is bounded by a Lagrangian
/// relaxation of its own, warm from its parent's multipliers, and rules out more candidates; nodes
/// with the highest bound come first, or the newest where the open ones take more than `most_bytes`
/// of memory. Deterministic unless stopped.
///
/// Where a budget can be shared out in more ways than CountChoice lists (20'000) there is no tree:
/// `known` comes back as it is, complete, with the bound it had.
/// \pre known.best need not exist: what is worth no more than its value is not looked for
SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress,
                            std::uint64_t enough = std::numeric_limits<std::uint64_t>::max(),
                            std::size_t most_bytes = kMostTreeBytes);

}  // namespace ispace
