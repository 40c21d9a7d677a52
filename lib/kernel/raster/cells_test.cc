// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cells.h"

#include <gtest/gtest.h>

#include <random>

#include "support/test_cells.h"

namespace ispace {
namespace cells_test {

using testing::cellsOf;
using testing::largestPiece;
using testing::rowsOf;

const auto kBySides = CellPieces::Joined::BySides;
const auto kByCorners = CellPieces::Joined::ByCorners;

TEST(CellPieces, SidesJoinAndCornersDoIfAsked) {
    const MapCells cells = cellsOf({"..##.",  //
                                    "..##.",  //
                                    "##...",  //
                                    "##..."});
    const CellPieces by_sides(cells, kBySides);
    ASSERT_EQ(by_sides.size(), 2U);
    EXPECT_EQ(by_sides[0].cells, 8U);
    EXPECT_EQ(by_sides[1].cells, 4U);
    EXPECT_EQ(by_sides.at({4, 3}), 0U);
    EXPECT_EQ(by_sides.at({0, 3}), 1U);
    EXPECT_FALSE(by_sides.at({0, 0}));
    EXPECT_FALSE(by_sides.at({-1, 0}));
    EXPECT_FALSE(by_sides.at({0, 4}));
    EXPECT_EQ(CellPieces(cells, kByCorners).size(), 1U);
    EXPECT_EQ(rowsOf(largestPiece(cells)), (std::vector<std::string>{"####.",  //
                                                                     "####.",  //
                                                                     "##...",  //
                                                                     "##..."}));
}

TEST(CellPieces, ArmsThatMeetAboveAreOnePiece) {
    const CellPieces pieces(cellsOf({".....",  //
                                     ".#.#.",  //
                                     ".#.#."}),
                            kBySides);
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
    EXPECT_DOUBLE_EQ(CellPieces(cellsOf({"...#"}), kBySides).borderShare(0), 0.75);
    EXPECT_DOUBLE_EQ(CellPieces(cellsOf({".", "#"}), kBySides).borderShare(0), 0.5);
    EXPECT_EQ(CellPieces(cellsOf({"##", "##"}), kBySides).size(), 0U);
}

TEST(CellPieces, EqualsFloodOnNoise) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 60; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 20), 1 + static_cast<int>(random() % 20));
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 100 < 55) cells.insert(x, y);
        for (const auto joined : {kBySides, kByCorners}) {
            const CellPieces pieces(cells, joined);
            std::size_t sum = 0;
            for (const CellPiece& piece : pieces.list()) sum += piece.cells;
            EXPECT_EQ(sum, cells.count());
            cells.forEach([&](int x, int y) {
                ASSERT_TRUE(pieces.at({x, y}));
                for (int v = -1; v <= 1; ++v)
                    for (int u = -1; u <= 1; ++u) {
                        if (joined == kBySides && u * v != 0) continue;
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
        EXPECT_EQ(CellPieces(cells, kBySides).size(), floods);
    }
}

}  // namespace cells_test
}  // namespace ispace
