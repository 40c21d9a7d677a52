// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_pieces.h"

#include <gtest/gtest.h>

#include <random>

#include "raster/cell_rooms.h"
#include "raster/test_cells.h"

namespace ispace {
namespace {

using testing::cellsOf;
using testing::largestPiece;
using testing::rowsOf;

const auto kSides = CellPieces::Joined::BySides;
const auto kCorners = CellPieces::Joined::ByCorners;

TEST(CellPieces, SidesJoinAndCornersDoIfAsked) {
    const MapCells cells = cellsOf({"..##.",  //
                                    "..##.",  //
                                    "##...",  //
                                    "##..."});
    const CellPieces by_sides(cells, kSides);
    ASSERT_EQ(by_sides.size(), 2U);
    EXPECT_EQ(by_sides[0].cells, 8U);
    EXPECT_EQ(by_sides[1].cells, 4U);
    EXPECT_EQ(by_sides.at({4, 3}), 0U);
    EXPECT_EQ(by_sides.at({0, 3}), 1U);
    EXPECT_FALSE(by_sides.at({0, 0}));
    EXPECT_FALSE(by_sides.at({-1, 0}));
    EXPECT_FALSE(by_sides.at({0, 4}));
    EXPECT_EQ(CellPieces(cells, kCorners).size(), 1U);
    EXPECT_EQ(rowsOf(largestPiece(cells)), (std::vector<std::string>{"####.",  //
                                                                     "####.",  //
                                                                     "##...",  //
                                                                     "##..."}));
}

TEST(CellPieces, ArmsThatMeetAboveAreOnePiece) {
    const CellPieces pieces(cellsOf({".....",  //
                                     ".#.#.",  //
                                     ".#.#."}),
                            kSides);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0].cells, 11U);
    EXPECT_EQ(pieces[0].first.x, 0);
    EXPECT_EQ(pieces[0].lowest.x, 0);
    EXPECT_EQ(pieces[0].highest.x, 4);
    EXPECT_EQ(pieces[0].highest.y, 2);
    EXPECT_EQ(pieces[0].extent(), 5);
    EXPECT_EQ(pieces[0].border, 10U);
    EXPECT_DOUBLE_EQ(pieces.borderShare(0), 10.0 / 12);
}

TEST(CellPieces, ThinGridsHaveABorderToo) {
    EXPECT_DOUBLE_EQ(CellPieces(cellsOf({"...#"}), kSides).borderShare(0), 0.75);
    EXPECT_DOUBLE_EQ(CellPieces(cellsOf({".", "#"}), kSides).borderShare(0), 0.5);
    EXPECT_EQ(CellPieces(cellsOf({"##", "##"}), kSides).size(), 0U);
}

TEST(CellPieces, EqualsFloodOnNoise) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 60; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 20), 1 + static_cast<int>(random() % 20));
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 100 < 55) cells.insert(x, y);
        for (const auto joined : {kSides, kCorners}) {
            const CellPieces pieces(cells, joined);
            std::size_t sum = 0;
            for (const CellPiece& piece : pieces.list()) sum += piece.cells;
            EXPECT_EQ(sum, cells.count());
            cells.forEach([&](int x, int y) {
                ASSERT_TRUE(pieces.at({x, y}));
                for (int v = -1; v <= 1; ++v)
                    for (int u = -1; u <= 1; ++u) {
                        if (joined == kSides && u * v != 0) continue;
                        if (!cells.contains(x + u, y + v)) continue;
                        EXPECT_EQ(pieces.at({x, y}), pieces.at({x + u, y + v}));
                    }
            });
        }
        // As many pieces as floods find.
        MapCells left = cells;
        std::size_t floods = 0;
        while (left.count() > 0) {
            ++floods;
            left = difference(left, largestPiece(left));
        }
        EXPECT_EQ(CellPieces(cells, kSides).size(), floods);
    }
}

/// The likeliest room of cells of a metre, by its first cell.
CellPlace roomOf(const std::vector<std::string>& rows) {
    const CellPieces pieces(cellsOf(rows), kSides);
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
    const CellPieces pieces(cellsOf(rows), kSides);
    EXPECT_EQ(likeliestRoom(pieces, 0.1), 0U);
    // Whatever the scale, a room that is not small against its yard is one.
    EXPECT_EQ(likeliestRoom(CellPieces(cellsOf({".....",  //
                                                ".###.",  //
                                                ".#.#.",  //
                                                ".###.",  //
                                                "....."}),
                                       kSides),
                            0.01),
              1U);
    EXPECT_FALSE(likeliestRoom(CellPieces(cellsOf({"#"}), kSides), 1));
    EXPECT_EQ(likeliestRoom(CellPieces(cellsOf({"#.#"}), kSides), 0.1), 0U);
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
    const CellPieces pieces(cells, kSides);
    ASSERT_EQ(pieces.size(), 5U);
    // At 0.2 m a cell: 22 cells at the border, 25 and 25 that are rooms, a corridor too narrow and
    // too small, and a closet too small. The first is not the likeliest.
    EXPECT_EQ(closedRooms(cells, pieces, 0.2).size(), 2U);
    // At 0.5 m a cell all but the first are rooms.
    EXPECT_EQ(closedRooms(cells, pieces, 0.5).size(), 4U);
}

}  // namespace
}  // namespace ispace
