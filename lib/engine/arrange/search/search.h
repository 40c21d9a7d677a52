// SPDX-License-Identifier: GPL-3.0-or-later
// Searches for good layouts, with a proven upper bound. Greedy is the fastest and has a guarantee
// for simple problems; Swap improves its layout and bounds the gap; Exact closes the gap by branch
// and bound, in time that may grow exponentially with the number of sensors.
//
//     SearchOptions options;
//     options.optimizer = Optimizer::Exact;
//     options.gap = 0.005;
//     const SearchResult result = search(problem, options, progress);
//     const double missed = double(result.bound - result.best.value) / double(result.bound);
//
// A result is feasible and has the value stated, whether or not the search was stopped; `bound`
// holds in any case.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "arrange/search/problem.h"
#include "arrange/search/search_share.h"
#include "base/error.h"

namespace ispace {

/// Greedy search (thesis section 4.6): adds sensors one by one, each on the candidate with the
/// largest marginal gain, the first among equals. problem.order sets the order of kinds; without it
/// the best kind comes next, and with a budget the better of two runs counts, one by gain and one
/// by gain per cost. If a cell requires several sensors, its weight is divided among those it still
/// lacks, and is 0 once too few are left; partial gains break ties. Adds every sensor that fits,
/// even without gain, and at least the first 32 if progress says stop.
///
/// Lazy: a candidate is evaluated again only while its upper bound exceeds the best gain (M.
/// Minoux, Accelerated greedy algorithms for maximizing submodular set functions, 1978). Reaches at
/// least 1 - 1/e of the optimum if one sensor covers a cell, there is one kind and no budget (G. L.
/// Nemhauser, L. A. Wolsey, M. L. Fisher, An analysis of approximations for maximizing submodular
/// set functions, 1978); 1/2 with several kinds (part II by Fisher, Nemhauser & Wolsey).
///
/// With is_connected each sensor after the first shares a cell with those before it, if any
/// candidate does; no guarantee holds then.
Solution placeGreedily(const Problem& problem, Progress& progress);
/// The same; returns an empty solution if the greedy one is not feasible.
Solution placeFeasibly(const Problem& problem, Progress& progress);

struct SwapOptions {
    int starts = 20;  ///< random starts, besides the greedy one
    std::uint64_t seed = 0;
    /// The search ends once it reaches this value.
    std::uint64_t enough = std::numeric_limits<std::uint64_t>::max();
    /// Feasible sensors, of solutions of similar problems, to search from as from `start`.
    std::vector<std::vector<Choice>> more = {};
    /// Receives the sensors found from each start, the best first; null: none.
    std::vector<std::vector<Choice>>* ends = nullptr;
    /// Null: the whole search. A shard of starts stores its solutions and returns `start`.
    const SearchShare* share = nullptr;
};

/// Local search: moves one sensor at a time to its best candidate given the others, while that
/// gains; with a budget it also swaps sensors for those of other kinds. Starts from `start`, from a
/// greedy solution by partial gains if cells require several sensors, and from random solutions, in
/// parallel. Returns the best result, of the first start among equals, or that of the first start
/// to reach options.enough: deterministic for any number of threads. Never worse than `start`.
/// \pre start is feasible
Solution improveBySwaps(const Problem& problem, const Solution& start, const SwapOptions& options,
                        Progress& progress);

/// The best solution found and an upper bound.
struct SearchResult {
    Solution best;
    std::uint64_t bound = 0;  ///< no feasible solution has a larger value
    bool is_complete = true;  ///< false if the search was stopped
};

enum class Optimizer { Greedy, Swap, Exact };
constexpr Optimizer kOptimizers[] = {Optimizer::Greedy, Optimizer::Swap, Optimizer::Exact};
/// Returns the name on the command line and in results.
std::string_view nameOf(Optimizer optimizer);

/// Default memory limit of the open nodes of a search tree.
constexpr std::size_t kMaxTreeBytes = std::size_t{1} << 30U;

/// Findings of one search that speed up the next one of a series of similar problems, with the same
/// candidates and cells.
struct SimilarSearch {
    /// Sensors found from the last starts, the best first: feasible in the next problem, which is
    /// searched from these, and from fewer random starts.
    std::vector<std::vector<Choice>> starts;
    std::vector<std::uint32_t> multipliers;  ///< of the last bound; empty: none
};

struct SearchOptions {
    Optimizer optimizer = Optimizer::Swap;
    double gap = 0;  ///< relative gap (bound - value) / bound at which the search ends
    SwapOptions swap = SwapOptions();
    std::size_t max_bytes = kMaxTreeBytes;
    SearchShare share = SearchShare();
    /// Read before a search, its multipliers are written after it; null: none.
    SimilarSearch* similar = nullptr;
};

/// Greedy search; then, depending on the optimizer, swap search and branch and bound. Computes
/// Lagrangian bounds: a quick one before the swaps, in case time runs out (the only one for
/// Greedy), and a tight one after. If more than 0.5 % remains, Exact kicks the best solution a
/// little; with six sensors or more it then computes overlapBound() and kicks at length. It removes
/// the candidates that the bound excludes by their reduced costs, merges cells that the same
/// remaining candidates see, and branches until value and bound are within the gap. Swap and Exact
/// branch at once, without swaps from random starts, if the quick bound leaves few sets of up to
/// five sensors and there is no budget. If a budget can be split among the kinds in more than
/// 20'000 ways no tree is built, and a gap may remain. Returns early, with is_complete = false, if
/// progress says stop. Deterministic for any number of threads unless it is stopped. A shard of
/// starts ends after the swaps, one of the tree after its subtrees, see SearchShare.
SearchResult search(const Problem& problem, const SearchOptions& options, Progress& progress);

/// A cheapest solution that reaches a given value.
struct MinimumCostCover {
    /// One of the cheapest solutions found, with a bound for its cost; if the value is not reached,
    /// the best solution found, without sensors of gain 0.
    SearchResult result;
    bool is_reached = false;
    bool is_all = false;    ///< even all candidates together do not reach it
    double cost = 0;        ///< of result, normalised
    double cost_bound = 0;  ///< lower bound of the cost, normalised
};

/// Minimum-cost cover: finds the cheapest sensors (the fewest, if all cost the same) that reach the
/// value `wanted`. Greedy search finds a first solution and quick bounds a lower limit of the cost;
/// the costs between them are searched with the optimizer of the options, in long steps with few
/// starts first. Tighter bounds follow and, except for Greedy, a swap search for the best value at
/// that cost. Kinds without a limit should have a `most` of about a thousand.
///
/// Exact ends with cost == cost_bound unless it is stopped or has no tree (see search()). If
/// solutions can have more than 4000 different costs, it searches 4000 even steps instead: cost and
/// cost_bound may then be off by one step.
MinimumCostCover minimumCostCover(const Problem& problem, std::uint64_t wanted,
                                  const SearchOptions& options, Progress& progress);

/// Sensors that see every cell of positive weight, and a lower bound of their number.
struct WholeCover {
    std::vector<Choice> chosen;
    std::size_t bound = 1;
};
/// Solves set covers of ever more cells: each bounds the number of sensors, and its sensors show
/// which cells to add. Returns `start` unless fewer sensors suffice.
/// \param proves false: without branching, so the bound may be lower
/// \pre one sensor covers a cell, all cost the same, and `start` sees every cell
WholeCover coverAllCells(const Problem& problem, std::vector<Choice> start, bool proves,
                         Progress& progress);

/// Reports value and bound as shares of the total weight: "best 85.7 %, at most 85.9 %".
void noteProgress(const Problem& problem, std::uint64_t value, std::uint64_t bound,
                  Progress& progress);
inline void noteProgress(const Problem& problem, const SearchResult& result, Progress& progress) {
    noteProgress(problem, result.best.value, result.bound, progress);
}

}  // namespace ispace
