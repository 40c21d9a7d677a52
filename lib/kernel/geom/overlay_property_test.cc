// SPDX-License-Identifier: GPL-3.0-or-later
// Many layers: sums, exact overlays and pixels agree; nothing is lost where all coincides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/arrangement.h"
#include "support/test_overlay.h"

namespace ispace {
namespace overlay_property_test {

TEST(Overlay, thousandEdgesAlongOneLine) {
    // Views that all end at one slanted wall, with ends of their own on it.
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> along(0, 1);
    const Point2 a{0.123, 0.456};
    const Vec2 wall{9.7, 3.1};
    std::vector<Layer> layers;
    double sum = 0;
    for (int i = 0; i < 1000; ++i) {
        // One above another, so that little else crosses.
        const double s = 1e-4 * i + 1e-5 * along(random), t = 1 - 1e-4 * i;
        const Vec2 up = 1e-3 * (1000 - i) * perpendicular(wall);
        const Point2 p = a + s * wall, q = a + t * wall;
        const Polygon view{p, q, q + up, p + up};
        sum += signedArea(view);
        layers.push_back(layerOf({view}, i));
    }
    const Overlay overlay(layers);
    double weighted = 0;
    const std::vector<double> by_depth = depths(overlay, layers.size());
    for (std::size_t k = 0; k < by_depth.size(); ++k)
        weighted += static_cast<double>(k) * by_depth[k];
    EXPECT_NEAR(weighted, sum, boundOf(overlay, layers));
    // Below the wall nothing is left but the outside.
    for (const auto& edge : overlay.edges()) {
        const Vec2 middle = 0.5 * ((edge.from - a) + (edge.to - a));
        if (std::abs(cross(wall, middle)) < 1e-7) {
            EXPECT_TRUE(edge.right == LayerLabel{} || edge.left == LayerLabel{});
        }
    }
}

TEST(Overlay, areasAddUp) {
    std::mt19937_64 random(8);
    for (int round = 0; round < 30; ++round) {
        const std::vector<Layer> layers = randomStars(random, 2 + round, 5 + round, 5);
        const Overlay overlay(layers);
        double own = 0, weighted = 0;
        for (const Layer& layer : layers) own += Overlay({&layer, 1}).area(kAny);
        const auto by_depth = depths(overlay, layers.size());
        for (std::size_t k = 0; k < by_depth.size(); ++k)
            weighted += static_cast<double>(k) * by_depth[k];
        EXPECT_NEAR(weighted, own, 2 * boundOf(overlay, layers));
        EXPECT_NEAR(totalArea(overlay.regions(kAny)), overlay.area(kAny), boundOf(overlay, layers));
    }
}

TEST(Overlay, inclusionAndExclusion) {
    std::mt19937_64 random(9);
    for (int round = 0; round < 40; ++round) {
        const auto all = randomStars(random, 3, 12, 2);
        const auto area = [&](std::vector<Layer> some) {
            const int n = static_cast<int>(some.size());
            return Overlay(some).area(atLeast(n));
        };
        const double one = area({all[0]}) + area({all[1]}) + area({all[2]});
        const double two = area({all[0], all[1]}) + area({all[1], all[2]}) + area({all[0], all[2]});
        const Overlay overlay(all);
        EXPECT_NEAR(overlay.area(kAny), one - two + area(all), 4 * boundOf(overlay, all));
    }
}

TEST(Overlay, agreesWithExactOverlay) {
    std::mt19937_64 random(10);
    for (int round = 0; round < 20; ++round) {
        const auto layers = randomStars(random, 8, 10, 4);
        std::vector<Polygon> polygons;
        for (const Layer& layer : layers) {
            polygons.emplace_back();
            for (const CurveEdge& e : layer.curves[0]) polygons.back().push_back(e.from);
        }
        const Overlay overlay(layers);
        const auto exact = unite(polygons);
        EXPECT_NEAR(overlay.area(kAny), totalArea(exact), boundOf(overlay, layers));
        const auto pieces = overlay.regions(kAny);
        std::size_t holes = 0, exact_holes = 0;
        for (const Region& r : pieces) holes += r.holes.size();
        for (const Region& r : exact) exact_holes += r.holes.size();
        EXPECT_EQ(pieces.size(), exact.size());
        EXPECT_EQ(holes, exact_holes);
        const double rest = overlay.area([](const LayerLabel& l) { return l.numbers == 3; });
        std::vector<Polygon> others = polygons;
        others.erase(others.begin() + 3);
        // Number 3 is that of layer 3 alone, and of 1 and 2 and perhaps 0.
        const double both =
            overlay.area([](const LayerLabel& l) { return l.numbers == 3 && l.count > 1; });
        const double zero =
            overlay.area([](const LayerLabel& l) { return l.numbers == 3 && l.count == 1; });
        EXPECT_NEAR(rest, both + zero, 1e-12);
        EXPECT_NEAR(zero, totalArea(difference({polygons[3], {}}, others)),
                    boundOf(overlay, layers));
    }
}

TEST(Overlay, depthsByPixels) {
    std::mt19937_64 random(11);
    const auto layers = randomStars(random, 12, 9, 3);
    const Overlay overlay(layers);
    const auto by_depth = depths(overlay, layers.size());
    constexpr int kSide = 300;
    constexpr double kCell = 16.0 / kSide;
    std::vector<double> pixels(layers.size() + 1);
    std::vector<Polygon> polygons;
    for (const Layer& layer : layers) {
        polygons.emplace_back();
        for (const CurveEdge& e : layer.curves[0]) polygons.back().push_back(e.from);
    }
    for (int i = 0; i < kSide * kSide; ++i) {
        const int column = i % kSide, row = i / kSide;
        const Point2 p{-8 + kCell * (column + 0.5), -8 + kCell * (row + 0.5)};
        std::size_t depth = 0;
        for (const Polygon& polygon : polygons) depth += locate(polygon, p) == Side::Inside ? 1 : 0;
        pixels[depth] += kCell * kCell;
    }
    for (std::size_t k = 1; k < pixels.size(); ++k) EXPECT_NEAR(by_depth[k], pixels[k], 0.3);
    EXPECT_GT(by_depth[5], 1);
}

TEST(Overlay, turningMovingReorderingChangeRoundingOnly) {
    std::mt19937_64 random(12);
    auto layers = randomStars(random, 10, 8, 4);
    layers.push_back(curveLayer(disc({1, 1}, 3)));
    const Overlay first(layers);
    const auto wanted = depths(first, layers.size());
    for (int round = 0; round < 10; ++round) {
        auto others = layers;
        std::shuffle(others.begin(), others.end(), random);
        const double angle = round, c = std::cos(angle), s = std::sin(angle);
        const auto move = [&](Point2 p) {
            return Point2{c * p.x - s * p.y + 17.3, s * p.x + c * p.y - 100.1};
        };
        for (Layer& layer : others) {
            Curve curve = layer.curves[0];
            for (CurveEdge& e : curve) e = {move(e.from), move(e.to), e.radius, move(e.center)};
            layer.curves = {std::move(curve)};
        }
        const auto got = depths(Overlay(others), layers.size());
        for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], wanted[k], 4e-7);
    }
    const auto again = depths(Overlay(layers), layers.size());
    EXPECT_EQ(again, wanted);
}

TEST(Overlay, tenThousandTinyTriangles) {
    std::mt19937_64 random(13);
    std::uniform_real_distribution<double> at(-10, 10), off(-1, 1);
    for (const double size : {1e-8, 0.2}) {
        std::vector<Layer> layers;
        for (int i = 0; i < 10000; ++i) {
            const Point2 p{at(random), at(random)};
            Polygon t{p, p + size * Vec2{off(random), off(random)},
                      p + size * Vec2{off(random), off(random)}};
            layers.push_back(layerOf({std::move(t)}, 1));
        }
        double own = 0, weighted = 0;
        for (const Layer& layer : layers)
            own += std::abs(signedArea(
                {layer.curves[0][0].from, layer.curves[0][1].from, layer.curves[0][2].from}));
        const Overlay overlay(layers);
        const auto by_depth = depths(overlay, layers.size());
        for (std::size_t k = 0; k < by_depth.size(); ++k)
            weighted += static_cast<double>(k) * by_depth[k];
        EXPECT_NEAR(weighted, own, boundOf(overlay, layers));
        EXPECT_NEAR(totalArea(overlay.regions(kAny)), overlay.area(kAny), boundOf(overlay, layers));
    }
}

// Slits of no width are turned inside out by rounding: a label is of a set all the same.
TEST(Overlay, sliversHaveLabelsOfSets) {
    std::mt19937_64 random(14);
    std::uniform_real_distribution<double> at(-10, 10), tiny(-1e-7, 1e-7);
    std::vector<Layer> layers;
    for (int i = 0; i < 30; ++i) {
        const Point2 p{at(random), at(random)}, q{at(random), at(random)};
        const Point2 m = p + 0.4 * (q - p), n = p + 0.7 * (q - p);
        layers.push_back(
            layerOf({{p, m + Vec2{tiny(random), tiny(random)}, q,
                      n + Vec2{tiny(random), tiny(random)}, m + Vec2{tiny(random), tiny(random)}}},
                    std::int64_t{1} << i));
    }
    const Overlay overlay(layers);
    EXPECT_GT(overlay.edges().size(), 100U);
    for (const auto& edge : overlay.edges()) {
        for (const LayerLabel& label : {edge.left, edge.right}) {
            EXPECT_GE(label.numbers, 0);
            EXPECT_LT(label.numbers, std::int64_t{1} << 30);
            EXPECT_EQ(label.count,
                      __builtin_popcountll(static_cast<unsigned long long>(label.numbers)));
        }
    }
}

// A sensor on a robot and one written beside it: the same place, reckoned in two ways.
TEST(Overlay, DiscsOneRoundingApartAreOne) {
    for (const double apart : {0.0, 0x1p-52, 1e-15, 1e-10}) {
        std::vector<Layer> layers;
        for (const double shift : {0.0, apart}) {
            Curve disc;
            for (int quarter = 0; quarter < 4; ++quarter) {
                const Point2 center{0.3 + shift, 0.1};
                const auto at = [&](int k) {
                    return center + 9 * unitVector(Angle::degrees(90.0 * k));
                };
                disc.push_back({at(quarter), at(quarter + 1), 9, center});
            }
            layers.push_back({.curves = {disc}});
        }
        const Overlay overlay(layers);
        const double both = overlay.area([](const LayerLabel& label) { return label.count > 0; });
        EXPECT_NEAR(both, 81 * std::numbers::pi, 1e-6) << apart;
    }
}

TEST(Overlay, CurvesHaveArcsAgain) {
    Curve half{{{-2, 0}, {2, 0}}, {{2, 0}, {0, 2}, 2, {0, 0}}, {{0, 2}, {-2, 0}, 2, {0, 0}}};
    const Layer layers[] = {{.curves = {half}},
                            {.curves = {curveOf({{0, -1}, {3, -1}, {3, 3}, {0, 3}})}}};
    const Overlay overlay(layers);
    const auto in_both = [](const LayerLabel& label) { return label.count == 2; };
    EXPECT_NEAR(signedArea(overlay.curves(in_both)), std::numbers::pi, 1e-7);
    EXPECT_LT(totalArea(overlay.regions(in_both)), std::numbers::pi - 1e-5) << "chords";
}

}  // namespace overlay_property_test
}  // namespace ispace
