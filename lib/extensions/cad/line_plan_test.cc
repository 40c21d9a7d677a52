// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/line_plan.h"

#include <gtest/gtest.h>

#include <string>

#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace line_plan_test {

/// A long slanted line, `count` times `count` copies of which lie 3 cm apart.
std::string crowd(int count) {
    return drawing(insert("B", "0", 0, 0,
                          group(70, count) + group(71, count) + group(44, 0.03) + group(45, 0.031)),
                   block("B", 0, 0, line("0", 0, 0, 50, 50)), 6);
}

std::string refusal(const std::string& dxf, const ImportOptions& options = {}) {
    try {
        readDxf(dxf, "plan.dxf", options, sceneSchemas());
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

// The boxes of slanted lines all overlap: searches compare each line with all others.
TEST(LinePlan, CrowdsOfSlantedLinesArePaidFor) {
    EXPECT_EQ(refusal(crowd(12)), "");
    const std::string message = refusal(crowd(60));
    EXPECT_NE(message.find("neighbours of the lines make more than 10"), std::string::npos)
        << message;
    EXPECT_NE(message.find("--max-work"), std::string::npos) << message;
    ImportOptions options;
    options.max_work.max = 100;
    EXPECT_NE(refusal(crowd(30), options), "");
}

TEST(LinePlan, WidthIsWantsLinesOnTheLayersOfWalls) {
    ImportOptions options;
    options.width_is = 12;
    options.wall_layers = {"WALS"};
    EXPECT_EQ(refusal(drawing(line("WALLS", 0, 0, 4, 0), "", 6), options),
              "plan.dxf: error: no line on the layers of walls; layers with lines: WALLS (1)");
}

// Either fits: 180 000 units for copies of a block, 114 000 for crossings of walls.
TEST(LinePlan, BlocksAndCrossingsShareOneBudget) {
    std::string grid;
    for (int i = 0; i < 70; ++i)
        grid += line("W", -0.5, 0.1 * i, 10.4, 0.1 * i) + line("W", 0.1 * i, -0.5, 0.1 * i, 10.4);
    const std::string copies =
        insert("B", "OTHERS", 0, 0, group(70, 300) + group(71, 300) + group(44, 1));
    const std::string leaf = block("B", 0, 0, line("0", 0, 0, 1, 1));
    ImportOptions options;
    options.wall_layers = {"W"};
    options.max_work.max = 200'000;
    EXPECT_EQ(refusal(drawing(grid, leaf, 6), options), "");
    EXPECT_EQ(refusal(drawing(rectangle("W", 0, 0, 4, 3) + copies, leaf, 6), options), "");
    const std::string message = refusal(drawing(grid + copies, leaf, 6), options);
    EXPECT_NE(message.find("crossings of the lines make more than 200000 units of work "
                           "(`--max-work 400000` allows more)"),
              std::string::npos)
        << message;
}

/// Two rooms of 5 m x 6 m, and a door in the wall between them, which is a line.
TEST(LinePlan, FloorThatADiscReachesGoesThroughDoors) {
    ImportOptions options;
    options.reachable = 0.2;
    const Document plan = readDxf(drawing(rectangle("WALL", 0, 0, 10, 6) +
                                              line("WALL", 5, 0, 5, 6) + line("DOOR", 5, 2, 5, 2.9),
                                          "", 6),
                                  "plan.dxf", options, sceneSchemas());
    EXPECT_NEAR(environmentOf(plan).indoor().area(), 59.93, 0.01);
}

double areaOf(const std::string& entities) {
    return environmentOf(readDxf(drawing(entities, "", 6), "plan.dxf", {}, sceneSchemas()))
        .indoor()
        .area();
}

// The space between the lines of a wall is floor in doorways alone, though the lines run on.
TEST(LinePlan, DoorsOverWallsOfTwoLines) {
    const std::string room = rectangle("WALL", 0, 0, 10, 6);
    const std::string outside = room + rectangle("WALL", -0.2, -0.2, 10.2, 6.2);
    EXPECT_NEAR(areaOf(outside + rectangle("DOOR", 3, -0.2, 4, 0)), 60 + 0.2, 1e-6);
    const std::string partition =
        room + line("WALL", 4.9, 0, 4.9, 6) + line("WALL", 5.1, 0, 5.1, 6);
    const double two_rooms = 60 - 0.2 * 6 + 0.2 * 0.9;
    EXPECT_NEAR(areaOf(partition + rectangle("DOOR", 4.9, 2, 5.1, 2.9)), two_rooms, 1e-6);
    // A swing at one of the lines.
    EXPECT_NEAR(areaOf(partition + line("DOOR", 4.9, 2, 4, 2) + arc("DOOR", 4.9, 2, 0.9, 90, 180)),
                two_rooms, 1e-6);
    // Jambs that are drawn remain the only ones.
    EXPECT_NEAR(areaOf(partition + line("WALL", 4.9, 2, 5.1, 2) + line("WALL", 4.9, 2.9, 5.1, 2.9) +
                       rectangle("DOOR", 4.9, 2, 5.1, 2.9)),
                two_rooms, 1e-6);
    // A cupboard behind a door stays one.
    EXPECT_NEAR(areaOf(room + line("WALL", 9.6, 0, 9.6, 6) + line("WALL", 9.6, 1.2, 10, 1.2) +
                       line("DOOR", 9.6, 0.2, 9.6, 1.1)),
                9.6 * 6 + 0.4 * 1.2, 1e-6);
}

TEST(LinePlan, DoorsOverWallsWithLinesOfPlaster) {
    const std::string room = rectangle("WALL", 0, 0, 10, 6);
    const std::string partition = room + line("WALL", 4.9, 0, 4.9, 6) +
                                  line("WALL", 4.915, 0, 4.915, 6) +
                                  line("WALL", 5.155, 0, 5.155, 6);
    EXPECT_NEAR(areaOf(partition + line("DOOR", 4.9, 2, 4, 2) + arc("DOOR", 4.9, 2, 0.9, 90, 180)),
                60 - 0.255 * 6 + 0.255 * 0.9, 1e-6);
}

// A shelf behind a door in its middle is deep as a wall, and ends beside the door.
TEST(LinePlan, CupboardsOfShelvesKeepTheirBacks) {
    const std::string cupboard = rectangle("WALL", 0, 0, 10, 6) + line("WALL", 5, 0, 5, 6) +
                                 line("WALL", 4.65, 2, 4.65, 4) + line("WALL", 4.65, 2, 5, 2) +
                                 line("WALL", 4.65, 4, 5, 4);
    EXPECT_NEAR(areaOf(cupboard + line("DOOR", 4.65, 2.6, 3.85, 2.6) +
                       arc("DOOR", 4.65, 2.6, 0.8, 90, 180)),
                5 * 6, 1e-6);
    // The wall of a house ends beside a door in its corner.
    const std::string house = rectangle("WALL", 0, 0, 10, 6);
    const std::string partition =
        house + line("WALL", 4.9, 0, 4.9, 6) + line("WALL", 5.1, 0, 5.1, 6);
    EXPECT_NEAR(
        areaOf(partition + line("DOOR", 4.9, 0.1, 4, 0.1) + arc("DOOR", 4.9, 0.1, 0.9, 90, 180)),
        60 - 0.2 * 6 + 0.2 * 0.9, 1e-6);
}

}  // namespace line_plan_test
}  // namespace ispace::cad
