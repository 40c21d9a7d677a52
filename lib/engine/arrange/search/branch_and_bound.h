// SPDX-License-Identifier: GPL-3.0-or-later
// The search tree of Exact: branch and bound (A. H. Land, A. G. Doig, An automatic method of
// solving discrete programming problems, 1960) with Lagrangian bounds (relaxation.h) in place of
// linear programs.
//
// Nodes are taken in batches that do not depend on the number of threads, processed in parallel,
// and their results are taken in order: the tree is the same for any number of threads. Memory is
// that of the open nodes, at most about max_bytes. Time is exponential at worst.
//
//     const Bound bound = lagrangianBound(problem, best.chosen, {.cut = best.value}, progress);
//     const SearchResult exact =
//         branchAndBound(problem, bound, {best, bound.value}, 0, progress);
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

/// Stores the open nodes of a search tree. The highest bound comes first (best first), or the
/// newest while memory is short: depth first leaves few open. Memory that nodes share counts once.
class OpenNodes {
  public:
    /// \param max_bytes memory limit, approximate
    explicit OpenNodes(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    /// Returns the highest bound, fine.
    /// \pre not empty
    [[nodiscard]] std::uint64_t bound() const { return ~nodes_.begin()->first.first; }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

    void add(BranchNode node);
    /// Removes and returns the next nodes to process: at most `most`, fewer large ones, at least
    /// one.
    std::vector<BranchNode> take(std::size_t most);
    /// Undoes the last take(), given its nodes.
    void putBack(std::vector<BranchNode> batch);
    /// Removes nodes with a bound of at most `cut`; returns the highest of these bounds, else 0.
    std::uint64_t dropUpTo(std::uint64_t cut);

    [[nodiscard]] std::size_t size() const { return nodes_.size(); }
    /// Returns all nodes, by age.
    [[nodiscard]] std::vector<const BranchNode*> byAge() const;
    /// Removes all nodes but those of one shard, dealt out in turn, the highest bound first.
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

/// Returns, per kind and ascending, the candidates that reduced-cost fixing by the bound's
/// multipliers leaves for solutions better than `value`.
std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value);

/// Branch and bound over the surviving candidates: improves `known` until its value and bound are
/// within `gap`, its value reaches `enough`, or progress says stop. Each node has a Lagrangian
/// bound, warm-started from its parent's multipliers, and excludes more candidates. Best first, or
/// depth first while open nodes take more than `max_bytes`. Deterministic unless stopped.
///
/// If a budget can be split in more ways than CountChoice lists (20'000), no tree is built: returns
/// `known` unchanged. known.best need not be a solution: only better values are searched.
///
/// With share.results, reads the tree stored there and continues it; writes the tree now and then
/// and at the end.
SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress,
                            std::uint64_t enough = std::numeric_limits<std::uint64_t>::max(),
                            std::size_t max_bytes = kMaxTreeBytes,
                            const SearchShare& share = SearchShare());

}  // namespace ispace
