// SPDX-License-Identifier: GPL-3.0-or-later
// Minimum-cost set cover: reductions, local search, prices, cuts, and a tree.
//
// Components are solved one by one, also within the tree. The tree is opened breadth first to 64
// subtrees or more, which are searched depth first in parallel, each from the same best cover, so
// that the result does not depend on the number of threads. Invariant: the bound of a subtree holds
// for all its covers that are cheaper than the best; infinite if it has no such cover.
#include "arrange/search/set_cover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arrange/search/cover_core.h"

namespace ispace {

namespace {

constexpr PriceRounds kRootRounds = {3000, 30, 0.1}, kLastRounds = {500, 12, 1},
                      kNodeRounds = {40, 12, 1};
constexpr std::size_t kSubtrees = 64;
constexpr int kSymmetricDepth = 2;  // of subtrees
constexpr std::size_t kMinRowsForCuts = 24;
constexpr double kMinCut = 0.2;    // of the gap that cuts close at the root, to be used in nodes
constexpr double kNoShare = 1e-6;  // of a column in a fractional cover
constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// Keeps what both bounds exclude, and the higher one.
void takeBetter(const CoverBound& other, CoverBound& bound) {
    for (std::size_t j = 0; j < bound.excluded.size(); ++j)
        if (other.excluded[j] != 0) bound.excluded[j] = 1;
    if (other.value <= bound.value) return;
    bound.value = other.value;
    bound.fraction = other.fraction;
}

/// Depth-first search of a subtree for covers cheaper than the best.
class CoverTree {
  public:
    /// \param uses_cuts in nodes
    CoverTree(double best_cost, bool uses_cuts, const Progress& progress)
        : best_cost_(best_cost), uses_cuts_(uses_cuts), progress_(progress) {}

    /// Replaces a node by its children; a node without children is closed.
    /// \param uses_symmetry of columns that are images of each other, one is taken
    [[nodiscard]] std::vector<CoverCore> childrenOf(CoverCore node, bool uses_symmetry);
    /// Returns a bound of all covers in the subtree that are cheaper than the best; infinite if
    /// there is none.
    [[nodiscard]] double search(CoverCore node, int depth = 0);

    [[nodiscard]] double bestCost() const { return best_cost_; }
    [[nodiscard]] const std::vector<std::uint32_t>& best() const { return best_; }

  private:
    /// Reduces, bounds and excludes. \return false if the node is closed
    [[nodiscard]] bool isOpen(CoverCore& node, CoverBound& bound);
    [[nodiscard]] static std::vector<CoverCore> branch(const CoverCore& node,
                                                       const CoverBound& bound, bool uses_symmetry);
    /// Searches the components of an open node one by one: each within the bounds of the others.
    [[nodiscard]] double searchParts(const CoverCore& node, std::vector<CoverCore> parts,
                                     int depth);
    [[nodiscard]] static bool isBlocked(const CoverCore& node) {
        for (std::size_t row = 0; row < node.rows(); ++row)
            if (node.columnsOf(row).empty()) return true;
        return false;
    }

    double best_cost_;
    bool uses_cuts_;
    std::vector<std::uint32_t> best_;  // ids; empty: as given
    const Progress& progress_;
};

/// Ends once a round excludes no column: each exclusion may lead to reductions. Costs are whole
/// numbers, so a bound closes the node once it rounds up to the best cost.
bool CoverTree::isOpen(CoverCore& node, CoverBound& bound) {
    for (;;) {
        node.reduce();
        if (node.taken_cost >= best_cost_ || isBlocked(node)) return false;
        if (node.rows() == 0) {
            best_cost_ = node.taken_cost;
            best_ = node.taken;
            return false;
        }
        bound = raisePrices(node, best_cost_ - node.taken_cost, kNodeRounds);
        if (std::ceil(node.taken_cost + bound.value) >= best_cost_) return false;
        if (uses_cuts_ && node.rows() >= kMinRowsForCuts) {
            takeBetter(raiseByCuts(node, best_cost_ - node.taken_cost, progress_), bound);
            if (std::ceil(node.taken_cost + bound.value) >= best_cost_) return false;
        }
        const auto out = std::count(bound.excluded.begin(), bound.excluded.end(), 1);
        if (out == 0) return true;
        node = node.without(bound.excluded, std::vector<char>(node.rows()), {});
    }
}

std::vector<CoverCore> CoverTree::childrenOf(CoverCore node, bool uses_symmetry) {
    CoverBound bound;
    return isOpen(node, bound) ? branch(node, bound, uses_symmetry) : std::vector<CoverCore>();
}

/// Branches on the row with fewest columns, the dearest of these: child k takes column k and
/// excludes those before it, so the children have no cover in common.
std::vector<CoverCore> CoverTree::branch(const CoverCore& node, const CoverBound& bound,
                                         bool uses_symmetry) {
    std::size_t shortest = 0;
    double highest = -1;
    for (std::size_t row = 0; row < node.rows(); ++row) {
        const std::size_t size = node.columnsOf(row).size();
        const std::size_t least = node.columnsOf(shortest).size();
        if (size > least || (size == least && node.price[row] <= highest)) continue;
        shortest = row;
        highest = node.price[row];
    }
    const auto row = node.columnsOf(shortest);
    std::vector<std::uint32_t> order(row.begin(), row.end());
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return bound.fraction[a] > bound.fraction[b];
    });
    std::vector<char> out(node.columns());
    std::vector<CoverCore> children;
    std::vector<std::uint32_t> orbits;
    if (uses_symmetry) orbits = columnOrbits(node);
    for (const std::uint32_t column : order) {
        if (out[column] != 0) continue;
        children.push_back(node.without(out, std::vector<char>(node.rows()), {&column, 1}));
        out[column] = 1;
        // A cover with another column of the orbit has an image with this one.
        for (std::size_t j = 0; j < orbits.size(); ++j)
            if (orbits[j] == orbits[column]) out[j] = 1;
    }
    return children;
}

/// If progress says stop, open nodes yield their bounds: the minimum still holds.
double CoverTree::search(CoverCore node, int depth) {
    if (progress_.stopped()) {
        // Prices came from the parent: a few rounds restore its bound.
        const CoverBound bound = raisePrices(node, best_cost_ - node.taken_cost, {4, 12, 1});
        return node.taken_cost + bound.value;
    }
    CoverBound bound;
    if (!isOpen(node, bound)) return kNoBound;
    std::vector<CoverCore> parts = node.components();
    if (parts.size() > 1) return searchParts(node, std::move(parts), depth);
    double least = kNoBound;
    for (CoverCore& child : branch(node, bound, depth < kSymmetricDepth))
        least = std::min(least, search(std::move(child), depth + 1));
    return least;
}

/// Costs of components add up. A component has to cost less than the best cover minus the bounds of
/// the others, and each that is searched raises this sum: small ones come first.
double CoverTree::searchParts(const CoverCore& node, std::vector<CoverCore> parts, int depth) {
    std::sort(parts.begin(), parts.end(),
              [](const CoverCore& a, const CoverCore& b) { return a.rows() < b.rows(); });
    std::vector<double> least;
    double sum = node.taken_cost;
    for (CoverCore& part : parts) {
        least.push_back(std::ceil(raisePrices(part, best_cost_, {1, 1, 1}).value));
        sum += least.back();
    }
    double cost = node.taken_cost;
    bool is_complete = true;
    std::vector<std::uint32_t> cover = node.taken;
    for (std::size_t i = 0; i < parts.size() && sum < best_cost_; ++i) {
        CoverTree tree(best_cost_ - (sum - least[i]), uses_cuts_, progress_);
        const double open = tree.search(std::move(parts[i]), depth);
        is_complete = is_complete && open == kNoBound;
        sum += std::max(std::min(std::ceil(open), tree.bestCost()) - least[i], 0.0);
        if (tree.best().empty())
            cost = kNoBound;
        else
            cost += tree.bestCost();
        cover.insert(cover.end(), tree.best().begin(), tree.best().end());
    }
    if (sum >= best_cost_) return kNoBound;
    if (cost < best_cost_) {
        best_cost_ = cost;
        best_ = std::move(cover);
    }
    if (is_complete) return kNoBound;
    return sum;
}

/// Divides the tree in subtrees, searched in parallel and each from the same best cover.
double searchTree(const CoverCore& root, bool uses_cuts, SetCoverResult& result,
                  const Progress& progress) {
    std::vector<CoverCore> open = {root};
    CoverTree top(static_cast<double>(result.cost), uses_cuts, progress);
    while (!open.empty() && open.size() < kSubtrees && !progress.stopped()) {
        std::vector<CoverCore> next;
        for (CoverCore& node : open)
            for (CoverCore& child : top.childrenOf(std::move(node), true))
                next.push_back(std::move(child));
        open = std::move(next);
    }
    std::vector<CoverTree> trees(open.size(), CoverTree(top.bestCost(), uses_cuts, progress));
    std::vector<double> bounds(open.size());
    tbb::parallel_for(std::size_t{0}, open.size(),
                      [&](std::size_t i) { bounds[i] = trees[i].search(std::move(open[i])); });
    double bound = kNoBound;
    const auto take = [&](const CoverTree& tree) {
        if (tree.best().empty() || tree.bestCost() >= static_cast<double>(result.cost)) return;
        result.chosen = tree.best();
        result.cost = static_cast<std::uint64_t>(tree.bestCost());
    };
    take(top);
    for (std::size_t i = 0; i < trees.size(); ++i) {
        take(trees[i]);
        bound = std::min(bound, bounds[i]);
    }
    return bound;
}

/// Covers a core by local search; takes the cover if it is cheaper than the result.
void searchLocally(const CoverCore& core, const SetCoverOptions& options, SetCoverResult& result,
                   const Progress& progress) {
    std::vector<std::vector<std::uint32_t>> covers(
        static_cast<std::size_t>(std::max(options.tries, 1)));
    tbb::parallel_for(std::size_t{0}, covers.size(), [&](std::size_t i) {
        covers[i] = coverByWeights(core, options.steps, i, 0, progress);
    });
    for (const std::vector<std::uint32_t>& cover : covers) {
        double cost = core.taken_cost;
        for (const std::uint32_t column : cover) cost += core.cost[column];
        if (result.is_coverable && cost >= static_cast<double>(result.cost)) continue;
        result.is_coverable = true;
        result.cost = static_cast<std::uint64_t>(cost);
        result.chosen = core.taken;
        for (const std::uint32_t column : cover) result.chosen.push_back(core.id[column]);
    }
}

/// Covers a core without taken columns.
SetCoverResult coverCore(CoverCore core, const SetCoverOptions& options, Progress& progress) {
    SetCoverResult result;
    searchLocally(core, options, result, progress);
    const auto limit = [&result] { return static_cast<double>(result.cost); };
    // Begins from the share of a row in its cheapest column.
    for (std::size_t row = 0; row < core.rows(); ++row) {
        double least = kNoBound;
        for (const std::uint32_t j : core.columnsOf(row))
            least = std::min(least, core.cost[j] / static_cast<double>(core.rowsOf(j).size()));
        core.price[row] = std::floor(least * 0x1p20) * 0x1p-20;
    }
    raisePrices(core, limit(), kRootRounds);
    CoverBound bound = raisePrices(core, limit(), kLastRounds);
    const auto is_open = [&] {
        return std::ceil(bound.value) < limit() && options.proves && !progress.stopped();
    };
    bool uses_cuts = false;
    if (is_open()) {
        const double gap = limit() - bound.value;
        const CoverBound cut = raiseByCuts(core, limit(), progress);
        uses_cuts = cut.value > limit() - (1 - kMinCut) * gap;
        takeBetter(cut, bound);
    }
    if (is_open() && uses_cuts) {
        // Columns of the fractional cover make few, good covers.
        std::vector<char> out(core.columns());
        for (std::size_t j = 0; j < out.size(); ++j) out[j] = bound.fraction[j] < kNoShare ? 1 : 0;
        CoverCore part = core.without(out, std::vector<char>(core.rows()), {});
        part.reduce();
        searchLocally(part, options, result, progress);
    }
    double least = std::min(std::ceil(bound.value), limit());
    if (is_open()) {
        core = core.without(bound.excluded, std::vector<char>(core.rows()), {});
        least = std::max(least, std::ceil(searchTree(core, uses_cuts, result, progress)));
    }
    result.bound = static_cast<std::uint64_t>(std::min(least, limit()));
    return result;
}

}  // namespace

SetCoverResult minimumSetCover(const SetCover& problem, const SetCoverOptions& options,
                               Progress& progress) {
    SetCoverResult result;
    CoverCore core(problem);
    for (std::size_t row = 0; row < core.rows(); ++row)
        if (core.columnsOf(row).empty()) return result;
    result.is_coverable = true;
    core.reduce();
    result.chosen = core.taken;
    result.cost = result.bound = static_cast<std::uint64_t>(core.taken_cost);
    for (CoverCore& part : core.components()) {
        const SetCoverResult cover = coverCore(std::move(part), options, progress);
        result.chosen.insert(result.chosen.end(), cover.chosen.begin(), cover.chosen.end());
        result.cost += cover.cost;
        result.bound += cover.bound;
    }
    std::sort(result.chosen.begin(), result.chosen.end());
    return result;
}

}  // namespace ispace
