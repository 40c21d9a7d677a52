// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_groups.h"

#include <gtest/gtest.h>

#include <string>

namespace ispace {
namespace {

/// Cells of a picture, `#` set, the first line at the top.
struct Cells {
    Cells(int columns, const std::string& picture)
        : grid{{{0, 0}, {1, 1}}, columns, static_cast<int>(picture.size()) / columns},
          cells(grid.size()) {
        for (int row = 0; row < grid.rows; ++row)
            for (int column = 0; column < columns; ++column)
                if (picture[grid.cell(column, grid.rows - 1 - row)] == '#')
                    cells.set(grid.cell(column, row));
    }
    Grid grid;
    CellSet cells;
};

TEST(CellPieces, AreJoinedBySidesNotByCorners) {
    const Cells c(6,
                  "##...."
                  "##..##"
                  "..#.##"
                  "....##");
    const auto pieces = piecesOf(c.grid, c.cells);
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_EQ(pieces[0].cells, 6U);
    EXPECT_EQ(pieces[1].cells, 4U);
    EXPECT_EQ(pieces[2].cells, 1U);
    EXPECT_EQ(pieces[2].middle, c.grid.cell(2, 1));
}

TEST(CellPieces, MiddleIsFarFromTheRim) {
    const Cells c(7,
                  ".#####."
                  ".#####."
                  ".#####."
                  ".#####."
                  "#######");
    const auto pieces = piecesOf(c.grid, c.cells);
    ASSERT_EQ(pieces.size(), 1U);
    // What touches the grid's edge is at the rim, too.
    EXPECT_EQ(pieces[0].middle, c.grid.cell(3, 2));
}

TEST(CellPieces, DoNotRunOnFromRowToRow) {
    const Cells c(3,
                  "#.."
                  "..#");
    EXPECT_EQ(piecesOf(c.grid, c.cells).size(), 2U);
}

TEST(CellPieces, OfNothingAreNone) {
    const Cells c(3, "......");
    EXPECT_TRUE(piecesOf(c.grid, c.cells).empty());
}

}  // namespace
}  // namespace ispace
