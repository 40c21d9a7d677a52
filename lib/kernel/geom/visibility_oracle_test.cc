// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/test_plans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "geom/predicates.h"
#include "geom/visibility/visibility.h"
#include "support/test_curves.h"

namespace ispace {
namespace visibility_oracle_test {

using test::VisibilityOracle;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The lines and the box of the oracle, so that sight is free nowhere.
std::vector<Segment2> boxed(std::vector<Segment2> lines) {
    const Box2 box = test::boxOf(lines);
    for (const Segment2& side :
         test::edgesOf(test::box(box.low.x - 10, box.low.y - 10, box.high.x + 10, box.high.y + 10)))
        lines.push_back(side);
    return lines;
}

struct Case {
    std::uint64_t seed;
    test::PlanSize size;
    int looks;
};

const Case kCases[] = {{1, {1, 1, 4, 4, 4}, 1000},   {2, {2, 2, 9, 12, 40}, 500},
                       {3, {3, 1, 6, 5, 60}, 500},   {4, {1, 1, 0, 0, 80}, 500},
                       {5, {2, 3, 54, 8, 100}, 300}, {6, {5, 5, 82, 14, 200}, 200}};

TEST(VisibilityOracle, FromRandomPlaces) {
    for (const Case& c : kCases) {
        const std::vector<Segment2> lines = test::linesOf(test::makePlan(c.seed, c.size));
        const VisibilityOracle oracle(lines);
        const VisibilityMap map(boxed(lines));
        std::mt19937_64 random(c.seed);
        const Box2 box = test::boxOf(lines);
        for (int i = 0; i < c.looks; ++i) {
            const Point2 p = test::randomIn(random, box);
            const double wanted = oracle.areaFrom(p);
            EXPECT_NEAR(area(map.query(p, kInfinity)), wanted, 1e-9 * wanted)
                << "plan " << c.seed << " from " << p.x << ", " << p.y;
        }
    }
}

TEST(VisibilityOracle, FromVertices) {
    for (const Case& c : kCases) {
        const std::vector<Segment2> lines = test::linesOf(test::makePlan(c.seed, c.size));
        const VisibilityOracle oracle(lines);
        const VisibilityMap map(boxed(lines));
        const std::size_t step = 1 + lines.size() / 40;
        for (std::size_t i = 0; i < lines.size(); i += step) {
            const Point2 p = lines[i].a;
            const double wanted = oracle.areaFrom(p);
            const VisibleRegion region = map.query(p, kInfinity);
            EXPECT_EQ(region.viewpoint, p);
            EXPECT_NEAR(area(region), wanted, 1e-9 * wanted)
                << "plan " << c.seed << " from vertex " << i;
        }
    }
}

TEST(VisibilityOracle, FromWalls) {
    for (const Case& c : kCases) {
        const std::vector<Segment2> lines = test::linesOf(test::makePlan(c.seed, c.size));
        const VisibilityOracle oracle(lines);
        const VisibilityMap map(boxed(lines));
        const std::size_t step = 1 + lines.size() / 40;
        for (std::size_t i = 0; i < lines.size(); i += step) {
            Point2 p;
            const double wanted = oracle.areaFrom(lines[i], 1 + static_cast<int>(i) % 7, p);
            EXPECT_NEAR(area(map.query(p, kInfinity)), wanted, 1e-9 * wanted)
                << "plan " << c.seed << " from wall " << i;
        }
    }
}

TEST(VisibilityOracle, CrossingLines) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(0, 10), way(-3, 3);
    for (int round = 0; round < 5; ++round) {
        std::vector<Segment2> lines;
        for (int i = 0; i < 30; ++i) {
            const Point2 from{place(random), place(random)};
            lines.push_back({from, from + Vec2{way(random), way(random)}});
        }
        const VisibilityOracle oracle(lines);
        const VisibilityMap map(boxed(lines));
        for (int i = 0; i < 60; ++i) {
            const Point2 p{place(random), place(random)};
            const auto touches = [p](const Segment2& line) {
                return distance(p, line) <= kRayEpsilon;
            };
            if (std::any_of(lines.begin(), lines.end(), touches)) continue;
            const double wanted = oracle.areaFrom(p);
            EXPECT_NEAR(area(map.query(p, kInfinity)), wanted, 1e-9 * wanted) << "round " << round;
        }
    }
}

}  // namespace visibility_oracle_test
}  // namespace ispace
