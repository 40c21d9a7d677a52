// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/path_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "support/test_layout.h"

namespace ispace {
namespace path_finder_test {

/// Two rooms of 4 m x 4 m, joined by a door 0.9 m wide at x = 4, y from 3 to 3.9.
constexpr const char* kRooms =
    "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\nfence id=a path=4,0;4,3\n"
    "fence id=b path=4,3.9;4,4\ninside at=1,1\n";

struct Floor {
    explicit Floor(const char* text)
        : scene(testing::scene(text, "")),
          obstacles(scene.environment, 0.3, nullptr),
          box(bounds(scene.environment.indoor())) {}
    Scene scene;
    Obstacles obstacles;
    Box2 box;
};

double lengthOf(Point2 from, const std::vector<Point2>& way) {
    double sum = 0;
    for (const Point2 p : way) {
        sum += distance(from, p);
        from = p;
    }
    return sum;
}

TEST(PathFinder, GoesThroughTheDoor) {
    const Floor floor(kRooms);
    const PathFinder finder(floor.obstacles, floor.box, 0.3);
    const auto field = finder.waysFrom({1, 1});
    const std::vector<Point2> way = finder.way(field, {7, 1});
    ASSERT_FALSE(way.empty());
    EXPECT_EQ(way.back(), (Point2{7, 1}));
    // The shortest way of a point passes the end of the wall; a circle goes around it.
    const double straight = 2 * std::hypot(3, 2);
    EXPECT_GT(lengthOf({1, 1}, way), straight);
    EXPECT_LT(lengthOf({1, 1}, way), straight + 0.6);
    Point2 at{1, 1};
    for (const Point2 p : way) {
        EXPECT_TRUE(finder.isStraight(at, p));
        at = p;
    }
    EXPECT_LT(lengthOf({1, 1}, way), *finder.length(field, {7, 1}) + 0.1);
}

TEST(PathFinder, GoesAroundAHoleAsAroundAFence) {
    const std::string room = "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\n";
    const Floor open((room + "inside at=1,1\n").c_str());
    const Floor fenced(
        (room + "fence id=h path=3,1;5,1;4.5,3;3,2.5 closed=yes\ninside at=1,1\n").c_str());
    const Polygon hole = {{3, 1}, {5, 1}, {4.5, 3}, {3, 2.5}};
    const PathFinder finder(open.obstacles, open.box, 0.3, {hole});
    const PathFinder oracle(fenced.obstacles, fenced.box, 0.3);
    const auto field = finder.waysFrom({1, 2});
    for (const Point2 to : {Point2{7, 2}, Point2{7, 0.5}, Point2{4, 3.5}, Point2{5.4, 2}})
        EXPECT_EQ(finder.way(field, to), oracle.way(oracle.waysFrom({1, 2}), to)) << to.x;
    EXPECT_FALSE(finder.isFree({4, 2}));
    EXPECT_FALSE(finder.isStraight({1, 2}, {7, 2}));
    EXPECT_TRUE(finder.isStraight({1, 0.5}, {7, 0.5}));
}

TEST(PathFinder, KeepsFromAHoleOfManyCornersByThePlainFormula) {
    const Floor floor("fence id=f path=0,0;20,0;20,20;0,20 closed=yes\ninside at=1,1\n");
    constexpr double kRadius = 0.3, kReach = kRadius + PathFinder::kMargin;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> any(0, 1);
    for (const int corners : {3, 40, 3000}) {
        Polygon star;
        for (int i = 0; i < corners; ++i) {
            const Angle angle = Angle::degrees(360.0 * i / corners);
            star.push_back(Point2{10, 9} + (2 + 5 * any(random)) * Vec2{cos(angle), sin(angle)});
        }
        const Polygon pit = {{1, 18}, {3, 18}, {3, 19}, {1, 19}};
        const PathFinder finder(floor.obstacles, floor.box, kRadius, {star, pit});
        const auto keeps_off = [&](const Polygon& hole, const Segment2& way) {
            bool is_off = locate(hole, way.a) != Side::Inside;
            forEachEdge(hole, [&](const Segment2& edge) {
                is_off = is_off && distance(way, edge) >= kReach;
            });
            return is_off;
        };
        int free = 0;
        for (int i = 0; i < 600; ++i) {
            // Many on centres of cells, whose distances tie.
            const double step = i % 2 == 0 ? 0.05 : 1e-9;
            const auto place = [&] { return 1 + step * std::round((18 * any(random)) / step); };
            const Point2 from{place(), place()}, to{place(), place()};
            const auto expected = [&](const Segment2& way) {
                return keeps_off(star, way) && keeps_off(pit, way);
            };
            EXPECT_EQ(finder.isFree(from), expected({from, from})) << from.x << ' ' << from.y;
            EXPECT_EQ(finder.isStraight(from, to), expected({from, to})) << from.x << ' ' << to.x;
            free += finder.isStraight(from, to) ? 1 : 0;
        }
        EXPECT_GT(free, 30);
        EXPECT_LT(free, 500);
    }
}

TEST(PathFinder, FindsNoneOverAHoleAcrossTheRoom) {
    const Floor floor("fence id=f path=0,0;8,0;8,4;0,4 closed=yes\ninside at=1,1\n");
    for (const double end : {4.0, 3.2}) {  // 0.7 m are needed beside it
        const Polygon hole = {{3, 0}, {5, 0}, {5, end}, {3, end}};
        const PathFinder finder(floor.obstacles, floor.box, 0.3, {hole});
        EXPECT_EQ(finder.wayBetween({1, 1}, {7, 1}).empty(), end == 4.0);
    }
}

TEST(PathFinder, FindsNoneThroughADoorThatIsTooNarrow) {
    const Floor floor(kRooms);
    const PathFinder finder(floor.obstacles, floor.box, 0.45);
    const auto field = finder.waysFrom({1, 1});
    EXPECT_FALSE(finder.length(field, {7, 1}));
    EXPECT_TRUE(finder.way(field, {7, 1}).empty());
    EXPECT_TRUE(finder.length(field, {1, 3}));
}

TEST(PathFinder, FindsTheSameWayTowardsAGoal) {
    const Floor floor(kRooms);
    const PathFinder finder(floor.obstacles, floor.box, 0.3);
    for (const Point2 from : {Point2{1, 1}, Point2{3.5, 3.5}, Point2{0.4, 2}})
        for (const Point2 to : {Point2{7, 1}, Point2{5, 3.6}, Point2{1, 3}}) {
            const double all = lengthOf(from, finder.way(finder.waysFrom(from), to));
            EXPECT_NEAR(lengthOf(from, finder.wayBetween(from, to)), all, 0.2);
        }
    EXPECT_TRUE(finder.wayBetween({1, 1}, {40, 1}).empty());
}

TEST(PathFinder, IsStraightInTheOpen) {
    const Floor floor(kRooms);
    const PathFinder finder(floor.obstacles, floor.box, 0.3);
    EXPECT_EQ(finder.way(finder.waysFrom({1, 1}), {3, 2.2}), (std::vector<Point2>{{3, 2.2}}));
}

TEST(PathFinder, KnowsNoWayFromWithinWallsOrBeyondTheGrid) {
    const Floor floor(kRooms);
    const PathFinder finder(floor.obstacles, floor.box, 0.3);
    EXPECT_TRUE(finder.way(finder.waysFrom({1e9, 0}), {1, 1}).empty());
    EXPECT_TRUE(finder.way(finder.waysFrom({1, 1}), {-1e300, 1e300}).empty());
    EXPECT_TRUE(finder.way(finder.waysFrom({1, 1}), {40, 1}).empty());
    // To where it stands.
    EXPECT_EQ(finder.way(finder.waysFrom({1, 1}), {1, 1}), (std::vector<Point2>{{1, 1}}));
}

/// A search that stops at its goal finds the ways of one that visits all cells, also round others.
TEST(PathFinder, ApproachesTheNearestSuitablePoint) {
    const Floor floor(kRooms);
    const PathFinder open(floor.obstacles, floor.box, 0.3);
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> across(0.2, 7.8), along(0.2, 3.8);
    std::size_t reached = 0, saved = 0;
    for (int i = 0; i < 100; ++i) {
        std::vector<PathFinder::Spot> spots;
        for (int k = 0; k < i % 12; ++k) spots.push_back({{across(random), along(random)}, 0.25});
        const PathFinder finder = open.around(spots);
        const Point2 from{across(random), along(random)}, to{across(random), along(random)};
        const Box2 box{to - Vec2{0.5, 0.5}, to + Vec2{0.5, 0.5}};
        const auto is_suitable = [&](Point2 p) { return distance(p, to) < 0.5; };
        const PathFinder::Approach found = finder.approach(from, to, box, is_suitable);
        const PathFinder::Field all = finder.waysFrom(from);
        std::optional<Point2> best;
        for (int row = 0; row < 40; ++row)
            for (int column = 0; column < 80; ++column) {
                const Point2 p{0.1 * column + 0.05, 0.1 * row + 0.05};
                if (!is_suitable(p) || !finder.isFree(p) || !finder.length(all, p)) continue;
                if (!best || distance(p, to) < distance(*best, to) - 1e-9) best = p;
            }
        ASSERT_EQ(found.goal.has_value(), best.has_value()) << i;
        for (const PathFinder::Spot& spot : spots)
            EXPECT_FALSE(finder.isFree(spot.center + Vec2{0.3, 0})) << i;
        if (!best) continue;
        EXPECT_NEAR(distance(*found.goal, to), distance(*best, to), 1e-6) << i;
        EXPECT_EQ(finder.way(found.field, *found.goal), finder.way(all, *found.goal)) << i;
        EXPECT_LE(found.field.expanded, all.expanded);
        saved += all.expanded - found.field.expanded;
        ++reached;
    }
    EXPECT_GT(reached, 30U);
    EXPECT_GT(saved, 10000U);
}

}  // namespace path_finder_test
}  // namespace ispace
