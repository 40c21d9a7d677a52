// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/ellipse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "geom/ellipse_arcs.h"

namespace ispace {
namespace {

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
            outside = std::max(outside, distance(edge.a, {3, 4}) - radius);
            inside = std::max(inside, radius - distance(middle, {3, 4}));
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

}  // namespace
}  // namespace ispace
