// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/set_cover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "arrange/search/cover_core.h"

namespace ispace {

namespace {

constexpr int kRootRounds = 1500, kNodeRounds = 40;
constexpr std::size_t kSubtrees = 64;
constexpr int kSymmetricDepth = 2;  // of subtrees
constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// Depth-first search of a subtree for covers cheaper than the best.
class CoverTree {
  public:
    CoverTree(double best_cost, const Progress& progress)
        : best_cost_(best_cost), progress_(progress) {}

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
    [[nodiscard]] static bool isBlocked(const CoverCore& node) {
        for (std::size_t row = 0; row < node.rows(); ++row)
            if (node.columnsOf(row).empty()) return true;
        return false;
    }

    double best_cost_;
    std::vector<std::uint32_t> best_;  // ids; empty: as given
    const Progress& progress_;
};

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
        const auto out = std::count(bound.excluded.begin(), bound.excluded.end(), 1);
        if (out == 0) return true;
        node = node.without(bound.excluded, std::vector<char>(node.rows()), {});
    }
}

std::vector<CoverCore> CoverTree::childrenOf(CoverCore node, bool uses_symmetry) {
    CoverBound bound;
    if (!isOpen(node, bound)) return {};
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

double CoverTree::search(CoverCore node, int depth) {
    if (progress_.stopped()) {
        // Prices came from the parent: a few rounds restore its bound.
        const CoverBound bound = raisePrices(node, best_cost_ - node.taken_cost, 4);
        return node.taken_cost + bound.value;
    }
    double least = kNoBound;
    for (CoverCore& child : childrenOf(std::move(node), depth < kSymmetricDepth))
        least = std::min(least, search(std::move(child), depth + 1));
    return least;
}

/// Divides the tree in subtrees, searched in parallel and each from the same best cover.
double searchTree(const CoverCore& root, SetCoverResult& result, const Progress& progress) {
    std::vector<CoverCore> open = {root};
    CoverTree top(static_cast<double>(result.cost), progress);
    while (!open.empty() && open.size() < kSubtrees && !progress.stopped()) {
        std::vector<CoverCore> next;
        for (CoverCore& node : open)
            for (CoverCore& child : top.childrenOf(std::move(node), true))
                next.push_back(std::move(child));
        open = std::move(next);
    }
    std::vector<CoverTree> trees(open.size(), CoverTree(top.bestCost(), progress));
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
    if (core.rows() == 0) {
        std::sort(result.chosen.begin(), result.chosen.end());
        return result;
    }

    std::vector<std::vector<std::uint32_t>> covers(
        static_cast<std::size_t>(std::max(options.tries, 1)));
    tbb::parallel_for(std::size_t{0}, covers.size(), [&](std::size_t i) {
        covers[i] = coverByWeights(core, options.steps, i, 0, progress);
    });
    const auto cost_of = [&core](const std::vector<std::uint32_t>& cover) {
        double sum = 0;
        for (const std::uint32_t column : cover) sum += core.cost[column];
        return sum;
    };
    const auto& best =
        *std::min_element(covers.begin(), covers.end(),
                          [&](const auto& a, const auto& b) { return cost_of(a) < cost_of(b); });
    for (const std::uint32_t column : best) result.chosen.push_back(core.id[column]);
    result.cost += static_cast<std::uint64_t>(cost_of(best));

    const double limit = static_cast<double>(result.cost) - core.taken_cost;
    // Begins from the share of a row in its cheapest column.
    for (std::size_t row = 0; row < core.rows(); ++row) {
        double least = kNoBound;
        for (const std::uint32_t j : core.columnsOf(row))
            least = std::min(least, core.cost[j] / static_cast<double>(core.rowsOf(j).size()));
        core.price[row] = std::floor(least * 0x1p20) * 0x1p-20;
    }
    const CoverBound bound = raisePrices(core, limit, kRootRounds);
    double least = core.taken_cost + std::min(std::ceil(bound.value), limit);
    if (least < static_cast<double>(result.cost) && options.proves && !progress.stopped()) {
        core = core.without(bound.excluded, std::vector<char>(core.rows()), {});
        least = std::max(least, std::ceil(searchTree(core, result, progress)));
    }
    result.bound = static_cast<std::uint64_t>(std::min(least, static_cast<double>(result.cost)));
    std::sort(result.chosen.begin(), result.chosen.end());
    return result;
}

}  // namespace ispace
