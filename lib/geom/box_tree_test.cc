// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace ispace {
namespace {

std::vector<std::size_t> found(const BoxTree& tree, const Box2& window) {
    std::vector<std::size_t> out;
    tree.search(window, [&](std::size_t i) { out.push_back(i); });
    std::sort(out.begin(), out.end());
    return out;
}

TEST(BoxTree, OfNothing) {
    EXPECT_TRUE(found(BoxTree(), {{0, 0}, {1, 1}}).empty());
    EXPECT_TRUE(found(BoxTree(std::span<const Box2>()), {{0, 0}, {1, 1}}).empty());
}

TEST(BoxTree, ClosedBoxesMeetWhereTheyTouch) {
    const std::vector<Box2> boxes{{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}, {{3, 3}, {3, 3}}, Box2()};
    const BoxTree tree(boxes);
    EXPECT_EQ(found(tree, {{1, 1}, {1, 1}}), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(found(tree, {{2, 2}, {3, 3}}), (std::vector<std::size_t>{1, 2}));
    EXPECT_TRUE(found(tree, {{4, 0}, {5, 5}}).empty());
    EXPECT_TRUE(found(tree, Box2()).empty());
}

TEST(BoxTree, FindsWhatALookAtAllFinds) {
    std::mt19937_64 random(7);
    std::uniform_int_distribution<int> place(0, 40), extent(0, 6), number(0, 200);
    for (int run = 0; run < 200; ++run) {
        std::vector<Box2> boxes(static_cast<std::size_t>(number(random)));
        const auto any = [&] {
            const Point2 low{1.0 * place(random), 1.0 * place(random)};
            return Box2{low, {low.x + extent(random), low.y + extent(random)}};
        };
        for (Box2& box : boxes) box = any();
        const BoxTree tree(boxes);
        for (int i = 0; i < 10; ++i) {
            const Box2 window = any();
            std::vector<std::size_t> expected;
            for (std::size_t k = 0; k < boxes.size(); ++k)
                if (meets(boxes[k], window)) expected.push_back(k);
            EXPECT_EQ(found(tree, window), expected);
        }
    }
}

TEST(BoxTree, WindowMayShrinkAsItIsSearched) {
    std::vector<Box2> boxes;
    for (int i = 0; i < 100; ++i) boxes.push_back({{1.0 * i, 0}, {i + 0.5, 1}});
    const BoxTree tree(boxes);
    Box2 window{{-10, 0.5}, {42, 0.5}};
    std::size_t last = 0;
    int visits = 0;
    tree.search(window, [&](std::size_t i) {
        ++visits;
        window.low.x = std::max(window.low.x, boxes[i].high.x + 0.1);
        last = std::max(last, i);
    });
    EXPECT_EQ(last, 42U);
    EXPECT_LT(visits, 43);
}

}  // namespace
}  // namespace ispace
