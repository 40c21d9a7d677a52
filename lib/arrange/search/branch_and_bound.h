// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "arrange/search/branch_node.h"
#include "arrange/search/relaxation.h"
#include "arrange/search/search.h"

namespace ispace {

/// The open nodes of a search tree. The highest bound comes first (best first), or the newest while
/// memory is short: depth first leaves few open. Memory that nodes share counts once.
class OpenNodes {
  public:
    /// \param max_bytes memory limit, approximate
    explicit OpenNodes(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    /// The highest, fine. \pre not empty
    [[nodiscard]] std::uint64_t bound() const { return ~nodes_.begin()->first.first; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    void add(BranchNode node);
    /// The next nodes to process: at most `most`, fewer where they are large, at least one.
    std::vector<BranchNode> take(std::size_t most);
    /// Undoes the last take(), of which these are the nodes.
    void putBack(std::vector<BranchNode> batch);
    /// Drops nodes with a bound of at most `cut`; returns the highest of these bounds, else 0.
    std::uint64_t dropUpTo(std::uint64_t cut);

    [[nodiscard]] std::size_t size() const { return nodes_.size(); }
    /// All of them, by age.
    [[nodiscard]] std::vector<const BranchNode*> byAge() const;
    /// Drops all but those of one shard, dealt out in turn, the highest bound first.
    void keepOnly(const Shard& shard);

  private:
    using Key = std::pair<std::uint64_t, std::uint64_t>;  ///< complement of the bound, age
    struct Shared {
        std::size_t users = 0, bytes = 0;
    };

    BranchNode remove(const Key& key);
    void insert(const Key& key, BranchNode node);
    void hold(const void* shared, std::size_t bytes);
    void release(const void* shared);

    std::size_t max_bytes_, bytes_ = 0;
    std::uint64_t next_ = 0;
    std::map<Key, BranchNode> nodes_;
    std::vector<Key> taken_;                         // by the last take()
    std::map<std::uint64_t, std::uint64_t> by_age_;  // to the first of the key
    std::unordered_map<const void*, Shared> shared_;
};

/// Per kind, ascending, the candidates that reduced-cost fixing by the bound's multipliers leaves
/// for solutions better than `value`.
std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value);

/// Branch and bound over the surviving candidates: improves `known` until its value and bound are
/// within `gap`, its value reaches `enough`, or progress says stop. Each node has its own
/// Lagrangian bound, warm-started from its parent's multipliers, and rules out more candidates.
/// Best first, or depth first while open nodes take more than `max_bytes`. Deterministic unless
/// stopped.
///
/// If a budget can be split in more ways than CountChoice lists (20'000) there is no tree: `known`
/// is returned unchanged. known.best need not be a solution: only better values are searched.
///
/// With results of steps it goes on from a tree stored there, and stores its own now and then and
/// at its end.
SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress,
                            std::uint64_t enough = std::numeric_limits<std::uint64_t>::max(),
                            std::size_t max_bytes = kMaxTreeBytes,
                            const SearchShare& share = SearchShare());

}  // namespace ispace
