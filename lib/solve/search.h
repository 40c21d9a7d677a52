// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/progress.h"
#include "solve/problem.h"

namespace ispace {

/// Places one sensor after another, each on the candidate that adds most to those before it (thesis
/// section 4.6), among equals on the first; in problem.order if there is one, else the sensor that
/// adds most, with a budget: most for its cost (and then the better of that and of plain gain).
/// Where it takes several sensors to meet a demand, a cell counts by its weight shared out among
/// those that it still lacks, and not at all once those to come are too few; among equals the parts
/// met decide. Places all that fit, also those that add nothing; where progress says stop, the
/// first 32 all the same. Lazy (Minoux 1978): a place is looked at again only while what it may add
/// at most is more than the best so far. Its value is at least 1 - 1/e of the best where one
/// sensor meets a demand, all are of one kind, and there is no budget; of several kinds 1/2
/// (Fisher, Nemhauser & Wolsey 1978).
///
/// With is_connected each sensor after the first sees a cell that those before it see, if there is
/// such a candidate; then nothing is guaranteed.
Solution placeGreedily(const Problem& problem, Progress& progress);

struct SwapOptions {
    int starts = 20;  ///< from greedy and from so many others
    std::uint64_t seed = 0;
    /// Once something is worth so much, nothing better is looked for.
    std::uint64_t enough = std::numeric_limits<std::uint64_t>::max();
};

/// Local search: while it helps, one sensor is moved to the candidate that is best for it given the
/// others (and sensors of another kind are bought instead, where there is a budget); from the
/// greedy solution, where demands take several sensors also from one by parts of them, and from
/// random ones, each from its own random numbers, in parallel. The best result, the one of the
/// first start among equals; or that of the first start that is worth enough: the same for any
/// number of threads. Never worse than `start`. \pre start is feasible
Solution improveBySwaps(const Problem& problem, const Solution& start, const SwapOptions& options,
                        Progress& progress);

/// An upper bound, and the multipliers that prove it.
struct Bound {
    std::uint64_t value = 0;  ///< no feasible set of choices is worth more
    /// Lagrange multipliers of the cells, in units of 1 / scale of those of weights; each at most
    /// its cell's weight.
    std::vector<std::uint32_t> multipliers;
    std::uint32_t scale = 1;
    /// Per kind, the candidates that may be part of something worth more than `cut`, ascending; the
    /// others are ruled out.
    std::vector<std::vector<std::uint32_t>> survivors;
    std::uint64_t cut = 0;
};

/// Lagrangian relaxation: of max sum w_i y_i, demand y_i <= met_i + sum_j share_j a_ij x_j, 0 <= y
/// <= 1, the rows of the cells; multipliers by a subgradient method that ends where bound and
/// `best` are within `gap` (a fraction of the bound; 0: equal) or nothing moves any more. The
/// arithmetic is in whole numbers: the bound holds exactly. The same for any number of threads.
Bound boundByLagrange(const Problem& problem, const Solution& best, double gap, Progress& progress);

/// What a search found and how good it is.
struct SearchResult {
    Solution best;
    std::uint64_t bound = 0;  ///< no feasible set of choices is worth more
    bool is_complete = true;  ///< false if the search was stopped
};

enum class Optimizer { Greedy, Swap, Exact };

/// About so much memory the open nodes of a tree may take.
constexpr std::size_t kMostTreeBytes = std::size_t{1} << 30U;

struct SearchOptions {
    Optimizer optimizer = Optimizer::Swap;
    double gap = 0;  ///< of value to bound, as a fraction of the bound, that is good enough
    SwapOptions swap = SwapOptions();
    std::size_t most_bytes = kMostTreeBytes;
};

/// Greedy, then by options: with swaps, with the bound of Lagrange for all three (a quick one
/// before the swaps, so that there is one if time runs out, and for Greedy no other), and for Exact
/// with branch and bound until value and bound are within the gap. Candidates that the bound rules
/// out (their reduced value) are dropped first, cells that the same remaining candidates see are
/// merged, then the tree is searched; where a budget can be shared out among the kinds in more than
/// 20'000 ways there is no tree and the bound of Lagrange is all there is: it need not meet the
/// value. Ends early, is_complete = false, where progress says so. The same for any number of
/// threads unless it is stopped.
SearchResult search(const Problem& problem, const SearchOptions& options, Progress& progress);

/// The least that reaches a value.
struct Fewest {
    /// Of the cheapest found that reach the value one that is worth much, with the bound of what
    /// costs no more; else the best there is, without sensors that add nothing.
    SearchResult result;
    bool is_reached = false;
    bool is_all = false;    ///< not reached, and all candidates together are worth no more
    double cost = 0;        ///< of result, as tidyCost() has it
    double least_cost = 0;  ///< nothing cheaper reaches it; tidy, too
};

/// The fewest sensors, or the cheapest where costs differ, that are worth at least `wanted`: greedy
/// until it is reached; quick bounds tell how much less cannot be enough; then what lies between is
/// searched with the optimiser asked for, with long steps and few starts first; then better bounds,
/// and with swaps the most that can be had at that cost, but not for Greedy. Kinds without limit
/// have a `most` of about a thousand.
///
/// Exact ends with cost and least_cost equal unless it is stopped or has no tree (see search). But
/// where costs have so little in common that sets can cost more than 4000 different sums, up to
/// what the first one found costs, it looks at 4000 even steps of that only: then both may be off
/// the least by a step, and least_cost is below cost.
Fewest placeFewest(const Problem& problem, std::uint64_t wanted, const SearchOptions& options,
                   Progress& progress);

/// Tells value and bound: "best 85.7 %, at most 85.9 %", of all there is.
void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress);
inline void noteProgress(const Problem& problem, const SearchResult& result, Progress& progress) {
    noteProgress(problem, result.best.value, result.bound, progress);
}

}  // namespace ispace
