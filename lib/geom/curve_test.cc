// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/predicates.h"
#include "geom/test_curves.h"

namespace ispace {
namespace {

using std::numbers::pi;

Point2 onCircle(Point2 center, double radius, double degrees) {
    return center + radius * unitVector(Angle::degrees(degrees));
}

/// From one direction to another, counter-clockwise if the second is greater.
CurveEdge arc(Point2 center, double radius, double from, double to) {
    return {onCircle(center, radius, from), onCircle(center, radius, to),
            to > from ? radius : -radius, center};
}

Curve disc(Point2 center, double radius) {
    return {arc(center, radius, 0, 90), arc(center, radius, 90, 240),
            arc(center, radius, 240, 360)};
}

TEST(Curve, StraightCurvesAreWhatTheirPolygonsAre) {
    std::mt19937_64 random(1);
    const Polygon polygon = test::star(random, 40, 7);
    const Curve curve = curveOf(polygon);
    EXPECT_NEAR(signedArea(curve), signedArea(polygon), 1e-12);
    EXPECT_NEAR(perimeter(curve), perimeter(polygon), 1e-12);
    EXPECT_EQ(bounds(curve), bounds(polygon));
    EXPECT_EQ(chords(curve), polygon);
    EXPECT_EQ(signedArea(Curve()), 0);
    EXPECT_EQ(chords(Curve()), Polygon());
    EXPECT_TRUE(bounds(Curve()).empty());
}

TEST(Curve, RegionsKeepTheirHoles) {
    const Region region{test::box(0, 0, 4, 3), {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
    const std::vector<Curve> curves = curvesWithArcs(region);
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_DOUBLE_EQ(signedArea(curves), 11);
    EXPECT_DOUBLE_EQ(perimeter(curves), 18);
}

TEST(Curve, DiscsSectorsAndLenses) {
    const Point2 center{3, -2};
    EXPECT_NEAR(signedArea(disc(center, 2)), 4 * pi, 1e-13);
    EXPECT_NEAR(perimeter(disc(center, 2)), 4 * pi, 1e-13);

    const CurveEdge third = arc(center, 2, 10, 130);
    const Curve sector{{center, third.from}, third, {third.to, center}};
    EXPECT_NEAR(signedArea(sector), 4 * pi / 3, 1e-13);
    EXPECT_NEAR(perimeter(sector), 4 + 4 * pi / 3, 1e-13);

    // The same backwards.
    const CurveEdge back{third.to, third.from, -2, center};
    EXPECT_NEAR(signedArea(Curve{{third.from, center}, {center, third.to}, back}), -4 * pi / 3,
                1e-13);

    const Curve half{arc(center, 2, 30, 210), {onCircle(center, 2, 210), onCircle(center, 2, 30)}};
    EXPECT_NEAR(signedArea(half), 2 * pi, 1e-13);
    EXPECT_NEAR(perimeter(half), 2 * pi + 4, 1e-13);

    // Two arcs that meet at their ends: the lens of two circles of radius 1, a metre apart.
    const Curve lens{arc({0, 0}, 1, -60, 60), arc({1, 0}, 1, 120, 240)};
    EXPECT_NEAR(signedArea(lens), 2 * pi / 3 - std::sqrt(3) / 2, 1e-14);

    // A square with a bite taken out by a clockwise arc.
    const Curve bitten{{{0, 0}, {4, 0}}, {{4, 0}, {4, 1}}, arc({4, 2}, 1, 270, 90),
                       {{4, 3}, {4, 4}}, {{4, 4}, {0, 4}}, {{0, 4}, {0, 0}}};
    EXPECT_NEAR(signedArea(bitten), 16 - pi / 2, 1e-13);
}

TEST(Curve, ShallowArcsKeepTheirDigits) {
    // r^2 (a - sin a) / 2, whose leading term is r^2 a^3 / 12.
    const double radius = 1e3, angle = 1e-4;
    const Point2 from{radius, 0};
    const Point2 to{radius * std::cos(angle), radius * std::sin(angle)};
    const Curve sliver{{from, to, radius, {0, 0}}, {to, from}};
    const double wanted = radius * radius * angle * angle * angle / 12;
    EXPECT_NEAR(signedArea(sliver) / wanted, 1, 2e-9);
}

TEST(Curve, BoundsHoldTheArcs) {
    const Box2 box = bounds(disc({3, -2}, 2));
    EXPECT_NEAR(box.low.x, 1, 1e-12);
    EXPECT_NEAR(box.low.y, -4, 1e-12);
    EXPECT_NEAR(box.high.x, 5, 1e-12);
    EXPECT_NEAR(box.high.y, 0, 1e-12);

    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> start(-180, 180), span(-179, 179);
    for (int i = 0; i < 300; ++i) {
        const double from = start(random);
        const CurveEdge edge = arc({1, 2}, 3, from, from + span(random));
        const Curve curve{edge, {edge.to, edge.from}};
        const Box2 held = bounds(curve);
        for (const Point2 p : chords(curve, 1e-4)) {
            EXPECT_TRUE(held.low.x <= p.x && p.x <= held.high.x);
            EXPECT_TRUE(held.low.y <= p.y && p.y <= held.high.y);
        }
        // Not much wider than it must be.
        const Box2 tight = bounds(chords(curve, 1e-4));
        EXPECT_NEAR(held.width(), tight.width(), 1e-3);
        EXPECT_NEAR(held.depth(), tight.depth(), 1e-3);
    }
}

TEST(Curve, ChordsKeepToTheirArcs) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> start(-180, 180), span(-180, 180);
    for (const double error : {1e-1, 1e-3, 1e-5}) {
        for (int i = 0; i < 30; ++i) {
            const double from = start(random);
            const Point2 center{4, -1};
            const CurveEdge edge = arc(center, 2.5, from, from + span(random));
            const Curve curve{edge, {edge.to, edge.from}};
            const Polygon polygon = chords(curve, error);
            EXPECT_EQ(polygon[0], edge.from);
            EXPECT_EQ(polygon.back(), edge.to);
            double farthest = 0;
            for (std::size_t k = 0; k + 1 < polygon.size(); ++k) {
                EXPECT_NEAR(distance(center, polygon[k]), 2.5, 1e-12);
                const double gap = 2.5 - distance(center, {polygon[k], polygon[k + 1]});
                EXPECT_LE(gap, error * (1 + 1e-6));
                farthest = std::max(farthest, gap);
            }
            // And no more of them than it takes.
            if (polygon.size() > 6) {
                EXPECT_GE(farthest, error / 2);
            }
            EXPECT_NEAR(signedArea(polygon), signedArea(curve), error * perimeter(curve));
        }
    }
}

TEST(Curve, ChordsOfDiscsHaveNoDoubledVertices) {
    const Polygon polygon = chords(disc({0, 0}, 1), 1e-4);
    forEachEdge(polygon, [](const Segment2& edge) { EXPECT_GT(distance(edge.a, edge.b), 1e-3); });
    EXPECT_TRUE(isStrictlyConvex(polygon));
}

}  // namespace
}  // namespace ispace
