// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/file.h"
#include "extensions/maps/maps.h"
#include "support/test_import.h"

namespace ispace::maps {
namespace grid_map_test {

ImportOptions withResolution(double metres) {
    ImportOptions options;
    options.resolution = metres;
    return options;
}

std::string gridMap(const std::string& rows, int width, int height,
                    const std::string& type = "octile") {
    return "type " + type + "\nheight " + std::to_string(height) + "\nwidth " +
           std::to_string(width) + "\nmap\n" + rows;
}

std::string gridText(const std::string& bytes, const ImportOptions& options = {}) {
    return writeRecordText(readGridMap(bytes, "arena.map", options, sceneSchemas()));
}

TEST(GridMap, Known) {
    EXPECT_TRUE(isGridMap("type octile\nheight 2\n"));
    EXPECT_TRUE(isGridMap("type octile\r\nheight 2\r\n"));
    EXPECT_FALSE(isGridMap("type: octile\n"));
    EXPECT_FALSE(isGridMap("2D-Map\n"));
    EXPECT_FALSE(isGridMap(""));
}

TEST(GridMap, TopRowIsFarthestUp) {
    EXPECT_EQ(gridText(gridMap("@@@@@\n@.GS@\n@.TT@\n@WWW@\n@@@@@\n", 5, 5)),
              "#env 1\nfence path=2,2;2,3;4,3;4,4;1,4;1,2 closed=yes\ninside at=1.5,2.5\n");
    EXPECT_EQ(gridText("type octile\r\nheight 1\r\nwidth 2\r\nmap\r\n..\r\n", withResolution(0.5)),
              "#env 1\nfence path=1,0;1,0.5;0,0.5;0,0 closed=yes\ninside at=0.25,0.25\n");
}

TEST(GridMap, KeepsStairsAndSpecksUnlessSimplified) {
    const std::string bytes = gridMap("....@\n...@@\n.@.@@\n....@\n.....\n", 5, 5);
    const auto area_of = [&](const ImportOptions& options) {
        const Document map = readGridMap(bytes, "arena.map", options, sceneSchemas());
        return environmentOf(map).indoor().area();
    };
    EXPECT_DOUBLE_EQ(area_of({}), 18);
    ImportOptions rough;
    rough.simplify = 1;
    EXPECT_NE(area_of(rough), 18);
}

TEST(GridMap, RefusesWithLine) {
    const auto error_of = [](const std::string& bytes) {
        return errorsOf([&] { gridText(bytes); });
    };
    EXPECT_EQ(error_of(gridMap(".\n", 1, 1, "tile")),
              "arena.map:1:1: error: found type `tile`, wanted `type octile`\n");
    EXPECT_EQ(error_of(gridMap("..\n.\n", 2, 2)),
              "arena.map:6:1: error: a row of 1 cell, wanted 2\n");
    EXPECT_EQ(error_of(gridMap("..\n.x\n", 2, 2)),
              "arena.map:6:1: error: found `x` in a row, wanted one of . G S @ O T W\n");
    EXPECT_EQ(error_of(gridMap("..\n..\n..\n", 2, 2)), "arena.map:7:1: error: more than 2 rows\n");
    EXPECT_EQ(error_of(gridMap("....\n", 2, 2)),
              "arena.map:5:1: error: a row of 4 cells, wanted 2\n");
    EXPECT_EQ(error_of(gridMap("..\n", 2, 2)), "arena.map:5:1: error: truncated: 1 of 2 rows\n");
    EXPECT_NE(error_of(gridMap(".\n", 2000000000, 2000000000)).find("truncated"),
              std::string::npos);
    EXPECT_NE(error_of(gridMap("@@\n@@\n", 2, 2)).find("no cell of ground"), std::string::npos);
    EXPECT_NE(error_of("type octile\nwidth 3\n").find("wanted `height`"), std::string::npos);
}

TEST(GridMap, SurvivesDamage) {
    surviveDamage(gridMap("@@@@@\n@.GS@\n@.TT@\n@WWW@\n@@@@@\n", 5, 5),
                  [](const std::string& bytes) { gridText(bytes); });
}

}  // namespace grid_map_test
}  // namespace ispace::maps
