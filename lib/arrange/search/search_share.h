// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string_view>

#include "base/part_file.h"

namespace ispace {

/// What the shards of a search share out.
enum class Shared {
    Candidates,  ///< what the candidates see, step by step in turn
    Starts,      ///< the starts of swap search, in blocks
    Tree         ///< the subtrees of a proof
};
constexpr Shared kShared[] = {Shared::Candidates, Shared::Starts, Shared::Tree};
/// As on the command line.
std::string_view nameOf(Shared shared);

/// How a search is shared out over processes that do not talk to each other, and goes on where
/// another one ended.
///
/// Shards differ in nothing but the steps that they take, and these are stored by key; a merge
/// is the same search over again, which finds the steps of all shards, and takes itself what it
/// does not find. So candidates and starts merge to the bytes of a single run.
///
/// Of a proof all shards grow the same tree until it has enough open nodes, deal these out in turn
/// by their bounds, and each goes on with its own. What a shard finds is the best of its subtrees,
/// with a bound of them that holds even if it was cut short; the merge takes the best value and the
/// highest bound. Proofs that end have the value and the gap of a single run; among equally good
/// layouts the merge may have another one.
struct SearchShare {
    Shared what = Shared::Tree;
    std::optional<Shard> own;       ///< take these steps only, and end
    int joined = 0;                 ///< of a merge: the number of shards
    JobResults* results = nullptr;  ///< of steps; null: store none

    /// True for a shard that shares out this.
    [[nodiscard]] bool isOwn(Shared which) const { return own && what == which; }
};

}  // namespace ispace
