// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/spatial_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geom/predicates.h"

namespace ispace {
namespace spatial_index_test {

std::vector<std::size_t> found(const BoxTree& tree, const Box2& window) {
    std::vector<std::size_t> out;
    tree.search(window, [&](std::size_t i) { out.push_back(i); });
    std::sort(out.begin(), out.end());
    return out;
}

TEST(MortonCode, TakesBitsInTurn) {
    EXPECT_EQ(mortonCode(0, 0), 0U);
    EXPECT_EQ(mortonCode(1, 0), 1U);
    EXPECT_EQ(mortonCode(0, 1), 2U);
    EXPECT_EQ(mortonCode(0b1011, 0b0110), 0b01101101U);
    EXPECT_EQ(mortonCode(0xffffffff, 0), 0x5555555555555555U);
    EXPECT_EQ(mortonCode(0xffffffff, 0xffffffff), 0xffffffffffffffffU);
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
                if (boxes[k].meets(window)) expected.push_back(k);
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

std::vector<std::size_t> near(const SegmentTree& tree, const Segment2& segment, double reach) {
    std::vector<std::size_t> out;
    tree.search(segment, reach, [&](std::size_t i) { out.push_back(i); });
    std::sort(out.begin(), out.end());
    return out;
}

TEST(SegmentTree, FindsAllInReachOnce) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> place(-10, 10), step(-2, 2);
    for (const double far : {0.0, 1e7, 1e120, 1e300}) {
        std::vector<Segment2> segments;
        for (int i = 0; i < 300; ++i) {
            const Point2 from{place(random), place(random)};
            segments.push_back({from, from + Vec2{step(random), step(random)}});
        }
        segments.push_back({{far, far}, {-far, far}});
        const SegmentTree tree(segments);
        for (int i = 0; i < 100; ++i) {
            const Point2 p{place(random), place(random)};
            for (const double reach : {0.0, 1e-6, 0.5}) {
                const auto found = near(tree, {p, p}, reach);
                EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
                for (std::size_t k = 0; k < segments.size(); ++k) {
                    if (!(distance(p, segments[k]) <= reach)) continue;  // or not a number
                    EXPECT_TRUE(std::binary_search(found.begin(), found.end(), k));
                }
            }
            const Segment2& own = segments[static_cast<std::size_t>(i)];
            const auto met = near(tree, own, 0);
            for (std::size_t k = 0; k < segments.size(); ++k) {
                if (!intersects(own, segments[k])) continue;
                EXPECT_TRUE(std::binary_search(met.begin(), met.end(), k));
            }
        }
    }
    EXPECT_TRUE(near(SegmentTree({}), {{0, 0}, {1, 1}}, 1).empty());
}

TEST(SegmentTree, LooksAtFewOfAHatchInAnyHeading) {
    for (const double angle : {0.0, 0.3, 0.7853981, 1.4}) {
        const Vec2 along{std::cos(angle), std::sin(angle)};
        std::vector<Segment2> hatch;
        for (int i = 0; i < 1000; ++i) {
            const Point2 from = Point2{0, 0} + 0.01 * i * perpendicular(along);
            hatch.push_back({from, from + 10 * along});
        }
        const SegmentTree tree(hatch);
        for (const Segment2& line : hatch) EXPECT_LE(near(tree, line, 1e-6).size(), 3U) << angle;
    }
}

TEST(SegmentGrid, FindsWhatLiesAlongALine) {
    constexpr double kMargin = 0.1;
    std::mt19937_64 random(5);
    const auto any = [&] {
        const auto coordinate = [&] { return static_cast<double>(random() % 200) / 10; };
        return Segment2{{coordinate(), coordinate()}, {coordinate(), coordinate()}};
    };
    std::vector<Segment2> segments(300);
    for (Segment2& segment : segments) segment = any();
    const SegmentGrid grid(segments, kMargin);
    for (int run = 0; run < 300; ++run) {
        const Segment2 line = any();
        std::vector<bool> visited(segments.size());
        grid.searchAlong(line, [&](std::span<const std::uint32_t> cell) {
            for (const std::uint32_t i : cell) visited[i] = true;
        });
        for (std::size_t i = 0; i < segments.size(); ++i) {
            const Segment2& s = segments[i];
            const bool is_near = intersects(s, line) ||
                                 std::min({distance(s.a, line), distance(s.b, line),
                                           distance(line.a, s), distance(line.b, s)}) <= kMargin;
            EXPECT_TRUE(visited[i] || !is_near) << run << ' ' << i;
        }
    }
}

TEST(SegmentGrid, PointsBeyondTheBoxCountAsInTheNearestCell) {
    std::vector<Segment2> row;
    for (int i = 0; i < 10; ++i) row.push_back({{1.0 * i, 0}, {1.0 * i, 1}});
    const SegmentGrid grid(row, 0.25);
    const auto holds = [&](Point2 p, std::uint32_t i) {
        const auto found = grid.near(p);
        return std::find(found.begin(), found.end(), i) != found.end();
    };
    EXPECT_TRUE(holds({-0.25, 0.5}, 0)) << "within the margin, outside the box";
    EXPECT_TRUE(holds({9.25, 1}, 9));
    EXPECT_TRUE(holds({3, 1.25}, 3));
    EXPECT_TRUE(holds({-1e300, -1e300}, 0));
    EXPECT_TRUE(holds({1e300, 0.5}, 9));
    EXPECT_FALSE(holds({1e300, 0.5}, 0));
}

}  // namespace spatial_index_test
}  // namespace ispace
