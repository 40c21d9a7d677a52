// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geom/pose.h"
#include "trace/test_fans.h"

namespace ispace {

using namespace testing;

namespace {

/// All ways in which a ray may be cast; they agree.
float rangeOf(const FlatWorld& world, Point2 origin, Vec2 way) {
    Directions directions;
    directions.resize(20);
    for (std::size_t i = 0; i < 20; ++i)
        directions.set(i, {way.x / length(way), way.y / length(way), 0});
    const Seen seen = cast(world, origin, directions);
    EXPECT_EQ(castApart(world, origin, directions), seen);
    for (const float range : seen.ranges) EXPECT_EQ(range, seen.ranges.front());
    const Vec3 first = directions[0];
    directions.resize(1);
    EXPECT_EQ(cast(world, origin, directions).ranges.front(), seen.ranges.front());
    directions.resize(5);
    for (std::size_t i = 0; i < 5; ++i) directions.set(i, first);
    directions.arc = Directions::Arc{directionOf(way.x, way.y), Angle::radians(1e-9)};
    EXPECT_EQ(cast(world, origin, directions).ranges[2], seen.ranges.front());
    return seen.ranges.front();
}

/// A wall from 5 m to 6 m ahead, seen almost from its edge, and one across at 9 m.
TEST(FlatLine, ARayPastAnEndMeetsThatEndOrPasses) {
    std::mt19937_64 random(51);
    std::uniform_real_distribution<double> turn(0, 360), place(-3, 3), exponent(-8.5, -2);
    int passed = 0, met = 0;
    for (int i = 0; i < 4000; ++i) {
        const Pose2 pose{{i % 2 == 0 ? 0 : place(random), 0},
                         Angle::degrees(i % 8 == 0 ? 22.5 * i : turn(random))};
        // The straight continuation passes this far below the origin, the end this far aside.
        const double height = std::pow(10, exponent(random));
        const double aside = i % 3 == 0 ? 0.5e-9 : 3e-10 * place(random);
        const bool at_near = i % 5 < 3;
        const double at = at_near ? 5 : 6, slope = (aside + height) / at;
        const Point2 near = pose * Point2{5, aside + (5 - at) * slope};
        const Point2 far = pose * Point2{6, aside + (6 - at) * slope};
        const FlatWorld world(Lines{{near, far}, {pose * Point2{9, -1}, pose * Point2{9, 1}}});
        const double range = rangeOf(world, pose.position, unitVector(pose.heading));
        const bool is_past = at_near ? aside > 0 : aside < 0;
        const double off = std::min(std::fabs(range - at), std::fabs(range - 9));
        if (is_past) {
            EXPECT_LT(off, 1e-5) << height << ' ' << aside << ' ' << at;
        } else {
            EXPECT_TRUE((range > 5 - 1e-5 && range < 6 + 1e-5) || off < 1e-5) << range;
        }
        ++(range > 8 ? passed : met);
    }
    EXPECT_GT(passed, 400);
    EXPECT_GT(met, 400);
}

TEST(FlatLine, NoRayPassesACommonEndSeenFromTheEdge) {
    std::mt19937_64 random(52);
    std::uniform_real_distribution<double> turn(0, 360), exponent(-9, 0);
    for (int i = 0; i < 2000; ++i) {
        // Two walls with a bend between them, almost in line with the rays.
        const Pose2 pose{{0.3, 0.1}, Angle::degrees(turn(random))};
        const double low = std::pow(10, exponent(random)), high = std::pow(10, exponent(random));
        const Point2 bend = pose * Point2{5, 0};
        const Lines lines{{pose * Point2{4, -low}, bend}, {bend, pose * Point2{6, high}}};
        const double range = rangeOf(FlatWorld(lines), pose.position, bend - pose.position);
        EXPECT_NEAR(range, 5, 1e-5) << low << ' ' << high;
    }
}

}  // namespace

}  // namespace ispace
