// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/test_cells.h"

namespace ispace {
namespace {

using testing::cellsOf;

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

TEST(WidestPlace, OfANotchedSquare) {
    const CellPlace place = widestPlace(cellsOf({".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 "....#."}));
    EXPECT_EQ(place.x, 2);
    EXPECT_EQ(place.y, 3);  // the ring below it holds the corner of the notch
    const CellPlace corner = widestPlace(cellsOf({"#.", "##"}));
    EXPECT_EQ(corner.x, 1);
    EXPECT_EQ(corner.y, 1);
}

TEST(WidestPlace, EqualsBruteForce) {
    std::mt19937_64 random(99);
    for (int round = 0; round < 200; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 12), 1 + static_cast<int>(random() % 12));
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 8 != 0) cells.insert(x, y);
        if (cells.count() == 0) continue;
        const auto rings = [&cells](int x, int y) {
            int ring = 0;
            const auto whole = [&](int r) {
                for (int v = y - r; v <= y + r; ++v)
                    for (int u = x - r; u <= x + r; ++u)
                        if (!cells.contains(u, v)) return false;
                return true;
            };
            while (whole(ring)) ++ring;
            return ring;
        };
        int best = 0;
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x) best = std::max(best, rings(x, y));
        const CellPlace place = widestPlace(cells);
        EXPECT_EQ(rings(place.x, place.y), best);
    }
}

}  // namespace
}  // namespace ispace
