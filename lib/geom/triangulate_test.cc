// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "geom/planar_map.h"
#include "geom/predicates.h"
#include "geom/test_curves.h"

namespace ispace {
namespace {

double areaOf(const Triangulation& t) {
    double sum = 0;
    for (const auto& [a, b, c] : t.triangles) {
        EXPECT_EQ(orientation(t.vertices[a], t.vertices[b], t.vertices[c]), Turn::Left);
        sum += signedArea({t.vertices[a], t.vertices[b], t.vertices[c]});
    }
    return sum;
}

TEST(Triangulate, square) {
    const Triangulation t = triangulate({test::box(0, 0, 2, 2), {}});
    EXPECT_EQ(t.vertices.size(), 4U);
    EXPECT_EQ(t.triangles.size(), 2U);
    EXPECT_EQ(areaOf(t), 4);
}

TEST(Triangulate, degenerateIsEmpty) {
    EXPECT_TRUE(triangulate({}).triangles.empty());
    EXPECT_TRUE(triangulate({{{1, 1}}, {}}).triangles.empty());
    EXPECT_TRUE(triangulate({{{0, 0}, {1, 1}, {2, 2}}, {}}).triangles.empty());
    EXPECT_TRUE(triangulate({{{0, 0}, {1, 1}, {0, 0}, {1, 1}}, {}}).triangles.empty());
}

TEST(Triangulate, holesStayOpen) {
    Polygon hole = test::box(1, 1, 3, 3);
    std::reverse(hole.begin(), hole.end());
    const Region region{test::box(0, 0, 4, 4), {hole}};
    const Triangulation t = triangulate(region);
    EXPECT_EQ(t.vertices.size(), 8U);
    EXPECT_EQ(t.triangles.size(), 8U);
    EXPECT_EQ(areaOf(t), 12);
    for (const auto& [a, b, c] : t.triangles) {
        const Point2 p = t.vertices[a], q = t.vertices[b], r = t.vertices[c];
        EXPECT_EQ(region.locate({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3}), Side::Inside);
    }
}

TEST(Triangulate, curvesThatTouchShareTheVertex) {
    Polygon hole{{0, 2}, {1, 1}, {2, 2}, {1, 3}}, next{{2, 2}, {3, 1.5}, {3, 2.5}};
    std::reverse(hole.begin(), hole.end());
    std::reverse(next.begin(), next.end());
    // The first hole touches the middle of an edge of the outline and a corner of the second hole.
    const Triangulation t = triangulate({test::box(0, 0, 4, 4), {hole, next}});
    EXPECT_EQ(t.vertices.size(), 10U);
    EXPECT_DOUBLE_EQ(areaOf(t), 16 - 2 - 0.5);
}

TEST(Triangulate, coversRandomRegionsOnce) {
    std::mt19937_64 random(13);
    for (int round = 0; round < 100; ++round) {
        const Region region{test::star(random, 3 + 3 * round, std::pow(10, round % 7 - 3)), {}};
        const Triangulation t = triangulate(region);
        EXPECT_EQ(t.triangles.size(), region.outline.size() - 2);
        EXPECT_NEAR(areaOf(t), region.area(), 1e-12 * region.area());
    }
}

TEST(Triangulate, raggedMapsUseTheirOwnVertices) {
    std::mt19937_64 random(14);
    const test::PixelMap map(random, 50, 50, 0.7);
    for (const Region& face : boundedFaces(weld(map.boundary()))) {
        std::set<std::pair<double, double>> own;
        face.forEachEdge([&](const Segment2& e) { own.emplace(e.a.x, e.a.y); });
        const Triangulation t = triangulate(face);
        EXPECT_EQ(t.vertices.size(), own.size());
        for (const Point2 v : t.vertices) EXPECT_TRUE(own.contains({v.x, v.y}));
        EXPECT_DOUBLE_EQ(areaOf(t), face.area());
    }
}

TEST(Triangulate, isTheSameForRotatedCurves) {
    std::mt19937_64 random(15);
    Region region{test::star(random, 50, 5), {}};
    const auto triangles = triangulate(region).triangles;
    std::rotate(region.outline.begin(), region.outline.begin() + 17, region.outline.end());
    EXPECT_EQ(triangulate(region).triangles, triangles);
}

}  // namespace
}  // namespace ispace
