// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "geom/predicates.h"
#include "support/test_triangles.h"
#include "trace/ray_world.h"

namespace ispace {

namespace ray_world_tangle_test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Lines of all sizes and directions.
std::vector<Segment2> tangle(std::mt19937_64& random, int count, double size) {
    std::uniform_real_distribution<double> place(0, size), turn(0, 360), exponent(-3, 0);
    std::vector<Segment2> lines;
    for (int i = 0; i < count; ++i) {
        const Point2 a{place(random), place(random)};
        const double reach = size * std::pow(10, exponent(random));
        lines.push_back({a, a + reach * unitVector(Angle::degrees(turn(random)))});
    }
    return lines;
}

/// In doubles, over all lines but those in whose own line the origin lies.
double bruteForce(const std::vector<Segment2>& lines, Point2 origin, Angle heading) {
    const Vec2 direction = unitVector(heading);
    double nearest = kInfinity;
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a, way = line.a - origin;
        if (std::fabs(cross(along, way)) <= kRayEpsilon * length(along)) continue;
        const double slope = cross(direction, along);
        const double t = cross(way, along) / slope, s = cross(way, direction) / slope;
        if (t > 0 && s >= 0 && s <= 1) nearest = std::min(nearest, t);
    }
    return nearest;
}

TEST(RayWorld, TangleAgreesWithBruteForceAsSliceAndAsMeshOfEveryWidth) {
    std::mt19937_64 random(11);
    for (const double size : {10.0, 300.0}) {
        const std::vector<Segment2> lines = tangle(random, 300, size);
        std::uniform_real_distribution<double> place(0, size);
        const RayWorld slice = RayWorld::ofSlice({.sheets = lines, .solids = {}});
        std::vector<EmbreeScene> meshes;
        for (const int width : testing::kWidths)
            meshes.emplace_back(testing::standing(lines), kRayEpsilon, width);
        int beside = 0;
        for (int i = 0; i < 50; ++i) {
            const Point2 origin{place(random), place(random)};
            std::vector<Angle> headings;
            Directions directions;
            directions.resize(731);
            for (std::size_t k = 0; k < directions.size(); ++k) {
                headings.push_back(Angle::degrees(0.5 * static_cast<double>(k) + 0.01 * i));
                const Vec2 direction = unitVector(headings.back());
                directions.set(k, {direction.x, direction.y, 0});
            }
            std::vector<std::vector<float>> all(1 + meshes.size(),
                                                std::vector<float>(directions.size()));
            slice.cast({origin.x, origin.y, 0.15}, directions, 2 * size, all[0]);
            for (std::size_t m = 0; m < meshes.size(); ++m)
                meshes[m].cast({origin.x, origin.y, 0.15}, directions, 2 * size, {all[m + 1], {}});
            for (const std::vector<float>& ranges : all) {
                for (std::size_t k = 0; k < directions.size(); ++k) {
                    const double exact = bruteForce(lines, origin, headings[k]);
                    if (ranges[k] == exact || std::fabs(ranges[k] - exact) < 1e-6 * size) continue;
                    // Past an end or along a line a hair of direction is much in range.
                    ++beside;
                    const Angle hair = Angle::radians(2e-6);
                    const double left = bruteForce(lines, origin, headings[k] + hair);
                    const double right = bruteForce(lines, origin, headings[k] - hair);
                    EXPECT_GE(ranges[k], std::min({left, exact, right}) - 1e-6 * size);
                    EXPECT_LE(ranges[k], std::max({left, exact, right}) + 1e-6 * size);
                }
            }
        }
        EXPECT_LT(beside, 5 * 50 * 731 / 500) << size;
    }
}

TEST(RayWorld, GazesAgreeWithExactPredicatesAtEveryWidth) {
    std::mt19937_64 random(12);
    const std::vector<Segment2> lines = tangle(random, 100, 10);
    std::vector<EmbreeScene> worlds;
    for (const int width : testing::kWidths)
        worlds.emplace_back(testing::standing(lines), kRayEpsilon, width);
    std::uniform_real_distribution<double> place(0, 10);
    for (int i = 0; i < 50; ++i) {
        const Point2 origin{place(random), place(random)};
        std::vector<Point3> targets;
        targets.reserve(301);
        for (int k = 0; k < 301; ++k) targets.push_back({place(random), place(random), 0.15});
        for (const EmbreeScene& world : worlds) {
            std::vector<std::uint8_t> seen(targets.size(), 7);
            world.query({origin.x, origin.y, 0.15}, targets, seen);
            for (std::size_t k = 0; k < targets.size(); ++k) {
                const bool free = std::none_of(lines.begin(), lines.end(), [&](const Segment2& s) {
                    return intersects(s, {origin, targets[k].onFloor()});
                });
                EXPECT_EQ(seen[k] == 1, free) << i << ' ' << k;
            }
        }
    }
}

TEST(RayWorld, SightIsSymmetric) {
    std::mt19937_64 random(13);
    const EmbreeScene world(testing::standing(tangle(random, 100, 10)), kRayEpsilon, 0);
    std::uniform_real_distribution<double> place(0, 10);
    const auto sees = [&](Point2 from, Point2 to) {
        std::uint8_t seen = 7;
        const Point3 target{to.x, to.y, 0.15};
        world.query({from.x, from.y, 0.15}, {&target, 1}, {&seen, 1});
        return seen;
    };
    for (int i = 0; i < 5000; ++i) {
        const Point2 a{place(random), place(random)}, b{place(random), place(random)};
        EXPECT_EQ(sees(a, b), sees(b, a));
    }
}

TEST(RayWorld, SeveralThreadsShareAWorld) {
    std::mt19937_64 random(14);
    const std::vector<Segment2> lines = tangle(random, 2000, 10);
    const RayWorld world = RayWorld::ofSlice({.sheets = lines, .solids = {}});
    const EmbreeScene mesh(testing::standing(lines), kRayEpsilon, 0);
    Directions directions;
    directions.resize(2000);
    for (std::size_t k = 0; k < directions.size(); ++k) {
        const Vec2 direction = unitVector(Angle::degrees(0.18 * static_cast<double>(k)));
        directions.set(k, {direction.x, direction.y, 0});
    }
    std::vector<Point3> targets;
    targets.reserve(directions.size());
    for (std::size_t k = 0; k < directions.size(); ++k)
        targets.push_back(Point3{5, 5, 0.15} + 3 * directions[k]);
    std::vector<std::vector<float>> found(4, std::vector<float>(directions.size()));
    std::vector<std::vector<std::uint8_t>> seen(4, std::vector<std::uint8_t>(targets.size(), 7));
    std::vector<std::thread> threads;
    threads.reserve(found.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        threads.emplace_back([&, i] {
            mesh.query({5, 5, 0.15}, targets, seen[i]);
            world.cast({5, 5, 0.15}, directions, 20, found[i]);
        });
    for (std::thread& thread : threads) thread.join();
    for (const auto& flags : seen) EXPECT_EQ(flags, seen.front());
    // The point is seen if no earlier hit lies on the way.
    for (std::size_t k = 0; k < targets.size(); ++k)
        if (std::fabs(found.front()[k] - 3) > 2e-4) {
            EXPECT_EQ(seen.front()[k] == 1, found.front()[k] > 3) << k;
        }
    for (const auto& ranges : found) EXPECT_EQ(ranges, found.front());
    // A world built again, and moved, answers the same.
    RayWorld again = RayWorld::ofSlice({.sheets = lines, .solids = {}});
    const RayWorld moved_world = std::move(again);
    moved_world.cast({5, 5, 0.15}, directions, 20, found.back());
    EXPECT_EQ(found.back(), found.front());
}

}  // namespace ray_world_tangle_test

}  // namespace ispace
