// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/branch_node.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "solve/relaxation.h"

namespace ispace {

namespace {

constexpr int kMaxTrials = 80;
constexpr int kTrialsBetweenLooks = 40;
constexpr std::uint64_t kFairPart = 5;  // of the distance to the cut that trials must gain
constexpr double kFewSets = 64;         // so many are tried one by one

/// In how many ways the groups can choose, up to about kFewSets.
double setsOf(const std::vector<OpenGroup>& groups, bool with_fewer) {
    double all = 1;
    for (const OpenGroup& group : groups) {
        const std::size_t size = group.list.size(), count = std::min(group.count, size);
        double ways = 1, up_to = 1;
        for (std::size_t n = 0; n < count && up_to <= kFewSets * 1e6; ++n) {
            ways *= static_cast<double>(size - n) / static_cast<double>(n + 1);
            up_to += ways;
        }
        all *= with_fewer ? up_to : ways;
        if (all > kFewSets * 1e6) break;
    }
    return all;
}

/// Tries all sets of choices of a node.
class SetSearch {
  public:
    SetSearch(const Problem& problem, const BranchNode& node, const NodeRelaxation& relaxed,
              std::uint64_t cut)
        : problem_(problem),
          reduced_(relaxed.problem()),
          groups_(relaxed.groups()),
          cut_(cut),
          multiplicities_(reduced_.cells(), 0),
          chosen_(node.fixed) {}
    /// The best solution above the cut.
    BranchResult search() {
        if (groups_.empty())
            check();
        else
            visit(0, 0, groups_[0].count);
        return std::move(result_);
    }

  private:
    void visit(std::size_t group, std::size_t first, std::size_t left) {
        if (group == groups_.size()) {
            check();
            return;
        }
        const OpenGroup& own = groups_[group];
        // Full groups are never worse, but connected solutions may need fewer.
        const bool is_full = left == 0 || first == own.list.size();
        if (is_full || problem_.is_connected) {
            const std::size_t next = group + 1;
            visit(next, 0, next < groups_.size() ? groups_[next].count : 0);
        }
        if (is_full) return;
        for (std::size_t i = first; i < own.list.size(); ++i) {
            add(own.kind, own.list[i], 1);
            visit(group, i + 1, left - 1);
            add(own.kind, own.list[i], -1);
            if (!problem_.is_connected && own.list.size() - i <= left) break;
        }
    }
    void add(std::size_t kind, std::uint32_t candidate, int sign) {
        const ReducedProblem::OfKind& own = reduced_.kinds[kind];
        own.candidates->forEachRun(candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i)
                multiplicities_[i] += sign * own.multiplicity;
        });
        if (sign > 0)
            chosen_.push_back({kind, own.original[candidate]});
        else
            chosen_.pop_back();
    }
    void check() {
        std::uint64_t value = reduced_.settled;
        for (std::size_t i = 0; i < multiplicities_.size(); ++i)
            if (multiplicities_[i] >= reduced_.needs[i]) value += reduced_.weights[i];
        if (value <= cut_) {
            // Once something is found, its value is above the others'.
            if (result_.found.empty()) result_.closed = std::max(result_.closed, value);
            return;
        }
        if (problem_.is_connected && !isFeasible(problem_, chosen_)) return;
        cut_ = value;
        result_.found = chosen_;
    }

    const Problem& problem_;
    const ReducedProblem& reduced_;
    const std::vector<OpenGroup>& groups_;
    std::uint64_t cut_;
    std::vector<int> multiplicities_;
    std::vector<Choice> chosen_;
    BranchResult result_;
};

/// The node with what has been fixed, cut down to what is left.
BranchNode cutDown(const BranchNode& node, const NodeRelaxation& relaxed,
                   const std::vector<Choice>& forced, std::vector<std::uint32_t> multipliers) {
    BranchNode now;
    now.fixed = node.fixed;
    for (const Choice& choice : forced)
        now.fixed.push_back(
            {choice.kind, relaxed.problem().kinds[choice.kind].original[choice.candidate]});
    std::vector<std::vector<std::uint32_t>> kept(relaxed.problem().kinds.size());
    std::size_t left = forced.size();
    for (const Choice& choice : forced)
        kept[choice.kind].push_back(static_cast<std::uint32_t>(choice.candidate));
    for (const OpenGroup& group : relaxed.groups()) {
        kept[group.kind].insert(kept[group.kind].end(), group.list.begin(), group.list.end());
        left += group.list.size();
    }
    // Where little has gone the problem stays as it is: memory is for what differs.
    const bool is_same = left * 5 > node.problem->candidates() * 4;
    if (is_same) {
        now.problem = node.problem;
        now.pending = node.pending;
    } else {
        for (auto& list : kept) std::sort(list.begin(), list.end());
        now.problem =
            std::make_shared<const ReducedProblem>(reduce(relaxed.problem(), kept, multipliers));
    }
    now.multipliers = std::make_shared<const std::vector<std::uint32_t>>(std::move(multipliers));
    const auto name_of = [&](std::size_t kind, std::size_t candidate) {
        if (is_same) return static_cast<std::uint32_t>(candidate);
        return static_cast<std::uint32_t>(
            std::lower_bound(kept[kind].begin(), kept[kind].end(), candidate) - kept[kind].begin());
    };
    for (const Choice& choice : forced)
        now.pending.push_back({choice.kind, name_of(choice.kind, choice.candidate)});
    for (const OpenGroup& group : relaxed.groups()) {
        if (group.list.empty()) continue;
        std::vector<std::uint32_t> list = group.list;
        for (std::uint32_t& i : list) i = name_of(group.kind, i);
        now.groups.push_back({group.kind, group.count,
                              std::make_shared<const std::vector<std::uint32_t>>(std::move(list))});
    }
    return now;
}

/// The bound of a node after some trials; its candidates are ruled out on the way.
std::uint64_t boundOf(NodeRelaxation& relaxed, MultiplierSearch& search, std::uint64_t bound,
                      std::uint64_t cut, const Progress& progress) {
    std::uint64_t last = bound;
    for (int trial = 0; trial < kMaxTrials && bound > cut && !progress.stopped(); ++trial) {
        const std::uint64_t now = relaxed.evaluate(search.trial());
        if (now <= bound) {
            bound = now;
            relaxed.ruleOut(cut);
        }
        search.report(static_cast<double>(now), relaxed.cover());
        relaxed.count(static_cast<float>(search.part()));
        if (trial % kTrialsBetweenLooks != kTrialsBetweenLooks - 1) continue;
        // As fast as this it would take too long.
        if (bound > cut && (last - bound) * kFairPart < bound - cut) break;
        last = bound;
    }
    return bound;
}

/// The solution of the relaxation, if it is feasible and above the cut.
std::vector<Choice> foundBy(const Problem& problem, const BranchNode& node,
                            const NodeRelaxation& relaxed, std::uint64_t cut) {
    std::uint64_t value = relaxed.problem().settled;
    for (std::size_t i = 0; i < relaxed.cover().size(); ++i)
        if (relaxed.cover()[i] > 0.9999F) value += relaxed.problem().weights[i];
    if (value <= cut) return {};
    std::vector<Choice> found = node.fixed;
    for (const Choice& choice : relaxed.chosen())
        found.push_back(
            {choice.kind, relaxed.problem().kinds[choice.kind].original[choice.candidate]});
    if (!isFeasible(problem, found)) return {};
    return found;
}

/// A closed node with this bound.
BranchResult closedAt(std::uint64_t bound) {
    BranchResult result;
    result.closed = bound;
    return result;
}

BranchResult unchanged(const BranchNode& node, std::uint64_t bound) {
    BranchResult result;
    result.children = {node};
    result.children[0].bound = bound;
    return result;
}

}  // namespace

BranchResult branch(const Problem& problem, const BranchNode& node, std::uint64_t cut,
                    const Progress& progress) {
    if (node.bound <= cut) return closedAt(node.bound);
    if (progress.stopped()) return unchanged(node, node.bound);
    NodeRelaxation relaxed(node);
    if (setsOf(relaxed.groups(), problem.is_connected) <= kFewSets)
        return SetSearch(problem, node, relaxed, cut).search();
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(node),
                            static_cast<double>(cut), kWarmFactor);
    std::uint64_t bound = boundOf(relaxed, search, node.bound, cut, progress);
    if (bound > cut && !progress.stopped())
        bound = std::min(bound, relaxed.evaluate(search.best()));
    if (bound <= cut) return closedAt(std::max(bound, relaxed.ruledOut()));
    if (progress.stopped()) return unchanged(node, bound);
    BranchResult result;
    result.found = foundBy(problem, node, relaxed, cut);
    relaxed.ruleOut(cut);
    const std::vector<Choice> forced = relaxed.takeForced(cut);
    result.closed = relaxed.ruledOut();
    BranchNode now = cutDown(node, relaxed, forced, search.best());
    now.bound = bound;
    if (!forced.empty() || setsOf(relaxed.groups(), problem.is_connected) <= kFewSets ||
        progress.stopped()) {
        result.children.push_back(std::move(now));
        return result;
    }
    SplitNode split = splitNode(now, relaxed, search.best(), cut, progress);
    result.children = std::move(split.children);
    result.closed = std::max(result.closed, split.closed);
    return result;
}

namespace {

constexpr int kTrials = 10;            // of the bound of each child
constexpr int kSplitsPerGroup = 3;     // tried
constexpr double kLevelsToClose = 10;  // a child that comes this part nearer halves its tree

/// Where a node may be split.
struct Split {
    std::size_t group = 0;
    std::vector<std::uint32_t> near, far;  ///< the places in the list of the group, in two
};

/// The candidates of a group, as places in its list: first the one that is chosen most often, then
/// the others, those that see most of what it sees first.
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

/// A group is split where by the relaxation half a sensor, or one and a half, ... are on the near
/// side: no whole number of sensors does that.
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

/// The children of a split: so many of the group from one side and the rest from the other.
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

/// The children of a node whose groups may choose all they have, where it is fewer that may be
/// feasible: with one candidate and without it.
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

/// An upper bound of a node by a few trials.
std::uint64_t soonBoundOf(const BranchNode& node, std::uint64_t cut, const Progress& progress) {
    NodeRelaxation relaxed(node);
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(node),
                            static_cast<double>(cut), kWarmFactor);
    std::uint64_t bound = node.bound;
    for (int trial = 0; trial < kTrials && bound > cut && !progress.stopped(); ++trial) {
        const std::uint64_t now = relaxed.evaluate(search.trial());
        bound = std::min(bound, now);
        search.report(static_cast<double>(now), relaxed.cover());
    }
    return bound;
}

/// What the tree below a child is guessed to be, in parts of the one that it would be if the bound
/// did not fall.
double sizeOfTree(std::uint64_t child, std::uint64_t parent, std::uint64_t cut) {
    const auto fallen = static_cast<double>(parent - child),
               open = static_cast<double>(parent - cut);
    return std::exp2(-kLevelsToClose * fallen / open);
}

}  // namespace

SplitNode splitNode(const BranchNode& node, NodeRelaxation& relaxed,
                    const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                    const Progress& progress) {
    std::vector<Split> splits;
    for (std::size_t g = 0; g < relaxed.groups().size(); ++g)
        addSplitsOf(relaxed, g, multipliers, splits);
    if (splits.empty()) return {withAndWithout(node), 0};
    SplitNode best;
    double least = std::numeric_limits<double>::infinity();
    for (const Split& split : splits) {
        SplitNode now;
        double size = 0;
        for (BranchNode& child : childrenOf(node, split)) {
            child.bound = soonBoundOf(child, cut, progress);
            if (child.bound <= cut) {
                now.closed = std::max(now.closed, child.bound);
                continue;
            }
            size += sizeOfTree(child.bound, node.bound, cut);
            now.children.push_back(std::move(child));
        }
        if (size >= least) continue;
        least = size;
        best = std::move(now);
        if (progress.stopped() || best.children.empty()) break;
    }
    return best;
}

}  // namespace ispace
