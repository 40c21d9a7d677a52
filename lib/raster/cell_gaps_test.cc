// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_gaps.h"

#include <gtest/gtest.h>

#include <random>

#include "raster/cell_pieces.h"
#include "raster/test_cells.h"

namespace ispace {
namespace {

using testing::cellsOf;
using testing::rowsOf;

TEST(BarrierCells, NoStepLeadsAcrossALine) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-5, 35);
    for (int round = 0; round < 100; ++round) {
        // A line across the grid, from beyond the left edge to beyond the right one.
        const Segment2 line{{-3, place(random)}, {33, place(random)}};
        MapCells floor(30, 30);
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x) floor.insert(x, y);
        floor = difference(floor, barrierCells({line}, 30, 30));
        const CellPieces pieces(floor, CellPieces::Joined::BySides);
        floor.forEach([&](int x, int y) {
            // Middles above and below are never in one piece.
            const double across = cross(line.b - line.a, Point2{x + 0.5, y + 0.5} - line.a);
            const CellPiece& piece = pieces[pieces.at({x, y}).value()];
            const double first =
                cross(line.b - line.a, Point2{piece.first.x + 0.5, piece.first.y + 0.5} - line.a);
            EXPECT_GT(across * first, 0);
        });
    }
    EXPECT_EQ(barrierCells({{{50, 50}, {60, 70}}}, 30, 30).count(), 0U);
}

TEST(GapCells, ClosesTheFrontDoorAndNoInnerOne) {
    const MapCells free = cellsOf({".................",  //
                                   ".###############.",  //
                                   ".#......#......#.",  //
                                   ".#......#......#.",  //
                                   ".#.............#.",  //
                                   ".#......#........",  //
                                   ".#......#......#.",  //
                                   ".#......#......#.",  //
                                   ".###############.",  //
                                   "................."});
    const MapCells cut = gapCells(free, 1);
    EXPECT_EQ(cut.count(), 1U);
    const CellPieces pieces(difference(free, cut), CellPieces::Joined::BySides);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_GE(pieces[1].cells, 73U);  // both rooms and the doorway between them
}

TEST(GapCells, WideOpeningsStay) {
    const MapCells free = cellsOf({"..........",  //
                                   ".########.",  //
                                   ".#......#.",  //
                                   ".#........",  //
                                   ".#........",  //
                                   ".#........",  //
                                   ".#......#.",  //
                                   ".########.",  //
                                   ".........."});
    EXPECT_EQ(gapCells(free, 1).count(), 0U);
    EXPECT_GT(gapCells(free, 3).count(), 0U);
}

TEST(GapCells, NothingOpensARoomThatIsClosed) {
    const MapCells free = cellsOf({".........",  //
                                   ".#######.",  //
                                   ".#.....#.",  //
                                   ".#.....#.",  //
                                   ".#.....#.",  //
                                   ".#######.",  //
                                   "........."});
    EXPECT_EQ(gapCells(free, 1).count(), 0U);
    EXPECT_EQ(gapCells(free, 100).count(), 0U);
}

}  // namespace
}  // namespace ispace
