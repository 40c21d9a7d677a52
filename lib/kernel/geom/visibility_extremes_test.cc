// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes beyond any drawing: far, tiny, crowded, unbounded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility.h"
#include "support/test_curves.h"
#include "support/test_plans.h"
#include "support/test_visibility.h"

namespace ispace {
namespace visibility_extremes_test {

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

TEST(Visibility, ManyCollinearAndTouchingLines) {
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
    const VisibilityEdge* const memory = region.edges.data();
    map.query({2, 2}, kInfinity, region);
    EXPECT_EQ(region.edges.data(), memory);
    EXPECT_DOUBLE_EQ(area(region), 16);
    map.query({0, 0}, 1, region);
    EXPECT_NEAR(area(region), pi, 1e-12);
}

TEST(VisibilityBreadth, MoreWindowsThanFitAtFirst) {
    Polygon round;
    constexpr int kCorners = 3000;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * std::numbers::pi * i / kCorners;
        round.push_back({10 * std::cos(angle), 10 * std::sin(angle)});
    }
    const VisibilityMap map(test::linesOf({round, {}}));
    const double wanted = kCorners / 2.0 * 100 * std::sin(2 * std::numbers::pi / kCorners);
    std::mt19937_64 random(1);
    for (int i = 0; i < 20; ++i) {
        const VisibleRegion region =
            map.query(test::randomIn(random, {{-7, -7}, {7, 7}}), kInfinity);
        EXPECT_NEAR(area(region), wanted, 1e-9 * wanted);
        EXPECT_EQ(region.edges.size(), std::size_t{kCorners});
    }
}

TEST(VisibilityBreadth, SameAsOneWayAfterTheOther) {
    const std::vector<Segment2> lines = test::linesOf(test::makePlan(1, {5, 5, 82, 14, 195}));
    const VisibilityMap map(lines);
    std::mt19937_64 random(2);
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point2 p = test::randomIn(random, test::boxOf(lines));
        const VisibleRegion in_turn = map.query(p, kInfinity);
        // A range that ends beyond all that is seen, but not beyond all lines.
        double farthest = 0;
        for (const VisibilityEdge& end : in_turn.edges)
            farthest = std::max({farthest, distance(p, end.from), distance(p, end.to)});
        const VisibleRegion bounded = map.query(p, 1.001 * farthest);
        if (farthest > 25) continue;
        ++compared;
        ASSERT_EQ(in_turn.edges.size(), bounded.edges.size());
        for (std::size_t k = 0; k < in_turn.edges.size(); ++k) {
            const VisibilityEdge &a = in_turn.edges[k], &b = bounded.edges[k];
            EXPECT_TRUE(a.from == b.from && a.to == b.to && a.line == b.line) << i << ' ' << k;
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST(SectorOf, SectorAndTheRestAreTheWholeOnAGrid) {
    std::mt19937_64 random(11);
    const auto whole = [&random](int low, int high) {
        return static_cast<double>(std::uniform_int_distribution<int>(low, high)(random));
    };
    for (int plan = 0; plan < 300; ++plan) {
        std::vector<Segment2> lines;
        for (int i = 0; i < 6; ++i)
            lines.push_back({{whole(-4, 4), whole(-4, 4)}, {whole(-4, 4), whole(-4, 4)}});
        const VisibilityMap map(lines);
        for (int trial = 0; trial < 40; ++trial) {
            const VisibleRegion seen =
                map.query({whole(-4, 4), whole(-4, 4)}, trial % 2 == 0 ? 5 : 0.5);
            const Angle first = Angle::degrees(15 * whole(-24, 24));
            const Angle span = Angle::degrees(15 * whole(1, 23));
            const VisibleRegion sector = sectorOf(seen, first, span);
            const VisibleRegion rest = sectorOf(seen, first + span, Angle::degrees(360) - span);
            ASSERT_NEAR(area(sector) + area(rest), area(seen), 1e-9)
                << plan << ' ' << trial << ' ' << first.degrees() << ' ' << span.degrees();
            ASSERT_NEAR(signedArea(outlineOf(sector)), area(sector), 1e-9);
        }
    }
}

TEST(SectorOf, SidesAlongALineOfSight) {
    // The sector begins in the direction of the wall's end, which rounds to either side of it.
    const std::vector<Segment2> wall = {{{-1, 3}, {0, 1}}};
    const VisibleRegion seen = VisibilityMap(wall).query({-2, 2}, 3);
    double before = 0;
    for (const double first : {44.9, 44.9999999, 45.0, 45.0000001, 45.1}) {
        const double now = area(sectorOf(seen, Angle::degrees(first), Angle::degrees(135)));
        EXPECT_GT(now, 10) << first;
        EXPECT_NEAR(now, before > 0 ? before : now, 0.05);
        before = now;
    }
}

}  // namespace visibility_extremes_test
}  // namespace ispace
