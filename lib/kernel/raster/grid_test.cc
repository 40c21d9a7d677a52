// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

#include "geom/predicates.h"

namespace ispace {
namespace grid_test {

Polygon square(double x, double y, double side) {
    return {{x, y}, {x + side, y}, {x + side, y + side}, {x, y + side}};
}

TEST(Grid, CentresAndArea) {
    const Grid grid{{{-1, 2}, {3, 4}}, 4, 2};
    EXPECT_EQ(grid.size(), 8U);
    EXPECT_EQ(grid.center(0), (Point2{-0.5, 2.5}));
    EXPECT_EQ(grid.center(3), (Point2{2.5, 2.5}));
    EXPECT_EQ(grid.center(grid.cell(1, 1)), (Point2{0.5, 3.5}));
    EXPECT_EQ(grid.cellArea(), 1);
}

TEST(Grid, CentresNeverDecrease) {
    const Grid grid{{{0.1, -1e6}, {0.1 + 1e-9, 1e6}}, 1000, 7};
    for (int i = 1; i < grid.columns; ++i)
        EXPECT_LE(grid.columnCenter(i - 1), grid.columnCenter(i));
    for (int i = 1; i < grid.rows; ++i) EXPECT_LT(grid.rowCenter(i - 1), grid.rowCenter(i));
}

TEST(CellsIn, WholeGridWhereTheRegionIsItsLimits) {
    const Grid grid{{{0, 0}, {4, 4}}, 10, 10};
    EXPECT_EQ(cellsIn(grid, {{{square(0, 0, 4), {}}}}).count(), 100U);
    EXPECT_EQ(cellsIn(grid, {{{square(-9, -9, 99), {}}}}).count(), 100U);
    EXPECT_EQ(cellsIn(grid, {{{square(5, 5, 9), {}}}}).count(), 0U);
    EXPECT_EQ(cellsIn(grid, {}).count(), 0U);
}

TEST(CellsIn, CentresOnTheBoundaryAreOutside) {
    const Grid grid{{{0, 0}, {4, 4}}, 4, 4};  // centres at .5
    EXPECT_EQ(cellsIn(grid, {{{square(0.5, 0.5, 2), {}}}}).count(), 1U);
    const Polygon hole = {{1.5, 1.5}, {1.5, 2.5}, {2.5, 2.5}, {2.5, 1.5}};
    EXPECT_EQ(cellsIn(grid, {{{square(0, 0, 4), {hole}}}}).count(), 12U);
}

TEST(CellsBlocked, CentresOnTheEdgeAreBlockedAndSolidsMayOverlap) {
    const Grid grid{{{0, 0}, {4, 4}}, 4, 4};
    EXPECT_EQ(cellsBlocked(grid, {}).count(), 0U);
    std::vector<Polygon> solids{square(0.5, 0.5, 2)};
    EXPECT_EQ(cellsBlocked(grid, solids).count(), 9U);
    solids.push_back(square(1, 1, 2.75));
    EXPECT_EQ(cellsBlocked(grid, solids).count(), 9U + 9U - 4U);
}

/// Points on a coarse lattice make edges that run through centres, along rows, and meet at them.
Polygon randomCurve(std::mt19937_64& random, bool lattice) {
    std::uniform_real_distribution<double> free(-1, 11);
    std::uniform_int_distribution<int> coarse(-2, 22);
    Polygon curve(3 + random() % 9);
    for (Point2& p : curve)
        p = lattice ? Point2{coarse(random) / 2.0, coarse(random) / 2.0}
                    : Point2{free(random), free(random)};
    return curve;
}

TEST(CellsIn, AgreesWithLocateForAnyCurves) {
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 400; ++trial) {
        const Grid grid{{{0, 0}, {10, 10}},
                        1 + static_cast<int>(random() % 20),
                        1 + static_cast<int>(random() % 20)};
        const bool lattice = trial % 2 == 0;
        const Region region{randomCurve(random, lattice), {}};
        const CellSet inside = cellsIn(grid, {{region}});
        const std::vector<Polygon> solids{region.outline, randomCurve(random, lattice)};
        const CellSet blocked = cellsBlocked(grid, solids);
        for (std::size_t cell = 0; cell < grid.size(); ++cell) {
            const Point2 p = grid.center(cell);
            ASSERT_EQ(inside.test(cell), region.locate(p) == Side::Inside)
                << trial << ": " << p.x << ' ' << p.y;
            ASSERT_EQ(blocked.test(cell), locate(solids[0], p) != Side::Outside ||
                                              locate(solids[1], p) != Side::Outside)
                << trial << ": " << p.x << ' ' << p.y;
        }
    }
}

TEST(CellsIn, AgreesWithLocateForRegionsWithHoles) {
    const Grid grid{{{0, 0}, {10, 10}}, 40, 30};
    Polygon round;
    for (int i = 0; i < 37; ++i)
        round.push_back({5 + 2 * std::sin(-i / 37.0 * 6.283), 5 + 2 * std::cos(-i / 37.0 * 6.283)});
    const Region region{{{0, 0}, {10, 1}, {9, 10}, {4, 8}, {1, 9}}, {round, square(1, 1, 1)}};
    const CellSet inside = cellsIn(grid, {{region}});
    for (std::size_t cell = 0; cell < grid.size(); ++cell)
        ASSERT_EQ(inside.test(cell), region.locate(grid.center(cell)) == Side::Inside);
    EXPECT_GT(inside.count(), 500U);
}

const Grid kGrid = gridOf({-2, -1}, 0.5, 8, 6);

Point2 middle(int column, int row) { return kGrid.center(kGrid.cell(column, row)); }

std::vector<std::vector<bool>> cellsOf(const std::vector<RowRun>& runs) {
    std::vector<std::vector<bool>> cells(6, std::vector<bool>(8));
    for (const RowRun& run : runs)
        for (int column = run.first; column <= run.last; ++column)
            cells[static_cast<std::size_t>(run.row)][static_cast<std::size_t>(column)] = true;
    return cells;
}

TEST(RunsWithin, ARectangle) {
    const Polygon square{{-1, 0}, {0.5, 0}, {0.5, 1}, {-1, 1}};
    EXPECT_EQ(runsWithin(kGrid, std::span(&square, 1)),
              (std::vector<RowRun>{{2, 2, 4}, {3, 2, 4}}));
    EXPECT_TRUE(runsWithin(kGrid, {}).empty());
}

TEST(Crossings, FarCurvesAreCutAtTheFrame) {
    const Polygon all{{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}};
    const std::vector<RowRun> runs = runsWithin(kGrid, std::span(&all, 1));
    ASSERT_EQ(runs.size(), 6U);
    for (const RowRun& run : runs) EXPECT_EQ(run, (RowRun{run.row, 0, 7}));
    const Polygon beside{{50, 0}, {60, 0}, {60, 1}};
    EXPECT_TRUE(runsWithin(kGrid, std::span(&beside, 1)).empty());
    std::vector<CellPair> pairs;
    appendCrossings({{-1e6, 100}, {1e6, 100}}, kGrid, pairs);
    EXPECT_EQ(pairs.size(), 8U);  // within its columns, in rows far above
}

TEST(RunsWithin, AgreeWithEachMiddle) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> x(-3, 3), y(-2, 3);
    for (int round = 0; round < 500; ++round) {
        std::vector<Polygon> curves(1 + static_cast<std::size_t>(round) % 2);
        for (Polygon& curve : curves)
            for (int i = 0; i < 3 + round % 5; ++i) curve.push_back({x(random), y(random)});
        const auto cells = cellsOf(runsWithin(kGrid, curves));
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 8; ++column) {
                const auto inside = std::count_if(curves.begin(), curves.end(), [&](auto& curve) {
                    return locate(curve, middle(column, row)) == Side::Inside;
                });
                EXPECT_EQ(cells[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)],
                          inside % 2 == 1)
                    << round << ": " << column << ", " << row;
            }
    }
}

TEST(Crossings, AreThePairsWithTheSegmentBetween) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> x(-2, 2), y(-1, 2);
    const auto key = [](int c1, int r1, int c2, int r2) {
        return std::array<int, 4>{std::min(c1, c2), std::min(r1, r2), std::max(c1, c2),
                                  std::max(r1, r2)};
    };
    for (int round = 0; round < 500; ++round) {
        const Segment2 segment{{x(random), y(random)}, {x(random), y(random)}};
        std::vector<CellPair> pairs;
        appendCrossings(segment, kGrid, pairs);
        std::set<std::array<int, 4>> found, wanted;
        for (const CellPair& pair : pairs) {
            const int c1 = static_cast<int>(pair.near_column), r1 = static_cast<int>(pair.near_row);
            const int c2 = static_cast<int>(pair.far_column), r2 = static_cast<int>(pair.far_row);
            const Vec2 along = segment.b - segment.a;
            const double t = c1 == c2 ? (middle(c1, r1).x - segment.a.x) / along.x
                                      : (middle(c1, r1).y - segment.a.y) / along.y;
            const Point2 crossing = segment.a + t * along;
            EXPECT_LE(distance(middle(c1, r1), crossing),
                      distance(middle(c2, r2), crossing) + 1e-9);
            if (std::min({c1, r1, c2, r2}) >= 0 && std::max(c1, c2) < 8 && std::max(r1, r2) < 6)
                found.insert(key(c1, r1, c2, r2));
        }
        for (int row = 0; row < 6; ++row)
            for (int column = 0; column < 8; ++column) {
                const Point2 here = middle(column, row);
                if (column < 7 && intersects(segment, {here, middle(column + 1, row)}))
                    wanted.insert(key(column, row, column + 1, row));
                if (row < 5 && intersects(segment, {here, middle(column, row + 1)}))
                    wanted.insert(key(column, row, column, row + 1));
            }
        EXPECT_EQ(found, wanted) << round;
    }
}

TEST(Crossings, ASegmentThroughMiddlesNamesThem) {
    std::vector<CellPair> pairs;
    appendCrossings({middle(1, 2), middle(3, 2)}, kGrid, pairs);
    EXPECT_EQ(pairs, (std::vector<CellPair>{{1, 2, 1, 2}, {2, 2, 2, 2}, {3, 2, 3, 2}}));
    pairs.clear();
    appendCrossings({{0.01, 0.01}, {0.02, 0.02}}, kGrid, pairs);
    EXPECT_TRUE(pairs.empty());
}

}  // namespace grid_test
}  // namespace ispace
