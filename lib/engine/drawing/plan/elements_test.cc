// SPDX-License-Identifier: GPL-3.0-or-later
#include "drawing/plan/elements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "geom/arrangement.h"
#include "support/test_layout.h"

namespace ispace {
namespace elements_test {

Body bodyFrom(const std::string& line) { return bodyOf(readRecord(line, "test", sceneSchemas())); }

/// A round plate of `n` triangles about (x, y), as meshes from files have them.
Mesh disc(double x, double y, double radius, std::uint32_t n) {
    Mesh mesh{Material::Mesh, {{x, y, 1}}, {}};
    for (std::uint32_t i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        mesh.vertices.push_back({x + radius * std::cos(a), y + radius * std::sin(a), 0.5});
        mesh.triangles.push_back({0, i + 1, (i + 1) % n + 1});
    }
    return mesh;
}

double areaOf(const std::vector<Polygon>& curves) {
    double area = 0;
    for (const Polygon& curve : curves) area += signedArea(curve);
    return area;
}

TEST(Footprint, WhatLiesBelowABoardIsHidden) {
    for (const char* line : {"table at=1,2", "desk at=1,2 heading=33", "desk at=1,2 kind=closed",
                             "chair at=-3,2 heading=77"}) {
        const Body body = bodyFrom(line);
        const std::vector<Region> pieces = footprintOf(body);
        ASSERT_EQ(pieces.size(), 1U) << line;
        EXPECT_TRUE(pieces.front().holes.empty());
        double largest = 0;
        for (const Prism& prism : body.prisms)
            largest =
                std::max(largest, prism.curve ? prism.curve->area() : signedArea(prism.footprint));
        EXPECT_NEAR(pieces.front().area(), largest, 1e-9) << line;
    }
    std::size_t seen = 0;
    for (const OverheadPart& part : partsFromAbove(bodyFrom("desk at=1,2 heading=33")))
        seen += part.hidden ? 0 : 1;
    EXPECT_EQ(seen, 1U);
}

TEST(Footprint, PartsComeLowestFirst) {
    const std::vector<OverheadPart> parts = partsFromAbove(bodyFrom("table at=1,2"));
    ASSERT_EQ(parts.size(), 3U);
    EXPECT_TRUE(parts[0].hidden);
    EXPECT_FALSE(parts[2].hidden);
    EXPECT_LT(parts[0].top, parts[1].top);
    EXPECT_LT(parts[1].top, parts[2].top);
}

TEST(Footprint, PartsBesideEachOtherAreUnited) {
    Body body;
    const auto add = [&](double x0, double y0, double x1, double y1) {
        body.prisms.push_back({{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, 0, 1, Material::Box});
    };
    add(0, 0, 2, 1);
    add(1, 0.5, 3, 2);
    add(5, 5, 6, 6);
    const std::vector<Region> pieces = footprintOf(body);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_DOUBLE_EQ(totalArea(pieces), 2 + 3 - 0.5 + 1);
    EXPECT_TRUE(footprintOf({}).empty());
}

TEST(Footprint, MeshesShowTheirOutline) {
    const auto circle = [](double radius) { return std::numbers::pi * radius * radius; };
    const std::vector<Polygon> few = silhouette(disc(1, 2, 0.5, 32));
    ASSERT_EQ(few.size(), 1U);
    EXPECT_EQ(few.front().size(), 32U);
    const std::vector<Polygon> many = silhouette(disc(1, 2, 0.5, 5000));
    ASSERT_EQ(many.size(), 1U);
    EXPECT_NEAR(areaOf(many), circle(0.5), 0.02 * circle(0.5));
    for (const Point2 p : many.front())
        EXPECT_NEAR(distance(p, {1, 2}), 0.5, 2 * std::numbers::sqrt2 / 500);
    EXPECT_TRUE(silhouette({}).empty());
    Mesh upright{Material::Mesh, {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}}, {{0, 1, 2}}};
    EXPECT_TRUE(silhouette(upright).empty());
    upright.triangles.resize(500, {0, 1, 2});
    EXPECT_LT(areaOf(silhouette(upright)), 0.02);
    upright.vertices.assign(3, {1, 1, 1});
    EXPECT_TRUE(silhouette(upright).empty());
}

TEST(Footprint, RegionsFindTheirHoles) {
    const auto box = [](double low, double high, bool hole) {
        Polygon polygon{{low, low}, {high, low}, {high, high}, {low, high}};
        if (hole) std::reverse(polygon.begin(), polygon.end());
        return polygon;
    };
    const std::vector<Region> regions =
        regionsOf({box(4, 6, false), box(3, 7, true), box(0, 10, false), box(4.5, 5, true)});
    ASSERT_EQ(regions.size(), 2U);
    EXPECT_DOUBLE_EQ(regions[0].area(), 4 - 0.25);
    EXPECT_DOUBLE_EQ(regions[1].area(), 100 - 16);
}

}  // namespace elements_test
}  // namespace ispace
