// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace ispace {
namespace {

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

TEST(BoxOrder, HasEachBoxOnce) {
    for (const std::size_t count : {1U, 2U, 8U, 9U, 64U, 65U, 1000U, 20000U}) {
        const std::vector<Segment2> lines = randomLines(count, 50);
        EXPECT_TRUE(orderOf(lines).isOf(count)) << count;
        std::vector<Box2> boxes;
        boxes.reserve(lines.size());
        for (const Segment2& line : lines) boxes.push_back(bounds(line));
        const BoxOrder single = orderOf(boxes, 1);
        EXPECT_TRUE(single.isOf(count)) << count;
        EXPECT_TRUE(std::all_of(single.shape.begin(), single.shape.end(),
                                [](std::uint8_t n) { return n <= BoxOrder::kWidth; }));
    }
}

TEST(BoxOrder, AThousandLinesInOnePlaceAreATreeLikeOthers) {
    const std::vector<Segment2> lines(1000, Segment2{{1, 1}, {2, 3}});
    EXPECT_TRUE(orderOf(lines).isOf(lines.size()));
    std::vector<Segment2> growing;
    growing.reserve(1000);
    for (int i = 0; i < 1000; ++i) growing.push_back({{0, 0}, {std::ldexp(1.0, i / 20), 1}});
    EXPECT_TRUE(orderOf(growing).isOf(growing.size()));
}

TEST(BoxOrder, WhatIsNoTreeOfTheseIsTold) {
    constexpr std::size_t kCount = 100;
    const BoxOrder good = orderOf(randomLines(kCount, 20));
    ASSERT_TRUE(good.isOf(kCount));
    EXPECT_FALSE(good.isOf(kCount - 1));
    EXPECT_FALSE(good.isOf(kCount + 1));
    EXPECT_FALSE(BoxOrder().isOf(0));
    BoxOrder bad = good;
    bad.items[3] = kCount;
    EXPECT_FALSE(bad.isOf(kCount));
    bad.items[3] = bad.items[4];
    EXPECT_FALSE(bad.isOf(kCount));
    // Whatever its shape says, what is told to be a tree has the right boxes and ends.
    std::size_t refused = 0;
    for (std::size_t i = 0; i < good.shape.size(); ++i)
        for (const int value : {0, 1, 2, 7, 8, 9, 255}) {
            bad = good;
            bad.shape[i] = static_cast<std::uint8_t>(value);
            if (!bad.isOf(kCount))
                ++refused;
            else
                EXPECT_EQ(bad.shape, good.shape) << i;
        }
    EXPECT_GT(refused, 0U);
    bad = good;
    bad.shape.pop_back();
    EXPECT_FALSE(bad.isOf(kCount));
    bad = good;
    bad.shape.push_back(0);
    EXPECT_FALSE(bad.isOf(kCount));
}

TEST(BoxOrder, IsNoDeeperThanWhoFollowsItMayGo) {
    // Nodes below each other, each with a leaf of one box and the next node, or a leaf at the end.
    const auto is_tree = [](std::size_t nodes) {
        BoxOrder order;
        for (std::size_t i = 0; i < nodes; ++i) {
            const std::uint8_t next = i + 1 == nodes ? 1 : 0;
            order.shape.insert(order.shape.end(), {2, 1, next});
        }
        order.items.resize(nodes + 1);
        std::iota(order.items.begin(), order.items.end(), 0U);
        return order.isOf(nodes + 1);
    };
    EXPECT_TRUE(is_tree(BoxOrder::kDepth));
    EXPECT_FALSE(is_tree(BoxOrder::kDepth + 1));
    EXPECT_FALSE(is_tree(100'000));
}

TEST(BoxOrder, HasNoNodesThatDivideNothing) {
    EXPECT_TRUE((BoxOrder{{0}, {1, 1}}.isOf(1)));
    EXPECT_FALSE((BoxOrder{{0}, {1, 0, 1, 1}}.isOf(1)));
    EXPECT_TRUE((BoxOrder{{0, 1, 2}, {2, 0, 1, 2, 1, 1}}.isOf(3)));
    EXPECT_FALSE((BoxOrder{{0, 1}, {2, 0, 1, 1, 1}}.isOf(2)));
}

}  // namespace
}  // namespace ispace
