// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: the branch and bound over tuples of boxes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <queue>
#include <span>
#include <string>
#include <vector>

#include "base/packed.h"
#include "extensions/proofs/poses/multiple_bound.h"
#include "extensions/proofs/poses/pose_boxes.h"
#include "extensions/proofs/poses/pose_search.h"
#include "extensions/proofs/poses/sum_bound.h"

namespace ispace::proofs::poses {

struct Tuple {
    double bound = 0;
    std::array<BoxId, kMaxPosed> boxes{};
    std::uint32_t node = 0;  // of the tree of tuples
};
/// A tuple of the tree that becomes a certificate.
struct TupleNode {
    std::array<std::uint32_t, 2> halves{};  // 0: left out
    int which = -1;                         // the box that is halved; -1: none
    double bound = 0;
};
struct IsWorse {
    bool operator()(const Tuple& a, const Tuple& b) const {
        return a.bound != b.bound ? a.bound < b.bound : a.boxes > b.boxes;
    }
};
class OpenTuples : public std::priority_queue<Tuple, std::vector<Tuple>, IsWorse> {
  public:
    [[nodiscard]] const std::vector<Tuple>& all() const { return c; }
    void sortByBound() {
        std::sort(c.begin(), c.end(),
                  [](const Tuple& a, const Tuple& b) { return IsWorse()(b, a); });
    }
    /// Deals sorted tuples out in turn, the best first, and keeps those of one shard.
    void keepOnly(const Shard& shard) {
        std::size_t kept = 0;
        const auto first = static_cast<std::size_t>(shard.index - 1);
        for (std::size_t i = first; i < c.size(); i += static_cast<std::size_t>(shard.count))
            c[kept++] = c[i];
        c.resize(kept);
        std::make_heap(c.begin(), c.end(), IsWorse());
    }
};

class PoseSearcher {
  public:
    PoseSearcher(const PoseFloor& floor, const Sector& sector, const PoseSearchOptions& options,
                 Progress& progress)
        : floor_(floor),
          sector_(sector),
          options_(options),
          progress_(progress),
          count_(static_cast<std::size_t>(options.sensors)),
          found_{options.found, {}},
          boxes_(floor, sector),
          sums_(floor, boxes_, static_cast<std::size_t>(options.times)),
          multiple_(floor, boxes_, count_, static_cast<std::size_t>(options.times)) {}

    PoseBound run();
    [[nodiscard]] std::uint64_t dealt() const { return dealt_; }

  private:
    void searchSingle();
    void searchTuples();
    /// Once there are enough tuples, a shard continues with its share.
    void deal();
    /// Stores the state, from which another run continues.
    void keep();
    bool recall();
    void unpackTuples(Unpacker& from);
    void readTree(const std::vector<std::uint32_t>& numbers);
    [[nodiscard]] std::span<const BoxId> boxesOf(const Tuple& tuple) const {
        return {tuple.boxes.data(), count_};
    }
    [[nodiscard]] double boundOf(const Tuple& tuple, double enough) const;
    /// Bounds it for sensors that see the floor once.
    [[nodiscard]] double unionBoundOf(const Tuple& tuple, double enough) const;
    /// Tuples that replace one, and the best layout of centres of boxes among them.
    struct Children {
        std::vector<Tuple> tuples;
        Tuple best;
        double best_value = 0;
    };
    [[nodiscard]] Children childrenOf(const Tuple& tuple, std::size_t which) const;
    /// Lowers bounds of children by SumBound.
    void lowerBySums(std::vector<Children>& made);
    [[nodiscard]] double cutoff() const { return found_.area / (1 - options_.gap); }
    void improve(const Tuple& tuple);
    [[nodiscard]] bool isFull() const {
        return boxes_.bytes() + queue_.size() * sizeof(Tuple) + tree_.size() * sizeof(TupleNode) >
               options_.max_bytes;
    }
    void addToTree(const Tuple& parent, std::size_t which, std::vector<Tuple>& children);
    /// Writes a subtree; nodes within the bound prove it without their halves.
    void writeTuples(std::uint32_t id, double bound, std::string& text) const;

    const PoseFloor& floor_;
    const Sector& sector_;
    const PoseSearchOptions& options_;
    Progress& progress_;
    std::size_t count_;
    PosedLayout found_;
    PoseBoxes boxes_;
    SumBound sums_;
    MultipleBound multiple_;  // for options.times > 1
    std::size_t tuples_ = 0;
    std::vector<TupleNode> tree_;  // with a certificate alone
    OpenTuples queue_;
    double tried_ = 0;   // best layout of centres of boxes, m2
    double closed_ = 0;  // largest bound of a tuple that was not split further
    bool is_complete_ = true;
    std::string name_;  // of the state
    std::uint64_t mark_ = 0;
    std::uint64_t dealt_ = 0;  // fingerprint of the tuples that were dealt out; 0: none yet
    bool is_kept_ = false;     // false also if single views were cut short
};

}  // namespace ispace::proofs::poses
