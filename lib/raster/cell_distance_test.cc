// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/test_cells.h"

namespace ispace {
namespace {

using testing::cellsOf;
using testing::rowsOf;

TEST(SquaredDistances, EqualBruteForce) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 60; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 24), 1 + static_cast<int>(random() % 24));
        const unsigned density = 60 + static_cast<unsigned>(random() % 40);
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 100 < density) cells.insert(x, y);
        for (const Beyond beyond : {Beyond::In, Beyond::Out}) {
            const std::vector<int> found = squaredDistances(cells, beyond);
            for (int y = 0; y < cells.height(); ++y)
                for (int x = 0; x < cells.width(); ++x) {
                    int least = kNoDistance;
                    for (int v = -1; v <= cells.height(); ++v)
                        for (int u = -1; u <= cells.width(); ++u) {
                            const bool in_grid =
                                u >= 0 && v >= 0 && u < cells.width() && v < cells.height();
                            if (in_grid ? cells.contains(u, v) : beyond == Beyond::In) continue;
                            least = std::min(least, (u - x) * (u - x) + (v - y) * (v - y));
                        }
                    ASSERT_EQ(found[cells.index(x, y)], least) << x << ' ' << y;
                }
        }
    }
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
    // Where the disc fits nowhere near the point there is nothing.
    EXPECT_EQ(reachedByDisc(rooms, 1, {{4, 2}}).count(), 0U);
}

}  // namespace
}  // namespace ispace
