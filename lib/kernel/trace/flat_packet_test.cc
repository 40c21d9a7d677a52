// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/flat_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "support/test_scans.h"

namespace ispace {

using namespace testing;

namespace flat_packet_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Rays from many places.
struct Rays {
    std::vector<Point2> origins;
    Directions directions;

    void add(Point2 origin, Vec2 way) {
        origins.push_back(origin);
        directions.resize(origins.size());
        directions.set(origins.size() - 1, {way.x, way.y, 0});
    }
    [[nodiscard]] std::size_t size() const { return origins.size(); }
};

Seen castTogether(const FlatWorld& world, const Rays& rays, double max_range = kInfinity,
                  double ray_epsilon = kTouching) {
    Seen seen{std::vector<float>(rays.size(), -1), std::vector<float>(rays.size(), -1)};
    world.cast(rays.origins, rays.directions, max_range, ray_epsilon, seen.ranges, seen.cosines);
    std::vector<float> plain(rays.size(), -1);
    world.cast(rays.origins, rays.directions, max_range, ray_epsilon, plain, {});
    EXPECT_EQ(plain, seen.ranges);
    return seen;
}

/// The same rays, one a call.
Seen castAlone(const FlatWorld& world, const Rays& rays, double max_range = kInfinity,
               double ray_epsilon = kTouching) {
    Seen seen{std::vector<float>(rays.size(), -1), std::vector<float>(rays.size(), -1)};
    Directions one;
    one.resize(1);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        one.set(0, rays.directions[i]);
        world.cast(rays.origins[i], one, max_range, ray_epsilon, std::span(&seen.ranges[i], 1),
                   std::span(&seen.cosines[i], 1));
    }
    return seen;
}

/// Draws all rays as one packet and compares to the bit with each alone; false if it is too wide.
bool agrees(const FlatTree& tree, const Rays& rays, double min_inverse_range = 0,
            double ray_epsilon = kTouching) {
    FlatPacket packet;
    packet.count = static_cast<int>((rays.size() + 7) / 8 * 8);
    EXPECT_LE(packet.count, FlatPacket::kMax);
    for (int i = 0; i < packet.count; ++i) {
        const auto lane = static_cast<std::size_t>(i);
        const std::size_t k = lane < rays.size() ? lane : rays.size() / 2;
        packet.x[i] = rays.directions.x[k];
        packet.y[i] = rays.directions.y[k];
        packet.origin_x[i] = rays.origins[k].x;
        packet.origin_y[i] = rays.origins[k].y;
    }
    const FlatPacketLimits limits{ray_epsilon, min_inverse_range, widestPacket(tree)};
    FlatPacket plain = packet;
    const bool is_drawn = drawLinesAndCosines(tree, limits, packet);
    EXPECT_EQ(drawLines(tree, limits, plain), is_drawn);
    if (!is_drawn) return false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const FlatHit hit =
            firstLine(tree, {rays.origins[i].x, rays.origins[i].y, ray_epsilon},
                      rays.directions.x[i], rays.directions.y[i], min_inverse_range);
        EXPECT_EQ(packet.inverse_range[i], hit.inverse_range) << i;
        EXPECT_EQ(plain.inverse_range[i], hit.inverse_range) << i;
        if (hit.inverse_range > min_inverse_range) {
            EXPECT_EQ(packet.cosine[i], hit.cosine) << i;
        }
    }
    return true;
}

/// As many neighbours as fit a packet, or fewer: from a disc, into a sector.
Rays neighbours(std::mt19937_64& random, Point2 middle, double radius, Angle sector) {
    std::uniform_real_distribution<double> turn(-180, 180), part(-0.5, 0.5);
    std::uniform_int_distribution<int> size(1, FlatPacket::kMax);
    const Angle ahead = Angle::degrees(turn(random));
    Rays rays;
    const int count = size(random);
    for (int i = 0; i < count; ++i)
        rays.add(middle + 2 * radius * part(random) * unitVector(Angle::degrees(turn(random))),
                 unitVector(ahead + Angle::degrees(sector.degrees() * part(random))));
    return rays;
}

TEST(FlatPacket, RaysMeetWhatTheyMeetAlone) {
    std::mt19937_64 random(1);
    const std::pair<Lines, double> worlds[] = {{office(4, 3), 20},
                                               {tangle(random, 60, 20), 20},
                                               {tangle(random, 2000, 20), 20},
                                               {tangle(random, 300, 1e-3), 1e-3},
                                               {tangle(random, 300, 1e5), 1e5}};
    for (const auto& [lines, size] : worlds) {
        SCOPED_TRACE(std::to_string(lines.size()) + " lines in " + std::to_string(size));
        const FlatTree tree(lines);
        std::uniform_real_distribution<double> place(0, size), exponent(-9, -1);
        int drawn = 0;
        for (int i = 0; i < 2000; ++i) {
            Point2 middle{place(random), place(random)};
            if (i % 4 == 0) middle = lines[random() % lines.size()].b;
            const double radius = i % 8 == 1 ? 0 : size * std::pow(10, exponent(random));
            const Rays rays = neighbours(random, middle, radius, Angle::degrees(i % 25));
            drawn += agrees(tree, rays, i % 3 == 0 ? 0 : 4 / size) ? 1 : 0;
        }
        EXPECT_GT(drawn, 1000);
    }
}

TEST(FlatPacket, RaysThatJustTouchAnEndAtTheRimOfThePacket) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> turn(-180, 180), part(0, 1), aside(-1.5e-9, 1.5e-9);
    int met = 0;
    for (int i = 0; i < 4000; ++i) {
        // The line lies on the far side of the ray at the rim.
        const Angle heading = Angle::degrees(turn(random));
        const int side = i % 2 == 0 ? 1 : -1;
        const Vec2 way = unitVector(heading), across = side * perpendicular(way);
        const double far = std::pow(10, 4 * part(random) - 3);
        const Point2 end = Point2{} + far * way + aside(random) * across;
        const Segment2 line{end, end + far * (part(random) * across + (part(random) - 0.5) * way)};
        Rays rays;
        const double spread = i % 3 == 0 ? 0 : 0.05 * far;
        for (int k = 0; k < 12; ++k)
            rays.add(Point2{} - (k * spread / 12) * across - (k % 4) * spread * way,
                     unitVector(heading - Angle::degrees(side * k * (i % 5) * 0.2)));
        const FlatTree tree(
            std::vector<Segment2>{line, {{-9 * far, -9 * far}, {-9 * far, 9 * far}}});
        EXPECT_TRUE(agrees(tree, rays, 0, 0));
        met += firstLine(tree, {0, 0, 0}, way.x, way.y, 0).inverse_range > 0 ? 1 : 0;
    }
    EXPECT_GT(met, 1000);
    EXPECT_LT(met, 3500);
}

TEST(FlatPacket, OnlyNeighboursAreWalkedTogether) {
    const FlatTree tree(office(4, 3));
    const double widest = widestPacket(tree);
    EXPECT_GT(widest, 0.5);
    EXPECT_LT(widest, 5);
    const auto rays = [](int count, double span, Vec2 shift) {
        Rays out;
        for (int i = 0; i < count; ++i) {
            const double part = static_cast<double>(i) / (count - 1);
            out.add(Point2{6, 6} + part * shift, unitVector(Angle::degrees(170 + span * part)));
        }
        return out;
    };
    for (const int count : {8, 9, 64}) {
        EXPECT_TRUE(agrees(tree, rays(count, 0, {})));
        EXPECT_TRUE(agrees(tree, rays(count, 20, {0.1, -0.2})));
        EXPECT_EQ(agrees(tree, rays(count, 60, {0.1, -0.2})), count == 8);
        EXPECT_FALSE(agrees(tree, rays(count, 120, {})));
        EXPECT_FALSE(agrees(tree, rays(count, 360, {})));
        EXPECT_FALSE(agrees(tree, rays(count, 5, {1.1 * widest, 0})));
        EXPECT_FALSE(agrees(tree, rays(count, 5, {0, 1.1 * widest})));
    }
    Rays opposite = rays(4, 0, {});
    for (std::size_t i = 0; i < 4; ++i)
        opposite.add({6, 6}, {-opposite.directions.x[i], -opposite.directions.y[i]});
    EXPECT_FALSE(agrees(tree, opposite));
}

/// A scan of a sensor that moves, with bearings that err.
Rays movingScan(std::mt19937_64& random, Point2 from, Point2 to, Angle first, Angle step,
                double error_degrees, int beams) {
    std::normal_distribution<double> error(0, 1);
    Rays rays;
    for (int i = 0; i < beams; ++i)
        rays.add(from + (static_cast<double>(i) / beams) * (to - from),
                 unitVector(first + i * step + Angle::degrees(error_degrees * error(random))));
    return rays;
}

TEST(FlatPacket, ScansOfAMovingSensor) {
    std::mt19937_64 random(3);
    const Lines plans[] = {office(4, 3), tangle(random, 500, 20)};
    std::uniform_real_distribution<double> place(0, 20), turn(-180, 180), exponent(-6, 1);
    for (const Lines& lines : plans) {
        const FlatWorld world(lines);
        for (int i = 0; i < 60; ++i) {
            const Point2 from{place(random), place(random)};
            const Vec2 shift =
                std::pow(10, exponent(random)) * unitVector(Angle::degrees(turn(random)));
            const double steps[] = {0.1, -0.25, 1, 7, 0};
            const int beams[] = {1, 2, 3, 7, 8, 9, 63, 64, 65, 200, 513};
            const Rays rays =
                movingScan(random, from, from + shift, Angle::degrees(turn(random)),
                           Angle::degrees(steps[i % 5]), i % 3 == 0 ? 0 : 0.1, beams[i % 11]);
            const double max_range = i % 2 == 0 ? kInfinity : 4;
            EXPECT_EQ(castTogether(world, rays, max_range), castAlone(world, rays, max_range));
        }
        // Nothing in common at all, and neighbours with strangers among them.
        for (int i = 0; i < 20; ++i) {
            Rays rays;
            for (int k = 0; k < 300; ++k) {
                const bool is_stranger = i % 2 == 0 || k % 50 == 7;
                rays.add(is_stranger ? Point2{place(random), place(random)} : Point2{7, 6},
                         unitVector(Angle::degrees(is_stranger ? turn(random) : 0.25 * k)));
            }
            EXPECT_EQ(castTogether(world, rays), castAlone(world, rays));
        }
    }
}

TEST(FlatPacket, APacketIsThePartOfAFan) {
    std::mt19937_64 random(4);
    const Lines lines = tangle(random, 400, 20);
    const FlatWorld world(lines);
    std::uniform_real_distribution<double> place(0, 20), turn(-180, 180);
    for (int i = 0; i < 60; ++i) {
        Point2 origin{place(random), place(random)};
        if (i % 3 == 0) origin = lines[random() % lines.size()].a;
        Directions beams = scan(Angle::degrees(turn(random)), Angle::degrees(0.3), 700);
        const Seen seen = cast(world, origin, beams, 9);
        EXPECT_EQ(castTogether(world, {std::vector<Point2>(700, origin), beams}, 9), seen);
        beams.arc.reset();
        EXPECT_EQ(cast(world, origin, beams, 9), seen);
    }
}

TEST(FlatPacket, InContactForSomeOfTheRays) {
    std::mt19937_64 random(5);
    // A wall in pieces, some of which are in contact; one ends where the sensor passes.
    const Lines wall = {{{-3, 0}, {-1, 0}}, {{-1, 0}, {1, 0}},    {{2, 0}, {1, 0}},
                        {{2.5, 0}, {4, 0}}, {{0.5, 0}, {0.5, 1}}, {{-4, 3}, {4, 3}},
                        {{-4, -2}, {4, -2}}};
    std::uniform_real_distribution<double> turn(-180, 180), height(-3e-4, 3e-4);
    std::uniform_real_distribution<double> along(-2, 3);
    for (const double degrees : {0.0, 90.0, 33.0}) {
        Lines lines = wall;
        const Pose2 at{{7, -3}, Angle::degrees(degrees)};
        for (Segment2& line : lines) line = {at * line.a, at * line.b};
        const FlatWorld world(lines);
        const FlatTree tree(lines);
        for (int i = 0; i < 400; ++i) {
            const Point2 from{along(random), i % 3 == 0 ? 0.0 : height(random)};
            const Point2 to{i % 2 == 0 ? from.x : from.x + 0.05 * along(random), height(random)};
            const Rays rays = movingScan(
                random, at * from, at * to, i % 4 == 0 ? at.heading : Angle::degrees(turn(random)),
                Angle::degrees(i % 5 == 0 ? 0.001 : 0.25), i % 2 == 0 ? 0.1 : 0, 64);
            for (const double ray_epsilon : {0.0, kTouching, 1e-2}) {
                agrees(tree, rays, 0, ray_epsilon);
                EXPECT_EQ(castTogether(world, rays, 20, ray_epsilon),
                          castAlone(world, rays, 20, ray_epsilon));
            }
        }
    }
    // Half of them still touch the wall and look through it, the others meet it.
    Rays rays;
    for (int i = 0; i < 64; ++i) rays.add({0.2, 2e-4 * i / 63}, {0, -1});
    const Seen seen = castTogether(FlatWorld(wall), rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_NEAR(seen.ranges[i], i < 32 ? 2 : 0, 1e-3) << i;
    // The second piece continues the one in contact, for the first half.
    Rays slanted;
    for (int i = 0; i < 64; ++i) {
        const double y = 2e-4 * i / 63;
        slanted.add({0.7, y}, unitVector(Angle::radians(-y / 0.8)));
    }
    const Seen grazing = castTogether(FlatWorld(wall), slanted);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (i < 32) {
            EXPECT_EQ(grazing.ranges[i], kInfinity) << i;
        } else {
            EXPECT_NEAR(grazing.ranges[i], 0.8, 1e-3) << i;
        }
    }
}

TEST(FlatPacket, SeenFromItsEdgeBySomeOfTheRays) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> turn(-180, 180), height(-3e-9, 3e-9), part(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const Pose2 at{{0, 0}, Angle::degrees(i % 3 == 0 ? 90 * (i % 4) : turn(random))};
        const Lines lines = {{at * Point2{2, 0}, at * Point2{4, 0}},
                             {at * Point2{6, -1}, at * Point2{6, 1}}};
        Rays rays;
        for (int k = 0; k < 40; ++k)
            rays.add(at * Point2{0.1 * part(random), i % 2 == 0 ? height(random) : 0.0},
                     unitVector(at.heading + Angle::radians((k % 2) * 1e-9 * part(random))));
        EXPECT_TRUE(agrees(FlatTree(lines), rays, 0, i % 4 == 0 ? 0 : kTouching));
    }
    // Those level with the line look past it, those above it do not.
    const FlatWorld world(Lines{{{2, 0}, {4, 0}}, {{6, -1}, {6, 1}}});
    Rays rays;
    for (int i = 0; i < 32; ++i) rays.add({0, i % 2 == 0 ? 0 : 1e-3}, {1, i % 2 == 0 ? 0 : -4e-4});
    const Seen seen = castTogether(world, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        EXPECT_NEAR(seen.ranges[i], i % 2 == 0 ? 6 : 2.5, 1e-5) << i;
}

TEST(FlatPacket, MaximumRangeIsInclusive) {
    const FlatWorld world(Lines{{{5, -1}, {5, 1}}, {{5, 1}, {9, 2}}});
    Rays rays;
    for (int i = 0; i < 64; ++i) rays.add({(i % 4 - 1) * 0.5, i * 0.01}, {1, 0});
    const Seen seen = castTogether(world, rays, 5);
    EXPECT_EQ(seen, castAlone(world, rays, 5));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double range = 5 - rays.origins[i].x;
        EXPECT_EQ(seen.ranges[i], range <= 5 ? static_cast<float>(range) : INFINITY) << i;
        EXPECT_EQ(seen.cosines[i], 1);
    }
    for (const double odd : {4.095, 4.999, 0.0, -1.0}) {
        for (std::size_t i = 0; i < rays.size(); ++i) rays.origins[i].x = 5 - odd;
        const Seen found = castTogether(world, rays, odd);
        EXPECT_EQ(found, castAlone(world, rays, odd));
        if (odd > 0) {
            EXPECT_EQ(found.ranges, std::vector<float>(64, static_cast<float>(odd)));
        }
    }
}

TEST(FlatPacket, EqualDistancesGiveTheLargerCosine) {
    // A corner that many rays hit from their own places, each as far away.
    const Lines three = {{{0, 0}, {1, 1}}, {{0, 0}, {0, -1}}, {{0, 0}, {3, 1}}};
    for (const std::size_t first : {0U, 1U, 2U}) {
        const Lines turned = {three[first], three[(first + 1) % 3], three[(first + 2) % 3]};
        Rays rays;
        for (int i = 0; i < 32; ++i) rays.add({-1 - i / 64.0, 0}, {1, 0});
        const Seen seen = castTogether(FlatWorld(turned), rays);
        EXPECT_EQ(seen, castAlone(FlatWorld(turned), rays));
        EXPECT_EQ(seen.cosines, std::vector<float>(32, 1.0F));
    }
}

TEST(FlatPacket, LinesWithoutLengthAndNoLines) {
    std::mt19937_64 random(7);
    Lines lines = tangle(random, 50, 10);
    const Rays rays = movingScan(random, {5, 5}, {5.2, 5.1}, {}, Angle::degrees(0.25), 0.1, 500);
    const Seen seen = castTogether(FlatWorld(lines), rays);
    for (int i = 0; i < 100; ++i) {
        const Point2 point = rays.origins[random() % 500] + (i % 2) * Vec2{1, 1};
        lines.push_back({point, point});
    }
    EXPECT_EQ(castTogether(FlatWorld(lines), rays), seen);
    for (const Lines& none : {Lines{}, Lines{{{1, 1}, {1, 1}}}})
        EXPECT_EQ(castTogether(FlatWorld(none), rays).ranges, std::vector<float>(500, INFINITY));
    castTogether(FlatWorld(lines), Rays{});
}

TEST(FlatPacket, WhatIsNoRayHarmsNoNeighbour) {
    std::mt19937_64 random(8);
    const FlatWorld world(office(3, 2));
    const Rays good = movingScan(random, {5, 6}, {5.2, 6.1}, {}, Angle::degrees(0.25), 0, 64);
    const Seen seen = castTogether(world, good);
    const std::pair<Point2, Vec2> bad[] = {{{kNaN, 6}, {1, 0}},      {{5, kNaN}, {0, 1}},
                                           {{kInfinity, 6}, {1, 0}}, {{5, -kInfinity}, {1, 0}},
                                           {{5, 6}, {kNaN, 0}},      {{5, 6}, {0, 0}}};
    for (const auto& [origin, way] : bad)
        for (const std::size_t place : {0U, 9U, 63U}) {
            Rays rays = good;
            rays.origins[place] = origin;
            rays.directions.set(place, {way.x, way.y, 0});
            const Seen found = castTogether(world, rays);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (i == place) {
                    EXPECT_FALSE(std::isnan(found.ranges[i]));
                    continue;
                }
                EXPECT_EQ(found.ranges[i], seen.ranges[i]) << i;
                EXPECT_EQ(found.cosines[i], seen.cosines[i]) << i;
            }
        }
}

}  // namespace flat_packet_test

}  // namespace ispace
