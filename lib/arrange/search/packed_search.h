// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange/search: what a search leaves to another process, as bytes.
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

/// Tells problems apart of which one search has several: a hash of weights, kinds and limits.
std::uint64_t fingerprintOf(const Problem& problem);

void pack(Packer& to, const std::vector<Choice>& chosen);
/// \throws FormatError for a choice that the problem does not have
std::vector<Choice> unpackChoices(Unpacker& from, const Problem& problem);

/// The solution with its value computed anew.
void pack(Packer& to, const SearchResult& result);
SearchResult unpackResult(Unpacker& from, const Problem& problem);

void pack(Packer& to, const Bound& bound);
Bound unpackBound(Unpacker& from, const Problem& problem);

/// What nodes share is packed once, and shared again afterwards.
void pack(Packer& to, const std::vector<const BranchNode*>& nodes);
std::vector<BranchNode> unpackNodes(Unpacker& from, const Problem& problem);

}  // namespace ispace
