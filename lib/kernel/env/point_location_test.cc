// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/point_location.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {
namespace point_location_test {

Polygon square(double x, double y) { return {{x, y}, {x + 1, y}, {x + 1, y + 1}, {x, y + 1}}; }

RegionIndex indexOf(const Region& region) { return RegionIndex(std::vector{region}); }

TEST(RegionIndex, AnswersAsTheRegionDoes) {
    const Region region{{{0, 0}, {8, 0}, {8, 4}, {4, 4}, {4, 8}, {0, 8}},
                        {{{1, 1}, {1, 3}, {3, 3}, {3, 1}}}};
    const RegionIndex index = indexOf(region);
    std::mt19937_64 random(11);
    // Half metres: through vertices and along edges.
    std::uniform_int_distribution<int> half(-2, 18);
    std::uniform_real_distribution<double> place(-1, 9);
    for (int i = 0; i < 3000; ++i) {
        const Point2 p = i % 2 == 0 ? Point2{0.5 * half(random), 0.5 * half(random)}
                                    : Point2{place(random), place(random)};
        EXPECT_EQ(index.locate(p), region.locate(p)) << p.x << ' ' << p.y;
        EXPECT_EQ(index.isWithin(p, 1e-6), region.locate(p) != Side::Outside) << p.x << ' ' << p.y;
    }
    EXPECT_TRUE(index.isWithin({8 + 1e-9, 2}, 1e-6)) << "it touches";
    EXPECT_FALSE(index.isWithin({8 + 1e-3, 2}, 1e-6));
    EXPECT_TRUE(index.isWithin({2.999999999, 2}, 1e-6));
    EXPECT_EQ(RegionIndex({}).locate({0, 0}), Side::Outside);
    EXPECT_FALSE(RegionIndex({}).isWithin({0, 0}, 1));
    // Left of the origin as well.
    const RegionIndex west = indexOf({{{-9, 0}, {-8, 0}, {-8, 1}, {-9, 1}}, {}});
    EXPECT_EQ(west.locate({-8.5, 0.5}), Side::Inside);
    EXPECT_EQ(west.locate({-7.5, 0.5}), Side::Outside);
}

TEST(RegionIndex, AnswersForOutlinesThatCrossThemselves) {
    // Small whole numbers: places, corners and lines often meet.
    std::mt19937_64 random(3);
    std::uniform_int_distribution<int> whole(0, 6);
    for (int round = 0; round < 200; ++round) {
        Region region;
        const int corners = 3 + round % 5;
        for (int i = 0; i < corners; ++i)
            region.outline.push_back({double(whole(random)), double(whole(random))});
        const RegionIndex index = indexOf(region);
        for (int x = -1; x <= 14; ++x)
            for (int y = -1; y <= 14; ++y) {
                const Point2 p{x / 2.0, y / 2.0};
                ASSERT_EQ(index.locate(p), region.locate(p));
            }
    }
    // Of no width.
    EXPECT_EQ(indexOf({{{0, 0}, {5, 0}, {2, 0}}, {}}).locate({1, 0}), Side::Boundary);
}

TEST(RegionIndex, DoesWithoutAKnownPointOnTheBoundary) {
    Region region{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
    const Grid cells = indexOf(region).cells();
    const Point2 center = cells.center(cells.cell(cells.columns / 2, cells.rows / 2));
    region.holes = {{center, center + Vec2{-0.5, 0.5}, center + Vec2{0.5, 0.5}}};
    const RegionIndex index = indexOf(region);
    ASSERT_EQ(index.cells(), cells) << "few more edges do not change them";
    for (int x = -10; x <= 10; ++x)
        for (int y = -10; y <= 10; ++y) {
            const Point2 p = center + Vec2{0.004 * x, 0.004 * y};
            EXPECT_EQ(index.locate(p), region.locate(p));
        }
}

TEST(PolygonIndex, DeepIsFartherFromTheEdgeThanTold) {
    const std::vector<Polygon> squares{square(0, 0), square(1, 0), square(5, 5)};
    const PolygonIndex index(squares);
    EXPECT_TRUE(index.containsWithMargin({0.5, 0.5}, 1e-4));
    EXPECT_TRUE(index.containsWithMargin({5.2, 5.7}, 1e-4));
    EXPECT_FALSE(index.containsWithMargin({0.5, 1e-5}, 1e-4));
    EXPECT_FALSE(index.containsWithMargin({1, 0.5}, 1e-4)) << "between two that touch";
    EXPECT_FALSE(index.containsWithMargin({3, 3}, 1e-4));
    EXPECT_FALSE(PolygonIndex({}).containsWithMargin({0, 0}, 1e-4));
}

TEST(ContainsWithMargin, AgreesWithTheIndex) {
    const std::vector<Polygon> squares = {square(0, 0), square(1, 0), square(5, 5.5)};
    const PolygonIndex index(squares);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-0.5, 7);
    for (int i = 0; i < 3000; ++i) {
        const Point2 p{place(random), place(random)};
        const bool is_in_one = std::any_of(
            squares.begin(), squares.end(),
            [p](const Polygon& polygon) { return containsWithMargin(polygon, p, 0.01); });
        EXPECT_EQ(is_in_one, index.containsWithMargin(p, 0.01)) << p.x << ' ' << p.y;
    }
}

TEST(ContainsWithMargin, RejectsPointsNearTheEdge) {
    constexpr double kMargin = 1e-6;
    const Polygon unit = square(0, 0);
    EXPECT_TRUE(containsWithMargin(unit, {0.5, 0.5}, kMargin));
    EXPECT_TRUE(containsWithMargin(unit, {0.5, 2 * kMargin}, kMargin));
    EXPECT_FALSE(containsWithMargin(unit, {0.5, kMargin / 2}, kMargin));
    EXPECT_FALSE(containsWithMargin(unit, {1 - kMargin / 2, 0.5}, kMargin));
    EXPECT_FALSE(containsWithMargin(unit, {0, 0.5}, kMargin));
    EXPECT_FALSE(containsWithMargin(unit, {2, 0.5}, kMargin)) << "far from the edges, but outside";
    EXPECT_FALSE(containsWithMargin({{0, 0}, {1, 0}}, {0.5, 0}, kMargin));
    EXPECT_FALSE(containsWithMargin({}, {0, 0}, kMargin));
}

TEST(PolygonIndex, HoldsTheirEdges) {
    const std::vector<Polygon> squares{square(0, 0), square(1, 0), square(5, 5)};
    const PolygonIndex index(squares);
    EXPECT_EQ(index.holder({0.5, 0.5}), 0U);
    EXPECT_EQ(index.holder({1, 0.5}), 0U) << "the first of two";
    EXPECT_EQ(index.holder({6, 6}), 2U);
    EXPECT_EQ(index.holder({3, 3}), std::nullopt);
}

TEST(PolygonIndex, TouchesFromBothSides) {
    const std::vector<Polygon> squares{square(0, 0), square(1, 0), square(5, 5)};
    const PolygonIndex index(squares);
    EXPECT_EQ(index.touching({1, 0.5}, 1e-4).size(), 2U);
    EXPECT_EQ(index.touching({-5e-5, 0.5}, 1e-4).size(), 1U);
    EXPECT_EQ(index.touching({5e-5, 0.5}, 1e-4).size(), 1U);
    EXPECT_TRUE(index.touching({0.5, 0.5}, 1e-4).empty());
    EXPECT_TRUE(index.touching({-2e-4, 0.5}, 1e-4).empty());
}

}  // namespace point_location_test
}  // namespace ispace
