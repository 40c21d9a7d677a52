// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "place/reduced_problem.h"

namespace ispace {

/// Sensors of one kind that are to be chosen from the same list; the lists of two groups of a node
/// have no candidate in common.
struct BranchGroup {
    std::size_t kind = 0;
    std::size_t count = 0;
    std::vector<std::uint32_t> list;  ///< candidates of the reduced problem, ascending
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
    std::uint64_t bound = 0;           ///< of the node, fine
    std::vector<BranchNode> children;  ///< all of it that may be worth more than the cut
    std::vector<Choice> found;         ///< feasible choices worth more than the cut, else empty
};

/// Bounds a node, fixes what it can, and splits what is left. What is worth at most `cut` (fine) is
/// of no interest. The result depends on the arguments alone.
BranchResult branch(const Problem& problem, const BranchNode& node, std::uint64_t cut);

}  // namespace ispace
