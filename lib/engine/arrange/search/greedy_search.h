// SPDX-License-Identifier: GPL-3.0-or-later
// State and candidate finder of greedy and local search.
//
// A state keeps the multiplicity of each cell, so that a sensor is added or removed in the time of
// its runs, and the gain of every candidate follows from one prefix sum of the cells' gains. The
// finder weighs few sites. Partial gains never grow as sensors are added, so an old one bounds a
// new one; full gains grow where cells require several sensors, and have bounds that hold at any
// time (SearchBasis::site_full).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "arrange/search/cover_sets.h"
#include "arrange/search/problem.h"
#include "arrange/search/site_blocks.h"
#include "base/error.h"

namespace ispace {

/// Measure of the marginal gain of a sensor.
enum class Measure {
    Full,    ///< weights of the cells that become covered
    Partial  ///< weight * (min(multiplicity, required) after - before) of each cell, scaled
};

/// Computes the weights for Measure::Partial: those of the problem, halved until the partial value
/// of a sensor stays below 2^32 (needed only for multiplicities above 1 and large weights).
/// Positive weights stay positive unless there are too many cells.
std::vector<std::uint32_t> partialWeights(const Problem& problem);

/// Returns true if a kind takes several sensors to cover a cell.
bool takesSteps(const Problem& problem);

/// Stores the chosen sensors and the multiplicity that each cell achieves. Repeated choices count
/// once.
class CoverageState {
  public:
    /// \param partial partialWeights(problem); it and problem must outlive this
    CoverageState(const Problem& problem, const std::vector<std::uint32_t>& partial);

    /// Appends a choice or inserts it at a position. O(cells it sees + chosen)
    void add(const Choice& choice) { insert(chosen_.size(), choice); }
    void insert(std::size_t position, const Choice& choice);
    void removeAt(std::size_t position);
    void clear();

    [[nodiscard]] const Problem& problem() const { return *problem_; }
    [[nodiscard]] const std::vector<Choice>& chosen() const { return chosen_; }
    /// O(1)
    [[nodiscard]] bool holds(const Choice& choice) const;
    /// Returns valueOf(problem, chosen()).
    [[nodiscard]] std::uint64_t value() const { return value_; }
    /// Returns the sum of partial weight * min(multiplicity, required).
    [[nodiscard]] std::uint64_t partialValue() const { return partial_value_; }
    [[nodiscard]] double cost() const;
    /// Returns the number of chosen sensors of a kind.
    [[nodiscard]] int count(std::size_t kind) const { return counts_[kind]; }

    /// Returns true if one more of this kind is within `limit` and the budget.
    [[nodiscard]] bool canTake(std::size_t kind, int limit) const;
    /// Computes the gain of each cell if one more sensor of this kind sees it.
    void marginalGains(std::size_t kind, Measure measure, std::vector<std::uint32_t>& gains) const;
    /// Computes the gain of each cell if one more sensor of this kind sees it and others with a
    /// multiplicity of at most `to_come` together may follow: 0 if it is covered already or can no
    /// longer be, else its weight divided by the number of sensors of this kind that it still
    /// lacks. The sensor that completes a cell so gains all of it. Weights are scaled up as far as
    /// their sum stays below 2^32.
    void stepGains(std::size_t kind, std::uint64_t to_come,
                   std::vector<std::uint32_t>& gains) const;

  private:
    template <bool kAdds>
    void change(const Choice& choice);

    const Problem* problem_;
    const std::vector<std::uint32_t>* partial_weights_;
    std::uint32_t required_, step_scale_;
    std::vector<std::uint32_t> multiplicities_;  // per kind, at most required_
    std::vector<std::uint32_t> loads_;  // achieved by each cell, at first at most required_
    std::vector<Choice> chosen_;
    std::vector<std::unordered_map<std::size_t, int>> times_;  // of each, by kind and candidate
    std::vector<int> counts_;
    std::uint64_t value_ = 0, partial_value_ = 0;
};

/// Returns the maximum number of sensors of each kind: SensorType::most, at most as many as the
/// order lists, and 0 for a kind without candidates.
std::vector<int> limitsOf(const Problem& problem);

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
/// until no bound exceeds the best gain (M. Minoux, 1978, see search.h). Reuses its memory; not
/// thread-safe.
class CandidateFinder {
  public:
    /// Finds the best candidate that `allows` accepts (null: any), the first among equals; once
    /// progress says stop, the first one found.
    /// \param bounds per site, an upper bound of the primary gain; updated to the exact gain for
    ///        sites visited
    /// \param known an allowed candidate to start from, if any; it speeds up the search
    BestCandidate find(const CandidateGains& gains, std::span<std::uint32_t> bounds,
                       const BestCandidate& known, const std::function<bool(std::size_t)>& allows,
                       const Progress& progress);

  private:
    void visit(std::size_t site, const CandidateGains& gains, std::span<std::uint32_t> bounds,
               const std::function<bool(std::size_t)>& allows, BestCandidate& best);

    std::vector<std::uint64_t> queue_;  // a heap: bound, and the complement of the site
    std::vector<std::uint32_t> values_, more_;
};

/// Returns, per site, the maximum of `values` over its candidates.
std::vector<std::uint32_t> maxOfSites(const CandidateSet& candidates,
                                      std::span<const std::uint32_t> values);

/// Data that all searches on one problem share. The problem must outlive it.
struct SearchBasis {
    /// Weighs all candidates: O(runs), in parallel.
    explicit SearchBasis(const Problem& of);

    /// Returns a state without choices.
    [[nodiscard]] CoverageState emptyState() const { return {problem, partial_weights}; }

    const Problem& problem;
    std::vector<std::uint32_t> partial_weights;  ///< partialWeights
    std::vector<int> limits;                     ///< limitsOf
    /// Per kind and candidate, its partial gain if placed first: an upper bound of any later gain.
    std::vector<std::vector<std::uint32_t>> alone;
    std::vector<std::vector<std::uint32_t>> site_partial;  ///< the maximum of these at each site
    /// Per kind and site, an upper bound of the full gain of its candidates at any time. Equals
    /// site_partial if 1 is required.
    std::vector<std::vector<std::uint32_t>> site_full;
    std::vector<SiteBlocks> site_blocks = {};  ///< by kind, of a local search; see addBlocks()

    /// Computes site_blocks.
    void addBlocks();
};

/// Greedily adds all remaining sensors by partial gain (per unit of cost with `per_cost`), in the
/// order of the problem if there is one. Computes starting points for swap search.
void placeRest(const SearchBasis& basis, bool per_cost, CoverageState& state, Progress& progress);

}  // namespace ispace
