// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve_clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "geom/overlay/overlay.h"
#include "support/test_overlay.h"

namespace ispace {
namespace curve_clip_test {

Curve circleOf(Point2 center, double radius) {
    const Point2 east = center + Vec2{std::abs(radius), 0};
    const Point2 west = center - Vec2{std::abs(radius), 0};
    return {{east, west, radius, center}, {west, east, radius, center}};
}

TEST(CutAlong, leavesCurvesWithinTheBoxAlone) {
    const std::vector<Curve> curves = {curveOf(test::box(0, 0, 2, 2)), circleOf({1, 1}, -0.5)};
    const CutCurves cut = cutAlong(curves, {{0, 0}, {2, 2}});
    EXPECT_EQ(cut.inside, curves);
    EXPECT_TRUE(cut.outside.empty());
}

TEST(CutAlong, halvesAndQuartersOfADisc) {
    const std::vector<Curve> curves = {circleOf({0, 0}, 3)};
    EXPECT_NEAR(signedArea(cutAlong(curves, {{0, -9}, {9, 9}}).inside), 4.5 * std::numbers::pi,
                1e-12);
    EXPECT_NEAR(signedArea(cutAlong(curves, {{0, 0}, {9, 9}}).inside), 2.25 * std::numbers::pi,
                1e-12);
    EXPECT_NEAR(signedArea(cutAlong(curves, {{-1, -1}, {1, 1}}).inside), 4, 1e-12);
    const CutCurves beside = cutAlong(curves, {{5, 5}, {9, 9}});
    EXPECT_NEAR(signedArea(beside.inside), 0, 1e-12);
    EXPECT_NEAR(signedArea(beside.outside), 9 * std::numbers::pi, 1e-12);
}

// A view through a door, to the end of a range that dwarfs the room.
TEST(CutAlong, farBeyondTheBox) {
    const double range = 1e6;
    const Point2 right{-3e5, -std::sqrt(range * range - 9e10)}, left{3e5, right.y};
    const std::vector<Curve> curves = {
        {{{0, 0}, right}, {right, left, range, {0, 0}}, {left, {0, 0}}}};
    const CutCurves cut = cutAlong(curves, {{-3, -2}, {3, 2}});
    EXPECT_NEAR(signedArea(cut.inside), 2 * 2 * 3e5 / -right.y, 1e-11);
    for (const CurveEdge& edge : cut.inside.front()) EXPECT_GE(edge.from.y, -2);
}

// Conics are followed by arcs, some of which are as short as rounding errors.
TEST(CutAlong, shortArcsOfLargeCirclesAreNoWholeTurns) {
    const double radius = 1e6, low = -0.5, high = 0.5;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> off(-1, 1);
    const auto at = [&](double angle) {
        return Point2{-radius, 0} + radius * Vec2{std::cos(angle), std::sin(angle)};
    };
    for (int round = 0; round < 200; ++round) {
        Curve curve = {{at(high / radius), {-3, 1}}, {{-3, 1}, {-3, -1}}};
        curve.push_back({{-3, -1}, at(low / radius)});
        Point2 from = curve.back().to;
        for (int i = 0; i < 40; ++i) {
            const double share = (i / 2 + 1) / 20.0 + (i % 2 == 0 ? 1e-15 * off(random) : 0);
            const Point2 to = i == 39 ? curve.front().from : at((low + share) / radius);
            if (to == from) continue;
            curve.push_back({from, to, radius, {-radius, 0}});
            from = to;
        }
        const std::vector<Curve> curves = {curve};
        const CutCurves cut = cutAlong(curves, {{-2, -0.3}, {2, 0.3}});
        EXPECT_NEAR(signedArea(cut.inside), 1.2, 1e-6) << round;
        EXPECT_NEAR(signedArea(cut.inside) + signedArea(cut.outside), signedArea(curves), 1e-6);
    }
}

TEST(CutAlong, partsAddUpAndAreThoseOfAnOverlay) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> at(-4, 4), size(0.3, 5);
    for (int round = 0; round < 400; ++round) {
        const Point2 center{at(random), at(random)};
        const double radius = size(random);
        const std::vector<Curve> curves = {circleOf(center, radius),
                                           circleOf(center, -0.4 * radius)};
        Box2 box;
        box.add({at(random), at(random)});
        box.add({at(random), at(random)});
        const CutCurves cut = cutAlong(curves, box);
        EXPECT_NEAR(signedArea(cut.inside) + signedArea(cut.outside), signedArea(curves), 1e-11);
        const Polygon window = test::box(box.low.x, box.low.y, box.high.x, box.high.y);
        const auto common = [&](const std::vector<Curve>& region) {
            return Overlay(std::vector<Layer>{{.curves = region}, {.curves = {curveOf(window)}}})
                .area(atLeast(2));
        };
        EXPECT_NEAR(common(cut.inside), common(curves), 2e-7) << round;
        EXPECT_NEAR(common(cut.inside), signedArea(cut.inside), 2e-7) << round;
        EXPECT_NEAR(common(cut.outside), 0, 2e-7) << round;
    }
}

}  // namespace curve_clip_test
}  // namespace ispace
