// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/cell_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/error.h"
#include "layout/schemas.h"

namespace ispace {
namespace {

/// What an import of cells gave.
struct Imported {
    std::vector<Polygon> fences;
    std::vector<Point2> inside;
    std::vector<std::string> notes, warnings;

    /// Of all fences, holes taken away: they run clockwise.
    [[nodiscard]] double area() const {
        double sum = 0;
        for (const Polygon& fence : fences) sum += signedArea(fence);
        return sum;
    }
    [[nodiscard]] std::size_t vertices() const {
        std::size_t count = 0;
        for (const Polygon& fence : fences) count += fence.size();
        return count;
    }
    [[nodiscard]] bool warns(const std::string& what) const {
        for (const std::string& warning : warnings)
            if (warning.find(what) != std::string::npos) return true;
        return false;
    }
};

Imported import(const CellMap& map, const ImportOptions& options = {}) {
    ImportRecords out(sceneSchemas(), "map", options);
    writeCellMap(map, {"map.png", "no hint"}, options, out);
    const Document document = out.take();
    Imported result;
    for (const Record& record : document.records) {
        if (record.keyword() == "inside") {
            const Tuple& at = record.tuple("at");
            result.inside.push_back({at[0], at[1]});
            continue;
        }
        Polygon& fence = result.fences.emplace_back();
        for (const Tuple& p : record.list("path")) fence.push_back({p[0], p[1]});
    }
    result.notes = document.notes;
    for (const Diagnostic& warning : document.warnings) result.warnings.push_back(warning.message);
    return result;
}

std::string errorOf(const CellMap& map, const ImportOptions& options) {
    try {
        import(map, options);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

/// A picture of free cells of 0.05 m, origin in its lower left corner, to be drawn on in metres.
class Drawing {
  public:
    Drawing(double width, double height)
        : map_{MapCells(cells(width), cells(height)),
               MapCells(cells(width), cells(height)),
               kCell,
               {}} {
        fill(0, 0, width, height, true);
    }
    /// Rooms are free, walls occupied.
    void fill(double left, double low, double right, double high, bool is_free) {
        for (int y = cells(low); y < cells(high); ++y)
            for (int x = cells(left); x < cells(right); ++x) {
                map_.free.erase(x, y);
                map_.occupied.erase(x, y);
                (is_free ? map_.free : map_.occupied).insert(x, y);
            }
    }
    /// A room with walls of 0.1 m around it.
    void room(double left, double low, double right, double high) {
        fill(left - 0.1, low - 0.1, right + 0.1, high + 0.1, false);
        fill(left, low, right, high, true);
    }
    void unknown() { map_.free = MapCells(map_.free.width(), map_.free.height()); }
    [[nodiscard]] const CellMap& map() const { return map_; }
    [[nodiscard]] CellMap& map() { return map_; }

  private:
    static constexpr double kCell = 0.05;
    static int cells(double metres) { return static_cast<int>(std::lround(metres / kCell)); }
    CellMap map_;
};

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

TEST(CellMap, CorridorThatLeavesThePictureIsSaid) {
    Drawing drawing(10, 8);
    drawing.fill(0, 0, 10, 8, false);
    drawing.fill(1, 1, 7, 6, true);
    drawing.fill(7, 3, 10, 5, true);
    const Imported found = import(drawing.map());
    EXPECT_NEAR(found.area(), 30 + 6, 1e-9);
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_EQ(found.warnings[0],
              "the room leaves the picture over 2.00 m at (9.98, 4.0); --fence closes it where it "
              "should end");
    ImportOptions fenced;
    fenced.known_walls = {{{8, 2}, {8, 6}}};
    const Imported closed = import(drawing.map(), fenced);
    EXPECT_TRUE(closed.warnings.empty());
    EXPECT_NEAR(closed.area(), 30 + 2, 0.2 + 1e-9);
}

TEST(CellMap, SmallPartOfTheFloorIsSaidWithWhatHelps) {
    Drawing drawing(20, 10);
    drawing.unknown();
    for (const double x : {1.0, 7.0, 13.0}) drawing.room(x, 1, x + 5, 5 + x / 10);
    const Imported found = import(drawing.map());
    ASSERT_EQ(found.warnings.size(), 1U);
    EXPECT_EQ(found.warnings[0],
              "less than half of the free floor is kept, 26.5 m2 of 70.5 m2; --inside 9.33,3.33 "
              "chooses the largest region left out, 23.5 m2, and --rooms all keeps every closed "
              "room");
}

TEST(CellMap, SizesOfNoBuildingAreSaid) {
    Drawing small(1, 1);
    small.unknown();
    small.room(0.2, 0.2, 0.8, 0.6);
    EXPECT_TRUE(
        import(small.map()).warns("the room is 0.60 m x 0.40 m; is the resolution of 0.05 m"));
    Drawing large(20, 10);
    large.unknown();
    large.room(1, 1, 9, 9);
    EXPECT_TRUE(import(large.map()).warnings.empty());
    // Of several rooms it is all that counts.
    large.room(11, 1, 12.2, 2.2);
    ImportOptions all;
    all.rooms = RoomChoice::All;
    EXPECT_EQ(import(large.map(), all).fences.size(), 2U);
    EXPECT_TRUE(import(large.map(), all).warnings.empty());
    large.map().resolution = 20;
    EXPECT_TRUE(import(large.map()).warns("the room is 3200.00 m x 3200.00 m"));
}

TEST(CellMap, ReachableFloorIsThatOfADisc) {
    Drawing drawing(10, 8);
    drawing.fill(0, 0, 10, 8, false);
    drawing.fill(1, 1, 7, 6, true);
    drawing.fill(3, 3, 3.3, 6, false);  // a cupboard, with a strip of 0.3 m behind it
    drawing.fill(3.3, 1.3, 3.6, 6, true);
    drawing.fill(3.6, 3, 3.9, 6, false);
    ImportOptions options;
    EXPECT_NEAR(import(drawing.map(), options).area(), 30 - 1.8, 1e-6);
    options.reachable = 0.2;
    options.simplify = 0;
    const Imported found = import(drawing.map(), options);
    // Corners are rounded off, by 0.2146 r2 each; the strip is left out.
    EXPECT_NEAR(found.area(), 30 - 1.8 - 0.9, 0.1);
    EXPECT_EQ(found.fences.size(), 1U);
    options.reachable = 3;
    EXPECT_EQ(errorOf(drawing.map(), options),
              "map.png: error: a disc with a radius of 3 m does not fit into the room; give "
              "--reachable a smaller one");
    options.inside = {{3.45, 5}};
    options.reachable = 0.2;
    EXPECT_EQ(errorOf(drawing.map(), options),
              "map.png: error: a disc with a radius of 0.2 m does not fit over the inside point; "
              "give --reachable a smaller one");
}

TEST(CellMap, NoiseOverARectangleComesOutAsTheRectangle) {
    std::mt19937_64 random(12);
    Drawing drawing(12, 9);
    drawing.unknown();
    drawing.room(1, 1, 11, 8);
    CellMap& map = drawing.map();
    for (int y = 0; y < map.free.height(); ++y)
        for (int x = 0; x < map.free.width(); ++x) {
            if (random() % 100 >= 3 || (!map.free.contains(x, y) && !map.occupied.contains(x, y)))
                continue;
            const bool was_free = map.free.contains(x, y);
            map.free.erase(x, y);
            map.occupied.erase(x, y);
            (was_free ? map.occupied : map.free).insert(x, y);
        }
    const Imported found = import(map);
    EXPECT_TRUE(found.warnings.empty());
    EXPECT_NEAR(found.area(), 70, 0.35);
    EXPECT_LE(found.fences.size(), 2U);
    EXPECT_LE(found.vertices(), 16U);
    // Off, every speck is a hole.
    ImportOptions exact;
    exact.simplify = 0;
    EXPECT_GT(import(map, exact).fences.size(), 500U);
}

TEST(CellMap, SpeckleOffTellsNothing) {
    Drawing drawing(10, 8);
    drawing.unknown();
    drawing.room(1, 1, 7, 6);
    drawing.fill(3, 3, 3.05, 3.05, false);
    EXPECT_EQ(import(drawing.map()).notes,
              std::vector<std::string>{
                  "below the map's noise: 1 speck and slits of 0.0 m2 became floor, 0 spikes of "
                  "0.0 m2 went; --simplify 0 keeps them"});
    ImportOptions exact;
    exact.simplify = 0;
    EXPECT_TRUE(import(drawing.map(), exact).notes.empty());
}

TEST(CellMap, NoFreeCellIsAnError) {
    Drawing drawing(1, 1);
    drawing.unknown();
    EXPECT_EQ(errorOf(drawing.map(), {}), "map.png: error: no free cell among 20 x 20: no hint");
    ImportOptions gaps;
    gaps.close_gaps = 1;
    gaps.rooms = RoomChoice::All;
    EXPECT_EQ(errorOf(drawing.map(), gaps), "map.png: error: no free cell among 20 x 20: no hint");
    // A single cell is a room.
    drawing.map().free.insert(3, 3);
    EXPECT_EQ(import(drawing.map(), gaps).fences.size(), 1U);
}

}  // namespace
}  // namespace ispace
