// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/contour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include <random>

namespace ispace {
namespace {

Grid unitGrid(int columns, int rows) {
    return {{{0, 0}, {static_cast<double>(columns), static_cast<double>(rows)}}, columns, rows};
}

CellSet cellsOf(const Grid& grid, const std::vector<std::string>& picture) {
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
    const auto curves = contours(grid, cellsOf(grid, {"...", ".#.", "..."}));
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves[0].size(), 4U);
    EXPECT_EQ(signedArea(curves[0]), 1);
}

TEST(Contours, RunsAreMergedAndHolesTurnClockwise) {
    const Grid grid = unitGrid(4, 4);
    const auto curves = contours(grid, cellsOf(grid, {"####", "#..#", "#..#", "####"}));
    ASSERT_EQ(curves.size(), 2U);
    EXPECT_EQ(curves[0].size(), 4U);
    EXPECT_EQ(curves[1].size(), 4U);
    EXPECT_EQ(signedArea(curves[0]), 16);
    EXPECT_EQ(signedArea(curves[1]), -4);
}

TEST(Contours, CellsThatTouchAtACornerAreApart) {
    const Grid grid = unitGrid(3, 3);
    EXPECT_EQ(contours(grid, cellsOf(grid, {"#.#", ".#.", "#.#"})).size(), 5U);
    EXPECT_EQ(contours(grid, cellsOf(grid, {".#.", "#.#", ".#."})).size(), 4U);
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
    // A ring, in its hole an island that has a hole of its own.
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

}  // namespace
}  // namespace ispace
