// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "base/simd.h"
#include "trace/flat_fan.h"
#include "trace/flat_tree.h"

namespace ispace {

/// False if nothing at this distance or beyond is as near as what was met, whatever the rounding.
ISPACE_INLINE bool mayBeNearer(double distance, double nearness_met) {
    return distance * nearness_met <= 1 + 1e-12;
}

/// Children of nodes to be visited, the nearest of a node first.
class FlatStack {
  public:
    struct Entry {
        double distance;
        std::int32_t child;
    };

    [[nodiscard]] bool empty() const { return count_ == 0; }
    ISPACE_INLINE Entry pop() { return entries_[--count_]; }
    /// Those whose distance is not negative.
    ISPACE_INLINE void push(const FlatTree::Node& node, const double* distances) {
        const int bottom = count_;
        for (int i = 0; i < node.count; ++i) {
            if (distances[i] < 0) continue;
            int place = count_++;
            for (; place > bottom && entries_[place - 1].distance < distances[i]; --place)
                entries_[place] = entries_[place - 1];
            entries_[place] = {distances[i], node.child[i]};
        }
    }

  private:
    Entry entries_[FlatTree::kStack];
    int count_ = 0;
};

/// What a ray met first.
struct FlatHit {
    double nearness;    ///< one over the range
    double cosine = 0;  ///< the largest among lines met at the same place
};

/// The nearest line or round body along the unit vector (x, y), if it is nearer than
/// `least_nearness`.
FlatHit firstLine(const FlatTree& tree, const FlatView& view, double x, double y,
                  double least_nearness);

}  // namespace ispace
