// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/parity.h"

#include <gtest/gtest.h>

#include "geom/planar_map.h"
#include "geom/test_curves.h"

namespace ispace {
namespace {

TEST(Parity, boxRoom) {
    const auto walls = test::edgesOf(test::box(0, 0, 8, 6));
    EXPECT_TRUE(insideByParity({1, 1}, {4, 3}, walls));
    EXPECT_FALSE(insideByParity({9, 1}, {4, 3}, walls));
    EXPECT_TRUE(insideByParity({4, 3}, {4, 3}, walls));
    // Through a corner, the two walls there are crossed once together …
    EXPECT_FALSE(insideByParity({-1, -1}, {3, 3}, walls));
    EXPECT_FALSE(insideByParity({9, 7}, {7, 5}, walls));
    // … and along a wall that the line does not end in.
    const auto l_room = test::edgesOf({{0, 0}, {8, 0}, {8, 3}, {4, 3}, {4, 6}, {0, 6}});
    EXPECT_TRUE(insideByParity({2, 3}, {1, 3}, l_room));
    EXPECT_FALSE(insideByParity({9, 3}, {1, 3}, l_room));
}

TEST(Parity, equalsTheExactTestOnSimpleCurves) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> coordinate(-10, 10);
    for (int round = 0; round < 200; ++round) {
        const Polygon curve = test::star(random, 3 + round % 60, 10);
        const auto walls = test::edgesOf(curve);
        for (int i = 0; i < 50; ++i) {
            const Point2 p{coordinate(random), coordinate(random)};
            const Side side = locate(curve, p);
            if (side == Side::Boundary) continue;
            EXPECT_EQ(insideByParity(p, {0, 0}, walls), side == Side::Inside);
        }
    }
}

TEST(Parity, equalsTheExactTestThroughVerticesAndAlongWalls) {
    // Pixel maps: their curves are simple but for single points where they touch; lines between
    // centres of pixels run through many vertices.
    std::mt19937_64 random(6);
    for (int round = 0; round < 30; ++round) {
        const test::PixelMap map(random, 8, 8, 0.6);
        auto walls = map.boundary();
        for (auto& [a, b] : walls) a = {2 * a.x, 2 * a.y}, b = {2 * b.x, 2 * b.y};
        for (int known = 0; known < 64; ++known) {
            if (!map.at(known % 8, known / 8)) continue;
            const Point2 inside{2.0 * (known % 8) + 1, 2.0 * (known / 8) + 1};
            for (int y = -1; y <= 8; ++y) {
                for (int x = -1; x <= 8; ++x)
                    EXPECT_EQ(insideByParity({2.0 * x + 1, 2.0 * y + 1}, inside, walls),
                              map.at(x, y));
            }
        }
    }
}

TEST(Parity, errsBehindAFreeStandingWallWhereTheExactTestDoesNot) {
    auto walls = test::edgesOf(test::box(0, 0, 8, 6));
    walls.push_back({{4, 2}, {4, 4}});  // bounds nothing
    const Point2 known{2, 3}, behind{6, 3};
    EXPECT_FALSE(insideByParity(behind, known, walls));

    const auto faces = boundedFaces(weld(walls));
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_EQ(faces[0].locate(known), Side::Inside);
    EXPECT_EQ(faces[0].locate(behind), Side::Inside);
    // Past its end they agree again.
    EXPECT_TRUE(insideByParity({6, 5}, {2, 5}, walls));
}

}  // namespace
}  // namespace ispace
