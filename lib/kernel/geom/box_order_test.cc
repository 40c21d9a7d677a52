// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/spatial_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

namespace ispace {
namespace box_order_test {

std::vector<Segment2> randomLines(std::size_t count, double extent) {
    std::mt19937_64 random(count);
    std::uniform_real_distribution<double> place(0, extent), way(-1, 1);
    std::vector<Segment2> lines;
    for (std::size_t i = 0; i < count; ++i) {
        const Point2 a{place(random), place(random)};
        lines.push_back({a, a + Vec2{way(random), way(random)}});
    }
    return lines;
}

/// Follows the shape of a tree that may be none.
class ShapeReader {
  public:
    explicit ShapeReader(std::span<const std::uint8_t> shape) : rest_(shape) {}

    /// The box of all, unless it is not the shape of a tree.
    std::optional<std::size_t> boxes() {
        if (!readNode(0) || !rest_.empty()) return std::nullopt;
        return boxes_;
    }

  private:
    bool readNode(int depth) {
        if (depth == BoxOrder::kDepth || rest_.empty()) return false;
        const std::size_t count = rest_.front();
        if (count == 0 || count > BoxOrder::kWidth || count >= rest_.size()) return false;
        // Below the root a node divides: else few boxes could be a tree of very many nodes.
        if (count == 1 && depth > 0) return false;
        const auto children = rest_.subspan(1, count);
        rest_ = rest_.subspan(1 + count);
        return std::all_of(children.begin(), children.end(), [&](std::uint8_t size) {
            boxes_ += size;
            return size == 0 ? readNode(depth + 1) : size <= BoxOrder::kWidth;
        });
    }

    std::span<const std::uint8_t> rest_;
    std::size_t boxes_ = 0;
};

/// True if it is a tree of so many boxes, each once.
bool isTreeOf(const BoxOrder& order, std::size_t boxes) {
    if (order.items.size() != boxes || ShapeReader(order.shape).boxes() != boxes) return false;
    std::vector<bool> is_seen(boxes);
    for (const std::uint32_t item : order.items) {
        if (item >= boxes || is_seen[item]) return false;
        is_seen[item] = true;
    }
    return true;
}

TEST(BoxOrder, HasEachBoxOnce) {
    for (const std::size_t count : {1U, 2U, 8U, 9U, 64U, 65U, 1000U, 20000U}) {
        const std::vector<Segment2> lines = randomLines(count, 50);
        EXPECT_TRUE(isTreeOf(orderOf(lines), count)) << count;
        std::vector<Box2> boxes;
        boxes.reserve(lines.size());
        for (const Segment2& line : lines) boxes.push_back(bounds(line));
        const BoxOrder single = orderOf(boxes, 1);
        EXPECT_TRUE(isTreeOf(single, count)) << count;
        EXPECT_TRUE(std::all_of(single.shape.begin(), single.shape.end(),
                                [](std::uint8_t n) { return n <= BoxOrder::kWidth; }));
    }
}

TEST(BoxOrder, AThousandLinesInOnePlaceAreATreeLikeOthers) {
    const std::vector<Segment2> lines(1000, Segment2{{1, 1}, {2, 3}});
    EXPECT_TRUE(isTreeOf(orderOf(lines), lines.size()));
    std::vector<Segment2> growing;
    growing.reserve(1000);
    for (int i = 0; i < 1000; ++i) growing.push_back({{0, 0}, {std::ldexp(1.0, i / 20), 1}});
    EXPECT_TRUE(isTreeOf(orderOf(growing), growing.size()));
}

}  // namespace box_order_test
}  // namespace ispace
