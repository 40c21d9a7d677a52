// SPDX-License-Identifier: GPL-3.0-or-later
// Level rays past the ends of lines, and against round bodies: the curve itself decides.
#include "trace/flat_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "geom/pose.h"
#include "support/test_scans.h"

namespace ispace {

using namespace testing;

namespace flat_kernels_test {

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

/// Distance and cosine at which a ray from outside meets a disc.
std::pair<double, double> meetDisc(const Ellipse& disc, Point2 from, Vec2 ray) {
    const double r = disc.half_length;
    const Vec2 way = disc.center - from;
    const double ahead = dot(way, ray), aside = std::fabs(cross(ray, way));
    if (ahead < 0 || aside > r) return {kInfinity, 1};
    const double half = std::sqrt((r - aside) * (r + aside));
    return {ahead - half, half / r};
}

TEST(FlatRound, RangesAreClosedForm) {
    std::mt19937_64 random(30);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int met = 0;
    for (int i = 0; i < 2000; ++i) {
        const double radius = std::exp(uniform(std::log(0.02), std::log(2)));
        const Ellipse disc({uniform(-5, 5), uniform(-5, 5)}, 2 * radius, 2 * radius,
                           Angle::degrees(uniform(0, 360)));
        const FlatWorld world({}, {&disc, 1});
        const Point2 from{uniform(-5, 5), uniform(-5, 5)};
        const double distance = length(disc.center - from);
        if (distance < radius + 0.001) continue;
        // Beams all over the body, and next to its tangents on both sides.
        Directions beams;
        const double half = std::asin(radius / distance);
        const Vec2 way = disc.center - from;
        const double middle = std::atan2(way.y, way.x);
        std::vector<Angle> angles;
        for (int k = 0; k < 40; ++k)
            angles.push_back(Angle::radians(middle + uniform(-1, 1) * half));
        for (const double off : {1e-3, 1e-5, 1.01e-6, 1e-8})
            for (const double side : {-1.0, 1.0})
                for (const double out : {-1.0, 1.0})
                    angles.push_back(Angle::radians(
                        middle + side * std::asin(std::min(1.0, (radius + out * off) / distance))));
        beams.resize(angles.size());
        for (std::size_t k = 0; k < angles.size(); ++k) {
            const Vec2 ray = unitVector(angles[k]);
            beams.set(k, {ray.x, ray.y, 0});
        }
        const Seen seen = cast(world, from, beams);
        for (std::size_t k = 0; k < angles.size(); ++k) {
            const auto [range, cosine] = meetDisc(disc, from, {beams.x[k], beams.y[k]});
            const double aside = std::fabs(cross(Vec2{beams.x[k], beams.y[k]}, way)) - radius;
            if (aside > 1e-9) {
                EXPECT_TRUE(std::isinf(seen.ranges[k])) << i << ' ' << k << ' ' << aside;
            } else if (aside < -1e-9) {
                ++met;
                EXPECT_NEAR(seen.ranges[k], range, 1e-6) << i << ' ' << k << ' ' << aside;
                EXPECT_NEAR(seen.cosines[k], cosine, 1e-6 + 1e-6 / cosine);
            }
        }
    }
    EXPECT_GT(met, 50000);
}

TEST(FlatRound, FansPacketsAndSingleRaysAgree) {
    std::mt19937_64 random(31);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 100; ++i) {
        Lines lines = i % 5 == 0 ? Lines{} : tangle(random, 30, 10);
        std::vector<Ellipse> rounds;
        for (int k = 0; k < 1 + i; ++k)
            rounds.emplace_back(Point2{uniform(0, 10), uniform(0, 10)}, uniform(0.01, 1),
                                uniform(0.01, 1), Angle::degrees(uniform(0, 360)));
        const FlatWorld world(lines, rounds);
        Point2 from{uniform(0, 10), uniform(0, 10)};
        // Now and then on a curve.
        if (i % 4 == 0)
            from = rounds.back().center +
                   rounds.back().fromUnit(unitVector(Angle::degrees(uniform(0, 360))));
        Directions beams = scan(Angle::degrees(uniform(0, 360)), Angle::degrees(0.4), 800);
        const Seen as_fan = cast(world, from, beams, i % 3 == 0 ? 4 : kInfinity);
        const Seen apart = castApart(world, from, beams, i % 3 == 0 ? 4 : kInfinity);
        EXPECT_EQ(as_fan, apart) << i;
        for (std::size_t k = 0; k < beams.size(); k += 7) {
            const Directions one{{beams.x[k]}, {beams.y[k]}, {0}};
            const Seen alone = cast(world, from, one, i % 3 == 0 ? 4 : kInfinity);
            EXPECT_EQ(alone.ranges[0], as_fan.ranges[k]) << i << ' ' << k;
            EXPECT_EQ(alone.cosines[0], as_fan.cosines[k]) << i << ' ' << k;
        }
        // Ranges of rays without a round body in their way stay, and none is larger.
        const Seen empty = cast(FlatWorld(lines), from, beams, i % 3 == 0 ? 4 : kInfinity);
        for (std::size_t k = 0; k < beams.size(); ++k) EXPECT_LE(as_fan.ranges[k], empty.ranges[k]);
    }
}

TEST(FlatRound, EllipsesInAnyHeading) {
    // From a focus of an ellipse about it the range is known: p / (1 - e cos).
    const double a = 2, b = 1, e = std::sqrt(3) / 2;
    const Angle heading = Angle::degrees(33);
    const Ellipse round({1, -1}, 2 * a, 2 * b, heading);
    const FlatWorld world({}, {&round, 1});
    const Point2 focus = round.center - std::sqrt(3) * unitVector(heading);
    const Directions beams = scan({}, Angle::degrees(0.5), 720);
    const Seen seen = cast(world, focus, beams);
    for (std::size_t k = 0; k < beams.size(); ++k) {
        const double angle = (0.5 * static_cast<double>(k) - 33) * std::numbers::pi / 180;
        EXPECT_NEAR(seen.ranges[k], b * b / a / (1 - e * std::cos(angle)), 1e-6) << k;
    }
}

TEST(FlatRound, FromItsSurfaceBeamsLeaveFreely) {
    const Ellipse disc({0, 0}, 2, 2, {});
    const FlatWorld world({}, {&disc, 1});
    const Directions beams = scan({}, Angle::degrees(1), 360);
    for (const double height : {0.0, 9e-5, -9e-5}) {
        const Seen seen = cast(world, {1 + height, 0}, beams);
        for (std::size_t k = 0; k < 360; ++k) {
            const double c = -std::cos(static_cast<double>(k) * std::numbers::pi / 180);
            if (c <= 0.01) {
                EXPECT_FALSE(seen.ranges[k] < 0.03F) << k;
                EXPECT_TRUE(c > -0.02 || std::isinf(seen.ranges[k])) << k;
            } else {
                // To the far side, as through any body from its surface.
                EXPECT_NEAR(seen.ranges[k], 2 * c, 2e-4 / c) << k;
            }
        }
    }
}

TEST(FlatRound, NearestOfMany) {
    // One behind the other, and a wall between them: what is nearest counts.
    const std::vector<Ellipse> rounds{{{2, 0}, 1, 1, {}}, {{4, 0}, 1, 1, {}}, {{8, 0}, 1, 1, {}}};
    const Lines wall{{{6, -5}, {6, 5}}};
    const FlatWorld world(wall, rounds);
    const Directions beams = scan(Angle::degrees(-0.1), Angle::degrees(0.1), 3);
    EXPECT_FLOAT_EQ(cast(world, {0, 0}, beams).ranges[1], 1.5F);
    EXPECT_FLOAT_EQ(cast(world, {3, 0}, beams).ranges[1], 0.5F);
    EXPECT_FLOAT_EQ(cast(world, {5, 0}, beams).ranges[1], 1);
    EXPECT_FLOAT_EQ(cast(world, {7, 0}, beams).ranges[1], 0.5F);
    EXPECT_FLOAT_EQ(cast(world, {8.1, 0}, beams).ranges[1], 0.4F);  // from inside
    EXPECT_TRUE(std::isinf(cast(world, {9, 0}, beams).ranges[1]));
}

}  // namespace flat_kernels_test

}  // namespace ispace
