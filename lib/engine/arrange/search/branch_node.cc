// SPDX-License-Identifier: GPL-3.0-or-later
// One node of the tree: its bound, its exclusions, and its children.
//
// Multipliers begin as the parent's. Candidates whose reduced cost cannot lift the bound above the
// cut are excluded, those without which it falls to the cut are fixed, and if few candidates remain
// the problem is cut down to them (reduced_problem.cc). Up to 10^4 sets are enumerated, others are
// split (split_node.cc). `closed` of a result bounds all that was excluded.
#include "arrange/search/branch_node.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "arrange/search/relaxation.h"

namespace ispace {

namespace {

constexpr int kMaxTrials = 80;
constexpr int kTrialsBetweenLooks = 40;
constexpr std::uint64_t kFairPart = 5;  // of the distance to the cut: minimum gain of trials
constexpr double kFewSets = 1e4;        // so many are enumerated one by one

/// Computes the number of ways in which the groups can choose, up to about kFewSets.
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

/// Enumerates the sets of choices of a node, but for those that reduced costs rule out. If progress
/// says stop, the node stays open.
class SetSearch {
  public:
    /// \param relaxed evaluated for all candidates; its reduced costs are used
    SetSearch(const Problem& problem, const BranchNode& node, const NodeRelaxation& relaxed,
              std::uint64_t cut, const Progress& progress)
        : problem_(problem),
          node_(node),
          progress_(progress),
          reduced_(relaxed.problem()),
          relaxed_(relaxed),
          groups_(relaxed.groups()),
          cut_(cut),
          multiplicities_(reduced_.cells(), 0),
          chosen_(node.fixed) {
        for (OpenGroup& group : groups_)
            std::stable_sort(group.list.begin(), group.list.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return costOf(group, a) > costOf(group, b);
                             });
    }
    /// Finds the best solution above the cut.
    BranchResult search() {
        if (groups_.empty())
            check(valueHere());
        else
            visit(0, 0, groups_[0].count, relaxed_.free());
        if (is_stopped_) result_.children = {node_};
        return std::move(result_);
    }

  private:
    [[nodiscard]] std::uint32_t costOf(const OpenGroup& group, std::uint32_t candidate) const {
        return relaxed_.costOf(group.kind, candidate);
    }
    /// Returns the sum of the reduced costs of the best `left` from `first` on, and of later
    /// groups.
    [[nodiscard]] std::uint64_t bestOf(std::size_t group, std::size_t first,
                                       std::size_t left) const {
        std::uint64_t sum = 0;
        for (; group < groups_.size(); first = 0) {
            const OpenGroup& own = groups_[group];
            for (std::size_t i = first; i < std::min(first + left, own.list.size()); ++i)
                sum += costOf(own, own.list[i]);
            if (++group < groups_.size()) left = groups_[group].count;
        }
        return sum;
    }
    /// \param most upper bound of the value of the choices so far, by reduced costs
    void visit(std::size_t group, std::size_t first, std::size_t left, std::uint64_t most) {
        is_stopped_ = is_stopped_ || progress_.stopped();
        if (is_stopped_) return;
        if (group == groups_.size()) {
            check(valueHere());
            return;
        }
        const OpenGroup& own = groups_[group];
        // Full groups are never worse, but connected solutions may need fewer.
        const bool is_full = left == 0 || first == own.list.size();
        if (is_full || problem_.is_connected) {
            const std::size_t next = group + 1;
            visit(next, 0, next < groups_.size() ? groups_[next].count : 0, most);
        }
        if (is_full) return;
        const bool is_last = left == 1 && group + 1 == groups_.size();
        WeightSums gains;
        const std::uint64_t here = is_last ? valueHere() : 0;
        if (is_last) gains.assign(gainsOf(own.kind));
        for (std::size_t i = first; i < own.list.size(); ++i) {
            const std::uint64_t bound = most + bestOf(group, i, left);
            if (bound <= cut_) {
                close(bound);
                break;
            }
            const std::uint32_t cost = costOf(own, own.list[i]);
            if (is_last) {
                chosen_.push_back({own.kind, reduced_.kinds[own.kind].original[own.list[i]]});
                check(here + reduced_.kinds[own.kind].candidates->weigh(own.list[i], gains));
                chosen_.pop_back();
                continue;
            }
            add(own.kind, own.list[i], 1);
            visit(group, i + 1, left - 1, most + cost);
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
    [[nodiscard]] std::uint64_t valueHere() const {
        std::uint64_t value = reduced_.settled;
        for (std::size_t i = 0; i < multiplicities_.size(); ++i)
            if (multiplicities_[i] >= reduced_.needs[i]) value += reduced_.weights[i];
        return value;
    }
    /// Returns what one more of a kind adds by each cell.
    [[nodiscard]] std::vector<std::uint32_t> gainsOf(std::size_t kind) const {
        std::vector<std::uint32_t> gains(reduced_.cells());
        for (std::size_t i = 0; i < gains.size(); ++i) {
            const int lack = reduced_.needs[i] - multiplicities_[i];
            gains[i] =
                lack > 0 && lack <= reduced_.kinds[kind].multiplicity ? reduced_.weights[i] : 0;
        }
        return gains;
    }
    /// Once a solution is found, its value is above the others'.
    void close(std::uint64_t bound) {
        if (result_.found.empty()) result_.closed = std::max(result_.closed, bound);
    }
    void check(std::uint64_t value) {
        if (value <= cut_) return close(value);
        if (problem_.is_connected && !isFeasible(problem_, chosen_)) return;
        cut_ = value;
        result_.found = chosen_;
    }

    const Problem& problem_;
    const BranchNode& node_;
    const Progress& progress_;
    const ReducedProblem& reduced_;
    const NodeRelaxation& relaxed_;
    std::vector<OpenGroup> groups_;  // lists by reduced cost, highest first
    std::uint64_t cut_;
    std::vector<int> multiplicities_;
    std::vector<Choice> chosen_;
    BranchResult result_;
    bool is_stopped_ = false;
};

/// Builds the node with its fixed choices, cut down to the remaining problem.
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
    // Cutting down costs as much as dozens of bounds, and a separate problem takes memory: many
    // candidates have to go.
    const bool is_same = left * 5 > node.problem->candidates() * 3;
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

/// Computes the bound of a node by some trials; excludes candidates on the way. A trial weighs all
/// candidates only if it promises a lower bound by those of the working sites.
std::uint64_t boundOf(NodeRelaxation& relaxed, MultiplierSearch& search, std::uint64_t bound,
                      std::uint64_t cut, const Progress& progress) {
    std::uint64_t last = bound;
    for (int trial = 0; trial < kMaxTrials && bound > cut && !progress.stopped(); ++trial) {
        std::uint64_t now = 0;
        if (trial > 0) now = relaxed.evaluateWorking(search.trial());
        if (static_cast<double>(now) < search.bound()) {
            now = relaxed.evaluate(search.trial());
            if (now <= bound) {
                bound = now;
                relaxed.ruleOut(cut);
            }
            relaxed.widen();
        }
        search.report(static_cast<double>(now), relaxed.cover());
        relaxed.count(static_cast<float>(search.part()));
        if (trial % kTrialsBetweenLooks != kTrialsBetweenLooks - 1) continue;
        // At this speed it takes too long.
        if (bound > cut && (last - bound) * kFairPart < bound - cut) break;
        last = bound;
    }
    return bound;
}

/// Returns the solution of the relaxation, if it is feasible and above the cut.
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

/// Returns a closed node with this bound.
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
    if (setsOf(relaxed.groups(), problem.is_connected) <= kFewSets) {
        relaxed.evaluate(relaxed.start(node));
        return SetSearch(problem, node, relaxed, cut, progress).search();
    }
    MultiplierSearch search(relaxed.problem().weights, relaxed.start(node),
                            static_cast<double>(cut), kWarmPace);
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

}  // namespace ispace
