// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "solve/reduced_problem.h"

namespace ispace {

class NodeRelaxation;

/// Sensors of one kind that are to be chosen from the same list; the lists of two groups of a node
/// have no candidate in common.
struct BranchGroup {
    std::size_t kind = 0;
    std::size_t count = 0;
    /// Candidates of the reduced problem, ascending; nodes share lists.
    std::shared_ptr<const std::vector<std::uint32_t>> list;
};

/// A part of all sets of choices: the fixed ones and from each group so many (or fewer).
struct BranchNode {
    std::shared_ptr<const ReducedProblem> problem;
    /// Good ones for the parent, to begin with.
    std::shared_ptr<const std::vector<std::uint32_t>> multipliers;
    std::vector<Choice> fixed;    ///< of the original problem
    std::vector<Choice> pending;  ///< of them, those not yet settled in `problem`, as named there
    std::vector<BranchGroup> groups;
    std::uint64_t bound = 0;  ///< fine
};

/// What came of a node.
struct BranchResult {
    std::vector<BranchNode> children;  ///< all of it that may be worth more than the cut
    std::vector<Choice> found;         ///< feasible choices worth more than the cut, else empty
    /// What is in no child is worth no more than this (fine, at most the cut) or than what was
    /// found.
    std::uint64_t closed = 0;
};

/// Bounds a node, fixes what it can, and splits what is left. What is worth at most `cut` (fine) is
/// of no interest. The result depends on the arguments alone, unless progress says stop: then the
/// node is its own only child.
BranchResult branch(const Problem& problem, const BranchNode& node, std::uint64_t cut,
                    const Progress& progress);

/// A node in parts.
struct SplitNode {
    std::vector<BranchNode> children;  ///< all of it that may be worth more than the cut
    std::uint64_t closed = 0;          ///< what is in no child is worth no more; at most the cut
};

/// Splits the list of one group of a node in two: candidates that see about the same as one of
/// them, and the rest. There is a child for each number of sensors that are of the first. Of the
/// places where a group could be split, that one is taken whose children promise the smallest tree,
/// by a few steps of the bound of each (strong branching, Applegate, Bixby, Chvatal & Cook 1995).
///
/// The result depends on the arguments alone, unless progress says stop: then any split will do.
/// \param relaxed of the node before it was cut down, the same groups and lists, with the shares of
///        a search for its multipliers
/// \param multipliers the best that were found, of the cells of `relaxed`
/// \pre a group has a candidate
SplitNode splitNode(const BranchNode& node, NodeRelaxation& relaxed,
                    const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                    const Progress& progress);

}  // namespace ispace
