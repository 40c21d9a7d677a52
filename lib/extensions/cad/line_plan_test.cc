// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/line_plan.h"

#include <gtest/gtest.h>

#include <string>

#include "extensions/cad/cad.h"
#include "support/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace {

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

}  // namespace
}  // namespace ispace::cad
