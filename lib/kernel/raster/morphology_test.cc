// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "raster/morphology.h"
#include "support/test_cells.h"

namespace ispace {

namespace morphology_test {

using testing::cellsOf;
using testing::rowsOf;

/// The cells of `all` for which a square of `side` cells through them meets `fits`.
template <typename Fits>
MapCells inSquares(const MapCells& like, int side, Fits fits) {
    MapCells result(like.width(), like.height());
    for (int y = 1 - side; y < like.height(); ++y)
        for (int x = 1 - side; x < like.width(); ++x) {
            if (!fits(x, y)) continue;
            for (int v = y; v < y + side; ++v)
                for (int u = x; u < x + side; ++u)
                    if (u >= 0 && v >= 0 && u < like.width() && v < like.height())
                        result.insert(u, v);
        }
    return result;
}

TEST(Morphology, EqualsBruteForce) {
    std::mt19937_64 random(8);
    for (int round = 0; round < 200; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 20), 1 + static_cast<int>(random() % 20));
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 10 < 8) cells.insert(x, y);
        const int side = 1 + round % 6;
        const auto count = [&](int x, int y) {
            int set = 0;
            for (int v = y; v < y + side; ++v)
                for (int u = x; u < x + side; ++u) set += cells.contains(u, v) ? 1 : 0;
            return set;
        };
        EXPECT_EQ(rowsOf(opened(cells, side)), rowsOf(inSquares(cells, side, [&](int x, int y) {
                      return count(x, y) == side * side;
                  })));
        const MapCells near = grown(cells, side);
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x) {
                bool any = false;
                cells.forEach([&](int u, int v) {
                    any = any || std::max(std::abs(u - x), std::abs(v - y)) <= side;
                });
                ASSERT_EQ(near.contains(x, y), any);
            }
    }
}

TEST(DeepestPlaces, AreFarFromTheRimAndTheGridsEdge) {
    const MapCells cells = cellsOf({"#.....#.",  //
                                    "#.....##",  //
                                    "#.....#.",  //
                                    "#.....#.",  //
                                    ".......#"});
    const CellPieces pieces(cells, CellPieces::Joined::BySides);
    const std::vector<CellIndex> places = deepestPlaces(cells, pieces);
    ASSERT_EQ(places.size(), 3U);
    EXPECT_EQ(places[0].x, 3);
    EXPECT_EQ(places[0].y, 2);
    EXPECT_EQ(places[1].x, 7);
    EXPECT_EQ(places[1].y, 1);
}

TEST(DeepestPlaces, EqualBruteForce) {
    std::mt19937_64 random(5);
    for (int round = 0; round < 60; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 16), 1 + static_cast<int>(random() % 16));
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 100 < 85) cells.insert(x, y);
        const CellPieces pieces(cells, CellPieces::Joined::BySides);
        const std::vector<CellIndex> found = deepestPlaces(cells, pieces);
        std::vector<int> deepest(pieces.size());
        std::vector<CellIndex> wanted(pieces.size());
        cells.forEach([&](int x, int y) {
            int steps = 100;
            for (int v = -1; v <= cells.height(); ++v)
                for (int u = -1; u <= cells.width(); ++u)
                    if (!cells.contains(u, v))
                        steps = std::min(steps, std::abs(u - x) + std::abs(v - y));
            const std::size_t piece = pieces.at({x, y}).value();
            if (steps <= deepest[piece]) return;
            deepest[piece] = steps;
            wanted[piece] = {x, y};
        });
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            ASSERT_EQ(found[i].x, wanted[i].x);
            ASSERT_EQ(found[i].y, wanted[i].y);
        }
    }
}

TEST(SquaredDistances, EqualBruteForce) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 60; ++round) {
        MapCells cells(1 + static_cast<int>(random() % 24), 1 + static_cast<int>(random() % 24));
        const unsigned density = 60 + static_cast<unsigned>(random() % 40);
        for (int y = 0; y < cells.height(); ++y)
            for (int x = 0; x < cells.width(); ++x)
                if (random() % 100 < density) cells.insert(x, y);
        for (const BorderRule beyond : {BorderRule::In, BorderRule::Out}) {
            const std::vector<int> found = squaredDistances(cells, beyond);
            for (int y = 0; y < cells.height(); ++y)
                for (int x = 0; x < cells.width(); ++x) {
                    int least = kNoDistance;
                    for (int v = -1; v <= cells.height(); ++v)
                        for (int u = -1; u <= cells.width(); ++u) {
                            const bool in_grid =
                                u >= 0 && v >= 0 && u < cells.width() && v < cells.height();
                            if (in_grid ? cells.contains(u, v) : beyond == BorderRule::In) continue;
                            least = std::min(least, (u - x) * (u - x) + (v - y) * (v - y));
                        }
                    ASSERT_EQ(found[cells.index(x, y)], least) << x << ' ' << y;
                }
        }
    }
}

TEST(WidestPlace, OfANotchedSquare) {
    const CellIndex place = widestPlace(cellsOf({".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 ".....#",  //
                                                 "....#."}));
    EXPECT_EQ(place.x, 2);
    EXPECT_EQ(place.y, 3);  // the ring below it holds the corner of the notch
    const CellIndex corner = widestPlace(cellsOf({"#.", "##"}));
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
        const CellIndex place = widestPlace(cells);
        EXPECT_EQ(rings(place.x, place.y), best);
    }
}

}  // namespace morphology_test

}  // namespace ispace
