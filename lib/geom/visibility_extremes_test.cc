// SPDX-License-Identifier: GPL-3.0-or-later
// Far, tiny, crowded and endless: what nobody draws.
#include "geom/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "geom/test_curves.h"
#include "geom/test_visibility.h"
#include "geom/visibility_test_plans.h"

namespace ispace {
namespace {

using std::numbers::pi;
using test::areaByRays;
using test::areaSeen;
using test::box;
using test::edgesOf;
using test::expectSound;
using test::kInfinity;
using test::nearest;
using test::query;

TEST(Visibility, FarFromTheOrigin) {
    // A room at 10 000 km, where a double is 2 nm.
    const std::vector<Segment2> room = edgesOf(box(1e7, -1e7, 1e7 + 4, -1e7 + 3));
    const VisibilityMap map(room);
    EXPECT_NEAR(area(map.query({1e7 + 1, -1e7 + 1}, kInfinity)), 12, 1e-12);
    EXPECT_NEAR(area(map.query({1e7 + 2, -1e7 + 1.5}, 1)), pi, 1e-8);
    EXPECT_NEAR(area(map.query({1e7, -1e7 + 1.5}, 1)), pi, 1e-8);
    expectSound(map.query({1e7 + 1, -1e7 + 1}, 2), 1e-8);
}

TEST(Visibility, TinyRooms) {
    const double side = 1e-3;
    const std::vector<Segment2> room = edgesOf(box(0, 0, side, side));
    EXPECT_NEAR(areaSeen(room, {0.4e-3, 0.3e-3}, kInfinity) / (side * side), 1, 1e-12);
    // Within contact of all of its walls there is nothing in the way.
    EXPECT_NEAR(areaSeen(edgesOf(box(0, 0, 1e-6, 1e-6)), {3e-7, 4e-7}, 1), pi, 1e-9);
}

TEST(Visibility, EveryFiniteNumberHasAnAnswer) {
    std::vector<double> numbers{0, 1, -1, 4, 1e-300, -1e-300, 5e-324, 1e-17, 1e7, -1e15};
    for (const double huge : {1e50, 1e100, 1e300, std::numeric_limits<double>::max()}) {
        numbers.push_back(huge);
        numbers.push_back(-huge);
    }
    std::mt19937_64 random(18);
    const auto any = [&] { return numbers[random() % numbers.size()]; };
    for (int round = 0; round < 60; ++round) {
        std::vector<Segment2> lines = edgesOf(box(0, 0, 4, 4));
        for (int i = 0; i < round % 6; ++i) {
            const Point2 from{any(), any()};
            lines.push_back({from, {any(), any()}});
        }
        const VisibilityMap map(lines);
        for (int i = 0; i < 100; ++i) {
            const Point2 p{any(), any()};
            const double range = i % 5 == 0 ? kInfinity : std::abs(any());
            const double seen = area(map.query(p, range));
            EXPECT_TRUE(std::isfinite(seen) && seen >= 0)
                << p.x << ',' << p.y << ' ' << range << " sees " << seen;
        }
    }
}

TEST(Visibility, HeapsOfCollinearAndTouchingLines) {
    std::mt19937_64 random(19);
    for (int round = 0; round < 40; ++round) {
        std::vector<Segment2> lines;
        const auto any = [&] { return static_cast<double>(random() % 5); };
        for (int i = 0; i < 25; ++i) {
            const Point2 from{any(), any()};
            lines.push_back({from, {any(), any()}});
        }
        const VisibilityMap map(lines);
        for (int i = 0; i < 40; ++i) {
            const Point2 p =
                i % 2 == 0 ? Point2{any(), any()} : Point2{any() + any() / 8, any() + any() / 16};
            for (const double range : {0.7, 3.0}) expectSound(map.query(p, range), 1e-7);
            if (nearest(lines, p) > kRayEpsilon) {
                EXPECT_NEAR(area(map.query(p, 3)), areaByRays(lines, p, 3, 3000), 0.15)
                    << "round " << round << " from " << p.x << ',' << p.y;
            }
        }
    }
}

TEST(Visibility, DeepCombs) {
    // A comb of 20 000 teeth, seen along its whole length: all of them wait at once.
    std::vector<Segment2> lines;
    constexpr int kTeeth = 20'000;
    for (int i = 0; i < kTeeth; ++i)
        lines.push_back({{double(i), 1}, {i + 0.5, 1 + 1.0 * (1 + i % 3)}});
    const VisibilityMap map(lines);
    for (const Point2 p : {Point2{-5, 0}, Point2{kTeeth / 2.0, -3000}}) {
        const VisibleRegion region = map.query(p, 1e5);
        EXPECT_GT(region.edges.size(), 1000U);
        expectSound(region);
    }
}

TEST(Visibility, LinesThatCrossByTheMillionAreRefused) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 1100; ++i) {
        lines.push_back({{0, double(i)}, {2000, i + 0.3}});
        lines.push_back({{double(i), -1}, {i + 0.2, 2000}});
    }
    EXPECT_THROW(VisibilityMap{lines}, FormatError);
}

TEST(Visibility, RegionsAreUsedAgain) {
    const std::vector<Segment2> room = edgesOf(box(0, 0, 4, 4));
    const VisibilityMap map(room);
    VisibleRegion region = map.query({1, 1}, 2);
    const SightEdge* const memory = region.edges.data();
    map.query({2, 2}, kInfinity, region);
    EXPECT_EQ(region.edges.data(), memory);
    EXPECT_DOUBLE_EQ(area(region), 16);
    map.query({0, 0}, 1, region);
    EXPECT_NEAR(area(region), pi, 1e-12);
}

}  // namespace
}  // namespace ispace
