// SPDX-License-Identifier: GPL-3.0-or-later
// A hash table of points, for the graphs of lines whose ends are equal points, as those of drawings
// are.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "geom/point.h"

namespace ispace {

/// Values by points: a hash table with open addressing and linear probing, at most three quarters
/// full, in which a look-up costs about one cache miss. Points are equal by their doubles, without
/// tolerance; 0 and -0 are equal. There is no iteration, so that no result can depend on the order
/// of slots. O(1) on average; the hash is fixed, so input made for it may take O(n). Const access
/// is thread-safe.
///
///     PointMap<int> degree;
///     for (const Segment2& s : segments) { ++degree[s.a]; ++degree[s.b]; }
///     const int* at_origin = degree.find({0, 0});  // null without an end there
///
/// \pre no coordinate is NaN: NaN marks free slots
template <typename T>
class PointMap {
  public:
    /// Returns the value of the point, at first T(). An insertion invalidates references.
    T& operator[](Point2 p) {
        if (4 * (count_ + 1) > 3 * slots_.size()) grow();
        Slot& slot = slots_[slotOf(p)];
        if (slot.isFree()) {
            slot.point = p;
            ++count_;
        }
        return slot.value;
    }

    /// Returns null if the point has no value.
    [[nodiscard]] const T* find(Point2 p) const {
        const Slot& slot = slots_[slotOf(p)];
        return slot.isFree() ? nullptr : &slot.value;
    }

  private:
    struct Slot {
        Point2 point{std::numeric_limits<double>::quiet_NaN(), 0};
        T value{};
        [[nodiscard]] bool isFree() const { return point.x != point.x; }
    };

    /// Finds the slot of the point, or the free one for it.
    [[nodiscard]] std::size_t slotOf(Point2 p) const {
        // The low bits of whole numbers are zero: those of x are mixed first, and the index is the
        // top of the product.
        std::uint64_t mixed = std::bit_cast<std::uint64_t>(p.x + 0.0) * 0x9E3779B97F4A7C15U;
        mixed = (mixed ^ mixed >> 32U) + std::bit_cast<std::uint64_t>(p.y + 0.0);
        mixed *= 0xBF58476D1CE4E5B9U;
        auto slot = static_cast<std::size_t>(mixed >> (65U - std::bit_width(slots_.size())));
        while (!slots_[slot].isFree() && !(slots_[slot].point == p))
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    void grow() {
        const auto old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
        for (const Slot& slot : old)
            if (!slot.isFree()) slots_[slotOf(slot.point)] = slot;
    }

    std::vector<Slot> slots_ = std::vector<Slot>(16);  // a power of two
    std::size_t count_ = 0;
};

}  // namespace ispace
