// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/predicates.h"
#include "support/test_curves.h"

namespace ispace {

namespace curve_test {

using std::numbers::pi;

Point2 onCircle(Point2 center, double radius, double degrees) {
    return center + radius * unitVector(Angle::degrees(degrees));
}

/// From one direction to another, counter-clockwise if the second is greater.
CurveEdge arc(Point2 center, double radius, double from, double to) {
    return {onCircle(center, radius, from), onCircle(center, radius, to),
            to > from ? radius : -radius, center};
}

/// A disc in unequal parts, with extremes within them.
Curve unevenDisc(Point2 center, double radius) {
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
    EXPECT_NEAR(signedArea(unevenDisc(center, 2)), 4 * pi, 1e-13);
    EXPECT_NEAR(perimeter(unevenDisc(center, 2)), 4 * pi, 1e-13);

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
    const Box2 box = bounds(unevenDisc({3, -2}, 2));
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
                const double gap = 2.5 - distance(center, Segment2{polygon[k], polygon[k + 1]});
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
    const Polygon polygon = chords(unevenDisc({0, 0}, 1), 1e-4);
    forEachEdge(polygon, [](const Segment2& edge) { EXPECT_GT(distance(edge.a, edge.b), 1e-3); });
    EXPECT_TRUE(isStrictlyConvex(polygon));
}

}  // namespace curve_test

namespace curve_test {

TEST(Ellipse, OutlineHasItsArea) {
    for (const double radius : {1e-5, 0.001, 0.05, 0.45, 1.0, 5.0, 250.0}) {
        const Ellipse circle({3, 4}, 2 * radius, 2 * radius, Angle::degrees(17));
        const double area = std::numbers::pi * radius * radius;
        EXPECT_NEAR(signedArea(outlineOf(circle)), area, 1e-12 * (1 + area)) << radius;
        const Ellipse flat({3, 4}, 2 * radius, 0.6 * radius, Angle::degrees(17));
        EXPECT_NEAR(signedArea(outlineOf(flat)), 0.3 * area, 1e-12 * (1 + area)) << radius;
        EXPECT_DOUBLE_EQ(flat.area(), 0.3 * area);
    }
}

TEST(Ellipse, InscribedPolygonHasTheBoxOfTheCurve) {
    const Ellipse flat({0, 0}, 4, 1, {});
    const Box2 box = bounds(inscribedIn(flat));
    EXPECT_EQ(box.low, (Point2{-2, -0.5}));
    EXPECT_EQ(box.high, (Point2{2, 0.5}));
}

TEST(Ellipse, OutlineStaysWithinTolerance) {
    for (const double radius : {1e-5, 0.001, 0.05, 0.45, 5.0, 250.0}) {
        const Ellipse circle({3, 4}, 2 * radius, 2 * radius, Angle::degrees(17));
        double outside = 0, inside = 0;
        forEachEdge(outlineOf(circle), [&](const Segment2& edge) {
            const Point2 middle = edge.a + 0.5 * (edge.b - edge.a);
            outside = std::max(outside, distance(edge.a, Point2{3, 4}) - radius);
            inside = std::max(inside, radius - distance(middle, Point2{3, 4}));
        });
        EXPECT_GT(outside, 0);
        EXPECT_GT(inside, 0);
        EXPECT_LE(outside, kCurveTolerance) << radius;
        EXPECT_LE(inside, kCurveTolerance) << radius;
    }
}

TEST(Ellipse, OutlineFromAnywhereHasItsAreaAndIsConvex) {
    std::mt19937_64 random(40);
    std::uniform_real_distribution<double> place(-4, 4), size(0.02, 2), turn(0, 360);
    for (int i = 0; i < 2000; ++i) {
        const Ellipse shape({place(random), place(random)}, size(random), size(random),
                            Angle::degrees(turn(random)));
        const Point2 v{place(random), place(random)};
        const Polygon outline = outlineFrom(shape, v);
        EXPECT_TRUE(isConvex(outline)) << i;
        EXPECT_NEAR(signedArea(outline), shape.area(), 1e-12) << i;
        if (shape.heightOf(v) < 0.001) continue;
        // It is seen between the tangents, and where they touch.
        const auto [right, left] = touchedFrom(shape, v);
        const Point2 r = placeOn(shape, right), l = placeOn(shape, left);
        EXPECT_NEAR(cross(r - v, shape.fromUnit({-std::sin(right), std::cos(right)})), 0, 1e-9);
        EXPECT_GT(cross(r - v, l - v), 0);
        for (const Point2 p : outline) {
            EXPECT_GE(cross(r - v, p - v), -1e-12) << i;
            EXPECT_GE(cross(p - v, l - v), -1e-12) << i;
        }
    }
}

TEST(Ellipse, GrownOutlineHoldsIt) {
    const Ellipse shape({1, -2}, 3, 0.4, Angle::degrees(31));
    const Polygon outline = inscribedIn(shape);
    const double growth = growthAround(outline.size());
    const auto grown = [&](Point2 p) { return shape.center + growth * (p - shape.center); };
    forEachEdge(outline, [&](const Segment2& edge) {
        const Point2 a = grown(edge.a), b = grown(edge.b), middle = a + 0.5 * (b - a);
        EXPECT_NEAR(length(shape.toUnit(middle - shape.center)), 1, 1e-12);
    });
}

TEST(Ellipse, TellsHowFarPointsLieOutside) {
    const Ellipse circle({1, 2}, 1, 1, {});
    EXPECT_NEAR(circle.heightOf({1, 3}), 0.5, 1e-12);
    EXPECT_NEAR(circle.heightOf({1.2, 2}), -0.3, 1e-12);
    EXPECT_NEAR(circle.heightOf({1, 2}), -0.5, 1e-12);
    const Ellipse flat({0, 0}, 4, 1, Angle::degrees(90));
    EXPECT_NEAR(flat.heightOf({0, 2.001}), 0.001, 1e-5);
    EXPECT_NEAR(flat.heightOf({-0.499, 0}), -0.001, 1e-5);
    EXPECT_NEAR(flat.box().high.x, 0.5, 1e-12);
    EXPECT_NEAR(flat.box().high.y, 2, 1e-12);
}

}  // namespace curve_test

}  // namespace ispace
