// SPDX-License-Identifier: GPL-3.0-or-later
// Where float32 alone would err: needles, grazing rays, far origins, large scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "support/test_triangles.h"
#include "trace/embree_scene.h"

namespace ispace {

using namespace testing;

namespace embree_limits_test {

/// A level square at 1 m over a floor, tiled by needles: from a corner to the side opposite, or
/// side by side.
struct NeedleTable {
    TriangleSoup soup;
    double side, turn;
    Point3 corner;
    bool is_fan;
    double wide = 0;  ///< of all needles, at the side opposite

    NeedleTable(double half, int needles, double width, bool fan, std::mt19937_64& random)
        : is_fan(fan) {
        std::uniform_real_distribution<double> share(0, 1);
        addQuad(soup, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
        side = 1 + 0.3 * half * share(random);
        turn = 2 * std::numbers::pi * share(random);
        corner = {0.2 * half * (share(random) - 0.5), 0.2 * half * (share(random) - 0.5), 1};
        addTriangle({0, 0}, {0, -side}, {side, -side});
        addTriangle({0, 0}, {side, -side}, {side, 0});
        for (int i = 0; i < needles; ++i, wide += width) {
            const double next = wide + width;
            if (is_fan) {
                addTriangle({0, 0}, {side, wide}, {side, next});
            } else {
                addTriangle({0, wide}, {side, wide}, {side, next});
                addTriangle({0, wide}, {side, next}, {0, next});
            }
        }
        const Point2 last{0, is_fan ? 0 : wide};
        addTriangle(last, {side, wide}, {side, side});
        addTriangle(last, {side, side}, {0, side});
    }
    [[nodiscard]] Point3 place(Point2 p) const {
        const double c = std::cos(turn), s = std::sin(turn);
        return {corner.x + c * p.x - s * p.y, corner.y + s * p.x + c * p.y, 1};
    }
    /// On a needle.
    [[nodiscard]] Point3 placeAt(double along, double across) const {
        return place({along * side, across * wide * (is_fan ? along : 1)});
    }

  private:
    void addTriangle(Point2 a, Point2 b, Point2 c) {
        const auto i = soup.add(place(a)), j = soup.add(place(b)), k = soup.add(place(c));
        soup.triangles.push_back({i, j, k});
    }
};

/// Rays from over the table to its needles.
void castAtNeedles(const NeedleTable& table, double half, int width, std::mt19937_64& random) {
    std::uniform_real_distribution<double> share(0, 1);
    const EmbreeScene scene(table.soup, kTouching, width);
    const double tolerance = 4 * TriangleSet(table.soup).tolerance();
    const Point3 origin{table.corner.x + 0.2 * half * (share(random) - 0.5),
                        table.corner.y + 0.2 * half * (share(random) - 0.5),
                        1 + half * (0.01 + 0.5 * share(random))};
    Beams beams(500);
    std::vector<double> ranges;
    ranges.reserve(500);
    for (std::size_t i = 0; i < 500; ++i) {
        const Vec3 way = table.placeAt(share(random), share(random)) - origin;
        ranges.push_back(length(way));
        beams.aim(i, way);
    }
    beams.cast(scene, origin, 1e5);
    for (std::size_t i = 0; i < 500; ++i)
        EXPECT_NEAR(beams.ranges[i], ranges[i], tolerance + 1e-6 * (1 + ranges[i]));
}

TEST(EmbreeLimits, NoRayPassesBetweenNeedles) {
    std::mt19937_64 random(41);
    for (int i = 0; i < 300; ++i) {
        const double half = i % 2 == 0 ? 5 : 500;
        const double width = std::pow(10, -7 + i % 5);
        const int needles = i % 3 == 0 ? 40 : i % 3;
        const bool is_fan = i / 2 % 2 == 0;
        SCOPED_TRACE(std::to_string(needles) + " of " + std::to_string(1e6 * width) + " um");
        castAtNeedles(NeedleTable(half, needles, width, is_fan, random), half, i % 7 == 0 ? 1 : 0,
                      random);
    }
}

TEST(EmbreeLimits, NeedlesAsWideAsTheToleranceAreMet) {
    std::mt19937_64 random(42);
    std::uniform_real_distribution<double> share(0, 1);
    for (const double half : {5.0, 500.0}) {
        for (const double tolerances : {4.0, 16.0, 64.0}) {
            const double width = tolerances * 1.4e-6 * half;
            TriangleSoup soup;
            addQuad(soup, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
            const double turn = 2 * std::numbers::pi * share(random), size = 1 + 0.2 * half;
            const Vec3 along{size * std::cos(turn), size * std::sin(turn), 0};
            const Vec3 aside{-width * std::sin(turn), width * std::cos(turn), 0};
            const Point3 begin{0.1 * half * share(random), -0.2 * half * share(random), 1};
            const auto a = soup.add(begin), b = soup.add(begin + along);
            const auto c = soup.add(begin + 0.5 * along + aside);
            soup.triangles.push_back({a, b, c});
            const EmbreeScene scene(soup, kTouching, 0);
            const Point3 origin{half * (share(random) - 0.5), half * (share(random) - 0.5), 2.5};
            Beams beams(300);
            std::vector<double> ranges;
            ranges.reserve(300);
            for (std::size_t i = 0; i < 300; ++i) {
                const double u = 0.25 + 0.5 * share(random), v = 0.2 + 0.6 * share(random);
                const double high = v * (1 - std::fabs(2 * u - 1));
                const Vec3 way = begin + u * along + high * aside - origin;
                ranges.push_back(length(way));
                beams.aim(i, way);
            }
            beams.cast(scene, origin, 1e5);
            for (std::size_t i = 0; i < 300; ++i)
                EXPECT_NEAR(beams.ranges[i], ranges[i], 8e-6 * half) << half << ' ' << width;
        }
    }
}

TEST(EmbreeLimits, WhatStandsBeforeAGrazedNeighbourIsMet) {
    for (const double half : {10.0, 100.0, 500.0}) {
        for (const double angle : {1e-4, 1e-3, 1e-2, 0.1}) {
            // A wall ahead ends in a corner, behind which another recedes almost along the rays. A
            // plate stands on that one, with no edge in common.
            TriangleSoup soup;
            const Vec3 up{0, 0, 3}, along{std::cos(angle), std::sin(angle), 0};
            addQuad(soup, {-half, half, 0}, {2 * half, 0, 0}, {0, 0, 4});
            addQuad(soup, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
            addQuad(soup, {5, -2, 0}, {0, 2, 0}, up);
            addQuad(soup, {5, 0, 0}, 4.0 * along, up);
            addQuad(soup, Point3{5, 0, 0} + 0.02 * along, {-0.5 * along.y, 0.5 * along.x, 0}, up);
            const TriangleSet set(soup);
            const EmbreeScene scene(soup, kTouching, 0);
            const Point3 origin{0, 0, 1.3};
            Beams beams(2000);
            for (std::size_t i = 0; i < 2000; ++i)
                beams.aim(i, {5, 2 * set.tolerance() * static_cast<double>(i) / 2000, 0.01});
            beams.cast(scene, origin, 1e4);
            for (std::size_t i = 0; i < 2000; ++i)
                EXPECT_TRUE(isWithinTolerance(set, {origin, beams.directions[i], 1e4},
                                              beams.ranges[i], set.tolerance()))
                    << half << ' ' << angle << ' ' << i;
        }
    }
}

/// Rays from afar against all triangles in doubles: from one origin, from their own, as a picture.
void castFromAfar(const TriangleSoup& soup, double size, double far, std::mt19937_64& random) {
    SCOPED_TRACE(std::to_string(size) + " seen from " + std::to_string(far));
    std::uniform_real_distribution<double> any(-1, 1);
    const TriangleSet set(soup);
    const EmbreeScene scene(soup, kTouching, 0);
    const Point3 origin{-0.8 * far, -0.6 * far, 0.1 * size};
    const std::size_t count = 500;
    Beams beams(count), own(count);
    std::vector<Point3> origins;
    origins.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Point3 target{size * any(random), size * any(random), size * any(random)};
        beams.aim(i, target - origin);
        origins.push_back(origin + 0.01 * far * Vec3{any(random), any(random), any(random)});
        own.aim(i, target - origins.back());
    }
    int met = 0;
    const auto expect_met = [&](float range, const Ray& ray) {
        const double exact = bruteForce(set, ray);
        if (static_cast<float>(exact) == range) return;
        const double tolerance = set.tolerance() * std::max(1.0, far / size);
        EXPECT_TRUE(isWithinTolerance(set, ray, range, tolerance)) << range << ' ' << exact;
    };
    beams.cast(scene, origin, 1e9);
    scene.cast(origins, own.directions, 1e9, {own.ranges, own.cosines});
    for (std::size_t i = 0; i < count; ++i) {
        met += beams.ranges[i] < kNoReturn ? 1 : 0;
        expect_met(beams.ranges[i], {origin, beams.directions[i], 1e9});
        expect_met(own.ranges[i], {origins[i], own.directions[i], 1e9});
    }
    // Sight ends before what is met, or just behind it.
    std::vector<std::uint8_t> seen(count);
    for (const double more : {-1e-3, 1e-3}) {
        std::vector<Point3> targets;
        std::vector<bool> is_free;
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 direction = beams.directions[i];
            const double exact = bruteForce(set, {origin, direction, 1e9});
            is_free.push_back(more < 0 || std::isinf(exact));
            const double reach = std::isinf(exact) ? 2 * far : exact + more * size;
            targets.push_back(origin + (reach + kTouching) * direction);
        }
        scene.query(origin, targets, seen);
        for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(seen[i] == 1, is_free[i]) << i;
    }
    EXPECT_GT(met, 100);
    EXPECT_LT(met, 500);
    // Wider than the scene: its rim misses it.
    const Vec3 ahead = Point3{0, 0, 0} - origin;
    const double aside = 0.1 * size;
    const RayGrid grid{{ahead.x + 1.2 * size, ahead.y - 1.6 * size, ahead.z + 1.97 * size},
                       {-0.6 * aside, 0.8 * aside, 0},
                       {0, 0, -aside},
                       40,
                       40};
    std::vector<float> multiples(grid.size());
    scene.cast(origin, grid, 1e9, {multiples, {}});
    if (far > 10 * size) {
        EXPECT_EQ(multiples[0], kNoReturn);
    }
    for (std::size_t i = 0; i < grid.size(); ++i)
        expect_met(multiples[i],
                   {origin, grid.ray(static_cast<int>(i) % 40, static_cast<int>(i) / 40), 1e9});
}

TEST(EmbreeLimits, TheToleranceGrowsWithTheDistanceOfTheOrigin) {
    std::mt19937_64 random(43);
    std::uniform_real_distribution<double> any(-1, 1);
    for (const double size : {0.01, 1.0, 100.0}) {
        TriangleSoup soup;
        for (int i = 0; i < 6; ++i)
            addBox(soup, {0.7 * size * any(random), 0.7 * size * any(random), 0},
                   {0.2 * size, 0.1 * size, 0.5 * size}, 6 * any(random));
        for (const double far : {0.3, 1.0, 3.0, 100.0})
            castFromAfar(soup, size, far * size, random);
    }
}

TEST(EmbreeLimits, ContactIsFeltInLargeScenes) {
    std::mt19937_64 random(44);
    std::uniform_real_distribution<double> share(0, 1);
    for (const double half : {20.0, 500.0, 5000.0, 20000.0}) {
        for (int i = 0; i < 100; ++i) {
            // A sensor on a wall, and another wall 3 m ahead.
            const Point3 middle{half * (share(random) - 0.5), half * (share(random) - 0.5), 0};
            const double turn = i % 2 == 0 ? 0 : 2 * std::numbers::pi * share(random);
            const Vec3 along{std::cos(turn), std::sin(turn), 0}, ahead{-along.y, along.x, 0};
            TriangleSoup soup;
            addQuad(soup, {-half, half, 0}, {2 * half, 0, 0}, {0, 0, 4});
            addQuad(soup, {-half, -half, 0}, {2 * half, 0, 0}, {0, 0, 4});
            addQuad(soup, middle + -2.0 * along, 4.0 * along, {0, 0, 3});
            addQuad(soup, (middle + -2.0 * along) + 3.0 * ahead, 4.0 * along, {0, 0, 3});
            const EmbreeScene scene(soup, kTouching, 0);
            const double off = 1.8e-4 * (share(random) - 0.5);
            const Point3 origin = Point3{middle.x, middle.y, 1.2} + off * ahead;
            Beams beams(20), own(20);
            for (std::size_t k = 0; k < 20; ++k) {
                const double angle = turn + std::numbers::pi / 2 + share(random) - 0.5;
                beams.aim(k, {std::cos(angle), std::sin(angle), 0});
                own.directions.set(k, beams.directions[k]);
            }
            beams.cast(scene, origin, 1e7);
            scene.cast(std::vector<Point3>(20, origin), own.directions, 1e7, {own.ranges, {}});
            for (std::size_t k = 0; k < 20; ++k) {
                const double range = (3 - off) / dot(beams.directions[k], ahead);
                EXPECT_NEAR(beams.ranges[k], range, 1e-5) << half;
                EXPECT_EQ(own.ranges[k], beams.ranges[k]) << half;
            }
        }
    }
}

TEST(EmbreeLimits, WallsBesideTheOriginAreMetInLargeScenes) {
    std::mt19937_64 random(45);
    std::uniform_real_distribution<double> share(0, 1);
    for (const double half : {20.0, 500.0, 5000.0}) {
        for (int i = 0; i < 100; ++i) {
            // Nearer than float32 tells, but not in contact, on either side; nothing stands beyond.
            const Point3 middle{half * (share(random) - 0.5), half * (share(random) - 0.5), 0};
            const double turn = i % 2 == 0 ? 0 : 2 * std::numbers::pi * share(random);
            const Vec3 along{std::cos(turn), std::sin(turn), 0}, ahead{-along.y, along.x, 0};
            TriangleSoup soup;
            addQuad(soup, {-half, -half, 0}, {2 * half, 0, 0}, {0, 2 * half, 0});
            addQuad(soup, middle + -2.0 * along, 4.0 * along, {0, 0, 3});
            const EmbreeScene scene(soup, kTouching, 0);
            const double off = (i % 4 < 2 ? 1 : -1) * (1.1e-4 + 2e-3 * share(random));
            const Point3 origin = Point3{middle.x, middle.y, 1.2} + off * ahead;
            Beams beams(20), own(20);
            for (std::size_t k = 0; k < 20; ++k) {
                const double angle =
                    turn + (k % 2 == 0 ? -0.5 : 0.5) * std::numbers::pi + 2 * (share(random) - 0.5);
                beams.aim(k, {std::cos(angle), std::sin(angle), 0});
                own.directions.set(k, beams.directions[k]);
            }
            beams.cast(scene, origin, 1e7);
            scene.cast(std::vector<Point3>(20, origin), own.directions, 1e7, {own.ranges, {}});
            for (std::size_t k = 0; k < 20; ++k) {
                const double range = -off / dot(beams.directions[k], ahead);
                if (range > 0) {
                    EXPECT_NEAR(beams.ranges[k], range, 1e-9) << half;
                } else {
                    EXPECT_EQ(beams.ranges[k], kNoReturn) << half;
                }
                EXPECT_EQ(own.ranges[k], beams.ranges[k]) << half;
            }
        }
    }
}

TEST(EmbreeLimits, ALimitThatIsNoNumberIsNeverReached) {
    TriangleSoup soup;
    addBox(soup, {0, 0, 0}, {1, 1, 1}, 0);
    const EmbreeScene scene(soup, kTouching, 0);
    Beams beams(40);
    // Some at corners, which are looked at closely.
    for (std::size_t i = 0; i < 40; ++i) beams.aim(i, {1, 1, 0.05 * static_cast<double>(i) - 1});
    for (const double most : {std::numeric_limits<double>::quiet_NaN(), -1.0, -kInfinity}) {
        beams.cast(scene, {0, 0, 0}, most);
        EXPECT_EQ(beams.ranges, std::vector<float>(40, kNoReturn)) << most;
        beams.cast(scene, {-1000, -1000, 0}, most);
        EXPECT_EQ(beams.ranges, std::vector<float>(40, kNoReturn)) << most;
    }
    beams.cast(scene, {0, 0, 0}, kInfinity);
    for (const float range : beams.ranges) EXPECT_LT(range, 2);
}

}  // namespace embree_limits_test

}  // namespace ispace
