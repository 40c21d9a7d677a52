// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map/cell_map.h"

#include <gtest/gtest.h>

#include "support/test_cell_map.h"

namespace ispace {
namespace cell_map_test {

using testing::Drawing;
using testing::errorOf;
using testing::import;
using testing::Imported;

/// Three closed rooms in a yard that is larger than all of them.
Drawing threeRooms() {
    Drawing drawing(20, 10);
    drawing.room(1, 1, 5, 4);
    drawing.room(6, 1, 11, 5);
    drawing.room(12, 1, 15, 3);
    drawing.room(16, 1, 16.4, 6);  // a duct
    return drawing;
}

TEST(CellMap, FramesAndCellsGoBothWays) {
    const CellMap map{MapCells(10, 10), MapCells(10, 10), 0.5, {{3, -2}, Angle::degrees(90)}};
    const Point2 p = map.inMap({2, 3});
    EXPECT_NEAR(p.x, 1.5, 1e-12);
    EXPECT_NEAR(p.y, -1, 1e-12);
    const Point2 back = map.inCells(p);
    EXPECT_NEAR(back.x, 2, 1e-12);
    EXPECT_NEAR(back.y, 3, 1e-12);
    EXPECT_EQ(map.placeOf(map.middleOf({4, 7})).x, 4);
    EXPECT_EQ(map.placeOf(map.middleOf({4, 7})).y, 7);
    EXPECT_EQ(map.placeOf({1e12, 0}).y, -1'000'000'000);
}

/// Checks that each room's point chooses it with its area. \return the rooms handed over
FoundRooms checkedRooms(const CellMap& map, ImportOptions options = {}) {
    FoundRooms found;
    options.found = &found;
    import(map, options);
    options.found = nullptr;
    for (const FoundRoom& room : found.rooms) {
        options.inside = {room.inside};
        EXPECT_NEAR(import(map, options).area(), room.area, 1e-6)
            << room.inside.x << ',' << room.inside.y;
    }
    return found;
}

TEST(CellMap, AllRoomsAreHandedOver) {
    const FoundRooms found = checkedRooms(threeRooms().map());
    ASSERT_EQ(found.rooms.size(), 5U) << "three rooms, the yard and a duct of 2 m2";
    EXPECT_NEAR(found.rooms[0].area, 20, 1e-6);
    EXPECT_TRUE(found.rooms[0].is_kept);
    EXPECT_FALSE(found.rooms[0].touches_border);
    EXPECT_TRUE(found.rooms[1].touches_border) << "the yard, the largest of the others";
    EXPECT_FALSE(found.rooms[1].is_kept);
    EXPECT_EQ(found.rooms[1].floor.front().holes.size(), 4U);
}

TEST(CellMap, RoomsWithGapsClosedAreHandedOver) {
    Drawing drawing(20, 10);
    drawing.room(1, 1, 5, 4);
    drawing.fill(4.9, 2, 5.2, 2.8, true);  // a door to the yard
    drawing.room(10, 1, 15, 5);
    EXPECT_EQ(checkedRooms(drawing.map()).rooms.size(), 2U);
    ImportOptions options;
    options.close_gaps = 1;
    const FoundRooms closed = checkedRooms(drawing.map(), options);
    EXPECT_EQ(closed.rooms.size(), 3U) << "both rooms, and the yard with the one it leads to";
    options.inside = {{3, 2}};
    const FoundRooms chosen = checkedRooms(drawing.map(), options);
    ASSERT_EQ(chosen.closed_gaps.size(), 1U);
    EXPECT_NEAR(distance(chosen.closed_gaps[0].a, chosen.closed_gaps[0].b), 0.8, 0.1);
    EXPECT_NEAR(chosen.closed_gaps[0].a.x, 5.1, 0.15);
}

TEST(CellMap, YardIsNoRoom) {
    const Imported found = import(threeRooms().map());
    EXPECT_EQ(found.fences.size(), 1U);
    EXPECT_NEAR(found.area(), 20, 1e-9);
    // The other rooms are 19 of 39 m2, the yard counts for nothing.
    EXPECT_TRUE(found.warnings.empty());
}

TEST(CellMap, AllRoomsAreThoseThatAreClosed) {
    ImportOptions options;
    options.rooms = RoomChoice::All;
    const Imported found = import(threeRooms().map(), options);
    ASSERT_EQ(found.fences.size(), 3U);
    EXPECT_NEAR(found.area(), 12 + 20 + 6, 1e-9);
    ASSERT_EQ(found.inside.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ((Region{found.fences[i], {}}.locate(found.inside[i])), Side::Inside);
}

TEST(CellMap, PointsChooseRooms) {
    ImportOptions options;
    options.inside = {{13, 2}, {3, 2}, {14, 2}};
    const Imported two = import(threeRooms().map(), options);
    EXPECT_EQ(two.fences.size(), 2U);
    EXPECT_NEAR(two.area(), 6 + 12, 1e-9);
    EXPECT_EQ(two.inside, (std::vector<Point2>{{13, 2}, {14, 2}, {3, 2}}));
    EXPECT_TRUE(two.warnings.empty());
    // Points of others choose, too, but their records are theirs; those elsewhere are ignored.
    ImportOptions known;
    known.known_inside = {{3, 2}, {100, 100}};
    const Imported one = import(threeRooms().map(), known);
    EXPECT_NEAR(one.area(), 12, 1e-9);
    EXPECT_TRUE(one.inside.empty());
    known.inside = {{13, 2}};
    EXPECT_EQ(import(threeRooms().map(), known).inside, (std::vector<Point2>{{13, 2}}));
    // The yard, if it is meant.
    ImportOptions yard;
    yard.inside = {{10, 8}};
    EXPECT_NEAR(import(threeRooms().map(), yard).area(),
                200 - 4.2 * 3.2 - 5.2 * 4.2 - 3.2 * 2.2 - 0.6 * 5.2, 0.05);
}

TEST(CellMap, PointsBesideWallsThatMoveAreReplaced) {
    Drawing drawing(10, 8);
    drawing.unknown();
    drawing.room(1, 1, 7, 6);
    drawing.fill(7, 3, 7.05, 3.05, true);  // a niche of one cell, which goes
    ImportOptions options;
    options.inside = {{7.03, 3.03}};
    const Imported found = import(drawing.map(), options);
    ASSERT_EQ(found.inside.size(), 1U);
    EXPECT_LT(found.inside[0].x, 6);
    EXPECT_EQ(found.notes.front(), "--inside 7.03,3.03 is too near to a wall and not kept");
}

TEST(CellMap, PointsOffTheFloorAreErrors) {
    Drawing drawing = threeRooms();
    drawing.map().free.erase(200, 180);
    const auto error = [&drawing](Point2 p) {
        ImportOptions options;
        options.inside = {p};
        return errorOf(drawing.map(), options);
    };
    EXPECT_EQ(
        error({0.97, 2.02}),
        "map.png: error: --inside 0.97,2.02 lies on an occupied cell, at pixel 19,159; wanted a "
        "point on free floor");
    EXPECT_EQ(
        error({10.02, 9.02}),
        "map.png: error: --inside 10.02,9.02 lies in unknown space, at pixel 200,19; wanted a "
        "point on free floor");
    EXPECT_EQ(error({-1, 2}),
              "map.png: error: --inside -1,2 lies outside of the map, whose corners are (0.0, 0.0) "
              "and (20.0, 10.0)");
    ImportOptions walled;
    walled.known_inside = {{3.02, 2.03}};
    walled.known_walls = {{{0, 2.03}, {20, 2.03}}};
    EXPECT_EQ(
        errorOf(drawing.map(), walled),
        "map.png: error: inside point 3.02,2.03 lies on a wall that was added, at pixel 60,159; "
        "wanted a point on free floor");
}

/// A house of two rooms with an inner door of 0.8 m, whose front door of 1 m opens to the yard.
Drawing openHouse() {
    Drawing drawing(14, 10);
    drawing.room(2, 2, 7, 6);
    drawing.room(7.1, 2, 10, 6);
    drawing.fill(6.9, 3, 7.2, 3.8, true);
    drawing.fill(3, 1.9, 4, 2, true);
    return drawing;
}
constexpr double kHouse = 5 * 4 + 2.9 * 4 + 0.1 * 0.8;

TEST(CellMap, OpenDoorToTheYardIsWarnedOfAndClosedByAFence) {
    const Imported open = import(openHouse().map());
    EXPECT_GT(open.area(), 100);
    EXPECT_TRUE(open.warns("may be the outside; --close-gaps 1.2 parts 31.7 m2 at "));
    ImportOptions fenced;
    fenced.known_walls = {{{2.9, 1.975}, {4.1, 1.975}}};
    const Imported house = import(openHouse().map(), fenced);
    EXPECT_TRUE(house.warnings.empty());
    // The floor reaches a cell beyond the fence, which cuts it off.
    EXPECT_NEAR(house.area(), kHouse + 1 * 0.1, 1e-6);
    Polygon outline = house.fences.front();
    EXPECT_EQ((Region{outline, {}}.locate({3.5, 1.98})), Side::Inside);
}

TEST(CellMap, FenceReachesTheWallsWhereItWasDrawnTo) {
    // Between the jambs of a door, drawn to their corners, on a map that simplification moves.
    for (const double simplify : {0.0, 0.05, 0.1, 0.2}) {
        ImportOptions options;
        options.simplify = simplify;
        options.known_walls = {{{3, 1.95}, {4, 1.95}}};
        const Imported house = import(openHouse().map(), options);
        ASSERT_EQ(house.fences.size(), 1U);
        const Region region{house.fences[0], {}};
        // The floor goes on behind the fence and nowhere beside it.
        EXPECT_EQ(region.locate({3.5, 1.93}), Side::Inside);
        EXPECT_EQ(region.locate({2.99, 1.95}), Side::Outside);
        EXPECT_EQ(region.locate({4.01, 1.95}), Side::Outside);
        EXPECT_NE(region.locate({3, 1.95}), Side::Inside);
        EXPECT_NE(region.locate({4, 1.95}), Side::Inside);
    }
}

TEST(CellMap, GapsToTheYardCloseAndInnerDoorsStay) {
    ImportOptions options;
    options.close_gaps = 1.2;
    const Imported house = import(openHouse().map(), options);
    EXPECT_EQ(house.fences.size(), 1U);
    EXPECT_NEAR(house.area(), kHouse, 0.1);
    ASSERT_GE(house.notes.size(), 2U);
    EXPECT_EQ(house.notes[0].substr(0, 28), "a gap of 1.00 m is closed at");
    EXPECT_EQ(house.notes[1], "1 gap of up to 1.2 m closed");
    // One that closes the inner door alone leaves the room behind that.
    options.close_gaps = 0.9;
    EXPECT_NEAR(import(openHouse().map(), options).area(), 2.9 * 4, 0.1);
    options.close_gaps = 0.5;
    const Imported open = import(openHouse().map(), options);
    EXPECT_EQ(open.notes.front(), "no gap of up to 0.5 m opens the room to the picture's border");
    EXPECT_GT(open.area(), 100);
    // A point in the yard is not closed in; one in the house is.
    options.close_gaps = 1.2;
    options.inside = {{1, 9}};
    EXPECT_GT(import(openHouse().map(), options).area(), 100);
    options.inside = {{9, 5}};
    EXPECT_NEAR(import(openHouse().map(), options).area(), kHouse, 0.1);
}

// 400 rooms around each other, each as wide as the map: minutes, of which the bound tells at once.
TEST(CellMap, RoomsAroundEachOtherAreBounded) {
    constexpr int kSide = 4000, kStep = 5;
    CellMap map{MapCells(kSide, kSide), MapCells(kSide, kSide), 0.14, {}};
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int ring = std::min({x, y, kSide - 1 - x, kSide - 1 - y});
            (ring % kStep == 0 ? map.occupied : map.free).insert(x, y);
        }
    ImportOptions options;
    EXPECT_EQ(import(map, options).fences.size(), 2U) << "one room";
    options.rooms = RoomChoice::All;
    const std::string error = errorOf(map, options);
    EXPECT_NE(error.find("are more than 1000000000"), std::string::npos) << error;
}

}  // namespace cell_map_test
}  // namespace ispace
