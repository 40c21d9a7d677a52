// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/progress.h"
#include "solve/reduced_problem.h"

namespace ispace {

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

}  // namespace ispace
