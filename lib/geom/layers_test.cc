// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "geom/boolean.h"
#include "geom/test_curves.h"

namespace ispace {
namespace {

using std::numbers::pi;

const auto kAny = [](const LayerLabel& label) { return label.count > 0; };
auto atLeast(int k) {
    return [k](const LayerLabel& label) { return label.count >= k; };
}

Curve straight(const Polygon& polygon) {
    Curve curve;
    forEachEdge(polygon, [&](const Segment2& e) { curve.push_back({e.a, e.b, 0, {}}); });
    return curve;
}

Layer layerOf(const std::vector<Polygon>& polygons, std::int64_t number = 0) {
    Layer layer;
    for (const Polygon& polygon : polygons) layer.curves.push_back(straight(polygon));
    layer.number = number;
    return layer;
}

Layer marking(const Polygon& polygon, std::uint64_t marks) {
    Layer layer = layerOf({polygon});
    layer.counts = false;
    layer.marks = marks;
    return layer;
}

Polygon reversed(Polygon polygon) {
    std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

/// In four quarters, from this direction.
Curve disc(Point2 center, double radius, double from = 0) {
    Curve curve;
    const auto at = [&](int i) {
        const double angle = from + i % 4 * pi / 2;
        return center + radius * Vec2{std::cos(angle), std::sin(angle)};
    };
    for (int i = 0; i < 4; ++i) curve.push_back({at(i), at(i + 1), radius, center});
    return curve;
}

Layer curveLayer(const Curve& curve, std::int64_t number = 0) {
    Layer layer;
    layer.curves.push_back(curve);
    layer.number = number;
    return layer;
}

/// Areas by label, without the outside.
std::map<std::tuple<int, std::int64_t, std::uint64_t>, double> areasOf(
    const LayerOverlay& overlay) {
    std::map<std::tuple<int, std::int64_t, std::uint64_t>, double> areas;
    overlay.addAreas([&](const LayerLabel& label, double area) {
        areas[{label.count, label.numbers, label.marks}] += area;
    });
    areas.erase({0, 0, 0});
    return areas;
}

std::vector<double> depths(const LayerOverlay& overlay, std::size_t most) {
    std::vector<double> areas(most + 1);
    overlay.addAreas([&](const LayerLabel& label, double area) {
        ASSERT_GE(label.count, 0);
        ASSERT_LE(static_cast<std::size_t>(label.count), most);
        areas[static_cast<std::size_t>(label.count)] += area;
    });
    areas[0] = 0;
    return areas;
}

double boundOf(const LayerOverlay& overlay, const std::vector<Layer>& layers) {
    double length = 0;
    for (const Layer& layer : layers)
        for (const Curve& curve : layer.curves)
            for (const CurveEdge& edge : curve) length += 2 * distance(edge.from, edge.to);
    return 3 * overlay.unit() * length + 1e-15;
}

Polygon moved(Polygon polygon, Vec2 by) {
    for (Point2& p : polygon) p = p + by;
    return polygon;
}

std::vector<Layer> randomStars(std::mt19937_64& random, int count, int corners, double spread) {
    std::uniform_real_distribution<double> at(-spread, spread);
    std::vector<Layer> layers;
    layers.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        layers.push_back(
            layerOf({moved(test::star(random, corners, 4), {at(random), at(random)})}, i));
    return layers;
}

TEST(LayerOverlay, twoSquaresThatOverlap) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 2, 2)}, 3),
                                    layerOf({test::box(1, 1, 3, 3)}, 5)};
    const LayerOverlay overlay(layers);
    const auto areas = areasOf(overlay);
    ASSERT_EQ(areas.size(), 3U);
    EXPECT_DOUBLE_EQ(areas.at({1, 3, 0}), 3);
    EXPECT_DOUBLE_EQ(areas.at({1, 5, 0}), 3);
    EXPECT_DOUBLE_EQ(areas.at({2, 8, 0}), 1);
    EXPECT_DOUBLE_EQ(overlay.area(kAny), 7);
    const auto pieces = overlay.regions(kAny);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0].outline,
              (Polygon{{0, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 3}, {1, 3}, {1, 2}, {0, 2}}));
    EXPECT_EQ(overlay.regions(atLeast(2))[0].outline, test::box(1, 1, 2, 2));
    EXPECT_EQ(overlay.edges().size(), 12U);
}

TEST(LayerOverlay, commonEdges) {
    // Along a whole side, along a part of one, at a corner.
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 2, 2)}, 1), layerOf({test::box(2, 0, 3, 2)}, 2),
        layerOf({test::box(-1, 0.5, 0, 1)}, 4), layerOf({test::box(3, 2, 4, 3)}, 8)};
    const LayerOverlay overlay(layers);
    const auto areas = areasOf(overlay);
    ASSERT_EQ(areas.size(), 4U);
    EXPECT_DOUBLE_EQ(areas.at({1, 1, 0}), 4);
    EXPECT_DOUBLE_EQ(areas.at({1, 2, 0}), 2);
    EXPECT_DOUBLE_EQ(areas.at({1, 4, 0}), 0.5);
    EXPECT_DOUBLE_EQ(areas.at({1, 8, 0}), 1);
    const auto pieces = overlay.regions(kAny);
    ASSERT_EQ(pieces.size(), 2U) << "pieces that touch at a corner are apart";
    EXPECT_DOUBLE_EQ(totalArea(pieces), 7.5);
    EXPECT_EQ(pieces[0].outline.size(), 8U);
}

TEST(LayerOverlay, equalLabelsOnBothSidesHaveNoEdge) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 1, 1)}),
                                    layerOf({test::box(1, 0, 2, 1)})};
    const LayerOverlay overlay(layers);
    EXPECT_EQ(overlay.edges().size(), 6U);
    EXPECT_EQ(overlay.regions(kAny)[0].outline, test::box(0, 0, 2, 1));
}

TEST(LayerOverlay, nestedHolesAndIslands) {
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 10, 10), reversed(test::box(1, 1, 9, 9))}, 1),
        layerOf({test::box(2, 2, 8, 8)}, 2), layerOf({test::box(3, 3, 4, 4)}, 4),
        layerOf({test::box(5, 3, 6, 4)}, 8), layerOf({test::box(20, 0, 21, 1)}, 16)};
    const LayerOverlay overlay(layers);
    const auto areas = areasOf(overlay);
    ASSERT_EQ(areas.size(), 5U);
    EXPECT_DOUBLE_EQ(areas.at({1, 1, 0}), 36);
    EXPECT_DOUBLE_EQ(areas.at({1, 2, 0}), 34);
    EXPECT_DOUBLE_EQ(areas.at({2, 6, 0}), 1);
    EXPECT_DOUBLE_EQ(areas.at({2, 10, 0}), 1);
    EXPECT_DOUBLE_EQ(areas.at({1, 16, 0}), 1);
    const auto single = overlay.regions([](const LayerLabel& l) { return l.count == 1; });
    ASSERT_EQ(single.size(), 3U);
    EXPECT_EQ(single[0].holes.size(), 1U);
    EXPECT_EQ(single[1].holes.size(), 2U);
    EXPECT_LT(signedArea(single[1].holes[0]), 0);
    EXPECT_DOUBLE_EQ(totalArea(single), 71);
}

TEST(LayerOverlay, regionsAreSorted) {
    const std::vector<Layer> layers{
        layerOf({test::box(20, 0, 30, 10), test::box(27, 1, 28, 2), test::box(21, 1, 22, 2)}),
        layerOf({test::box(10, 5, 11, 6)}), layerOf({test::box(0, 0, 1, 1)})};
    const auto pieces = LayerOverlay(layers).regions(kAny);
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[0].outline, test::box(0, 0, 1, 1));
    EXPECT_EQ(pieces[1].outline, test::box(10, 5, 11, 6));
    ASSERT_EQ(pieces[2].holes.size(), 2U);
    EXPECT_EQ(pieces[2].holes[0][0], (Point2{21, 1}));
}

TEST(LayerOverlay, identicalLayers) {
    std::vector<Layer> layers;
    for (int i = 0; i < 50; ++i) {
        layers.push_back(layerOf({test::box(0.1, 0.2, 2.3, 3.1)}, i));
        layers.push_back(layerOf({{{0.1, 3.1}, {0.1, 0.2}, {2.3, 0.2}, {2.3, 3.1}}}, i));
    }
    const LayerOverlay overlay(layers);
    EXPECT_EQ(overlay.edges().size(), 4U);
    const auto areas = areasOf(overlay);
    ASSERT_EQ(areas.size(), 1U);
    EXPECT_NEAR(areas.at({100, 50 * 49, 0}), 2.2 * 2.9, 20 * overlay.unit());
}

TEST(LayerOverlay, marks) {
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 2, 2)}, 7), marking(test::box(1, 0, 3, 2), 1),
        marking(test::box(1.5, 0, 3, 2), 2), marking(test::box(1.75, 0, 4, 2), 1)};
    const auto areas = areasOf(LayerOverlay(layers));
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 0}), 2);
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 1}), 1);
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 3}), 1);  // with a mark twice as well
    EXPECT_DOUBLE_EQ(areas.at({0, 0, 3}), 2);
    EXPECT_DOUBLE_EQ(areas.at({0, 0, 1}), 2);
    EXPECT_EQ(areas.size(), 5U);
}

TEST(LayerOverlay, numbersThatWrapAround) {
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 2, 2)}, kMost),
                                    layerOf({test::box(0, 0, 2, 3)}, kMost),
                                    layerOf({test::box(0, 0, 2, 4)}, 11)};
    const auto areas = areasOf(LayerOverlay(layers));
    EXPECT_DOUBLE_EQ(areas.at({1, 11, 0}), 2);
}

TEST(LayerOverlay, lensOfTwoDiscs) {
    for (const double d : {0.3, 1.0, 1.9}) {
        const double r = 1.25;
        const std::vector<Layer> layers{curveLayer(disc({0, 0}, r), 1),
                                        curveLayer(disc({d, 0.1}, r, 0.4), 2)};
        const LayerOverlay overlay(layers);
        const double apart = std::hypot(d, 0.1);
        const double lens = 2 * r * r * std::acos(apart / (2 * r)) -
                            apart / 2 * std::sqrt(4 * r * r - apart * apart);
        const double tolerance = 4 * kChordError * kChordError;
        EXPECT_NEAR(overlay.area(atLeast(2)), lens, tolerance);
        EXPECT_NEAR(overlay.area(kAny), 2 * pi * r * r - lens, tolerance);
    }
}

TEST(LayerOverlay, discAndHalfPlane) {
    const double r = 4, h = 1.3;
    const std::vector<Layer> layers{curveLayer(disc({0.1, 0.2}, r), 1),
                                    layerOf({test::box(-10, 0.2 + h, 10, 10)}, 2)};
    const double cap = r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h);
    EXPECT_NEAR(LayerOverlay(layers).area(atLeast(2)), cap, 4 * kChordError * kChordError);
}

TEST(LayerOverlay, arcsOfOneCircle) {
    // Discs that begin at different places are the same but for a few chords.
    std::vector<Layer> layers;
    layers.reserve(10);
    for (int i = 0; i < 10; ++i) layers.push_back(curveLayer(disc({1, 2}, 3, 0.01 + 0.1 * i), i));
    const LayerOverlay overlay(layers);
    EXPECT_NEAR(overlay.area(kAny), 9 * pi, 1e-12 + boundOf(overlay, layers));
    EXPECT_NEAR(overlay.area(atLeast(10)), 9 * pi, 1e-12 + boundOf(overlay, layers));
    EXPECT_LT(overlay.edges().size(), 600U);
    // A ring by clockwise arcs, whose edges bulge inwards.
    Layer ring = curveLayer(disc({1, 2}, 3));
    Curve hole = disc({1, 2}, 2);
    std::reverse(hole.begin(), hole.end());
    for (CurveEdge& e : hole) e = {e.to, e.from, -e.radius, e.center};
    ring.curves.push_back(hole);
    const LayerOverlay rings({&ring, 1});
    EXPECT_NEAR(rings.area(kAny), 5 * pi, 1e-7);
    for (const auto& edge : rings.edges()) {
        const Vec2 to_center = Point2{1, 2} - edge.from;
        EXPECT_GT(edge.bulge * cross(edge.to - edge.from, to_center), 0);
    }
    EXPECT_NEAR(totalArea(rings.regions(kAny)), 5 * pi, kChordError * 10 * pi);
}

TEST(LayerOverlay, biteOfAClockwiseArc) {
    Curve curve = straight({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {1, 4}, {0, 4}});
    curve[3].radius = -1;
    curve[3].center = {2, 4};
    const LayerOverlay overlay(std::vector<Layer>{curveLayer(curve)});
    EXPECT_NEAR(overlay.area(kAny), 16 - pi / 2, 1e-7);
    EXPECT_EQ(overlay.regions(kAny)[0].locate({2, 3.5}), Side::Outside);
}

TEST(LayerOverlay, arcsOfNoLengthAndTinyOnes) {
    Curve curve = straight(test::box(0, 0, 1, 1));
    curve.insert(curve.begin() + 1, {{1, 0}, {1, 0}, 0.5, {0.5, 0}});
    curve.insert(curve.begin() + 1, {{1, 0}, {1, 0}, -0.5, {0.5, 0}});
    // Backwards by the last bit: no whole turn.
    curve.insert(curve.begin() + 1, {{1, 0}, {std::nextafter(1, 2), 0}, 0.5, {1, -0.5}});
    EXPECT_NEAR(LayerOverlay(std::vector<Layer>{curveLayer(curve)}).area(kAny), 1, 1e-8);
    for (const double radius : {1e-12, 1e-7, 1e-3, 1e6}) {
        const LayerOverlay overlay(std::vector<Layer>{curveLayer(disc({3, 4}, radius))});
        EXPECT_NEAR(overlay.area(kAny), pi * radius * radius, 1e-6 * radius * radius);
    }
}

TEST(LayerOverlay, wallsPartRegions) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 4, 4)}, 1),
                                    layerOf({test::box(2, 0, 6, 4)}, 2)};
    const auto pieces = [&](const std::vector<Segment2>& walls) {
        return LayerOverlay(layers, walls).regions(kAny);
    };
    EXPECT_EQ(pieces({}).size(), 1U);
    // From outside through and out again; half way; up to another wall; alone inside.
    EXPECT_EQ(pieces({{{1, -5}, {1, 9}}}).size(), 2U);
    EXPECT_EQ(pieces({{{1, -5}, {1, 3}}}).size(), 1U);
    const auto three = pieces({{{1, -5}, {1, 9}}, {{1, 2}, {4, 2}}, {{4, 0}, {4, 4}}});
    ASSERT_EQ(three.size(), 4U);
    EXPECT_DOUBLE_EQ(totalArea(three), 24);
    EXPECT_EQ(three[0].outline, test::box(0, 0, 1, 4));
    // From so far away that its ends are off the lattice.
    const auto slanted = pieces({{{-1e9, 1 - 1e9}, {1e9, 1e9 + 1}}});
    ASSERT_EQ(slanted.size(), 2U);
    EXPECT_NEAR(slanted[1].area(), 4.5, 1e-5);
    // A wall on an edge between labels.
    EXPECT_EQ(pieces({{{2, 0}, {2, 4}}}).size(), 2U);
    // A closed one inside, joined to the outline by another, makes an island.
    std::vector<Segment2> walls = test::edgesOf(test::box(1, 1, 3, 3));
    EXPECT_EQ(pieces(walls).size(), 2U);
    walls.push_back({{0, 2}, {1, 2}});
    walls.push_back({{0.5, 3}, {0.7, 3.5}});
    const auto island = pieces(walls);
    ASSERT_EQ(island.size(), 2U);
    ASSERT_EQ(island[0].holes.size(), 1U);
    EXPECT_EQ(signedArea(island[0].holes[0]), -4);
    EXPECT_EQ(island[1].outline, test::box(1, 1, 3, 3));
    // They change no figure, wherever they are.
    walls.push_back({{-1e9, -7}, {1e9, 8}});
    walls.push_back({{100, 100}, {200, 100}});
    walls.push_back({{1, 1}, {1, 1}});
    const LayerOverlay overlay(layers, walls);
    EXPECT_NEAR(overlay.area(kAny), 24, 1e-7);
    EXPECT_EQ(overlay.unit(), LayerOverlay(layers).unit());
}

TEST(LayerOverlay, nothing) {
    EXPECT_TRUE(LayerOverlay({}).edges().empty());
    EXPECT_TRUE(LayerOverlay({}).regions(kAny).empty());
    const std::vector<Layer> layers{Layer{}, curveLayer(Curve{}),
                                    layerOf({{{1, 1}, {1, 1}, {1, 1}}}), layerOf({{{1, 1}}})};
    const std::vector<Segment2> walls{{{0, 0}, {2, 2}}};
    EXPECT_TRUE(LayerOverlay(layers, walls).edges().empty());
    EXPECT_EQ(LayerOverlay(layers, walls).area(kAny), 0);
    // In one line, and there and back.
    const std::vector<Layer> flat{layerOf({{{0, 0}, {1, 1}, {5, 5}, {3, 3}}}),
                                  layerOf({{{0, 0}, {7, 7}}})};
    EXPECT_TRUE(LayerOverlay(flat, walls).edges().empty());
    EXPECT_TRUE(LayerOverlay(flat, walls).regions(kAny).empty());
}

TEST(LayerOverlay, farAndHuge) {
    for (const double scale : {1e-300, 1e-150, 1e-9, 1.0, 1e9, 1e150}) {
        for (const double off : {0.0, 1e3, 1e8}) {
            const std::vector<Layer> layers{
                layerOf({test::box(scale * off, 0, scale * (off + 2), 2 * scale)}),
                layerOf({test::box(scale * (off + 1), scale, scale * (off + 3), 3 * scale)})};
            EXPECT_NEAR(LayerOverlay(layers).area(kAny) / scale / scale, 7,
                        scale < 1e-200 ? 10 : 1e-7);
        }
    }
    constexpr double kMost = std::numeric_limits<double>::max();
    const LayerOverlay all(std::vector<Layer>{layerOf({test::box(-kMost, -kMost, kMost, kMost)})});
    EXPECT_EQ(all.edges().size(), 4U);
    EXPECT_EQ(all.regions(kAny).size(), 1U);
    const LayerOverlay corner(
        std::vector<Layer>{layerOf({test::box(kMost / 2, kMost / 2, kMost, kMost)})});
    EXPECT_EQ(corner.edges().size(), 4U);
}

TEST(LayerOverlay, thousandEdgesAlongOneLine) {
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
    const LayerOverlay overlay(layers);
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

TEST(LayerOverlay, areasAddUp) {
    std::mt19937_64 random(8);
    for (int round = 0; round < 30; ++round) {
        const std::vector<Layer> layers = randomStars(random, 2 + round, 5 + round, 5);
        const LayerOverlay overlay(layers);
        double own = 0, weighted = 0;
        for (const Layer& layer : layers) own += LayerOverlay({&layer, 1}).area(kAny);
        const auto by_depth = depths(overlay, layers.size());
        for (std::size_t k = 0; k < by_depth.size(); ++k)
            weighted += static_cast<double>(k) * by_depth[k];
        EXPECT_NEAR(weighted, own, 2 * boundOf(overlay, layers));
        EXPECT_NEAR(totalArea(overlay.regions(kAny)), overlay.area(kAny), boundOf(overlay, layers));
    }
}

TEST(LayerOverlay, inclusionAndExclusion) {
    std::mt19937_64 random(9);
    for (int round = 0; round < 40; ++round) {
        const auto all = randomStars(random, 3, 12, 2);
        const auto area = [&](std::vector<Layer> some) {
            const int n = static_cast<int>(some.size());
            return LayerOverlay(some).area(atLeast(n));
        };
        const double one = area({all[0]}) + area({all[1]}) + area({all[2]});
        const double two = area({all[0], all[1]}) + area({all[1], all[2]}) + area({all[0], all[2]});
        const LayerOverlay overlay(all);
        EXPECT_NEAR(overlay.area(kAny), one - two + area(all), 4 * boundOf(overlay, all));
    }
}

TEST(LayerOverlay, agreesWithExactOverlay) {
    std::mt19937_64 random(10);
    for (int round = 0; round < 20; ++round) {
        const auto layers = randomStars(random, 8, 10, 4);
        std::vector<Polygon> polygons;
        for (const Layer& layer : layers) {
            polygons.emplace_back();
            for (const CurveEdge& e : layer.curves[0]) polygons.back().push_back(e.from);
        }
        const LayerOverlay overlay(layers);
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

TEST(LayerOverlay, depthsByPixels) {
    std::mt19937_64 random(11);
    const auto layers = randomStars(random, 12, 9, 3);
    const LayerOverlay overlay(layers);
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

TEST(LayerOverlay, turningMovingReorderingChangeRoundingOnly) {
    std::mt19937_64 random(12);
    auto layers = randomStars(random, 10, 8, 4);
    layers.push_back(curveLayer(disc({1, 1}, 3)));
    const LayerOverlay first(layers);
    const auto wanted = depths(first, layers.size());
    for (int round = 0; round < 10; ++round) {
        auto others = layers;
        std::shuffle(others.begin(), others.end(), random);
        const double angle = round, c = std::cos(angle), s = std::sin(angle);
        const auto move = [&](Point2 p) {
            return Point2{c * p.x - s * p.y + 17.3, s * p.x + c * p.y - 100.1};
        };
        for (Layer& layer : others) {
            for (CurveEdge& e : layer.curves[0])
                e = {move(e.from), move(e.to), e.radius, move(e.center)};
        }
        const auto got = depths(LayerOverlay(others), layers.size());
        for (std::size_t k = 0; k < got.size(); ++k) EXPECT_NEAR(got[k], wanted[k], 4e-7);
    }
    const auto again = depths(LayerOverlay(layers), layers.size());
    EXPECT_EQ(again, wanted);
}

TEST(LayerOverlay, tenThousandTinyTriangles) {
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
        const LayerOverlay overlay(layers);
        const auto by_depth = depths(overlay, layers.size());
        for (std::size_t k = 0; k < by_depth.size(); ++k)
            weighted += static_cast<double>(k) * by_depth[k];
        EXPECT_NEAR(weighted, own, boundOf(overlay, layers));
        EXPECT_NEAR(totalArea(overlay.regions(kAny)), overlay.area(kAny), boundOf(overlay, layers));
    }
}

// Slits of no width are turned inside out by rounding: a label is of a set all the same.
TEST(LayerOverlay, sliversHaveLabelsOfSets) {
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
    const LayerOverlay overlay(layers);
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
TEST(LayerOverlay, DiscsOneRoundingApartAreOne) {
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
        const LayerOverlay overlay(layers);
        const double both = overlay.area([](const LayerLabel& label) { return label.count > 0; });
        EXPECT_NEAR(both, 81 * std::numbers::pi, 1e-6) << apart;
    }
}

TEST(LayerOverlay, CurvesHaveArcsAgain) {
    Curve half{{{-2, 0}, {2, 0}}, {{2, 0}, {0, 2}, 2, {0, 0}}, {{0, 2}, {-2, 0}, 2, {0, 0}}};
    const Layer layers[] = {{.curves = {half}},
                            {.curves = {curveOf({{0, -1}, {3, -1}, {3, 3}, {0, 3}})}}};
    const LayerOverlay overlay(layers);
    const auto in_both = [](const LayerLabel& label) { return label.count == 2; };
    EXPECT_NEAR(signedArea(overlay.curves(in_both)), std::numbers::pi, 1e-7);
    EXPECT_LT(totalArea(overlay.regions(in_both)), std::numbers::pi - 1e-5) << "chords";
}

}  // namespace
}  // namespace ispace
