// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/map/cell_map.h"

#include <gtest/gtest.h>

#include <random>

#include "support/test_cell_map.h"

namespace ispace {
namespace cell_report_test {

using testing::Drawing;
using testing::errorOf;
using testing::import;
using testing::Imported;

TEST(CellReport, CorridorThatLeavesThePictureIsSaid) {
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

TEST(CellReport, SmallPartOfTheFloorIsSaidWithWhatHelps) {
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

TEST(CellReport, SizesOfNoBuildingAreSaid) {
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

TEST(CellReport, ReachableFloorIsThatOfADisc) {
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

TEST(CellReport, NoiseOverARectangleComesOutAsTheRectangle) {
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

TEST(CellReport, SpeckleOffTellsNothing) {
    Drawing drawing(10, 8);
    drawing.unknown();
    drawing.room(1, 1, 7, 6);
    drawing.fill(3, 3, 3.05, 3.05, false);
    EXPECT_EQ(import(drawing.map()).notes,
              std::vector<std::string>{
                  "below the map's noise: 1 speck and slits of 0.0 m2 became floor, 0 spikes of "
                  "0.0 m2 went; --clean 0 keeps them"});
    ImportOptions exact;
    exact.simplify = 0;
    EXPECT_TRUE(import(drawing.map(), exact).notes.empty());
}

TEST(CellReport, SpikesOfMoreThanAHundredthAreToldByDefault) {
    const auto told_with = [](double width) {
        Drawing drawing(12, 8);
        drawing.unknown();
        drawing.room(1, 1, 7, 6);
        for (double y = 2; y < 6; y += 0.5) drawing.fill(7, y, 7 + width, y + 0.05, true);
        return import(drawing.map());
    };
    EXPECT_TRUE(told_with(4).warns("8 spikes of"));
    EXPECT_TRUE(told_with(0.2).warnings.empty());
    EXPECT_EQ(told_with(0.2).notes.size(), 1U);
}

TEST(CellReport, AnyCellsAndOptionsGiveRoomsOrAnError) {
    std::mt19937_64 random(77);
    const auto chance = [&random](unsigned percent) { return random() % 100 < percent; };
    int errors = 0;
    for (int round = 0; round < 400; ++round) {
        const int width = 1 + static_cast<int>(random() % 40);
        const int height = 1 + static_cast<int>(random() % 40);
        const double resolution = chance(50) ? 0.05 : 0.5;
        CellMap map{MapCells(width, height), MapCells(width, height), resolution, {}};
        const unsigned free = 50 + static_cast<unsigned>(random() % 50);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                if (chance(free))
                    map.free.insert(x, y);
                else if (chance(50))
                    map.occupied.insert(x, y);
            }
        const auto place = [&] {
            return map.inMap({static_cast<double>(random() % 400) / 400 * width,
                              static_cast<double>(random() % 400) / 400 * height});
        };
        ImportOptions options;
        if (chance(30)) options.rooms = RoomChoice::All;
        if (chance(30)) options.inside = {place(), place()};
        if (chance(20)) options.known_inside = {place()};
        if (chance(30)) options.known_walls = {{place(), place()}, {place(), place()}};
        if (chance(40)) options.close_gaps = resolution * static_cast<double>(random() % 10);
        if (chance(30)) options.reachable = resolution * static_cast<double>(1 + random() % 3);
        if (chance(30)) options.simplify = resolution * static_cast<double>(random() % 4) / 2;
        try {
            const Imported found = import(map, options);
            EXPECT_FALSE(found.fences.empty());
            EXPECT_GT(found.area(), 0);
            // No point is outside of all outlines, or in a hole.
            for (const Point2 p : found.inside) {
                int around = 0;
                for (const Polygon& fence : found.fences)
                    if (Region{fence, {}}.locate(p) == Side::Inside)
                        around += signedArea(fence) > 0 ? 1 : -1;
                EXPECT_EQ(around, 1) << round;
            }
        } catch (const FormatError&) {
            ++errors;
        }
    }
    EXPECT_LT(errors, 250);
    EXPECT_GT(errors, 50);
}

TEST(CellReport, NoFreeCellIsAnError) {
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

}  // namespace cell_report_test
}  // namespace ispace
