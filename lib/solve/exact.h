// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solve/branch_node.h"
#include "solve/search.h"

namespace ispace {

/// The nodes of a search tree that are still to be looked at. Those with the highest bound come
/// first, or, while they take too much memory, the newest: depth first leaves few open. What nodes
/// share counts once.
class OpenNodes {
  public:
    /// \param most_bytes about so much may be held
    explicit OpenNodes(std::size_t most_bytes) : most_bytes_(most_bytes) {}

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    /// The highest, fine. \pre not empty
    [[nodiscard]] std::uint64_t bound() const { return ~nodes_.begin()->first.first; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    void add(BranchNode node);
    /// The next nodes to look at: at most `most`, fewer where they are large, but one at least.
    std::vector<BranchNode> take(std::size_t most);
    /// Drops what is worth at most `cut`; returns the highest bound of that, else 0.
    std::uint64_t dropUpTo(std::uint64_t cut);

  private:
    using Key = std::pair<std::uint64_t, std::uint64_t>;  ///< complement of the bound, age
    struct Shared {
        std::size_t users = 0, bytes = 0;
    };

    BranchNode remove(const Key& key);
    void hold(const void* shared, std::size_t bytes);
    void release(const void* shared);

    std::size_t most_bytes_, bytes_ = 0;
    std::uint64_t next_ = 0;
    std::map<Key, BranchNode> nodes_;
    std::map<std::uint64_t, std::uint64_t> by_age_;  // to the first of the key
    std::unordered_map<const void*, Shared> shared_;
};

/// Per kind, the candidates that may still be part of something worth more than `value`, ascending:
/// the others are ruled out by the multipliers of the bound (reduced-cost fixing), or were before.
std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value);

/// Branch and bound over what is left: best and bound of `known` are improved until they are within
/// `gap`, the best is worth `enough`, or progress says stop. Each node is bounded by a Lagrangian
/// relaxation of its own, warm from its parent's multipliers, and rules out more candidates; nodes
/// with the highest bound come first, or the newest where the open ones take more than `most_bytes`
/// of memory. Deterministic unless stopped.
///
/// Where a budget can be shared out in more ways than CountChoice lists (20'000) there is no tree:
/// `known` comes back as it is, complete, with the bound it had.
/// \pre known.best need not exist: what is worth no more than its value is not looked for
SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress,
                            std::uint64_t enough = std::numeric_limits<std::uint64_t>::max(),
                            std::size_t most_bytes = kMostTreeBytes);

}  // namespace ispace
