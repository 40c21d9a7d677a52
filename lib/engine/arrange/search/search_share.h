// SPDX-License-Identifier: GPL-3.0-or-later
// How one search is divided among processes (--shard) and continued (--resume). Parts of a job are
// files of base/part_file.h.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/part_file.h"

namespace ispace {

/// Work of a search that shards divide among themselves.
enum class Shared {
    Candidates,  ///< views of the candidates, step by step in turn
    Starts,      ///< the starts of swap search, in blocks
    Tree,        ///< the subtrees of a proof
    Poses        ///< those of a proof over all poses, see PoseShare
};
constexpr Shared kShared[] = {Shared::Candidates, Shared::Starts, Shared::Tree, Shared::Poses};
/// True if a part that was cut short is of use, since its bound holds.
constexpr bool isOfProof(Shared shared) {
    return shared == Shared::Tree || shared == Shared::Poses;
}
/// Returns the name on the command line.
std::string_view nameOf(Shared shared);

/// Divides a search among processes without communication, and continues an earlier run.
///
/// Shards differ only in the steps that they compute, and store these by key. A merge runs the same
/// search again: it reads the steps of all shards from their results, and computes missing ones
/// itself. So candidates and starts merge to the bytes of a single run.
///
/// For a proof, all shards grow the same tree until it has enough open nodes, deal these out in
/// turn by their bounds, and each continues with its share. A shard returns the best solution of
/// its subtrees, with a bound of them that holds even if it was cut short; the merge takes the best
/// value and the highest bound. Complete proofs have the value and the gap of a single run; among
/// equally good layouts the merge may have another one.
struct SearchShare {
    Shared what = Shared::Tree;
    std::optional<Shard> own;       ///< compute only these steps, and end
    int joined = 0;                 ///< of a merge: the number of shards
    JobResults* results = nullptr;  ///< null: do not store steps
    std::string search = {};        ///< of several searches of a job, each with a tree: its name

    /// Returns true for a shard that divides this work.
    [[nodiscard]] bool isOwn(Shared which) const { return own && what == which; }
};

}  // namespace ispace
