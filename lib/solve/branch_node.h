// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "solve/reduced_problem.h"

namespace ispace {

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
    /// Good ones for the parent, to begin with.
    std::shared_ptr<const std::vector<std::uint32_t>> multipliers;
    std::vector<Choice> fixed;    ///< of the original problem
    std::vector<Choice> pending;  ///< of them, those not yet settled in `problem`, as named there
    std::vector<BranchGroup> groups;
    std::uint64_t bound = 0;  ///< fine
};

/// The result of processing a node.
struct BranchResult {
    std::vector<BranchNode> children;  ///< what may be better than the cut
    std::vector<Choice> found;         ///< a feasible solution above the cut, else empty
    /// Upper bound, fine and at most the cut, of solutions that are neither in a child nor `found`.
    std::uint64_t closed = 0;
};

/// Processes a node: bounds it, fixes variables, and splits the rest. Only solutions better than
/// `cut` (fine) matter. Deterministic, unless progress says stop: then the node is its only child.
BranchResult branch(const Problem& problem, const BranchNode& node, std::uint64_t cut,
                    const Progress& progress);

/// A node in parts.
struct SplitNode {
    std::vector<BranchNode> children;  ///< what may be better than the cut
    std::uint64_t closed = 0;          ///< upper bound of solutions in no child
};

/// Branches on a node: splits the list of one group into candidates that see much the same as a
/// pivot and the rest, with one child for each number of sensors from the first part. Strong
/// branching (Applegate, Bixby, Chvatal & Cook 1995) picks the split whose children promise the
/// smallest tree after a few steps of their bounds.
///
/// Deterministic, unless progress says stop: then any split will do.
/// \param relaxed of the node before it was cut down, the same groups and lists, with the shares of
///        a search for its multipliers
/// \param multipliers the best that were found, of the cells of `relaxed`
/// \pre a group has a candidate
SplitNode splitNode(const BranchNode& node, NodeRelaxation& relaxed,
                    const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                    const Progress& progress);

}  // namespace ispace
