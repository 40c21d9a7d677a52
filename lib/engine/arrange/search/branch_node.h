// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange/search: nodes of the search tree, their reduced problems and
// bounds.
//
// Bounds are in fine units (RelaxedCells), whole numbers that round up, so that a node is closed
// only if no better solution is in it. Nodes share problems, lists and multipliers, which never
// change.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "arrange/search/relaxation.h"
#include "base/error.h"

namespace ispace {

/// A problem reduced to the surviving candidates: cells seen by the same candidates are merged,
/// cells that no candidate sees are removed. Weights are in fine units, see RelaxedCells.
struct ReducedProblem {
    struct OfKind {
        std::shared_ptr<const CandidateSet> candidates;
        std::vector<std::uint32_t> original;  ///< candidates in the problem's set, ascending
        std::uint16_t multiplicity = 1;
    };
    std::uint64_t settled = 0;  ///< weight of cells covered in any case
    std::vector<std::uint32_t> weights;
    std::vector<std::uint16_t> needs;
    std::vector<OfKind> kinds;

    [[nodiscard]] std::size_t cells() const { return weights.size(); }
    [[nodiscard]] std::size_t candidates() const;
    [[nodiscard]] std::size_t bytes() const;
};

/// Returns the whole problem; `original` stays empty.
ReducedProblem wholeProblem(const Problem& problem, const RelaxedCells& cells);

/// Reduces a problem further, by hashes of the set of candidates that see a cell. O(cells + runs of
/// the sites of those kept)
/// \param kept per kind, the candidates to keep (of the sets of `from`), ascending
/// \param multipliers of the cells; replaced by those of the merged cells, their sums
ReducedProblem reduce(const ReducedProblem& from,
                      const std::vector<std::vector<std::uint32_t>>& kept,
                      std::vector<std::uint32_t>& multipliers);

class NodeRelaxation;

/// Sensors of one kind to be chosen from one list; lists of different groups of a node are
/// disjoint.
struct BranchGroup {
    std::size_t kind = 0;
    std::size_t count = 0;
    /// Candidates of the reduced problem, ascending; nodes share lists.
    std::shared_ptr<const std::vector<std::uint32_t>> list;
};

/// A subproblem: fixed choices, and at most `count` candidates from each group.
struct BranchNode {
    std::shared_ptr<const ReducedProblem> problem;
    /// Start of the search: good multipliers of the parent, or of the node itself.
    std::shared_ptr<const std::vector<std::uint32_t>> multipliers;
    std::vector<Choice> fixed;    ///< of the original problem
    std::vector<Choice> pending;  ///< fixed choices not yet settled in `problem`, with its indices
    std::vector<BranchGroup> groups;
    std::uint64_t bound = 0;  ///< fine
};

/// The result of processing a node.
struct BranchResult {
    std::vector<BranchNode> children;  ///< subproblems that may beat the cut
    std::vector<Choice> found;         ///< a feasible solution above the cut, else empty
    /// Upper bound, fine and at most the cut, of solutions that are neither in a child nor `found`.
    std::uint64_t closed = 0;
};

/// Processes a node: bounds it, fixes variables, and splits the rest. Finds only solutions better
/// than `cut` (fine). Deterministic, unless progress says stop: then the node is its only child.
BranchResult branch(const Problem& problem, const BranchNode& node, std::uint64_t cut,
                    const Progress& progress);

/// A node split into children.
struct SplitNode {
    std::vector<BranchNode> children;  ///< subproblems that may beat the cut
    std::uint64_t closed = 0;          ///< upper bound of solutions in no child
};

/// Branches on a node: splits the list of one group into candidates with views similar to a pivot's
/// and the rest, with one child for each number of sensors from the first part. Strong branching
/// (D. Applegate, R. Bixby, V. Chvatal, W. Cook, Finding cuts in the TSP, 1995) selects the split
/// with children that promise the smallest tree after a few steps of the bounds of their core.
///
/// Deterministic, unless progress says stop: then returns an arbitrary split.
/// \param relaxed of the node before it was cut down, the same groups and lists, with the
///        frequencies of a search for its multipliers
/// \param multipliers the best ones found, of the cells of `relaxed`
/// \pre a group has a candidate
SplitNode splitNode(const BranchNode& node, NodeRelaxation& relaxed,
                    const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                    const Progress& progress);

/// The remaining candidates of a group of a node.
struct OpenGroup {
    std::size_t kind = 0;
    std::size_t count = 0;
    std::vector<std::uint32_t> list;  ///< candidates of the reduced problem, ascending
};

/// The core of a node: 1 for the candidates that are part of it, by group and index in its list.
using NodeCore = std::vector<std::vector<char>>;

/// The Lagrangian relaxation of a node of the search tree: finds the best candidates of each group.
class NodeRelaxation {
  public:
    explicit NodeRelaxation(const BranchNode& node);

    /// Returns the cells with the needs that the fixed sensors leave.
    [[nodiscard]] const ReducedProblem& problem() const { return problem_; }
    [[nodiscard]] const std::vector<OpenGroup>& groups() const { return groups_; }
    /// Returns the node's multipliers, clipped to the remaining weights.
    [[nodiscard]] std::vector<std::uint32_t> start(const BranchNode& node) const;

    /// Computes the bound for these multipliers; the members below refer to the last call.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers);
    /// Computes the same from the candidates of the working sites alone: fast, and at most the
    /// result of evaluate().
    std::uint64_t evaluateWorking(const std::vector<std::uint32_t>& multipliers);
    /// Returns the part of the bound that no candidate adds.
    [[nodiscard]] std::uint64_t free() const { return free_; }
    [[nodiscard]] std::uint32_t costOf(std::size_t kind, std::uint32_t candidate) const {
        return reduced_costs_[kind][candidate];
    }
    /// After evaluate(): adds the sites of the best reduced costs to the working sites.
    void widen();
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }
    /// Returns the best candidates of all groups, with the indices of the reduced problem.
    [[nodiscard]] std::vector<Choice> chosen() const;
    /// Reduced-cost fixing: removes candidates that are in no solution better than `cut`.
    void ruleOut(std::uint64_t cut);
    /// Removes and returns the candidates that are in every solution better than `cut`, with the
    /// indices of the reduced problem; their groups choose one sensor less.
    std::vector<Choice> takeForced(std::uint64_t cut);
    /// Returns an upper bound of the solutions that these two excluded, at most their cut.
    [[nodiscard]] std::uint64_t ruledOut() const { return ruled_out_; }

    /// After evaluate(): returns the most promising candidates, about `size` in all, and the
    /// candidates chosen so far.
    [[nodiscard]] NodeCore core(std::size_t size) const;

    /// Updates the running frequency with which each candidate is chosen.
    void count(float part);
    [[nodiscard]] const std::vector<std::vector<float>>& frequencies() const {
        return frequencies_;
    }
    /// Computes the overlap of the view of each candidate of a group with that of `pivot`, weighed
    /// by the multipliers (not all 0): 1 for the pivot itself. Overwrites the reduced costs: call
    /// evaluate() before any member but frequencies().
    [[nodiscard]] std::vector<float> likeness(std::size_t group, std::uint32_t pivot,
                                              const std::vector<std::uint32_t>& multipliers);

  private:
    void settle(const std::vector<Choice>& chosen);
    void findSites();
    using PerKind = std::vector<std::vector<std::uint32_t>>;
    void weigh(const std::vector<std::uint32_t>& multipliers, const PerKind& sites);
    [[nodiscard]] std::vector<std::uint32_t> mostPromising(const OpenGroup& group,
                                                           std::size_t count) const;
    std::uint64_t findBest(const std::vector<std::uint32_t>& multipliers, bool is_all);
    void setCover();

    ReducedProblem problem_;
    std::vector<OpenGroup> groups_;
    PerKind sites_, working_sites_;                    // to be weighed
    std::vector<std::vector<char>> is_working_;        // per kind and site
    PerKind reduced_costs_;                            // by candidate
    std::vector<std::vector<std::uint32_t>> working_;  // per group: candidates of working sites
    std::vector<std::vector<std::uint32_t>> top_;  // per group: the best, one more than requested
    std::vector<std::vector<float>> frequencies_;  // per group, beside its list
    std::vector<std::uint32_t> cell_costs_;
    std::vector<float> cover_;
    std::uint64_t free_ = 0, bound_ = 0, ruled_out_ = 0;
};

}  // namespace ispace
