// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "geom/planar_map.h"
#include "geom/polygon.h"
#include "geom/predicates.h"
#include "support/test_curves.h"

namespace ispace {
namespace polygon_cgal_test {

double distanceFrom(const Polygon& curve, Point2 p) {
    double nearest = 1e300;
    forEachEdge(curve, [&](const Segment2& e) { nearest = std::min(nearest, distance(p, e)); });
    return nearest;
}

/// Greatest distance of a point of one curve from the other, both ways, points taken densely.
double displacement(const Polygon& a, const Polygon& b) {
    double most = 0;
    const auto measure = [&](const Polygon& from, const Polygon& to) {
        forEachEdge(from, [&](const Segment2& e) {
            for (int i = 0; i < 8; ++i)
                most = std::max(most, distanceFrom(to, e.a + (i / 8.0) * (e.b - e.a)));
        });
    };
    measure(a, b);
    measure(b, a);
    return most;
}

/// Curves of the pixel map with collinear vertices gone or not: outlines and holes of its faces.
std::vector<Polygon> curvesOf(const test::PixelMap& map) {
    std::vector<Region> faces = boundedFaces(weld(map.boundary()));
    std::erase_if(faces, [&map](const Region& face) {
        const Point2 p = interiorPoint(face);
        return !map.at(int(std::floor(p.x)), int(std::floor(p.y)));
    });
    return curvesOf(faces);
}

TEST(Simplified, dropsCollinearVertices) {
    const Polygon dense{{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 2}, {4, 4}, {1, 4}, {0, 4}, {0, 1}};
    const auto result = simplified({dense}, 0);
    ASSERT_EQ(result.size(), 1U);
    EXPECT_EQ(result[0], test::box(0, 0, 4, 4));
    // The orientation stays.
    const auto turned = simplified({Polygon(dense.rbegin(), dense.rend())}, 0);
    EXPECT_EQ(signedArea(turned[0]), -16);
}

TEST(Simplified, takesTheStairsOutOfASlope) {
    Polygon stairs{{0, 0}};
    for (int i = 0; i < 20; ++i) {
        stairs.push_back({i + 1.0, double(i)});
        stairs.push_back({i + 1.0, i + 1.0});
    }
    stairs.push_back({0, 20});
    const auto result = simplified({stairs}, 0.75);
    EXPECT_LE(result[0].size(), 5U);
    EXPECT_LE(displacement(result[0], stairs), 0.75);
}

TEST(Simplified, keepsTheVerticesThatAreToStay) {
    const Polygon notched{{0, 0}, {10, 0}, {10, 4}, {6, 4}, {5.5, 4.2}, {5, 4}, {0, 4}};
    EXPECT_EQ(simplified({notched}, 0.5)[0].size(), 4U);
    EXPECT_EQ(simplified({notched}, 0.5, {{5.5, 4.2}})[0].size(), 5U);
    EXPECT_EQ(simplified({notched}, 0.5, {{6, 4}, {5.5, 4.2}, {5, 4}})[0].size(), 7U);
}

TEST(Simplified, losesNoCurveHoweverSmall) {
    const std::vector<Polygon> curves{
        test::box(0, 0, 10, 10), test::box(5, 5, 5.01, 5.01), {{7, 7}, {7.001, 7}, {7, 7.001}}};
    const auto result = simplified(curves, 1);
    ASSERT_EQ(result.size(), 3U);
    for (const Polygon& curve : result) {
        EXPECT_GE(curve.size(), 3U);
        EXPECT_NE(signedArea(curve), 0);
    }
}

TEST(Simplified, returnsWhatIsNoCurveAsItIs) {
    const std::vector<Polygon> curves{{}, {{1, 1}}, {{1, 1}, {2, 2}}, {{3, 3}, {3, 3}, {3, 3}}};
    EXPECT_EQ(simplified(curves, 0.1), curves);
    EXPECT_TRUE(simplified({}, 0.1).empty());
}

TEST(Simplified, keepsVerticesWhereCurvesTouch) {
    // The second curve touches the first at (2, 0.1), the third touches itself at (20, 2).
    const std::vector<Polygon> curves{
        {{0, 0}, {2, 0.1}, {4, 0}, {4, -4}, {0, -4}},
        {{2, 0.1}, {3, 4}, {1, 4}},
        {{18, 0}, {20, 2}, {22, 0}, {22, 4}, {20, 2}, {18, 4}},
    };
    const auto result = simplified(curves, 0.5);
    const auto count = [](const Polygon& curve, Point2 p) {
        return std::count(curve.begin(), curve.end(), p);
    };
    EXPECT_EQ(count(result[0], {2, 0.1}), 1);
    EXPECT_EQ(count(result[1], {2, 0.1}), 1);
    EXPECT_EQ(count(result[2], {20, 2}), 2);
    // Alone the first would lose it.
    EXPECT_EQ(count(simplified({curves[0]}, 0.5)[0], {2, 0.1}), 0);
}

TEST(Simplified, displacementIsMeasuredAgainstTheOriginal) {
    // A slow spiral of vertices: each step alone is small, together they would drift far.
    Polygon arc;
    for (int i = 0; i <= 400; ++i) {
        const double angle = 3.0 * i / 400;
        arc.push_back({5 * std::cos(angle), 5 * std::sin(angle)});
    }
    arc.push_back({0, -1});
    for (const double tolerance : {0.001, 0.01, 0.1, 0.5}) {
        const auto result = simplified({arc}, tolerance);
        EXPECT_LE(displacement(result[0], arc), tolerance * (1 + 1e-9));
        EXPECT_LT(result[0].size(), arc.size() / 3);
    }
}

TEST(Simplified, raggedMapsStayWithinToleranceAndDoNotCross) {
    std::mt19937_64 random(16);
    for (const double tolerance : {0.3, 0.8, 1.5, 3.0}) {
        const test::PixelMap map(random, 30, 30, 0.72);
        const auto curves = curvesOf(map);
        const auto result = simplified(curves, tolerance);
        ASSERT_EQ(result.size(), curves.size());

        std::vector<std::pair<Segment2, std::size_t>> edges;
        std::size_t before = 0;
        for (std::size_t i = 0; i < curves.size(); ++i) {
            EXPECT_LE(displacement(result[i], curves[i]), tolerance * (1 + 1e-9));
            EXPECT_GT(signedArea(result[i]) * signedArea(curves[i]), 0);
            EXPECT_GE(result[i].size(), 3U);
            before += curves[i].size();
            forEachEdge(result[i], [&](const Segment2& e) { edges.emplace_back(e, i); });
        }
        EXPECT_LT(edges.size(), before);
        // Edges meet at common end points only, and only where their curves met before.
        for (std::size_t i = 0; i < edges.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const auto& [s, of_s] = edges[i];
                const auto& [t, of_t] = edges[k];
                if (!intersects(s, t)) continue;
                const bool share = s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
                EXPECT_TRUE(share);
                const Point2 common = s.a == t.a || s.a == t.b ? s.a : s.b;
                const auto has = [&](std::size_t c) {
                    return std::find(curves[c].begin(), curves[c].end(), common) != curves[c].end();
                };
                EXPECT_TRUE(has(of_s) && has(of_t));
            }
        }
    }
}

TEST(Simplified, raggedMapsKeepTheirPieces) {
    // In metres the corners of pixels lie on common lines only up to rounding: an edge that passes
    // a vertex by that much would join the two when they are welded, and cut a room in two.
    std::mt19937_64 random(17);
    test::PixelMap map(random, 80, 80, 0.75);
    auto curves = curvesOf(map);
    const auto facesOf = [](const std::vector<Polygon>& all) {
        std::vector<Segment2> lines;
        for (const Polygon& curve : all)
            forEachEdge(curve, [&](const Segment2& e) { lines.push_back(e); });
        return boundedFaces(weld(lines)).size();
    };
    for (Polygon& curve : curves) {
        for (Point2& p : curve) p = {p.x * 0.05 - 12.3, p.y * 0.05 + 4.56};
    }
    for (const double tolerance : {0.025, 0.05, 0.08, 0.1, 0.2})
        EXPECT_EQ(facesOf(simplified(curves, tolerance)), facesOf(curves)) << tolerance;
}

TEST(Simplified, dependsOnTheCurvesNotOnTheirOrder) {
    std::mt19937_64 random(18);
    const auto curves = curvesOf(test::PixelMap(random, 40, 40, 0.7));
    const auto result = simplified(curves, 0.8);
    std::vector<std::size_t> order(curves.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), random);
    std::vector<Polygon> shuffled;
    for (const std::size_t i : order) shuffled.push_back(curves[i]);
    const auto again = simplified(shuffled, 0.8);
    for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(again[i], result[order[i]]);
}

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

}  // namespace polygon_cgal_test
}  // namespace ispace
