// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "solve/branch_node.h"

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

}  // namespace ispace
