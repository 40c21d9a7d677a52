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

/// Marginal gain of a candidate: the primary gain in the upper 32 bits, the tie breaker below.
using Score = std::uint64_t;

/// The best candidate found and its gain.
struct BestCandidate {
    std::size_t candidate = 0;
    Score score = 0;
    bool is_found = false;
};

/// The gains by which candidates are compared.
struct CandidateGains {
    const CandidateSet* candidates = nullptr;
    const WeightSums* first = nullptr;
    const WeightSums* second = nullptr;  ///< may be null
};

/// Finds the best candidate by lazy evaluation: visits sites in descending order of an upper bound
/// until no bound exceeds the best gain (Minoux 1978). Reuses its memory; not thread-safe.
class CandidateFinder {
  public:
    /// The best candidate that `allows` accepts (null: any), the first among equals; once progress
    /// says stop, the first one found.
    /// \param bounds per site, an upper bound of the primary gain; made exact for sites visited
    /// \param known an allowed candidate to start from, or none; it speeds the search up
    BestCandidate find(const CandidateGains& gains, std::span<std::uint32_t> bounds,
                       const BestCandidate& known, const std::function<bool(std::size_t)>& allows,
                       const Progress& progress);

  private:
    void lookAt(std::size_t site, const CandidateGains& gains, std::span<std::uint32_t> bounds,
                const std::function<bool(std::size_t)>& allows, BestCandidate& best);

    std::vector<std::uint64_t> queue_;  // a heap: bound, and the complement of the site
    std::vector<std::uint32_t> values_, more_;
};

/// Per site, the maximum of `values` over its candidates.
std::vector<std::uint32_t> maxOfSites(const CandidateSet& candidates,
                                      std::span<const std::uint32_t> values);

/// Data that all searches on one problem share. The problem must outlive it.
struct SearchBasis {
    /// Weighs all candidates: O(runs), in parallel.
    explicit SearchBasis(const Problem& of);

    /// A state with nothing chosen.
    [[nodiscard]] CoverageState emptyState() const { return {problem, partial_weights}; }

    const Problem& problem;
    std::vector<std::uint32_t> partial_weights;  ///< partialWeights
    std::vector<int> limits;                     ///< limitsOf
    /// Per kind and candidate, its partial gain if placed first: an upper bound of any later gain.
    std::vector<std::vector<std::uint32_t>> alone;
    std::vector<std::vector<std::uint32_t>> site_partial;  ///< the maximum of these at each site
    /// Per kind and site, an upper bound of the full gain of its candidates at any time. The same
    /// as site_partial if 1 is required.
    std::vector<std::vector<std::uint32_t>> site_full;
};

/// Greedily places all sensors that still may be placed, by partial gain (per unit of cost with
/// `per_cost`), in the order of the problem if there is one. Starting points for swap search.
void placeRest(const SearchBasis& basis, bool per_cost, CoverageState& state, Progress& progress);

}  // namespace ispace
