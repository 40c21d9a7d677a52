// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "geom/arrangement.h"
#include "support/test_overlay.h"

namespace ispace {
namespace overlay_test {

TEST(Overlay, twoSquaresThatOverlap) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 2, 2)}, 3),
                                    layerOf({test::box(1, 1, 3, 3)}, 5)};
    const Overlay overlay(layers);
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

TEST(Overlay, commonEdges) {
    // Along a whole side, along a part of one, at a corner.
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 2, 2)}, 1), layerOf({test::box(2, 0, 3, 2)}, 2),
        layerOf({test::box(-1, 0.5, 0, 1)}, 4), layerOf({test::box(3, 2, 4, 3)}, 8)};
    const Overlay overlay(layers);
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

TEST(Overlay, equalLabelsOnBothSidesHaveNoEdge) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 1, 1)}),
                                    layerOf({test::box(1, 0, 2, 1)})};
    const Overlay overlay(layers);
    EXPECT_EQ(overlay.edges().size(), 6U);
    EXPECT_EQ(overlay.regions(kAny)[0].outline, test::box(0, 0, 2, 1));
}

TEST(Overlay, nestedHolesAndIslands) {
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 10, 10), reversed(test::box(1, 1, 9, 9))}, 1),
        layerOf({test::box(2, 2, 8, 8)}, 2), layerOf({test::box(3, 3, 4, 4)}, 4),
        layerOf({test::box(5, 3, 6, 4)}, 8), layerOf({test::box(20, 0, 21, 1)}, 16)};
    const Overlay overlay(layers);
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

TEST(Overlay, regionsAreSorted) {
    const std::vector<Layer> layers{
        layerOf({test::box(20, 0, 30, 10), test::box(27, 1, 28, 2), test::box(21, 1, 22, 2)}),
        layerOf({test::box(10, 5, 11, 6)}), layerOf({test::box(0, 0, 1, 1)})};
    const auto pieces = Overlay(layers).regions(kAny);
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[0].outline, test::box(0, 0, 1, 1));
    EXPECT_EQ(pieces[1].outline, test::box(10, 5, 11, 6));
    ASSERT_EQ(pieces[2].holes.size(), 2U);
    EXPECT_EQ(pieces[2].holes[0][0], (Point2{21, 1}));
}

TEST(Overlay, identicalLayers) {
    std::vector<Layer> layers;
    for (int i = 0; i < 50; ++i) {
        layers.push_back(layerOf({test::box(0.1, 0.2, 2.3, 3.1)}, i));
        layers.push_back(layerOf({{{0.1, 3.1}, {0.1, 0.2}, {2.3, 0.2}, {2.3, 3.1}}}, i));
    }
    const Overlay overlay(layers);
    EXPECT_EQ(overlay.edges().size(), 4U);
    const auto areas = areasOf(overlay);
    ASSERT_EQ(areas.size(), 1U);
    EXPECT_NEAR(areas.at({100, 50 * 49, 0}), 2.2 * 2.9, 20 * overlay.unit());
}

TEST(Overlay, marks) {
    const std::vector<Layer> layers{
        layerOf({test::box(0, 0, 2, 2)}, 7), marking(test::box(1, 0, 3, 2), 1),
        marking(test::box(1.5, 0, 3, 2), 2), marking(test::box(1.75, 0, 4, 2), 1)};
    const auto areas = areasOf(Overlay(layers));
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 0}), 2);
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 1}), 1);
    EXPECT_DOUBLE_EQ(areas.at({1, 7, 3}), 1);  // with a mark twice as well
    EXPECT_DOUBLE_EQ(areas.at({0, 0, 3}), 2);
    EXPECT_DOUBLE_EQ(areas.at({0, 0, 1}), 2);
    EXPECT_EQ(areas.size(), 5U);
}

TEST(Overlay, numbersThatWrapAround) {
    constexpr std::int64_t kMax = std::numeric_limits<std::int64_t>::max();
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 2, 2)}, kMax),
                                    layerOf({test::box(0, 0, 2, 3)}, kMax),
                                    layerOf({test::box(0, 0, 2, 4)}, 11)};
    const auto areas = areasOf(Overlay(layers));
    EXPECT_DOUBLE_EQ(areas.at({1, 11, 0}), 2);
}

TEST(Overlay, lensOfTwoDiscs) {
    for (const double d : {0.3, 1.0, 1.9}) {
        const double r = 1.25;
        const std::vector<Layer> layers{curveLayer(disc({0, 0}, r), 1),
                                        curveLayer(disc({d, 0.1}, r, 0.4), 2)};
        const Overlay overlay(layers);
        const double apart = std::hypot(d, 0.1);
        const double lens = 2 * r * r * std::acos(apart / (2 * r)) -
                            apart / 2 * std::sqrt(4 * r * r - apart * apart);
        const double tolerance = 4 * kChordError * kChordError;
        EXPECT_NEAR(overlay.area(atLeast(2)), lens, tolerance);
        EXPECT_NEAR(overlay.area(kAny), 2 * pi * r * r - lens, tolerance);
    }
}

TEST(Overlay, regionsWithTheAreasOfTheirArcs) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(0, 10), size(0.2, 4);
    std::vector<Layer> layers{layerOf({test::box(1, 1, 9, 8)}, 1)};
    for (int i = 2; i < 9; ++i)
        layers.push_back(curveLayer(disc({place(random), place(random)}, size(random)), i));
    const Overlay overlay(layers);
    double sum = 0;
    for (int count = 1; count < 9; ++count) {
        const auto in = [count](const LayerLabel& label) { return label.count == count; };
        const std::vector<Region> chords = overlay.regions(in);
        const std::vector<Region> pieces = withArcAreas(overlay, chords);
        ASSERT_EQ(pieces.size(), chords.size());
        const std::vector<double> areas = overlay.areasOf(chords);
        for (std::size_t i = 0; i < pieces.size(); ++i)
            EXPECT_NEAR(pieces[i].area(), areas[i], 1e-7) << count;
        sum += totalArea(pieces);
    }
    // Neighbours have the same vertices, so that no gap is between them.
    EXPECT_NEAR(sum, totalArea(withArcAreas(overlay, overlay.regions(kAny))), 1e-12);
    EXPECT_NEAR(sum, overlay.area(kAny), 1e-6);
}

TEST(Overlay, discAndHalfPlane) {
    const double r = 4, h = 1.3;
    const std::vector<Layer> layers{curveLayer(disc({0.1, 0.2}, r), 1),
                                    layerOf({test::box(-10, 0.2 + h, 10, 10)}, 2)};
    const double cap = r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h);
    EXPECT_NEAR(Overlay(layers).area(atLeast(2)), cap, 4 * kChordError * kChordError);
}

TEST(Overlay, arcsOfOneCircle) {
    // Discs that begin at different places are the same but for a few chords.
    std::vector<Layer> layers;
    layers.reserve(10);
    for (int i = 0; i < 10; ++i) layers.push_back(curveLayer(disc({1, 2}, 3, 0.01 + 0.1 * i), i));
    const Overlay overlay(layers);
    EXPECT_NEAR(overlay.area(kAny), 9 * pi, 1e-12 + boundOf(overlay, layers));
    EXPECT_NEAR(overlay.area(atLeast(10)), 9 * pi, 1e-12 + boundOf(overlay, layers));
    EXPECT_LT(overlay.edges().size(), 600U);
    // A ring by clockwise arcs, whose edges bulge inwards.
    Layer ring = curveLayer(disc({1, 2}, 3));
    Curve hole = disc({1, 2}, 2);
    std::reverse(hole.begin(), hole.end());
    for (CurveEdge& e : hole) e = {e.to, e.from, -e.radius, e.center};
    ring.curves = {ring.curves[0], hole};
    const Overlay rings({&ring, 1});
    EXPECT_NEAR(rings.area(kAny), 5 * pi, 1e-7);
    for (const auto& edge : rings.edges()) {
        const Vec2 to_center = Point2{1, 2} - edge.from;
        EXPECT_GT(edge.bulge * cross(edge.to - edge.from, to_center), 0);
    }
    EXPECT_NEAR(totalArea(rings.regions(kAny)), 5 * pi, kChordError * 10 * pi);
}

TEST(Overlay, biteOfAClockwiseArc) {
    Curve curve = straight({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {1, 4}, {0, 4}});
    curve[3].radius = -1;
    curve[3].center = {2, 4};
    const Overlay overlay(std::vector<Layer>{curveLayer(curve)});
    EXPECT_NEAR(overlay.area(kAny), 16 - pi / 2, 1e-7);
    EXPECT_EQ(overlay.regions(kAny)[0].locate({2, 3.5}), Side::Outside);
}

TEST(Overlay, arcsOfNoLengthAndTinyOnes) {
    Curve curve = straight(test::box(0, 0, 1, 1));
    curve.insert(curve.begin() + 1, {{1, 0}, {1, 0}, 0.5, {0.5, 0}});
    curve.insert(curve.begin() + 1, {{1, 0}, {1, 0}, -0.5, {0.5, 0}});
    // Backwards by the last bit: no whole turn.
    curve.insert(curve.begin() + 1, {{1, 0}, {std::nextafter(1, 2), 0}, 0.5, {1, -0.5}});
    EXPECT_NEAR(Overlay(std::vector<Layer>{curveLayer(curve)}).area(kAny), 1, 1e-8);
    for (const double radius : {1e-12, 1e-7, 1e-3, 1e6}) {
        const Overlay overlay(std::vector<Layer>{curveLayer(disc({3, 4}, radius))});
        EXPECT_NEAR(overlay.area(kAny), pi * radius * radius, 1e-6 * radius * radius);
    }
}

TEST(Overlay, wallsPartRegions) {
    const std::vector<Layer> layers{layerOf({test::box(0, 0, 4, 4)}, 1),
                                    layerOf({test::box(2, 0, 6, 4)}, 2)};
    const auto pieces = [&](const std::vector<Segment2>& walls) {
        return Overlay(layers, walls).regions(kAny);
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
    // They change no area, wherever they are.
    walls.push_back({{-1e9, -7}, {1e9, 8}});
    walls.push_back({{100, 100}, {200, 100}});
    walls.push_back({{1, 1}, {1, 1}});
    const Overlay overlay(layers, walls);
    EXPECT_NEAR(overlay.area(kAny), 24, 1e-7);
    EXPECT_EQ(overlay.unit(), Overlay(layers).unit());
}

TEST(Overlay, nothing) {
    EXPECT_TRUE(Overlay({}).edges().empty());
    EXPECT_TRUE(Overlay({}).regions(kAny).empty());
    const std::vector<Layer> layers{Layer{}, curveLayer(Curve{}),
                                    layerOf({{{1, 1}, {1, 1}, {1, 1}}}), layerOf({{{1, 1}}})};
    const std::vector<Segment2> walls{{{0, 0}, {2, 2}}};
    EXPECT_TRUE(Overlay(layers, walls).edges().empty());
    EXPECT_EQ(Overlay(layers, walls).area(kAny), 0);
    // In one line, and there and back.
    const std::vector<Layer> flat{layerOf({{{0, 0}, {1, 1}, {5, 5}, {3, 3}}}),
                                  layerOf({{{0, 0}, {7, 7}}})};
    EXPECT_TRUE(Overlay(flat, walls).edges().empty());
    EXPECT_TRUE(Overlay(flat, walls).regions(kAny).empty());
}

TEST(Overlay, farAndHuge) {
    for (const double scale : {1e-300, 1e-150, 1e-9, 1.0, 1e9, 1e150}) {
        for (const double off : {0.0, 1e3, 1e8}) {
            const std::vector<Layer> layers{
                layerOf({test::box(scale * off, 0, scale * (off + 2), 2 * scale)}),
                layerOf({test::box(scale * (off + 1), scale, scale * (off + 3), 3 * scale)})};
            EXPECT_NEAR(Overlay(layers).area(kAny) / scale / scale, 7, scale < 1e-200 ? 10 : 1e-7);
        }
    }
    constexpr double kMax = std::numeric_limits<double>::max();
    const Overlay all(std::vector<Layer>{layerOf({test::box(-kMax, -kMax, kMax, kMax)})});
    EXPECT_EQ(all.edges().size(), 4U);
    EXPECT_EQ(all.regions(kAny).size(), 1U);
    const Overlay corner(std::vector<Layer>{layerOf({test::box(kMax / 2, kMax / 2, kMax, kMax)})});
    EXPECT_EQ(corner.edges().size(), 4U);
}

}  // namespace overlay_test
}  // namespace ispace
