// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
