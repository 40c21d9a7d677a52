// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/maps/maps.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "base/file.h"
#include "env/level.h"
#include "support/test_import.h"

namespace ispace::maps {
namespace aria_map_test {

const std::string kMap =
    "2D-Map\n"
    "LineMinPos: 0 0\n"
    "LineMaxPos: 8000 6000\n"
    "NumLines: 6\n"
    "MinPos: 0 0\n"
    "MaxPos: 8000 6000\n"
    "NumPoints: 7\n"
    "Resolution: 20\n"
    "Cairn: RobotHome 1000 2000 90.000000 \"\" ICON \"Home 1\"\n"
    "Cairn: Goal 3000 2000 0.000000 \"\" ICON \"desk\"\n"
    "Cairn: ForbiddenArea 0 0 0.000000 \"\" ICON \"Cold Store\" 6000 4000 8000 6000\n"
    "Cairn: ForbiddenArea 10 20 90.000000 \"\" ICON \"\" 1000 -3000 2000 -1000\n"
    "Cairn: ForbiddenLine 0 0 0.000000 \"\" ICON \"edge\" 100 100 200 200\n"
    "LINES\n"
    "0 0 8000 0\n"
    "8000 0 8000 6000\n"
    "0 6000 8000 6000\n"
    "0 3 0 6000\n"
    "2000 1000 3000 1000\n"
    "9000 0 9900 0\n"
    "DATA\n"
    "4010 3010\n"
    "4060 3010\n"
    "4011 3060\n"
    "4061 3060\n"
    "5000 5000\n"
    "100 50\n"
    "20000 3000\n";

Document read(const std::string& map, const ImportOptions& options = {}) {
    return readAriaMap(map, "office.map", options, sceneSchemas());
}
std::string errorOf(const std::string& map) {
    return errorsOf([&] { read(map); });
}
/// The map with one text in place of another.
std::string with(const std::string& old_text, const std::string& new_text) {
    std::string map = kMap;
    return map.replace(map.find(old_text), old_text.size(), new_text);
}

TEST(AriaMap, LinesZonesAndHome) {
    const Document document = read(kMap);
    EXPECT_EQ(writeRecordText(document),
              "#env 1\n"
              "fence path=0,0;8,0;8,6;0,6 closed=yes\n"
              "fence path=2,1;3,1\n"
              "zone id=forbidden-cold-store at=7,5 size=2,2\n"
              "zone id=forbidden at=2,1.5 heading=90 size=1,2\n"
              "inside at=1,2\n");
    EXPECT_EQ(notesOf(document),
              "kept 48.0 m2 in 1 room\n"
              "1 ForbiddenLine left out\n"
              "1 Goal left out\n"
              "7 points left out\n"
              "left out outside of it: 1 line\n");
    EXPECT_EQ(warningsOf(document), "");
    EXPECT_DOUBLE_EQ(environmentOf(document).indoor().area(), 48);
    EXPECT_EQ(document.records.front().place().line, 15);
}

TEST(AriaMap, PointsOnRequest) {
    ImportOptions options;
    options.own.edit<AriaPoints>().are_obstacles = true;
    options.wall_height = 2;
    const Document document = read(kMap, options);
    const std::string text = writeRecordText(document);
    // Two by two cells are one cube; the echo of a wall and what is outside are left out.
    EXPECT_NE(
        text.find("cube at=4.05,3.05 size=0.1,0.1,2\ncube at=5.025,5.025 size=0.05,0.05,2\nzone"),
        std::string::npos)
        << text;
    EXPECT_NE(notesOf(document).find("5 points became 2 cubes; left out: 1 at lines, 1 outside\n"),
              std::string::npos);
    EXPECT_GT(environmentOf(document).level(0.15)->freeFloor().size(), 0U);
}

TEST(AriaMap, OpenMapsAreClosedAndSaySo) {
    const std::string open = with("8000 0 8000 6000", "8000 0 8000 5000");
    const Document document = read(open);
    EXPECT_EQ(warningsOf(document),
              "office.map: warning: the walls do not close: closed 1 gap of up to 1 m (1.000 m at "
              "(8.0, 5.5)); --close-gaps M sets the widest\n");
    EXPECT_DOUBLE_EQ(environmentOf(document).indoor().area(), 48);
}

TEST(AriaMap, GapsStayOpenOnRequest) {
    ImportOptions options;
    options.close_gaps = 0.9;
    const Document document = read(with("8000 0 8000 6000", "8000 0 8000 5000"), options);
    EXPECT_EQ(countOf(document, "fence"), 3U);
    // Home tells which room the gap is about.
    EXPECT_EQ(countOf(document, "inside"), 1U);
    EXPECT_NE(notesOf(document).find("nothing is enclosed: all lines are kept\n"),
              std::string::npos);
    EXPECT_NE(errorsOf([&] { environmentOf(document); }).find("not enclosed: 1.0 m"),
              std::string::npos);
}

TEST(AriaMap, HomeTellsTheRoom) {
    // A larger hall beside the room.
    const std::string hall =
        "20000 0 40000 0\n40000 0 40000 9000\n40000 9000 20000 9000\n20000 9000 20000 0\n";
    const std::string both = with("NumLines: 6", "NumLines: 10");
    const Document document = read(std::string(both).insert(both.find("DATA"), hall));
    EXPECT_DOUBLE_EQ(environmentOf(document).indoor().area(), 48);
    std::string homeless = both;
    homeless.erase(homeless.find("Cairn: RobotHome"),
                   homeless.find("Cairn: Goal") - homeless.find("Cairn: RobotHome"));
    EXPECT_DOUBLE_EQ(
        environmentOf(read(homeless.insert(homeless.find("DATA"), hall))).indoor().area(), 180);
}

TEST(AriaMap, NamesWhatIsWrong) {
    EXPECT_EQ(errorOf(with("0 0 8000 0", "0 0 8000")),
              "office.map:15:1: error: found 3 words, wanted a line, x1 y1 x2 y2 in mm\n");
    EXPECT_EQ(errorOf(with("0 0 8000 0\n", "0 0 8000 nan\n")),
              "office.map:15:1: error: found `nan`, wanted a number\n");
    EXPECT_EQ(errorOf(with("4010 3010", "4010 3010 1")),
              "office.map:22:1: error: found 3 words, wanted a point, x y in mm\n");
    EXPECT_EQ(errorOf(with("0 0 8000 0\n", "0 0 1e12 0\n")),
              "office.map:15:1: error: a place more than 900 km from the origin\n");
    EXPECT_EQ(errorOf(with("NumLines: 6", "NumLines: 7")),
              "office.map:28:1: error: 6 of 7 lines: is the file whole?\n");
    EXPECT_EQ(errorOf(with("NumLines: 6", "NumLines: 5")),
              "office.map:28:1: error: found 6 lines, the header announces 5\n");
    EXPECT_EQ(errorOf(with("NumPoints: 7", "NumPoints: -7")),
              "office.map:7:1: error: `NumPoints:`: wanted how many\n");
    EXPECT_EQ(errorOf(with("6000 4000 8000 6000", "6000 4000")),
              "office.map:11:1: error: the line ends early, wanted a number\n");
    EXPECT_EQ(errorOf("2D-Map\n"), "office.map: error: a map without lines: nothing is a wall\n");
    EXPECT_NE(errorOf("2D-Map\nDATA\n1 2\n").find("a map of points alone"), std::string::npos);
}

TEST(AriaMap, StarsCompile) {
    const Document star = read(
        "2D-Map\nLINES\n0 5000 -2938 -4045\n-2938 -4045 4755 1545\n4755 1545 -4755 1545\n"
        "-4755 1545 2938 -4045\n2938 -4045 0 5000\n");
    EXPECT_EQ(errorsOf([&] { EXPECT_GT(environmentOf(star).indoor().area(), 1); }), "no error")
        << writeRecordText(star);
}

TEST(AriaMap, SimplifyOnRequest) {
    std::string map = "2D-Map\nLINES\n10000 0 10000 8000\n10000 8000 0 8000\n0 8000 0 0\n";
    for (int i = 0; i < 100; ++i)
        map += std::to_string(100 * i) + (i % 2 == 0 ? " 0 " : " 2 ") +
               std::to_string(100 * i + 100) + (i % 2 == 0 ? " 2\n" : " 0\n");
    EXPECT_EQ(read(map).records[0].list("path").size(), 103U);
    ImportOptions options;
    options.simplify = 0.01;
    const Document document = read(map, options);
    EXPECT_EQ(document.records[0].list("path").size(), 4U);
    EXPECT_DOUBLE_EQ(environmentOf(document).indoor().area(), 80);
}

TEST(AriaMap, SurvivesDamage) {
    ImportOptions options;
    options.own.edit<AriaPoints>().are_obstacles = true;
    surviveDamage(kMap, [&](const std::string& bytes) { read(bytes, options); });
}

TEST(AriaMap, ManyPoints) {
    std::string map =
        "2D-Map\nLINES\n0 0 100000 0\n100000 0 100000 100000\n100000 100000 0 100000\n0 100000 0 "
        "0\nDATA\n";
    std::string far = map;
    for (int i = 0; i < 300; ++i)
        for (int k = 0; k < 300; ++k) {
            map += std::to_string(1000 + 50 * i) + ' ' + std::to_string(1000 + 50 * k) + '\n';
            far += std::to_string(1000 + 110 * i) + ' ' + std::to_string(1000 + 100 * k + i % 2) +
                   '\n';
        }
    ImportOptions options;
    options.own.edit<AriaPoints>().are_obstacles = true;
    EXPECT_EQ(countOf(read(map, options), "cube"), 1U);
    EXPECT_EQ(countOf(read(far, options), "cube"), 90'000U);
}

TEST(AriaMap, Known) {
    EXPECT_TRUE(isAriaMap("2D-Map\r\nLINES\r\n"));
    EXPECT_TRUE(isAriaMap("2D-Map"));
    EXPECT_FALSE(isAriaMap("2D-Maps\n"));
    EXPECT_FALSE(isAriaMap("2D"));
}

/// Areas that a person would mean; `options` where a person has to say something.
void expectArea(const std::string& file, double area, const ImportOptions& options = {}) {
    const char* folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const Document document =
        readAriaMap(readAll(std::string(folder) + "/more/" + file), file, options, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), area, 0.01 * area) << file;
}

TEST(AriaMap, LinesThatMissEachOther) { expectArea("ActivMediaLab.map", 38.2); }
TEST(AriaMap, ClosedLines) { expectArea("triangle.map", 103.4); }

}  // namespace aria_map_test
}  // namespace ispace::maps
