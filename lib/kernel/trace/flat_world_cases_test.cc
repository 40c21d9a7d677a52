// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "support/test_scans.h"
#include "trace/flat_world.h"

namespace ispace {

using namespace testing;

namespace flat_world_cases_test {

/// Along a heading, as one ray and as one of a scan.
double range(const FlatWorld& world, Point2 origin, Angle heading, double max_range = kInfinity) {
    const float found = cast(world, origin, scan(heading, {}, 1), max_range).ranges[0];
    const Directions turn = scan(heading, Angle::degrees(30), 12);
    EXPECT_EQ(cast(world, origin, turn, max_range).ranges[0], found);
    return static_cast<double>(found);
}

/// Cases turned about, and far from the origin of coordinates.
class FlatWorldCases : public ::testing::TestWithParam<Pose2> {
  protected:
    [[nodiscard]] static FlatWorld world(Lines lines) {
        for (Segment2& line : lines) line = {GetParam() * line.a, GetParam() * line.b};
        return FlatWorld(lines);
    }
    static void expectRange(const FlatWorld& world, Point2 from, double heading, double expected,
                            double max_range = kInfinity) {
        const Angle way = GetParam().heading + Angle::degrees(heading);
        const double found = range(world, GetParam() * from, way, max_range);
        if (std::isinf(expected)) {
            EXPECT_EQ(found, expected) << heading << " degrees";
        } else {
            EXPECT_NEAR(found, expected, 1e-6) << heading << " degrees";
        }
    }
};

INSTANTIATE_TEST_SUITE_P(MoverPoses, FlatWorldCases,
                         ::testing::Values(Pose2{}, Pose2{{1e5, -2e5}, {}},
                                           Pose2{{3.3, -1.7}, Angle::degrees(17)},
                                           Pose2{{3.3, -1.7}, Angle::degrees(45)},
                                           Pose2{{0, 0}, Angle::degrees(90)},
                                           Pose2{{-100, 70}, Angle::degrees(180)},
                                           Pose2{{-1e4, 1e4}, Angle::degrees(200.1)}));

Lines rectangle(Point2 low, Point2 high) {
    Lines lines;
    forEachEdge(Polygon{low, {high.x, low.y}, high, {low.x, high.y}},
                [&](const Segment2& edge) { lines.push_back(edge); });
    return lines;
}

TEST_P(FlatWorldCases, Room) {
    const FlatWorld room = world(rectangle({0, 0}, {8, 6}));
    expectRange(room, {3, 2}, 0, 5);
    expectRange(room, {3, 2}, 90, 4);
    expectRange(room, {3, 2}, 180, 3);
    expectRange(room, {3, 2}, -90, 2);
    expectRange(room, {2, 2}, -135, 2 * std::sqrt(2.0));
    expectRange(room, {4, 3}, Angle::radians(std::atan2(3, 4)).degrees(), 5);
    expectRange(room, {-1, 3}, 0, 1);
    expectRange(room, {-1, 3}, 180, kInfinity);
}

TEST_P(FlatWorldCases, FromAWallItLooksOutOnBothSidesAndAlong) {
    Lines lines = rectangle({0, 0}, {8, 6});
    // In two pieces: the second is not in contact but continues the first.
    lines[0] = {{0, 0}, {5, 0}};
    lines.push_back({{8, 0}, {5, 0}});
    const FlatWorld room = world(lines);
    for (const double y : {0.0, 9e-5, -9e-5}) {
        expectRange(room, {2, y}, 90, 6 - y);
        expectRange(room, {2, y}, -90, kInfinity);
        expectRange(room, {2, y}, y > 0 ? -0.001 : 0.001, y > 0 ? kInfinity : 6 + 1e-9);
    }
    expectRange(room, {2, 0}, 0, 6);
    expectRange(room, {2, 0}, 180, 2);
    expectRange(room, {2, 2e-4}, -90, 2e-4);
    expectRange(room, {2, -2e-4}, 90, 2e-4);
    expectRange(room, {0, 0}, 45, 6 * std::sqrt(2.0));
    expectRange(room, {0, 0}, 0, 8);
    expectRange(room, {0, 0}, 90, 6);
    expectRange(room, {0, 0}, 225, kInfinity);
    // In line with a wall but not in contact with it: beams that cross the line meet it.
    expectRange(room, {-1, -5e-5}, Angle::radians(1e-5).degrees(), 5);
    expectRange(room, {-1, -5e-5}, Angle::radians(-1e-5).degrees(), kInfinity);
}

TEST_P(FlatWorldCases, LineSeenFromItsEdgeStopsNothing) {
    Lines lines = rectangle({0, 0}, {8, 6});
    lines.push_back({{3, 2}, {5, 2}});
    expectRange(world(lines), {1, 2}, 0, 7);
    expectRange(world(lines), {1, 2}, 0.001, 7 / std::cos(0.001 * std::numbers::pi / 180));
    expectRange(world(lines), {3, 1}, 90, 1);
    expectRange(world(lines), {1, 1.9999}, Angle::radians(3e-5).degrees(), 0.0001 / 3e-5);
    lines.push_back({{3, 1}, {3, 3}});
    expectRange(world(lines), {1, 2}, 0, 2);
}

TEST_P(FlatWorldCases, MaximumRangeIsInclusive) {
    const FlatWorld room = world(rectangle({0, 0}, {8, 6}));
    expectRange(room, {3, 2}, 0, 5, 5);
    expectRange(room, {3, 2}, 0, kInfinity, 4.9999);
    expectRange(room, {3, 2}, 180, kInfinity, 2.9);
    expectRange(room, {3.905, 2}, 0, 4.095, 4.095);
    expectRange(room, {3, 2}, 0, kInfinity, 0);
    expectRange(room, {3, 2}, 0, kInfinity, -1);
}

TEST(FlatWorld, CosineOfTheNearestOrTheLarger) {
    const FlatWorld room(rectangle({0, 0}, {8, 6}));
    const Directions beams = scan({}, Angle::degrees(30), 12);
    const Seen seen = cast(room, {4, 3}, beams);
    EXPECT_FLOAT_EQ(seen.cosines[0], 1);
    EXPECT_FLOAT_EQ(seen.cosines[1], static_cast<float>(std::cos(std::numbers::pi / 6)));
    EXPECT_FLOAT_EQ(seen.cosines[2], static_cast<float>(std::cos(std::numbers::pi / 6)));
    EXPECT_FLOAT_EQ(seen.cosines[3], 1);
    EXPECT_EQ(cast(room, {4, 3}, beams, 2).cosines, std::vector<float>(12, 1.0F));
    // A corner square ahead, where three lines end at once.
    const Lines three = {{{4, 0}, {5, 1}}, {{4, 0}, {4, -1}}, {{4, 0}, {7, 1}}};
    for (const std::size_t first : {0U, 1U, 2U}) {
        const Lines turned = {three[first], three[(first + 1) % 3], three[(first + 2) % 3]};
        const Seen corner = cast(FlatWorld(turned), {0, 0}, beams);
        EXPECT_EQ(corner.ranges[0], 4);
        EXPECT_EQ(corner.cosines[0], 1);
        EXPECT_EQ(castApart(FlatWorld(turned), {0, 0}, beams), corner);
    }
}

TEST(FlatWorld, AFullTurnMeetsWhatBeginsWhereItEnds) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> turn(-180, 180);
    for (int i = 0; i < 2000; ++i) {
        const Angle first = Angle::degrees(i % 4 == 0 ? 7.5 * i : turn(random));
        const int sign = i % 2 == 0 ? 1 : -1;
        const Directions beams = scan(first, Angle::degrees(sign), 361);
        // A line to the left or to the right of the cut.
        const Vec2 way{beams.x[0], beams.y[0]};
        const Vec2 aside = perpendicular(i % 3 == 0 ? -way : way);
        const Point2 end = Point2{} + 2 * way;
        const Seen seen = cast(FlatWorld({{Segment2{end, end + aside}}}), {0, 0}, beams);
        EXPECT_FLOAT_EQ(seen.ranges.front(), 2);
        EXPECT_FLOAT_EQ(seen.ranges.back(), 2);
        EXPECT_EQ(std::count_if(seen.ranges.begin(), seen.ranges.end(),
                                [](float range) { return std::isfinite(range); }),
                  28);
    }
}

TEST(FlatWorld, ALineAlongTheCutOfAFanStopsNothingAhead) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> turn(-180, 180), exponent(-8.9, -5);
    for (int i = 0; i < 2000; ++i) {
        // Seen almost from its edge, straight behind the middle of a full turn.
        const Pose2 pose{{0.3, -0.7}, Angle::degrees(i % 4 == 0 ? 7.5 * i : turn(random))};
        const double height = (i % 2 == 0 ? 1 : -1) * std::pow(10, exponent(random));
        const FlatWorld world(
            {{Segment2{pose * Point2{-70, height}, pose * Point2{-119, height}}}});
        const Directions beams =
            scan(pose.heading - Angle::degrees(180), Angle::degrees(4.5), i % 3 == 0 ? 80 : 81);
        const Seen seen = cast(world, pose.position, beams);
        EXPECT_EQ(castApart(world, pose.position, beams), seen) << i;
        EXPECT_TRUE(std::isinf(seen.ranges[40])) << i;
    }
}

TEST(FlatWorld, FansAmongLinesBeyondFloat32) {
    // Fans have room for a part of float64's range only; what is farther out they meet all the
    // same.
    const Directions beams = scan(Angle::degrees(-45), Angle::degrees(0.5), 181);
    for (const double far : {1e3, 1e14, 1e16, 1e30, 1e50}) {
        const FlatWorld world(Lines{{{5, -1}, {5, far}}, {{far, -far}, {far, far}}});
        const Seen seen = cast(world, {0, 0}, beams);
        EXPECT_EQ(castApart(world, {0, 0}, beams), seen) << far;
        EXPECT_EQ(seen.ranges[90], 5) << far;
    }
    const FlatWorld here(Lines{{{1e17 + 1024, -1e3}, {1e17 + 1024, 1e3}}});
    EXPECT_EQ(cast(here, {1e17, 0}, beams).ranges[90], 1024);
}

TEST(FlatWorld, NothingStopsNothing) {
    for (const Lines& lines : {Lines{}, Lines{{{1, 1}, {1, 1}}}, Lines(20, {{2, 0}, {2, 0}})}) {
        const FlatWorld world(lines);
        const Directions beams = scan({}, Angle::degrees(0.5), 720);
        const Seen seen = cast(world, {0, 0}, beams);
        EXPECT_EQ(seen.ranges, std::vector<float>(720, std::numeric_limits<float>::infinity()));
        EXPECT_EQ(seen.cosines, std::vector<float>(720, 1.0F));
        EXPECT_EQ(castApart(world, {0, 0}, beams), seen);
        cast(world, {0, 0}, Directions{});
        cast(world, {0, 0}, scan({}, Angle::degrees(1), 0));
    }
}

TEST(FlatWorld, LinesThatPileUpMakeNoDeepTree) {
    // Each a fraction as far and as large as the last, and many at one place.
    Lines lines;
    for (int i = 0; i < 900; ++i) {
        const double size = std::pow(0.7, i);
        lines.push_back({{size, -size}, {size, size}});
        lines.push_back({{5, 1}, {5, -1}});
    }
    const FlatWorld world(lines);
    EXPECT_EQ(range(world, {-1, 0}, {}), 1);
    EXPECT_EQ(range(world, {6, 0}, Angle::degrees(180)), 1);
    EXPECT_EQ(range(world, {2, 0}, {}), 3);
    EXPECT_EQ(range(world, {2, 0}, Angle::degrees(180)), 1);
}

TEST(FlatWorld, SeveralThreadsShareAWorld) {
    const Lines lines = office(4, 4);
    FlatWorld first(lines);
    const FlatWorld world = std::move(first);
    const Directions beams = scan({}, Angle::degrees(0.1), 3600);
    std::vector<Seen> seen(4);
    std::vector<std::thread> threads;
    threads.reserve(seen.size());
    for (Seen& mine : seen)
        threads.emplace_back([&] { mine = cast(world, {6.1, 6.2}, beams, 20); });
    for (std::thread& thread : threads) thread.join();
    for (const Seen& mine : seen) EXPECT_EQ(mine, seen.front());
    EXPECT_EQ(cast(FlatWorld(lines), {6.1, 6.2}, beams, 20), seen.front());
}

}  // namespace flat_world_cases_test

}  // namespace ispace
