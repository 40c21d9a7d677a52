// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cover/test_map.h"
#include "geom/predicates.h"

namespace ispace {
namespace {

const Box2 kBox{{0, 0}, {4, 2}};

TEST(MapCurves, ClipKeepsWhatIsInsideAsItIs) {
    const Polygon inside = {{1, 1}, {2, 1}, {1.5, 1.5}};
    EXPECT_EQ(clipped(inside, kBox), inside);
    EXPECT_TRUE(clipped(Polygon{}, kBox).empty());
    EXPECT_TRUE(clipped(Polygon{{5, 0}, {6, 0}, {6, 1}}, kBox).empty());
}

TEST(MapCurves, ClipCutsAtTheSidesWhateverTheTurn) {
    const Polygon square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(square, kBox)), 1);
    EXPECT_DOUBLE_EQ(signedArea(clipped(Polygon(square.rbegin(), square.rend()), kBox)), -1);
    const Polygon around = {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(around, kBox)), 8);
    // A comb that leaves the box and comes back twice.
    const Polygon comb = {{1, 1}, {1, 5},   {2, 5},   {2, 1}, {3, 1},
                          {3, 5}, {3.5, 5}, {3.5, 0}, {1, 0}};
    EXPECT_DOUBLE_EQ(signedArea(clipped(comb, kBox)), -(2 + 1 + 1));
}

TEST(MapCurves, ClipOfRandomTrianglesHoldsTheSamePlaces) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-4, 8);
    for (int round = 0; round < 300; ++round) {
        Polygon triangle(3);
        for (Point2& p : triangle) p = {place(random), place(random)};
        const Polygon part = clipped(triangle, kBox);
        for (const Point2& p : part) {
            ASSERT_GE(p.x, 0);
            ASSERT_LE(p.x, 4);
            ASSERT_GE(p.y, 0);
            ASSERT_LE(p.y, 2);
        }
        for (int k = 0; k < 20; ++k) {
            const Point2 p{place(random) / 2 + 1, place(random) / 4};
            const bool in_box = p.x > 0 && p.x < 4 && p.y > 0 && p.y < 2;
            const bool wanted = in_box && locate(triangle, p) == Side::Inside;
            ASSERT_EQ(!part.empty() && locate(part, p) == Side::Inside, wanted) << round;
        }
    }
}

TEST(MapCurves, SegmentsAreCutOrDropped) {
    EXPECT_EQ(clipped(Segment2{{-1, 1}, {9, 1}}, kBox), (Segment2{{0, 1}, {4, 1}}));
    EXPECT_EQ(clipped(Segment2{{1, 1}, {1, 9}}, kBox), (Segment2{{1, 1}, {1, 2}}));
    EXPECT_EQ(clipped(Segment2{{1, 1}, {2, 1}}, kBox), (Segment2{{1, 1}, {2, 1}}));
    EXPECT_FALSE(clipped(Segment2{{-1, 3}, {9, 3}}, kBox));
    EXPECT_FALSE(clipped(Segment2{{-2, 1}, {1, 4}}, kBox));
    const auto far = clipped(Segment2{{1, 1}, {1 + 3e9, 1 + 1e9}}, kBox);  // keeps its direction
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->b.x, 4, 1e-6);
    EXPECT_NEAR(far->b.y, 2, 1e-6);
}

TEST(MapCurves, WhatIsFarOffThePlanIsCutBeforeItIsDrawn) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const Coverage coverage = coverageOf(scene);
    const MapOptions options;
    const MapPicture map{scene, coverage, options, nullptr, 10, {100, {}, {}}};
    // A cone from the room to far outside: its sides keep their directions.
    const std::vector<Polygon> cone = {{{0, 0}, {3e9, 1e9}, {1e9, 3e9}}};
    const std::vector<Polygon> drawn = drawable(map, cone);
    ASSERT_EQ(drawn.size(), 1U);
    EXPECT_LT(bounds(drawn[0]).high.x, 5);
    EXPECT_EQ(locate(drawn[0], {3, 1.01}), Side::Inside);
    EXPECT_EQ(locate(drawn[0], {3, 0.99}), Side::Outside);
    EXPECT_TRUE(drawable(map, std::vector<Polygon>{{{9, 9}, {10, 9}, {10, 10}}}).empty());
}

TEST(MapCurves, ThinnedLinesStayNear) {
    std::mt19937_64 random(8);
    std::normal_distribution<double> step(0, 1);
    for (const double tolerance : {1.0, 3.0}) {
        std::vector<Point2> line = {{0, 0}};
        for (int i = 0; i < 500; ++i)
            line.push_back({line.back().x + 1 + 0.1 * step(random), line.back().y + step(random)});
        const std::vector<Point2> thin = thinned(line, tolerance);
        EXPECT_LT(thin.size(), line.size() / 2);
        EXPECT_EQ(thin.front(), line.front());
        EXPECT_EQ(thin.back(), line.back());
        for (const Point2& p : line) {
            double nearest = 1e9;
            for (std::size_t i = 1; i < thin.size(); ++i)
                nearest = std::min(nearest, distance(p, Segment2{thin[i - 1], thin[i]}));
            ASSERT_LE(nearest, tolerance);
        }
    }
    EXPECT_EQ(thinned({{0, 0}, {1, 0}, {2, 0}}, 0.1), (std::vector<Point2>{{0, 0}, {2, 0}}));
}

}  // namespace
}  // namespace ispace
