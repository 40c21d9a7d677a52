// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>

#include "geom/predicates.h"
#include "support/test_cells.h"

namespace ispace {
namespace contour_test {

using testing::cellsOf;
using testing::largestPiece;

/// Noise, smoothed a little: blobs with holes, pinches and slits.
MapCells randomBlob(std::mt19937_64& random, int size, unsigned density) {
    MapCells noise(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (random() % 100 < density) noise.insert(x, y);
    return largestPiece(noise);
}

/// Creates a half plane of cells: those with centres right of the line through the middle.
MapCells halfPlane(int size, double degrees) {
    const Vec2 normal = unitVector(Angle::degrees(degrees));
    MapCells cells(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            if (dot(normal, Vec2{x + 0.5 - size / 2.0, y + 0.5 - size / 2.0}) > 0.1)
                cells.insert(x, y);
    return largestPiece(cells);
}

double totalArea(const std::vector<Polygon>& curves) {
    return std::accumulate(curves.begin(), curves.end(), 0.0, [](double sum, const Polygon& curve) {
        return sum + signedArea(curve);
    });
}

/// Edges of the curves that cross: a point in common that is no end point of either.
int crossings(const std::vector<Polygon>& curves) {
    std::vector<Segment2> edges;
    for (const Polygon& curve : curves)
        forEachEdge(curve, [&](const Segment2& edge) { edges.push_back(edge); });
    int count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            const Segment2& s = edges[i];
            const Segment2& t = edges[j];
            const bool share = s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
            if (!share && intersects(s, t)) ++count;
        }
    return count;
}

TEST(BoundaryCurves, RoomWithPillar) {
    const auto curves = boundaryCurves(cellsOf({".....",  //
                                                "..#..",  //
                                                ".....",  //
                                                "....#"}));
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[0], (Polygon{{4, 0}, {4, 1}, {5, 1}, {5, 4}, {0, 4}, {0, 0}}));
    // Clockwise, from its lowest edge with the set above: the pillar's top.
    EXPECT_EQ(curves[1], (Polygon{{3, 3}, {3, 2}, {2, 2}, {2, 3}}));
    EXPECT_EQ(totalArea(curves), 18);
}

TEST(BoundaryCurves, SingleCell) {
    EXPECT_EQ(boundaryCurves(cellsOf({"."})),
              (std::vector<Polygon>{{{1, 0}, {1, 1}, {0, 1}, {0, 0}}}));
}

TEST(BoundaryCurves, PinchOfOutlineKeepsCellsApart) {
    // Two arms of a ring touch by a corner at (2, 1) and stay apart there.
    const auto curves = boundaryCurves(cellsOf({"....",  //
                                                ".##.",  //
                                                ".#..",  //
                                                "..#."}));
    // The set's complement is 8-connected: no hole, one outline that touches itself.
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(totalArea(curves), 12);
    EXPECT_EQ(std::count(curves[0].begin(), curves[0].end(), Point2{2, 1}), 2);
}

TEST(BoundaryCurves, DiagonalPillarsAreOneHole) {
    const auto curves = boundaryCurves(cellsOf({"....",  //
                                                ".#..",  //
                                                "..#.",  //
                                                "...."}));
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(signedArea(curves[1]), -2);
    EXPECT_EQ(std::count(curves[1].begin(), curves[1].end(), Point2{2, 2}), 2);
}

TEST(BoundaryCurves, CoverTheCellsExactly) {
    std::mt19937_64 random(2024);
    for (int round = 0; round < 40; ++round) {
        const MapCells blob = randomBlob(random, 4 + round, 60 + static_cast<unsigned>(round) % 35);
        const auto curves = boundaryCurves(blob);
        EXPECT_EQ(totalArea(curves), static_cast<double>(blob.count()));
        EXPECT_GT(signedArea(curves.front()), 0);
        for (std::size_t i = 1; i < curves.size(); ++i) EXPECT_LT(signedArea(curves[i]), 0);
        Region region{curves.front(), {curves.begin() + 1, curves.end()}};
        for (int y = 0; y < blob.height(); ++y)
            for (int x = 0; x < blob.width(); ++x)
                ASSERT_EQ(region.locate({x + 0.5, y + 0.5}) == Side::Inside, blob.contains(x, y));
    }
}

TEST(WithoutStairs, KeepsRectanglesAndRightAngles) {
    for (const auto& rows : {std::vector<std::string>{"."}, {".."}, {"...", "..."}}) {
        const auto curves = boundaryCurves(cellsOf(rows));
        EXPECT_EQ(withoutStairs(curves), curves);
    }
    // An L with legs wide enough to be kept.
    const std::vector<Polygon> corner{{{9, 0}, {9, 3}, {4, 3}, {4, 8}, {0, 8}, {0, 0}}};
    EXPECT_EQ(withoutStairs(corner), corner);
}

TEST(WithoutStairs, KeepsTheStepOfALongWall) {
    const std::vector<Polygon> step{{{20, 0}, {20, 1}, {40, 1}, {40, 9}, {0, 9}, {0, 0}}};
    EXPECT_EQ(withoutStairs(step), step);
}

TEST(WithoutStairs, MakesADiagonalStraight) {
    const auto curves = withoutStairs(boundaryCurves(cellsOf({"....####",  //
                                                              ".....###",  //
                                                              "......##",  //
                                                              ".......#",  //
                                                              "........",  //
                                                              "........",  //
                                                              "........",  //
                                                              "........"})));
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves[0], (Polygon{{8, 0}, {8, 4}, {7.5, 4}, {4, 7.5}, {4, 8}, {0, 8}, {0, 0}}));
    EXPECT_EQ(signedArea(curves[0]), 54.125);
}

TEST(WithoutStairs, FlattensABumpOfOneCell) {
    const std::vector<Polygon> bump{
        {{7, 0}, {7, 3}, {4, 3}, {4, 4}, {3, 4}, {3, 3}, {0, 3}, {0, 0}}};
    EXPECT_EQ(withoutStairs(bump),
              (std::vector<Polygon>{{{7, 0}, {7, 3}, {4, 3.5}, {3, 3.5}, {0, 3}, {0, 0}}}));
}

TEST(WithoutStairs, CrossesNothingAndMovesHalfACell) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 120; ++round) {
        const MapCells blob =
            randomBlob(random, 3 + round % 22, 55 + static_cast<unsigned>(round) % 40);
        const auto curves = boundaryCurves(blob);
        const auto smooth = withoutStairs(curves);
        ASSERT_EQ(smooth.size(), curves.size());
        EXPECT_EQ(crossings(smooth), 0) << round;
        for (std::size_t i = 0; i < curves.size(); ++i) {
            EXPECT_GE(smooth[i].size(), 4U);
            EXPECT_GT(signedArea(smooth[i]) * signedArea(curves[i]), 0);
            for (const Point2 corner : curves[i]) {
                double nearest = 1e9;
                forEachEdge(smooth[i], [&](const Segment2& edge) {
                    nearest = std::min(nearest, distance(corner, edge));
                });
                EXPECT_LE(nearest, 0.5);
            }
        }
    }
}

TEST(Vectorised, ToleranceZeroIsExact) {
    std::mt19937_64 random(31);
    for (int round = 0; round < 20; ++round) {
        const MapCells blob = randomBlob(random, 30, 70);
        EXPECT_EQ(vectorised(blob, 0).area(), static_cast<double>(blob.count()));
    }
}

TEST(Vectorised, AreaStaysWithinTheMovedBoundary) {
    std::mt19937_64 random(32);
    for (const double tolerance : {0.25, 0.5, 1.0, 1.5}) {
        for (int round = 0; round < 20; ++round) {
            const MapCells blob = randomBlob(random, 30, 60 + static_cast<unsigned>(round));
            const Region exact = vectorised(blob, 0);
            const Region region = vectorised(blob, tolerance);
            EXPECT_EQ(region.holes.size(), exact.holes.size());
            EXPECT_LE(std::abs(region.area() - exact.area()), exact.boundaryLength() * tolerance);
            std::vector<Polygon> curves = region.holes;
            curves.push_back(region.outline);
            EXPECT_EQ(crossings(curves), 0) << tolerance << ' ' << round;
        }
    }
}

TEST(Vectorised, SlantedWallsBecomeFewSegments) {
    for (const double degrees : {8.0, 13.0, 26.565, 30.0, 45.0, 60.0, 77.0, 160.0, 250.0}) {
        const Region exact = vectorised(halfPlane(100, degrees), 0);
        const Region region = vectorised(halfPlane(100, degrees), 1);
        EXPECT_LE(region.outline.size(), 14U) << degrees;
        EXPECT_GE(exact.outline.size(), 15U) << degrees;
        EXPECT_NEAR(region.area(), exact.area(), 60) << degrees;
    }
}

TEST(Vectorised, StraightWallsStayStraight) {
    MapCells cells(60, 40);
    for (int y = 3; y < 37; ++y)
        for (int x = 2; x < 55; ++x)
            if (x < 20 || x > 24 || y < 10 || y > 13) cells.insert(x, y);
    const Region region = vectorised(cells, 1);
    EXPECT_EQ(bounds(region.outline), (Box2{{2, 3}, {55, 37}}));
    EXPECT_EQ(region.outline.size(), 4U);
    ASSERT_EQ(region.holes.size(), 1U);
    EXPECT_EQ(bounds(region.holes[0]), (Box2{{20, 10}, {25, 14}}));
    EXPECT_EQ(region.area(), 53 * 34 - 5 * 4);
}

TEST(Vectorised, KeepsAPillarOfOneCell) {
    MapCells cells(9, 9);
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x)
            if (x != 4 || y != 4) cells.insert(x, y);
    const Region region = vectorised(cells, 1);
    EXPECT_EQ(region.area(), 80);
    ASSERT_EQ(region.holes.size(), 1U);
    EXPECT_EQ(region.holes[0].size(), 4U);
}

TEST(Vectorised, RigidCellsKeepTheirCorners) {
    // A wall of a slope, and steps in it.
    MapCells cells(40, 12);
    for (int x = 0; x < 40; ++x)
        for (int y = 0; y < 4 + x / 8; ++y) cells.insert(x, y);
    const Region free = vectorised(cells, 2);
    MapCells rigid(40, 12);
    rigid.insert(16, 6);
    const Region held = vectorised(cells, 2, &rigid);
    const auto has = [](const Region& region, Point2 corner) {
        return std::find(region.outline.begin(), region.outline.end(), corner) !=
               region.outline.end();
    };
    for (const Point2 corner : {Point2{16, 5}, Point2{16, 6}}) {
        EXPECT_TRUE(has(vectorised(cells, 0), corner));
        EXPECT_EQ(has(held, corner), corner.y == 6);
        EXPECT_FALSE(has(free, corner));
    }
}

Grid unitGrid(int columns, int rows) {
    return {{{0, 0}, {static_cast<double>(columns), static_cast<double>(rows)}}, columns, rows};
}

CellSet setOf(const Grid& grid, const std::vector<std::string>& picture) {
    CellSet cells(grid.size());
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            if (picture[static_cast<std::size_t>(grid.rows - 1 - row)]
                       [static_cast<std::size_t>(column)] == '#')
                cells.set(grid.cell(column, row));
    return cells;
}

TEST(Contours, NoneOfTheEmptySet) {
    const Grid grid = unitGrid(3, 3);
    EXPECT_TRUE(contours(grid, CellSet(9)).empty());
}

TEST(Contours, OneCellHasFourCorners) {
    const Grid grid = unitGrid(3, 3);
    const auto curves = contours(grid, setOf(grid, {"...", ".#.", "..."}));
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves[0].size(), 4U);
    EXPECT_EQ(signedArea(curves[0]), 1);
}

TEST(Contours, RunsAreMergedAndHolesTurnClockwise) {
    const Grid grid = unitGrid(4, 4);
    const auto curves = contours(grid, setOf(grid, {"####", "#..#", "#..#", "####"}));
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[0].size(), 4U);
    EXPECT_EQ(curves[1].size(), 4U);
    EXPECT_EQ(signedArea(curves[0]), 16);
    EXPECT_EQ(signedArea(curves[1]), -4);
}

TEST(Contours, CellsThatTouchAtACornerAreApart) {
    const Grid grid = unitGrid(3, 3);
    EXPECT_EQ(contours(grid, setOf(grid, {"#.#", ".#.", "#.#"})).size(), 5U);
    EXPECT_EQ(contours(grid, setOf(grid, {".#.", "#.#", ".#."})).size(), 4U);
}

TEST(Contours, FillExactlyTheCells) {
    std::mt19937_64 random(5);
    for (int trial = 0; trial < 100; ++trial) {
        const Grid grid =
            unitGrid(1 + static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 12));
        CellSet cells(grid.size());
        for (std::size_t i = 0; i < grid.size(); ++i)
            if (random() % 2 != 0) cells.set(i);
        const auto curves = contours(grid, cells);
        double area = 0;
        for (const Polygon& curve : curves) area += signedArea(curve);
        EXPECT_EQ(area, static_cast<double>(cells.count()));
        for (std::size_t i = 0; i < grid.size(); ++i) {
            int inside = 0;
            for (const Polygon& curve : curves)
                inside += locate(curve, grid.center(i)) == Side::Inside ? 1 : 0;
            ASSERT_EQ(inside % 2 == 1, cells.test(i)) << trial;
        }
    }
}

TEST(CellRegions, HolesBelongToTheInnermostOutline) {
    // A ring with an island in its hole, and a hole in the island.
    const Grid grid{{{0, 0}, {9, 9}}, 9, 9};
    CellSet cells(grid.size());
    for (int row = 0; row < 9; ++row)
        for (int column = 0; column < 9; ++column)
            if (const int ring = std::max(std::abs(row - 4), std::abs(column - 4));
                ring == 4 || ring == 3 || ring == 1)
                cells.set(grid.cell(column, row));
    const std::vector<Region> pieces = cellRegions(grid, cells);
    ASSERT_EQ(pieces.size(), 2U);
    std::vector<double> areas;
    for (const Region& piece : pieces) {
        EXPECT_EQ(piece.holes.size(), 1U);
        areas.push_back(piece.area());
    }
    std::sort(areas.begin(), areas.end());
    EXPECT_EQ(areas[0], 8);
    EXPECT_EQ(areas[1], 81 - 25);
}

}  // namespace contour_test
}  // namespace ispace
