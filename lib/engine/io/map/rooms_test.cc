// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map/map_rooms.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/test_cells.h"

namespace ispace {
namespace rooms_test {

using testing::cellsOf;
using testing::rowsOf;

/// The likeliest room of cells of a metre, by its first cell.
CellIndex roomOf(const std::vector<std::string>& rows) {
    const CellPieces pieces(cellsOf(rows), CellPieces::Joined::BySides);
    return pieces[likeliestRoom(pieces, 1).value()].first;
}

TEST(LikeliestRoom, YardAroundAHouseIsTheOutside) {
    EXPECT_EQ(roomOf({".......",  //
                      ".#####.",  //
                      ".#...#.",  //
                      ".#####.",  //
                      "......."})
                  .x,
              2);
}

TEST(LikeliestRoom, RoomCutByThePictureBeatsHollowRocks) {
    // Along half of the border, 9 times as large as the hollow rock.
    EXPECT_EQ(roomOf({"##########",  //
                      "..........",  //
                      "...###....",  //
                      "...#.#....",  //
                      "...###....",  //
                      "##########"})
                  .x,
              0);
    // Of two at the border the larger one counts, however small its share.
    EXPECT_EQ(roomOf({"..#.......", "..#......."}).x, 3);
}

TEST(LikeliestRoom, SpecksAreNoRooms) {
    // In cells of 0.1 m the hollow is no room, and all of the border is free.
    std::vector<std::string> rows(40, std::string(40, '.'));
    rows[10] = "........###.............................";
    rows[11] = "........#.#.............................";
    rows[12] = rows[10];
    const CellPieces pieces(cellsOf(rows), CellPieces::Joined::BySides);
    EXPECT_EQ(likeliestRoom(pieces, 0.1), 0U);
    // Whatever the scale, a room that is not small against its yard is one.
    EXPECT_EQ(likeliestRoom(CellPieces(cellsOf({".....",  //
                                                ".###.",  //
                                                ".#.#.",  //
                                                ".###.",  //
                                                "....."}),
                                       CellPieces::Joined::BySides),
                            0.01),
              1U);
    EXPECT_FALSE(likeliestRoom(CellPieces(cellsOf({"#"}), CellPieces::Joined::BySides), 1));
    EXPECT_EQ(likeliestRoom(CellPieces(cellsOf({"#.#"}), CellPieces::Joined::BySides), 0.1), 0U);
}

TEST(ClosedRooms, AreLargeAndWideAndAwayFromTheBorder) {
    const MapCells cells = cellsOf({"##################",  //
                                    "#.....#.....#..#.#",  //
                                    "#.....#.....#..#.#",  //
                                    "#.....#.....####.#",  //
                                    "#.....#.....#....#",  //
                                    "#.....#.....######",  //
                                    "#############.....",  //
                                    "#.................",  //
                                    "##################"});
    const CellPieces pieces(cells, CellPieces::Joined::BySides);
    ASSERT_EQ(pieces.size(), 5U);
    // At 0.2 m a cell: 22 cells at the border, 25 and 25 that are rooms, a corridor too narrow and
    // too small, and a closet too small. The first is not the likeliest.
    EXPECT_EQ(closedRooms(cells, pieces, 0.2).size(), 2U);
    // At 0.5 m a cell all but the first are rooms.
    EXPECT_EQ(closedRooms(cells, pieces, 0.5).size(), 4U);
}

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

TEST(ReachedByDisc, WholeFloorOfARectangleButItsCorners) {
    const MapCells room = cellsOf({"########",  //
                                   "#......#",  //
                                   "#......#",  //
                                   "#......#",  //
                                   "########"});
    EXPECT_EQ(rowsOf(reachedByDisc(room, 0.5, {})), rowsOf(room));
    EXPECT_EQ(rowsOf(reachedByDisc(room, 1.5, {})), (std::vector<std::string>{"########",  //
                                                                              "#......#",  //
                                                                              "#......#",  //
                                                                              "#......#",  //
                                                                              "########"}));
    EXPECT_EQ(reachedByDisc(room, 1.6, {}).count(), 0U);
}

TEST(ReachedByDisc, StaysOnItsSideOfADoorThatIsTooNarrow) {
    const MapCells rooms = cellsOf({"#############",  //
                                    "#...#.......#",  //
                                    "#...........#",  //
                                    "#...#.......#",  //
                                    "#############"});
    const MapCells left = reachedByDisc(rooms, 1, {{1, 1}});
    EXPECT_TRUE(left.contains(2, 2));
    EXPECT_FALSE(left.contains(6, 2));
    EXPECT_TRUE(reachedByDisc(rooms, 1, {{8, 2}}).contains(11, 2));
    // Without a point the side with more room.
    EXPECT_TRUE(reachedByDisc(rooms, 1, {}).contains(8, 2));
    EXPECT_FALSE(reachedByDisc(rooms, 1, {}).contains(2, 2));
    // Both, if asked for both; through the door, if the disc fits.
    EXPECT_TRUE(reachedByDisc(rooms, 1, {{2, 2}, {8, 2}}).contains(2, 2));
    EXPECT_EQ(reachedByDisc(rooms, 0.5, {{2, 2}}).count(), rooms.count());
    // Where the disc fits nowhere near the point the region is empty.
    EXPECT_EQ(reachedByDisc(rooms, 1, {{4, 2}}).count(), 0U);
}

}  // namespace rooms_test
}  // namespace ispace
