// SPDX-License-Identifier: GPL-3.0-or-later
// Plans of so many triangles that windows go on in turn.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "geom/visibility.h"
#include "geom/visibility_test_plans.h"

namespace ispace {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
        for (const SightEdge& end : in_turn.edges)
            farthest = std::max({farthest, distance(p, end.from), distance(p, end.to)});
        const VisibleRegion bounded = map.query(p, 1.001 * farthest);
        if (farthest > 25) continue;
        ++compared;
        ASSERT_EQ(in_turn.edges.size(), bounded.edges.size());
        for (std::size_t k = 0; k < in_turn.edges.size(); ++k) {
            const SightEdge &a = in_turn.edges[k], &b = bounded.edges[k];
            EXPECT_TRUE(a.from == b.from && a.to == b.to && a.line == b.line) << i << ' ' << k;
        }
    }
    EXPECT_GT(compared, 1000);
}

}  // namespace
}  // namespace ispace
