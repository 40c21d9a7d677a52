// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/predicates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/planar_map.h"
#include "support/test_curves.h"

namespace ispace {

namespace predicates_test {

TEST(Orientation, plainCases) {
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {1, 1}), Turn::Left);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {1, -1}), Turn::Right);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {5, 0}), Turn::Straight);
    EXPECT_EQ(orientation({1, 1}, {1, 1}, {2, 3}), Turn::Straight);
}

TEST(Orientation, isExactWhereDoublesAreNot) {
    // Neighbouring doubles about the line y = x; the plain determinant gets most of them wrong.
    const Point2 far{24, 24}, farther{12, 12};
    double x = 0.5;
    for (int i = 0; i < 64; ++i, x = std::nextafter(x, 1.0)) {
        double y = 0.5;
        for (int k = 0; k < 64; ++k, y = std::nextafter(y, 1.0)) {
            const Turn wanted = i == k ? Turn::Straight : (i < k ? Turn::Right : Turn::Left);
            EXPECT_EQ(orientation(far, farther, {x, y}), wanted) << i << " " << k;
        }
    }
}

TEST(Intersects, plainAndDegenerate) {
    const Segment2 s{{0, 0}, {4, 0}};
    EXPECT_TRUE(intersects(s, {{2, -1}, {2, 1}}));
    EXPECT_TRUE(intersects(s, {{2, 0}, {2, 1}})) << "T";
    EXPECT_TRUE(intersects(s, {{4, 0}, {5, 1}})) << "common end";
    EXPECT_TRUE(intersects(s, {{3, 0}, {6, 0}})) << "overlap";
    EXPECT_TRUE(intersects(s, {{1, 0}, {2, 0}})) << "contained";
    EXPECT_TRUE(intersects(s, {{4, 0}, {6, 0}})) << "collinear, common end";
    EXPECT_FALSE(intersects(s, {{4.1, 0}, {6, 0}})) << "collinear, apart";
    EXPECT_FALSE(intersects(s, {{0, 1}, {4, 1}})) << "parallel";
    EXPECT_FALSE(intersects(s, {{3, 3}, {5, -0.5}})) << "beyond the end";
    EXPECT_FALSE(intersects({{0, 0}, {4, 4}}, {{3, 2}, {4, 2}})) << "boxes overlap";
    EXPECT_TRUE(intersects(s, {{2, 0}, {2, 0}})) << "a point on it";
    EXPECT_FALSE(intersects(s, {{2, 1e-300}, {2, 1e-300}})) << "a point beside it";
    EXPECT_TRUE(intersects({{1, 1}, {1, 1}}, {{1, 1}, {1, 1}}));
    EXPECT_FALSE(intersects({{1, 1}, {1, 1}}, {{1, 2}, {1, 2}}));
}

TEST(Intersects, isSymmetricAndExactOnSmallIntegers) {
    std::mt19937_64 random(4);
    std::uniform_int_distribution<int> coordinate(-3, 3);
    const auto point = [&] {
        return Point2{double(coordinate(random)), double(coordinate(random))};
    };
    for (int i = 0; i < 20000; ++i) {
        const Segment2 s{point(), point()}, t{point(), point()};
        const bool met = intersects(s, t);
        EXPECT_EQ(met, intersects(t, s));
        EXPECT_EQ(met, intersects({s.b, s.a}, t));
        EXPECT_EQ(met, intersects({s.a, s.b}, {t.b, t.a}));
        // Small integers are exact in doubles: solve for the crossing.
        const Vec2 u = s.b - s.a, v = t.b - t.a;
        const double det = cross(u, v);
        if (det == 0) continue;
        const double along_s = cross(t.a - s.a, v), along_t = cross(t.a - s.a, u);
        const auto inside = [&](double a) {
            return det > 0 ? a >= 0 && a <= det : a <= 0 && a >= det;
        };
        EXPECT_EQ(met, inside(along_s) && inside(along_t));
    }
}

TEST(Distance, toClosedSegment) {
    const Segment2 s{{0, 0}, {4, 0}};
    EXPECT_EQ(distance(Point2{2, 3}, s), 3);
    EXPECT_EQ(distance(Point2{7, 4}, s), 5);
    EXPECT_EQ(distance(Point2{-3, -4}, s), 5);
    EXPECT_EQ(distance(Point2{1, 0}, s), 0);
    EXPECT_EQ(distance(Point2{3, 4}, {{0, 0}, {0, 0}}), 5);
    EXPECT_EQ(nearestPoint(s, {2, 3}), (Point2{2, 0}));
    EXPECT_EQ(nearestPoint(s, {-2, 3}), (Point2{0, 0}));
    EXPECT_EQ(nearestPoint(s, {9, 3}), (Point2{4, 0}));
}

}  // namespace predicates_test

namespace predicates_test {

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
    walls.push_back({{4, 2}, {4, 4}});  // bounds no face
    const Point2 known{2, 3}, behind{6, 3};
    EXPECT_FALSE(insideByParity(behind, known, walls));

    const auto faces = boundedFaces(weld(walls));
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_EQ(faces[0].locate(known), Side::Inside);
    EXPECT_EQ(faces[0].locate(behind), Side::Inside);
    // Past its end they agree again.
    EXPECT_TRUE(insideByParity({6, 5}, {2, 5}, walls));
}

}  // namespace predicates_test

}  // namespace ispace
