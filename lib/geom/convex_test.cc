// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/convex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "geom/boolean.h"
#include "geom/ellipse.h"

namespace ispace {
namespace {

double reachOf(const Polygon& polygon, Vec2 direction) {
    double most = -std::numeric_limits<double>::infinity();
    for (const Point2 p : polygon) most = std::max(most, dot(p - Point2(), direction));
    return most;
}

Vec2 towards(double angle) { return {std::cos(angle), std::sin(angle)}; }

Polygon round(Point2 center, double length, double width, double heading) {
    return inscribedIn(Ellipse(center, length, width, Angle::radians(heading)));
}

TEST(ConvexPair, ReachesAsFarAsTheFurthestCorner) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 60; ++k) {
        const double scale = std::pow(10, 4 * uniform(random));
        const Polygon polygon = round({scale * uniform(random), 3 * scale}, scale,
                                      scale * std::pow(10, -2 + 2 * uniform(random)), k);
        Caliper turning(polygon), jumping(polygon), back(polygon);
        for (int i = 0; i < 200; ++i) {
            const double turn = i * std::numbers::pi / 100;
            for (const auto& [caliper, angle] :
                 {std::pair(&turning, turn), {&back, -turn}, {&jumping, 9 * uniform(random)}})
                EXPECT_NEAR(caliper->reach(towards(angle)), reachOf(polygon, towards(angle)),
                            1e-13 * scale);
        }
    }
}

TEST(ConvexPair, ReachesOverDoubledAndStraightCorners) {
    const Polygon polygon{{0, 0}, {0, 0}, {1, 0}, {2, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}};
    const Polygon line{{0, 0}, {3, 1}};
    for (const Polygon& shape : {polygon, line, Polygon{{1, 2}}}) {
        Caliper caliper(shape);
        for (int i = 0; i < 50; ++i)
            EXPECT_NEAR(caliper.reach(towards(i)), reachOf(shape, towards(i)), 1e-15) << i;
        Caliper axes(shape);
        for (const Vec2 axis : {Vec2{0, -1}, {1, 0}, {0, 1}, {-1, 0}, {1, 0}})
            EXPECT_EQ(axes.reach(axis), reachOf(shape, axis));
    }
}

TEST(ConvexPair, SharesWhatTheOverlayShares) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int k = 0; k < 100; ++k) {
        const Polygon a =
            round({uniform(random), uniform(random)}, 1.5, 1 + 0.4 * uniform(random), k);
        const Polygon b =
            k % 2 == 0 ? round({uniform(random), uniform(random)}, 2, 0.3, 7 * uniform(random))
                       : Polygon{{-1, -1}, {0.4 * uniform(random), -0.8}, {1, 1}, {-1, 1}};
        const Polygon shared = sharedByConvex(a, b);
        const Polygon both[] = {a, b};
        const double wanted = signedArea(a) + signedArea(b) - totalArea(unite(both));
        EXPECT_NEAR(shared.empty() ? 0 : signedArea(shared), wanted, 1e-9) << k;
    }
    const Polygon square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    EXPECT_EQ(signedArea(sharedByConvex(square, square)), 1);
    EXPECT_TRUE(sharedByConvex(square, {{5, 5}, {6, 5}, {6, 6}}).empty());
    EXPECT_TRUE(sharedByConvex({}, square).empty());
}

// 220 000 corners each, of which each crosses one of the other: quadratic time would be an hour.
TEST(ConvexPair, ManyCorners) {
    const Polygon a = round({0, 0}, 1e6, 1e6, 0), b = round({1e5, 0}, 1e6, 1e6, 0.1);
    ASSERT_GT(a.size(), 200'000U);
    const double r = 5e5, d = 1e5;
    const double lens = 2 * r * r * std::acos(d / (2 * r)) - d / 2 * std::sqrt(4 * r * r - d * d);
    EXPECT_NEAR(signedArea(sharedByConvex(a, b)) / lens, 1, 1e-9);
}

}  // namespace
}  // namespace ispace
