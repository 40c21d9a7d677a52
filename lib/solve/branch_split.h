// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "solve/branch_node.h"
#include "solve/node_relaxation.h"

namespace ispace {

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
