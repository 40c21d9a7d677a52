// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/floor_tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "geom/curve.h"
#include "geom/polygon.h"

namespace ispace {
namespace floor_tiles_test {

Curve rectangle(double x, double y, double to_x, double to_y) {
    return curveOf({{x, y}, {to_x, y}, {to_x, to_y}, {x, to_y}});
}

TEST(FloorTiles, BoundTheFloorInABoxFromAbove) {
    const Box2 room{{0, 0}, {64, 64}};
    FloorTiles tiles(room);
    Curve hole = rectangle(20, 20, 30, 30);
    std::reverse(hole.begin(), hole.end());
    for (CurveEdge& edge : hole) std::swap(edge.from, edge.to);
    tiles.add(std::vector<Curve>{rectangle(10, 10, 40, 40), hole}, 2);
    EXPECT_NEAR(tiles.mostIn(room), 2 * 800, 1e-9);
    EXPECT_NEAR(tiles.mostIn({{-5, -5}, {9.5, 90}}), 0, 1e-9);
    EXPECT_NEAR(tiles.mostIn({{20.5, 20.5}, {29.5, 29.5}}), 0, 1e-9);
    EXPECT_NEAR(tiles.mostIn({{100, 100}, {120, 120}}), 0, 1e-9);
    // The tiles of 1 m that it meets hold 3 x 2 m2.
    EXPECT_NEAR(tiles.mostIn({{10.5, 11.5}, {12.5, 12.5}}), 2 * 6, 1e-9);
}

TEST(FloorTiles, HoldFloorBeyondChords) {
    Curve disc;
    const Point2 corners[] = {{20, 10}, {10, 20}, {0, 10}, {10, 0}};
    for (std::size_t i = 0; i < 4; ++i)
        disc.push_back({corners[i], corners[(i + 1) % 4], 10, {10, 10}});
    FloorTiles tiles({{0, 0}, {20, 20}});
    tiles.add({&disc, 1}, 1);
    const double all = tiles.mostIn({{-1, -1}, {21, 21}});
    EXPECT_GE(all, signedArea(disc));
    EXPECT_EQ(tiles.mostIn(Box2()), 0);
}

TEST(FloorTiles, HoldFloorWhereChordsLeaveATileEmpty) {
    // The top of the disc lies beyond a chord, alone in the last row of tiles.
    Curve disc;
    const auto at = [](int degrees) {
        const double a = degrees * std::numbers::pi / 180;
        return Point2{10 + 10 * std::cos(a), 10 + 10 * std::sin(a)};
    };
    for (const int from : {10, 100, 190, 280})
        disc.push_back({at(from), at(from == 280 ? 10 : from + 90), 10, {10, 10}});
    const double row = 19.9999 / 63;
    FloorTiles tiles({{0, 0}, {20, 64 * row}});
    tiles.add({&disc, 1}, 1);
    // A cap of 0.1 mm: two thirds of its chord times its height.
    const double cap = 2.0 / 3 * 2 * std::sqrt(2 * 10 * 1e-4) * 1e-4;
    EXPECT_GE(tiles.mostIn({{9, 19.99995}, {11, 20}}), cap);
    // It stays a bound of use: a box within is no more than its tiles and a strip along the circle.
    EXPECT_LE(tiles.mostIn({{8, 8}, {12, 12}}), 5 * 5 + 1e-3 * 63);
}

TEST(FloorTiles, BoundCellsInReachOfAnyPoint) {
    const Grid grid{{{0, 0}, {10, 5}}, 100, 50};
    CellSet cells(grid.size());
    EXPECT_EQ(mostWithin(1, cells, grid), 0);
    for (const int row : {3, 4, 5})
        for (int column = 0; column < 100; ++column) cells.set(grid.cell(column, row));
    // At most 2 x 11 columns and one of 0.1 m, three rows high.
    EXPECT_NEAR(mostWithin(1, cells, grid), 3 * 23 * 0.01, 1e-9);
    EXPECT_NEAR(mostWithin(20, cells, grid), 3, 1e-9);
}

}  // namespace floor_tiles_test
}  // namespace ispace
