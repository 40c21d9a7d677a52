// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "solve/coverage_state.h"

namespace ispace {

/// What all searches on one problem share. The problem must outlive it.
struct SearchBasis {
    /// Prices all candidates alone, with what stands: O(runs), on all cores.
    explicit SearchBasis(const Problem& of);

    /// A state with nothing chosen.
    [[nodiscard]] CoverageState emptyState() const { return {problem, part_weights}; }

    const Problem& problem;
    std::vector<std::uint32_t> part_weights;  ///< weightsOfParts
    std::vector<int> limits;                  ///< limitsOf
    /// Per kind and candidate: the parts that it adds alone. With others placed it adds no more.
    std::vector<std::vector<std::uint32_t>> alone;
    std::vector<std::vector<std::uint32_t>> site_parts;  ///< the most of these at each site
    /// Per kind and site: no candidate there ever adds more to the cells met. With a demand of 1
    /// the same as site_parts.
    std::vector<std::vector<std::uint32_t>> site_met;
};

/// Places all that may still be placed, each where it adds most parts of demands, met at last or
/// not; in the order asked for if there is one; with `per_cost` by gain for cost. For the starts of
/// swaps.
void placeRest(const SearchBasis& basis, bool per_cost, CoverageState& state, Progress& progress);

}  // namespace ispace
