// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/predicates.h"
#include "support/test_curves.h"

namespace ispace {
namespace polygon_test {

TEST(Box2, growsFromEmpty) {
    Box2 box;
    EXPECT_TRUE(box.empty());
    box.add({1, 2});
    EXPECT_FALSE(box.empty());
    EXPECT_EQ(box.width(), 0);
    box.add({-1, 6});
    EXPECT_EQ(box.width(), 2);
    EXPECT_EQ(box.depth(), 4);
    EXPECT_EQ(box.center(), (Point2{0, 4}));
}

TEST(Box2, expandsEachSide) {
    const Box2 box{{1, 2}, {4, 6}};
    EXPECT_EQ(box.expanded(0.5), (Box2{{0.5, 1.5}, {4.5, 6.5}}));
    EXPECT_EQ(box.expanded(1, 0), (Box2{{0, 2}, {5, 6}}));
    EXPECT_EQ((Box2{{1, 2}, {1, 2}}.expanded(1)), (Box2{{0, 1}, {2, 3}}));
    EXPECT_TRUE(box.expanded(-2).empty());
    EXPECT_TRUE(Box2().expanded(3).empty());
}

TEST(Polygon, boundsOfManyHoldAllOutlines) {
    const std::vector<Polygon> curves = {test::box(1, 2, 4, 6), test::box(-3, 5, 0, 9), {}};
    EXPECT_EQ(bounds(curves), (Box2{{-3, 2}, {4, 9}}));
    const std::vector<Region> regions = {{curves[0], {test::box(2, 3, 3, 4)}}, {curves[1], {}}};
    EXPECT_EQ(bounds(regions), bounds(curves));
    EXPECT_TRUE(bounds(std::vector<Region>()).empty());
}

TEST(Polygon, areaPerimeterBounds) {
    const Polygon room = test::box(1, 2, 4, 6);
    EXPECT_EQ(signedArea(room), 12);
    EXPECT_EQ(signedArea(Polygon(room.rbegin(), room.rend())), -12);
    EXPECT_EQ(perimeter(room), 14);
    EXPECT_EQ(bounds(room), (Box2{{1, 2}, {4, 6}}));
}

TEST(Polygon, degenerateHaveNoArea) {
    EXPECT_EQ(signedArea({}), 0);
    EXPECT_EQ(perimeter({}), 0);
    EXPECT_TRUE(bounds(Polygon()).empty());
    EXPECT_EQ(signedArea({{1, 1}}), 0);
    EXPECT_EQ(signedArea({{1, 1}, {2, 5}}), 0);
    EXPECT_EQ(perimeter({{0, 0}, {3, 4}}), 10);
    EXPECT_EQ(signedArea({{0, 0}, {1, 1}, {2, 2}}), 0);
}

TEST(Segment, bounds) {
    EXPECT_EQ(bounds(Segment2{{4, 2}, {1, 6}}), (Box2{{1, 2}, {4, 6}}));
    EXPECT_EQ(bounds(Segment2{{1, 2}, {1, 2}}), (Box2{{1, 2}, {1, 2}})) << "a point has a box";
}

TEST(Convex, turnsLeftOrGoesStraightOn) {
    const Polygon square = test::box(0, 0, 1, 1);
    EXPECT_TRUE(isConvex(square));
    EXPECT_TRUE(isConvex({{0, 0}, {1, 0}, {2, 0}, {2, 2}})) << "a vertex along an edge";
    EXPECT_TRUE(isConvex({{0, 0}, {1, 0}, {1, 0}, {1, 1}})) << "a doubled vertex";
    EXPECT_FALSE(isConvex({{0, 0}, {2, 0}, {1, 0.5}, {0, 2}}));
    EXPECT_FALSE(isConvex({square.rbegin(), square.rend()})) << "clockwise";
    EXPECT_TRUE(isConvex({{0, 0}, {0.5, -0x1p-60}, {1, 0}, {0, 1}})) << "decided exactly";
    EXPECT_FALSE(isConvex({{0, 0}, {0.5, 0x1p-60}, {1, 0}, {0, 1}}));
}

TEST(Convex, strictlyTurnsLeftOnly) {
    EXPECT_TRUE(isStrictlyConvex(test::box(0, 0, 1, 1)));
    EXPECT_TRUE(isStrictlyConvex({{0, 0}, {0.5, -0x1p-60}, {1, 0}, {0, 1}}));
    EXPECT_FALSE(isStrictlyConvex({{0, 0}, {1, 0}, {2, 0}, {2, 2}}));
    EXPECT_FALSE(isStrictlyConvex({{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 1}})) << "at the seam";
    EXPECT_FALSE(isStrictlyConvex({{0, 0}, {1, 0}, {1, 0}, {1, 1}}));
    EXPECT_FALSE(isStrictlyConvex({{0, 0}, {0, 1}, {1, 1}, {1, 0}})) << "clockwise";
}

TEST(Convex, needsAnArea) {
    for (const Polygon& none : {Polygon(), {{1, 1}}, {{1, 1}, {2, 5}}, {{0, 0}, {1, 0}, {2, 0}}}) {
        EXPECT_FALSE(isConvex(none)) << none.size();
        EXPECT_FALSE(isStrictlyConvex(none)) << none.size();
    }
}

TEST(Polygon, areaKeepsItsDigitsFarFromTheOrigin) {
    EXPECT_NEAR(signedArea(test::box(1e6, 1e6, 1e6 + 0.5, 1e6 + 0.25)), 0.125, 1e-12);
}

TEST(Locate, insideOutsideBoundary) {
    const Polygon l{{0, 0}, {8, 0}, {8, 3}, {4, 3}, {4, 6}, {0, 6}};
    EXPECT_EQ(locate(l, {1, 1}), Side::Inside);
    EXPECT_EQ(locate(l, {6, 5}), Side::Outside);
    EXPECT_EQ(locate(l, {-1, 3}), Side::Outside) << "level with an edge";
    EXPECT_EQ(locate(l, {2, 3}), Side::Inside) << "level with an edge";
    EXPECT_EQ(locate(l, {9, 3}), Side::Outside) << "level with an edge";
    EXPECT_EQ(locate(l, {6, 3}), Side::Boundary);
    EXPECT_EQ(locate(l, {4, 4}), Side::Boundary);
    for (const Point2 corner : l) EXPECT_EQ(locate(l, corner), Side::Boundary);
    EXPECT_EQ(locate({}, {0, 0}), Side::Outside);
    EXPECT_EQ(locate({{1, 1}}, {1, 1}), Side::Boundary);
    EXPECT_EQ(locate({{0, 0}, {2, 2}}, {1, 1}), Side::Boundary);
}

TEST(Locate, isExactBesideASlopingEdge) {
    const Polygon triangle{{0, 0}, {24, 24}, {0, 24}};
    const double x = 0.5 + std::ldexp(1, -52);
    EXPECT_EQ(locate(triangle, {x, x}), Side::Boundary);
    EXPECT_EQ(locate(triangle, {x, std::nextafter(x, 1)}), Side::Inside);
    EXPECT_EQ(locate(triangle, {std::nextafter(x, 1), x}), Side::Outside);
}

TEST(Locate, evenOddWhereACurveTouchesItself) {
    // Two squares joined at (1, 1).
    const Polygon eight{{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {1, 2}, {1, 1}, {0, 1}};
    EXPECT_EQ(locate(eight, {0.5, 0.5}), Side::Inside);
    EXPECT_EQ(locate(eight, {1.5, 1.5}), Side::Inside);
    EXPECT_EQ(locate(eight, {1.5, 0.5}), Side::Outside);
    EXPECT_EQ(locate(eight, {1, 1}), Side::Boundary);
}

TEST(Region, areaAndSides) {
    Polygon hole = test::box(2, 2, 4, 4);
    std::reverse(hole.begin(), hole.end());
    const Region region{test::box(0, 0, 8, 6), {hole}};
    EXPECT_EQ(region.area(), 44);
    EXPECT_EQ(region.boundaryLength(), 36);
    EXPECT_EQ(region.locate({1, 1}), Side::Inside);
    EXPECT_EQ(region.locate({3, 3}), Side::Outside);
    EXPECT_EQ(region.locate({2, 3}), Side::Boundary);
    EXPECT_EQ(region.locate({8, 3}), Side::Boundary);
    EXPECT_EQ(region.locate({9, 3}), Side::Outside);
    std::size_t edges = 0;
    region.forEachEdge([&](const Segment2&) { ++edges; });
    EXPECT_EQ(edges, 8U);
}

TEST(Region, curvesAreOutlineAndHoles) {
    const Polygon outline = test::box(0, 0, 8, 6), one = test::box(2, 2, 4, 4),
                  two = test::box(5, 2, 6, 4), other = test::box(9, 0, 10, 1);
    const Region region{outline, {one, two}};
    EXPECT_EQ(curvesOf(region), (std::vector<Polygon>{outline, one, two}));
    EXPECT_EQ(curvesOf(Region{outline, {}}), std::vector<Polygon>{outline});
    EXPECT_EQ(curvesOf({region, {other, {}}}), (std::vector<Polygon>{outline, one, two, other}));
    EXPECT_TRUE(curvesOf(std::vector<Region>()).empty());
}

double clearance(const Region& region, Point2 p) {
    double nearest = 1e300;
    region.forEachEdge([&](const Segment2& e) { nearest = std::min(nearest, distance(p, e)); });
    return nearest;
}

TEST(InteriorPoint, isWellInside) {
    const Region room{test::box(0, 0, 8, 6), {}};
    EXPECT_GT(clearance(room, interiorPoint(room)), 2.8);
    Polygon pillar = test::box(3, 2, 5, 4);
    std::reverse(pillar.begin(), pillar.end());
    const Region ring{test::box(0, 0, 8, 6), {pillar}};
    EXPECT_EQ(ring.locate(interiorPoint(ring)), Side::Inside);
    EXPECT_GT(clearance(ring, interiorPoint(ring)), 0.9);
}

/// A comb with enough edges for two threads; its widest gap is the answer.
TEST(InteriorPoint, isTheWidestPlaceOfManyEdges) {
    Region comb{test::box(0, 0, 100, 10), {}};
    Polygon& outline = comb.outline;
    outline.pop_back();
    const Point2 last{0, 10};
    for (int i = 4000; i > 0; --i) {
        const double x = i < 2000 ? i * 0.02 : 20 + i * 0.02;
        outline.insert(outline.end(), {{x, 10}, {x, 1}, {x - 0.01, 1}, {x - 0.01, 10}});
    }
    outline.push_back(last);
    const Point2 place = interiorPoint(comb);
    EXPECT_EQ(comb.locate(place), Side::Inside);
    EXPECT_GT(clearance(comb, place), 4.9);
}

/// Rows of posts: few distances between many vertices.
TEST(InteriorPoint, isInTheWidestAisle) {
    constexpr int kRows = 41, kColumns = 40, kBefore = 17;
    constexpr double kAisle = 2.5, kPost = 0.1;
    Region hall{test::box(-1, -1, 95, 43), {}};
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const double x = 2.4 * column, y = row + (row < kBefore ? 0 : kAisle + kPost - 1);
            Polygon post = test::box(x, y, x + kPost, y + kPost);
            std::reverse(post.begin(), post.end());
            hall.holes.push_back(post);
        }
    const Point2 place = interiorPoint(hall);
    EXPECT_EQ(hall.locate(place), Side::Inside);
    EXPECT_GT(clearance(hall, place), 1.5);  // between posts of any other aisle: 1.24
}

TEST(InteriorPoint, isStrictlyInsideSlivers) {
    const Polygon slivers[] = {
        {{0, 0}, {1, 0}, {1, 1e-12}},
        {{0, 0}, {1e6, 1e6}, {1e6, 1e6 + 1e-9}},
        {{0, 0}, {10, 1e-300}, {10, 2e-300}},
        {{1, 1}, {3, 2}, {2, std::nextafter(1.5, 2)}},
        {{0.1, 0.1}, {0.7, 0.7000000000000002}, {0.1, 0.1000000000000001}},
        {{0, 0}, {5, 0}, {5, 5}, {4.999999999, 1e-9}},
    };
    for (Polygon sliver : slivers) {
        if (signedArea(sliver) < 0) std::reverse(sliver.begin(), sliver.end());
        const Region region{sliver, {}};
        EXPECT_EQ(region.locate(interiorPoint(region)), Side::Inside) << sliver[1].x;
    }
}

TEST(InteriorPoint, refusesWhatHasNoInside) {
    EXPECT_THROW(interiorPoint({}), std::invalid_argument);
    EXPECT_THROW(interiorPoint({{{0, 0}, {1, 1}, {2, 2}}, {}}), std::invalid_argument);
}

TEST(InteriorPoint, isInsideRandomRegions) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 200; ++round) {
        const Region region{test::star(random, 3 + round, std::pow(10, round % 9 - 4)), {}};
        EXPECT_EQ(region.locate(interiorPoint(region)), Side::Inside) << round;
    }
}

}  // namespace polygon_test
}  // namespace ispace
