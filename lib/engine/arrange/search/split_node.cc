// SPDX-License-Identifier: GPL-3.0-or-later
// Splits of a node, compared by strong branching on its core.
//
// The candidates of a group are sorted by the likeness of their views to that of the candidate that
// the relaxation takes most often. Parts end where the relaxation has half a sensor, or one and a
// half, in the first part: a whole number of sensors on either side excludes its present solution.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "arrange/search/branch_node.h"
#include "arrange/search/relaxation.h"

namespace ispace {

namespace {

constexpr int kTrialsPerChild = 10;    // of the bound of each child
constexpr int kSplitsPerGroup = 3;     // tried
constexpr std::size_t kCoreSize = 96;  // candidates with which splits are compared
constexpr double kLevelsToClose =
    10;  // a child that closes this share of the distance halves its tree

/// A candidate split of a node.
struct Split {
    std::size_t group = 0;
    std::vector<std::uint32_t> near, far;  ///< indices in the list of the group, in two parts
};

/// Returns the candidates of a group, as indices in its list: first the one that is chosen most
/// often, then the others, sorted by the overlap of their views with it.
std::vector<std::uint32_t> byLikeness(NodeRelaxation& relaxed, std::size_t group,
                                      const std::vector<std::uint32_t>& multipliers) {
    const std::vector<float>& frequencies = relaxed.frequencies()[group];
    const auto pivot = static_cast<std::size_t>(
        std::max_element(frequencies.begin(), frequencies.end()) - frequencies.begin());
    const std::vector<float> like =
        relaxed.likeness(group, relaxed.groups()[group].list[pivot], multipliers);
    std::vector<std::uint32_t> order(like.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        if ((a == pivot) != (b == pivot)) return a == pivot;
        return like[a] > like[b];
    });
    return order;
}

Split splitAt(std::size_t group, const std::vector<std::uint32_t>& order, std::size_t count) {
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(count);
    Split split{group, {order.begin(), middle}, {middle, order.end()}};
    std::sort(split.near.begin(), split.near.end());
    std::sort(split.far.begin(), split.far.end());
    return split;
}

/// Splits a group if by the relaxation half a sensor, or one and a half, ... are on the near side:
/// an integer solution excludes that.
void addSplitsOf(NodeRelaxation& relaxed, std::size_t g,
                 const std::vector<std::uint32_t>& multipliers, std::vector<Split>& splits) {
    const OpenGroup& group = relaxed.groups()[g];
    if (group.list.size() <= std::max<std::size_t>(group.count, 1)) return;
    const std::vector<std::uint32_t> order = byLikeness(relaxed, g, multipliers);
    const std::vector<float>& frequencies = relaxed.frequencies()[g];
    const double total = std::accumulate(frequencies.begin(), frequencies.end(), 0.0);
    const double sensors = total > 0 ? static_cast<double>(group.count) / total : 0;
    double near = 0, wanted = 0.5;
    const std::size_t before = splits.size();
    for (std::size_t n = 1; n < order.size() && wanted < kSplitsPerGroup; ++n) {
        near += static_cast<double>(frequencies[order[n - 1]]) * sensors;
        if (near < wanted) continue;
        splits.push_back(splitAt(g, order, n));
        wanted = std::floor(near + 0.5) + 0.5;
    }
    if (splits.size() == before) splits.push_back(splitAt(g, order, order.size() / 2));
}

/// Builds the children of a split: so many of the group from one side and the rest from the other.
std::vector<BranchNode> childrenOf(const BranchNode& node, const Split& split) {
    std::vector<BranchNode> children;
    const BranchGroup& group = node.groups[split.group];
    const auto list_of = [&group](std::vector<std::uint32_t> places) {
        for (std::uint32_t& i : places) i = (*group.list)[i];
        return std::make_shared<const std::vector<std::uint32_t>>(std::move(places));
    };
    const auto near_list = list_of(split.near), far_list = list_of(split.far);
    children.reserve(group.count + 1);
    for (std::size_t near = 0; near <= group.count; ++near) {
        const std::size_t far = group.count - near;
        if (near > split.near.size() || far > split.far.size()) continue;
        BranchNode child = node;
        child.groups.erase(child.groups.begin() + static_cast<std::ptrdiff_t>(split.group));
        if (near > 0) child.groups.push_back({group.kind, near, near_list});
        if (far > 0) child.groups.push_back({group.kind, far, far_list});
        children.push_back(std::move(child));
    }
    return children;
}

/// Builds two children, with one candidate and without it, for a node with groups that may choose
/// all their candidates, but of which only a subset may be feasible.
std::vector<BranchNode> withAndWithout(const BranchNode& node) {
    const auto larger = std::max_element(
        node.groups.begin(), node.groups.end(),
        [](const BranchGroup& a, const BranchGroup& b) { return a.list->size() < b.list->size(); });
    assert(larger != node.groups.end() && !larger->list->empty());
    std::vector<std::uint32_t> rest = *larger->list;
    const std::uint32_t candidate = rest.back();
    rest.pop_back();
    BranchNode without = node;
    const auto group = without.groups.begin() + (larger - node.groups.begin());
    if (rest.empty()) {
        without.groups.erase(group);
    } else {
        group->count = std::min(group->count - 1, rest.size());
        group->list = std::make_shared<const std::vector<std::uint32_t>>(std::move(rest));
    }
    BranchNode with = without;
    with.fixed.push_back({larger->kind, node.problem->kinds[larger->kind].original[candidate]});
    with.pending.push_back({larger->kind, candidate});
    return {std::move(with), std::move(without)};
}

/// Computes an upper bound of a node by a few trials, which weigh all candidates only if the
/// working ones promise a lower one.
struct SoonBound {
    std::uint64_t value = 0;
    std::vector<std::uint32_t> multipliers;  ///< the best of the trials; empty before the first
};

SoonBound soonBoundOf(const BranchNode& node, std::uint64_t cut, const Progress& progress) {
    NodeRelaxation relaxed(node);
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(node),
                            static_cast<double>(cut), kWarmPace);
    std::uint64_t bound = node.bound;
    for (int trial = 0; trial < kTrialsPerChild && bound > cut && !progress.stopped(); ++trial) {
        std::uint64_t now = trial > 0 ? relaxed.evaluateWorking(search.trial()) : 0;
        if (static_cast<double>(now) < search.bound()) {
            now = relaxed.evaluate(search.trial());
            bound = std::min(bound, now);
            relaxed.widen();
        }
        search.report(static_cast<double>(now), relaxed.cover());
    }
    return {bound, search.best()};
}

/// Estimates the size of the tree below a child, relative to that of a tree without a fall of the
/// bound.
double sizeOfTree(std::uint64_t child, std::uint64_t parent, std::uint64_t cut) {
    const auto fallen = static_cast<double>(parent - child),
               open = static_cast<double>(parent - cut);
    return std::exp2(-kLevelsToClose * fallen / open);
}

/// Compares splits by their effect on the core of the node, its most promising candidates (Caprara,
/// Fischetti & Toth 1999): trials with these cost a fraction.
class SplitComparison {
  public:
    SplitComparison(const BranchNode& node, NodeCore is_core, std::uint64_t cut,
                    const Progress& progress)
        : is_core_(std::move(is_core)),
          core_(coreOf(node, is_core_)),
          cut_(cut),
          progress_(progress) {}

    /// Estimates the size of the children's trees; above `least` the result is arbitrary.
    [[nodiscard]] double sizeBy(const Split& split, double least) const {
        double size = 0;
        for (const BranchNode& child : childrenOf(core_, coreOf(split))) {
            const std::uint64_t bound = soonBoundOf(child, cut_, progress_).value;
            if (bound > cut_) size += sizeOfTree(bound, core_.bound, cut_);
            if (size >= least) break;
        }
        return size;
    }

  private:
    static BranchNode coreOf(const BranchNode& node, const NodeCore& is_core) {
        BranchNode core = node;
        for (std::size_t g = 0; g < core.groups.size(); ++g) {
            std::vector<std::uint32_t> list;
            for (std::size_t i = 0; i < is_core[g].size(); ++i)
                if (is_core[g][i] != 0) list.push_back((*node.groups[g].list)[i]);
            core.groups[g].list =
                std::make_shared<const std::vector<std::uint32_t>>(std::move(list));
        }
        return core;
    }
    /// Maps the split to the core.
    [[nodiscard]] Split coreOf(const Split& split) const {
        const std::vector<char>& is_own = is_core_[split.group];
        std::vector<std::uint32_t> place_of;  // index in the list of the core
        place_of.reserve(is_own.size());
        std::uint32_t before = 0;
        for (const char is_here : is_own) {
            place_of.push_back(before);
            if (is_here != 0) ++before;
        }
        const auto own_of = [&](const std::vector<std::uint32_t>& places) {
            std::vector<std::uint32_t> own;
            for (const std::uint32_t i : places)
                if (is_own[i] != 0) own.push_back(place_of[i]);
            return own;
        };
        return {split.group, own_of(split.near), own_of(split.far)};
    }

    NodeCore is_core_;
    BranchNode core_;
    std::uint64_t cut_;
    const Progress& progress_;
};

}  // namespace

SplitNode splitNode(const BranchNode& node, NodeRelaxation& relaxed,
                    const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                    const Progress& progress) {
    relaxed.evaluate(multipliers);
    const SplitComparison comparison(node, relaxed.core(kCoreSize), cut, progress);
    std::vector<Split> splits;
    for (std::size_t g = 0; g < relaxed.groups().size(); ++g)
        addSplitsOf(relaxed, g, multipliers, splits);
    if (splits.empty()) return {withAndWithout(node), 0};
    const Split* best = &splits.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Split& split : splits) {
        const double size = comparison.sizeBy(split, least);
        if (size >= least) continue;
        least = size;
        best = &split;
        if (progress.stopped() || size <= 0) break;
    }
    SplitNode all;
    for (BranchNode& child : childrenOf(node, *best)) {
        SoonBound soon = soonBoundOf(child, cut, progress);
        child.bound = soon.value;
        if (child.bound <= cut) {
            all.closed = std::max(all.closed, child.bound);
            continue;
        }
        if (!soon.multipliers.empty())
            child.multipliers =
                std::make_shared<const std::vector<std::uint32_t>>(std::move(soon.multipliers));
        all.children.push_back(std::move(child));
    }
    return all;
}

}  // namespace ispace
