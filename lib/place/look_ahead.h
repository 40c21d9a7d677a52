// SPDX-License-Identifier: GPL-3.0-or-later
// The sites that are evaluated ahead of their turn, and storage for their views until then.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/cell_set.h"
#include "geom/point.h"
#include "geom/spatial_index.h"
#include "place/sites.h"
#include "trace/ray_world.h"

namespace ispace {

/// Position of a place along a Morton curve through the box; 32 bits.
inline std::uint64_t alongCurve(Point2 place, const Box2& box) {
    const double scale = 0xffff / std::max({box.width(), box.depth(), kRayEpsilon});
    const auto x = static_cast<std::uint32_t>((place.x - box.low.x) * scale);
    const auto y = static_cast<std::uint32_t>((place.y - box.low.y) * scale);
    return mortonCode(x & 0xffffU, y & 0xffffU);
}

/// A sample of the sites, in an order whose every prefix is spread over the plan, however the sites
/// are listed. O(n log n)
class Spread {
  public:
    /// \pre count <= sites.size() < 2^32
    Spread(std::span<const Site> sites, std::size_t count) {
        Box2 box;
        for (const Site& site : sites) box.add(site.place);
        std::vector<std::uint64_t> curve;  // the place on it above, the site below
        curve.reserve(sites.size());
        for (std::size_t i = 0; i < sites.size(); ++i)
            curve.push_back(alongCurve(sites[i].place, box) << 32U | i);
        std::sort(curve.begin(), curve.end());
        // The middle of each stretch of the curve, in the order of their numbers with bits
        // reversed.
        in_turn_.reserve(count);
        const std::size_t end = std::bit_ceil(count);
        for (std::size_t k = 0, stretch = 0; k < end; ++k) {
            if (stretch < count)
                in_turn_.push_back(curve[(2 * stretch + 1) * sites.size() / (2 * count)] &
                                   0xffffffffU);
            // The highest bits are counted up first.
            std::size_t bit = end / 2;
            for (; (stretch & bit) != 0; bit /= 2) stretch ^= bit;
            stretch |= bit;
        }
        in_order_ = in_turn_;
        std::sort(in_order_.begin(), in_order_.end());
    }
    [[nodiscard]] std::size_t size() const { return in_turn_.size(); }
    /// The k-th site in that order.
    [[nodiscard]] std::size_t turn(std::size_t k) const { return in_turn_[k]; }
    /// The k-th site of the sample in the order of the list.
    [[nodiscard]] std::size_t at(std::size_t k) const { return in_order_[k]; }
    [[nodiscard]] std::size_t slotOf(std::size_t site) const {
        return static_cast<std::size_t>(std::lower_bound(in_order_.begin(), in_order_.end(), site) -
                                        in_order_.begin());
    }

  private:
    std::vector<std::size_t> in_turn_, in_order_;
};

/// Views that were found ahead of their turn, stored together for some hundred neighbours, in
/// pieces large enough to be returned to the system when done.
class Shelf {
  public:
    explicit Shelf(std::size_t size) : slots_(size), boards_(size / kTogether + 1) {}
    void put(std::size_t k, const CellParts& parts) {
        Board& board = boards_[k / kTogether];
        slots_[k] = {board.runs.size(), board.first.size(), parts.runs.size(), parts.first.size()};
        board.runs.insert(board.runs.end(), parts.runs.begin(), parts.runs.end());
        board.first.insert(board.first.end(), parts.first.begin(), parts.first.end());
        bytes_ += parts.runs.size() * sizeof(CellRun) + parts.first.size() * sizeof(std::uint32_t);
    }
    [[nodiscard]] bool has(std::size_t k) const { return slots_[k].firsts > 0; }
    void copy(std::size_t k, CellParts& parts) const {
        const Board& board = boards_[k / kTogether];
        const Slot& slot = slots_[k];
        const std::span runs = std::span(board.runs).subspan(slot.run, slot.runs);
        const std::span first = std::span(board.first).subspan(slot.first, slot.firsts);
        parts.runs.assign(runs.begin(), runs.end());
        parts.first.assign(first.begin(), first.end());
    }
    /// Frees those before k.
    void dropBefore(std::size_t k) {
        for (; dropped_ < k / kTogether; ++dropped_) boards_[dropped_] = {};
    }
    /// Of all that was ever stored.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }

  private:
    static constexpr std::size_t kTogether = 512;
    struct Slot {
        std::size_t run = 0, first = 0;    // where they begin on their board
        std::size_t runs = 0, firsts = 0;  // how many
    };
    struct Board {
        std::vector<CellRun> runs;
        std::vector<std::uint32_t> first;
    };
    std::vector<Slot> slots_;
    std::vector<Board> boards_;
    std::size_t dropped_ = 0, bytes_ = 0;
};

}  // namespace ispace
