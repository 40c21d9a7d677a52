// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map/map_rooms.h"

#include <gtest/gtest.h>

#include <random>

#include "support/test_cells.h"

namespace ispace {
namespace cleaning_test {

using testing::largestPiece;
using testing::rowsOf;

constexpr double kFine = 0.05;

/// '.' floor, '#' occupied, ' ' unknown.
MapRoom roomOf(const std::vector<std::string>& rows) {
    const auto width = static_cast<int>(rows.front().size());
    const auto height = static_cast<int>(rows.size());
    MapRoom room{MapCells(width, height), MapCells(width, height), {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const char c =
                rows[static_cast<std::size_t>(height - 1 - y)][static_cast<std::size_t>(x)];
            if (c == '.') room.floor.insert(x, y);
            if (c == '#') room.occupied.insert(x, y);
        }
    return room;
}

TEST(CleanRoom, SpecksBecomeFloorAndLegsOfTablesStay) {
    MapRoom room = roomOf({"####################",  //
                           "#..................#",  //
                           "#..#.....##........#",  //
                           "#.............##...#",  //
                           "#....    .....#....#",  //
                           "#.... #  ..........#",  //
                           "#....    ...    ...#",  //
                           "#...........    ...#",  //
                           "#..................#",  //
                           "####################"});
    const Cleaning done = cleanRoom(room, kFine, kNoiseWidth, {});
    EXPECT_EQ(rowsOf(room.floor), (std::vector<std::string>{"####################",  //
                                                            "#..................#",  //
                                                            "#..................#",  //
                                                            "#.............##...#",  //
                                                            "#....####.....#....#",  //
                                                            "#....####..........#",  //
                                                            "#....####..........#",  //
                                                            "#..................#",  //
                                                            "#..................#",  //
                                                            "####################"}));
    EXPECT_EQ(done.specks, 3U);
    EXPECT_EQ(done.speck_cells, 1U + 2 + 8);
    EXPECT_EQ(done.spikes, 0U);
}

TEST(CleanRoom, CoarseCellsMeanSomething) {
    const std::vector<std::string> rows{"#########",  //
                                        "#...#...#",  //
                                        "#.......#",  //
                                        "#..#..###",  //
                                        "###.#####",  //
                                        "###.#####",  //
                                        "###.#####"};
    MapRoom room = roomOf(rows);
    cleanRoom(room, 0.5, kNoiseWidth, {});
    EXPECT_EQ(rowsOf(room.floor), rows);
}

TEST(CleanRoom, RaysThroughWindowsGoAndDoorsOfOneCellStay) {
    // A ray leaves to the right; the way to the room below is a cell wide.
    std::vector<std::string> rows(70, std::string(60, ' '));
    for (std::size_t y = 5; y < 35; ++y)
        for (std::size_t x = 5; x < 35; ++x) rows[y][x] = '.';
    for (std::size_t y = 38; y < 68; ++y)
        for (std::size_t x = 5; x < 35; ++x) rows[y][x] = '.';
    for (std::size_t y = 35; y < 38; ++y) rows[y][20] = '.';
    for (std::size_t x = 35; x < 58; ++x) rows[10][x] = '.';
    MapRoom room = roomOf(rows);
    const Cleaning done = cleanRoom(room, kFine, kNoiseWidth, {});
    EXPECT_EQ(room.floor.count(), 2U * 900 + 3);
    EXPECT_EQ(done.spikes, 1U);
    EXPECT_EQ(done.spike_cells, 23U);
    // A point on the ray keeps it.
    MapRoom kept = roomOf(rows);
    cleanRoom(kept, kFine, kNoiseWidth, {{50, 59}});
    EXPECT_EQ(kept.floor.count(), 2U * 900 + 3 + 23);
}

TEST(CleanRoom, WhatHangsOnAStripGoesUnlessItIsARoom) {
    const auto with_room = [](std::size_t side) {
        std::vector<std::string> rows(40, std::string(80, '#'));
        for (std::size_t y = 5; y < 35; ++y)
            for (std::size_t x = 5; x < 35; ++x) rows[y][x] = '.';
        for (std::size_t x = 35; x < 40; ++x) rows[10][x] = '.';
        for (std::size_t y = 5; y < 5 + side; ++y)
            for (std::size_t x = 40; x < 40 + side; ++x) rows[y][x] = '.';
        MapRoom room = roomOf(rows);
        cleanRoom(room, kFine, kNoiseWidth, {});
        return room.floor.count();
    };
    EXPECT_EQ(with_room(19), 900U);  // 0.9 m2
    EXPECT_EQ(with_room(20), 900U + 5 + 400);
}

TEST(CleanRoom, SlitsOfUnknownCloseAndThinWallsStay) {
    MapRoom room = roomOf({"                              ",  //
                           " ........ ........ .......... ",  //
                           " ........ ........ .......... ",  //
                           " ........ ........ .....#.... ",  //
                           " ........ ........ .....#.... ",  //
                           " ........ ..............#.... ",  //
                           " ........ ..............#.... ",  //
                           " ........ ........ .....#.... ",  //
                           " ........ ........ .....#.... ",  //
                           " .................#.....#.... ",  //
                           " ........ ........#.....#.... ",  //
                           "         ###      #     #     "});
    cleanRoom(room, 0.14, kNoiseWidth, {});
    // Dead ends of unknown became floor, above and below the door …
    EXPECT_TRUE(room.floor.contains(9, 9));
    EXPECT_TRUE(room.floor.contains(9, 1));
    EXPECT_TRUE(room.floor.contains(18, 8));
    EXPECT_TRUE(room.floor.contains(18, 3));
    // … occupied cells did not, and no cell at the room's edge.
    EXPECT_FALSE(room.floor.contains(18, 2));
    EXPECT_FALSE(room.floor.contains(24, 8));
    EXPECT_FALSE(room.floor.contains(9, 0));
    EXPECT_FALSE(room.floor.contains(18, 11));
    // A line of unknown that parts two rooms stays, though the rooms hang together elsewhere.
    MapRoom rooms = roomOf({"            ",  //
                            " .......... ",  //
                            " .......... ",  //
                            " .......... ",  //
                            "            ",  //
                            " .......... ",  //
                            " .......... ",  //
                            " .......... ",  //
                            "            "});
    const auto before = rowsOf(rooms.floor);
    EXPECT_EQ(cleanRoom(rooms, kFine, kNoiseWidth, {{2, 2}, {2, 6}}).slit_cells, 0U);
    EXPECT_EQ(rowsOf(rooms.floor), before);
}

TEST(CleanRoom, BumpsOfWallsBecomeFlatAndCornersStay) {
    const std::string top = '#' + std::string(44, '.') + '#', low = '#' + std::string(30, '.');
    const std::string wall(46, '#');
    std::vector<std::string> flat{wall, wall, top, top, top, low + std::string(15, '#')};
    flat.push_back(flat.back());
    flat.push_back(wall);
    flat.push_back(wall);
    std::vector<std::string> rough = flat;
    rough[1][8] = rough[1][9] = '.';
    rough[2][24] = rough[2][25] = rough[2][26] = '#';
    rough[6][9] = '#';
    rough[7][19] = '.';
    // Too near to the corner to know which is the wall; too deep; too long.
    const auto stays = [](std::vector<std::string>& rows) {
        rows[1][40] = '.';
        rows[6][26] = rows[5][26] = '#';
        rows[1][33] = rows[1][34] = rows[1][35] = rows[1][36] = '.';
    };
    stays(rough);
    stays(flat);
    MapRoom room = roomOf(rough);
    cleanRoom(room, kFine, kNoiseWidth, {});
    EXPECT_EQ(rowsOf(room.floor), flat);
}

TEST(CleanRoom, NoiseOverARectangleComesOutAsTheRectangle) {
    std::mt19937_64 random(2022);
    for (const unsigned percent : {1U, 2U, 4U}) {
        MapRoom room{MapCells(206, 156), MapCells(206, 156), {}};
        for (int y = 3; y < 153; ++y)
            for (int x = 3; x < 203; ++x)
                (random() % 100 < percent ? room.occupied : room.floor).insert(x, y);
        room.floor = largestPiece(room.floor);
        const Cleaning done = cleanRoom(room, kFine, kNoiseWidth, {});
        EXPECT_TRUE(done.isRagged());
        EXPECT_EQ(CellPieces(room.floor, CellPieces::Joined::BySides).size(), 1U);
        EXPECT_NEAR(static_cast<double>(room.floor.count()), 30000, 150) << percent;
    }
}

// A square of half a metre has a million cells of half a millimetre and stands on four million
// places: painting it on each would take hours.
TEST(CleanRoom, FineCellsCostNoMoreThanCoarseOnes) {
    constexpr int kSide = 3000;
    MapRoom room{MapCells(kSide, kSide), MapCells(kSide, kSide), {}};
    for (int y = 1; y + 1 < kSide; ++y) room.floor.insertRun(y, 1, kSide - 2);
    room.floor.erase(kSide / 2, kSide / 2);
    const Cleaning done = cleanRoom(room, 0.0005, kNoiseWidth, {});
    EXPECT_EQ(done.specks, 1U);
    EXPECT_EQ(room.floor.count(), std::size_t{kSide - 2} * (kSide - 2));
}

// 500 000 rooms along a lane: looking each up in a list of all took as many steps again.
TEST(CleanRoom, LanesWithManyRooms) {
    constexpr int kLength = 2'000'001;
    MapRoom room{MapCells(kLength, 5), MapCells(kLength, 5), {}};
    room.floor.insertRun(0, 0, kLength - 1);
    for (int x = 0; x + 3 < kLength; x += 4)
        for (int y = 1; y < 4; ++y) room.floor.insertRun(y, x, x + 2);
    room.occupied.insertRun(4, 0, kLength - 1);
    cleanRoom(room, 0.14, kNoiseWidth, {{1, 2}, {kLength - 4, 2}});
    EXPECT_TRUE(room.floor.contains(1, 2));
    EXPECT_TRUE(room.floor.contains(kLength / 2, 0)) << "joins both";
    EXPECT_TRUE(room.floor.contains(kLength - 4, 2));
}

}  // namespace cleaning_test
}  // namespace ispace
