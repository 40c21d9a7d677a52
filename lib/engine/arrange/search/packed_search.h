// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange/search: writes and reads the job results of a search, by
// base/packed.h. Results are those of the same version (part_head.h), and are checked nevertheless:
// choices that the problem does not have, and values that its solutions do not have, are errors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arrange/search/branch_node.h"
#include "arrange/search/relaxation.h"
#include "arrange/search/search.h"
#include "base/packed.h"

namespace ispace {

/// Computes a hash of weights, kinds and limits, which tells the problems of one search apart.
std::uint64_t fingerprintOf(const Problem& problem);

void pack(Packer& to, const std::vector<Choice>& chosen);
/// \throws FormatError for a choice that the problem does not have
std::vector<Choice> unpackChoices(Unpacker& from, const Problem& problem);

void pack(Packer& to, const SearchResult& result);
/// \throws FormatError unless the solution is feasible, has this value and is within the bound
SearchResult unpackResult(Unpacker& from, const Problem& problem);

void pack(Packer& to, const Bound& bound);
/// \throws FormatError for multipliers above the weights of their cells, or foreign candidates
Bound unpackBound(Unpacker& from, const Problem& problem);

/// Writes the nodes; data that nodes share is written once, and shared again after reading.
void pack(Packer& to, const std::vector<const BranchNode*>& nodes);
std::vector<BranchNode> unpackNodes(Unpacker& from, const Problem& problem);

}  // namespace ispace
