// SPDX-License-Identifier: GPL-3.0-or-later
// Local search: one sensor moves at a time, from several starts, and from disturbed solutions.
//
// Ends at a local optimum of single moves, without a guarantee; bounds tell the gap.
// Starts run in parallel, share best responses by a cache, and give the same result in any order:
// of equal solutions that of the first start counts.
//
//     const Solution better = iteratedLocalSearch(problem, solution, {.seed = 1}, progress);
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "arrange/search/greedy_search.h"
#include "arrange/search/problem.h"
#include "base/error.h"

namespace ispace {

/// The best sensor to add to a given set.
struct Response {
    Choice choice;
    Score score = 0;
    bool is_found = false;
};

/// Stores best responses by the set they extend, shared by concurrent searches: different starts
/// reach the same sets. A response depends on its key alone, so results do not depend on timing.
/// Holds the first 100'000.
class ResponseCache {
  public:
    /// A 128-bit hash of a set, independent of order: collisions among millions are negligible.
    struct Key {
        explicit Key(const std::vector<Choice>& chosen);
        friend bool operator==(const Key&, const Key&) = default;
        std::uint64_t first = 0, second = 0;
    };

    [[nodiscard]] std::optional<Response> find(const Key& others) const;
    void store(const Key& others, const Response& response);

  private:
    struct Hash {
        std::size_t operator()(const Key& key) const { return key.first; }
    };
    mutable std::mutex mutex_;
    std::unordered_map<Key, Response, Hash> responses_;
};

/// Moves sensors one at a time to their best candidates until no move gains: by value, then partial
/// value, then lower cost.
class LocalSearch {
  public:
    /// \param enough the search ends once it reaches this value
    LocalSearch(const SearchBasis& basis, ResponseCache& cache, std::uint64_t enough,
                const Progress& progress);

    /// Adds the best sensor while the problem allows another.
    void fill(CoverageState& state);
    /// Moves to a local optimum, or until progress says stop. With a budget also buys others for
    /// one sensor.
    /// \pre the choices are feasible
    void improve(CoverageState& state);
    /// Also exchanges pairs of the least useful sensors. Slow: for the best solutions only.
    void improveByPairs(CoverageState& state);

  private:
    /// Upper bounds of the gain at each site, valid for these gains of the cells.
    struct SiteBounds {
        std::vector<std::uint32_t> gains;  ///< empty: any
        std::vector<std::uint32_t> bounds;
    };
    using Slot = std::vector<SiteBounds>;  ///< per kind

    Response respond(const CoverageState& others, Slot& slot, const std::optional<Response>& known);
    BestCandidate bestOf(const CoverageState& others, std::size_t kind, SiteBounds& bounds,
                         const BestCandidate& known);
    void renew(SiteBounds& known, std::size_t kind);
    Slot& slotAt(std::size_t position);
    bool move(CoverageState& state, std::size_t position);
    bool add(CoverageState& state);
    void moveAll(CoverageState& state);
    bool rebuyOne(CoverageState& state);
    bool rebuyTwo(CoverageState& state, int& tries);
    [[nodiscard]] std::vector<std::size_t> leastUseful(const CoverageState& state) const;
    [[nodiscard]] bool isOver(const CoverageState& state) const {
        return state.value() >= enough_ || progress_.stopped();
    }
    bool rebuyWithout(CoverageState& state, const std::vector<std::size_t>& positions);

    const SearchBasis& basis_;
    ResponseCache& cache_;
    std::uint64_t enough_;
    const Progress& progress_;
    bool is_by_cost_ = false;  // there is a budget, and costs differ
    std::size_t max_slots_;
    CandidateFinder finder_;
    std::vector<Slot> slots_;                        // by position, the last for all beyond
    std::vector<std::uint32_t> gains_, more_gains_;  // of the search under way
    std::vector<std::uint32_t> rises_, most_;        // by cell; by site
    WeightSums sums_, more_sums_;
};

/// Length of an iterated local search.
struct KickOptions {
    std::uint64_t seed = 0;
    int rounds = 40;   ///< at most
    int patience = 4;  ///< rounds in a row without gain after which the search ends
    /// It ends once it reaches this value.
    std::uint64_t enough = std::numeric_limits<std::uint64_t>::max();
};

/// Improves a good solution: removes a few sensors with similar views, inserts others, and moves
/// all to a local optimum, again and again (H. R. Lourenço, O. C. Martin, T. Stützle, Iterated
/// local search, 2003). Chains run side by side for a round of a dozen kicks each, from the best so
/// far. Returns a solution never worse than `start`. Deterministic for any number of threads unless
/// progress says stop. \pre start is feasible
Solution iteratedLocalSearch(const Problem& problem, const Solution& start,
                             const KickOptions& options, Progress& progress);

}  // namespace ispace
