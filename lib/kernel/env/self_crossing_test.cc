// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <chrono>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "env/walls.h"
#include "geom/pose.h"
#include "geom/predicates.h"

namespace ispace {
namespace self_crossing_test {

/// Compares all pairs of edges.
bool anyCross(const Polygon& polygon) {
    std::vector<Segment2> edges;
    forEachEdge(polygon, [&](const Segment2& edge) { edges.push_back(edge); });
    const auto parts = [](const Segment2& line, const Segment2& other) {
        const Turn a = orientation(line.a, line.b, other.a);
        const Turn b = orientation(line.a, line.b, other.b);
        return a != Turn::Straight && b != Turn::Straight && a != b;
    };
    for (const Segment2& s : edges)
        for (const Segment2& t : edges)
            if (parts(s, t) && parts(t, s)) return true;
    return false;
}

/// Teeth that reach over the whole width, one above the other.
Polygon comb(int teeth, double turn) {
    const Pose2 pose{{}, Angle::degrees(turn)};
    Polygon out{pose * Point2{0, 0}};
    for (int i = 0; i < teeth; ++i) {
        out.push_back(pose * Point2{9, 7.0 * i / teeth});
        out.push_back(pose * Point2{1, 7.0 * (i + 0.5) / teeth});
    }
    out.push_back(pose * Point2{0, 8});
    return out;
}

TEST(SelfCrossing, TouchesAndOverlapsAreNone) {
    EXPECT_FALSE(selfCrossing({}));
    EXPECT_FALSE(selfCrossing({{1, 1}, {1, 1}, {1, 1}}));
    EXPECT_FALSE(selfCrossing({{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}})) << "a corner on an edge";
    EXPECT_FALSE(selfCrossing({{0, 0}, {4, 0}, {2, 0}, {2, 3}})) << "an edge on another";
    EXPECT_FALSE(selfCrossing({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}})) << "two corners";
    EXPECT_FALSE(selfCrossing({{0, 0}, {0, 3}, {0, 1}, {0, 5}})) << "upright, without area";
}

TEST(SelfCrossing, IsFoundWhereEdgesCross) {
    EXPECT_EQ(selfCrossing({{0, 0}, {2, 2}, {2, 0}, {0, 2}}), (Point2{1, 1}));
    EXPECT_EQ(selfCrossing({{0, 1}, {4, 1}, {4, 3}, {2, 3}, {2, 0}}), (Point2{2, 1}))
        << "an upright edge";
    // Both edges through the crossing hide behind one that ends there.
    EXPECT_EQ(selfCrossing({{0, 0}, {4, 4}, {4, 0}, {0, 4}, {2, 2}}), (Point2{2, 2}));
}

TEST(SelfCrossing, IsFoundAsByAllPairs) {
    std::mt19937 engine(7);
    int crossing = 0, simple = 0;
    for (int round = 0; round < 20000; ++round) {
        const int corners = 3 + static_cast<int>(engine() % 8);
        const auto range = static_cast<unsigned>(2 + round % 7);
        Polygon polygon;
        for (int i = 0; i < corners; ++i)
            polygon.push_back({static_cast<double>(engine() % range) / 7,
                               static_cast<double>(engine() % range) / 7});
        const bool crosses = anyCross(polygon);
        ASSERT_EQ(selfCrossing(polygon).has_value(), crosses) << "round " << round;
        ++(crosses ? crossing : simple);
    }
    EXPECT_GT(crossing, 2000);
    EXPECT_GT(simple, 2000);
}

TEST(SelfCrossing, CombsOfAnyDirectionTakeNoSquareOfTheirTeeth) {
    const auto begin = std::chrono::steady_clock::now();
    for (const double turn : {0.0, 30.0, 90.0}) {
        Polygon polygon = comb(100'000, turn);
        EXPECT_FALSE(selfCrossing(polygon)) << turn;
        polygon.push_back(Pose2{{}, Angle::degrees(turn)} * Point2{5, 0.5});
        EXPECT_TRUE(selfCrossing(polygon)) << turn;
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30))
        << "it takes minutes";
}

}  // namespace self_crossing_test
}  // namespace ispace
