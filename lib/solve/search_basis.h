// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/progress.h"
#include "solve/candidate_set.h"
#include "solve/coverage_state.h"

namespace ispace {

/// What a candidate adds: the first price in the upper half, the second, which decides among
/// equals, in the lower half.
using Score = std::uint64_t;

/// A candidate and what it adds.
struct BestPlace {
    std::size_t candidate = 0;
    Score score = 0;
    bool is_found = false;
};

/// By what candidates are compared.
struct PlacePrices {
    const CandidateSet* candidates = nullptr;
    const CellPrices* first = nullptr;
    const CellPrices* second = nullptr;  ///< may be missing
};

/// Finds the best candidate, lazily: sites in descending order of an upper bound, until no bound is
/// more than the best found (Minoux 1978). Keeps its memory from call to call; not thread-safe.
class PlaceFinder {
  public:
    /// The best candidate that `allows` accepts (missing: any), the first among equals.
    /// Once progress says stop, what is found first is taken.
    /// \param bounds per site, no first price of its candidates is more; those looked at get exact
    /// \param known a candidate to begin with, allowed, or none; with one the same is found earlier
    BestPlace find(const PlacePrices& prices, std::span<std::uint32_t> bounds,
                   const BestPlace& known, const std::function<bool(std::size_t)>& allows,
                   const Progress& progress);

  private:
    void lookAt(std::size_t site, const PlacePrices& prices, std::span<std::uint32_t> bounds,
                const std::function<bool(std::size_t)>& allows, BestPlace& best);

    std::vector<std::uint64_t> queue_;  // a heap: bound, and the complement of the site
    std::vector<std::uint32_t> values_, more_;
};

/// The most that a candidate of each site has of `values` (per candidate).
std::vector<std::uint32_t> mostOfSites(const CandidateSet& candidates,
                                       std::span<const std::uint32_t> values);

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
