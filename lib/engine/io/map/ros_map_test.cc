// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"
#include "support/test_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "raster/picture.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "support/test_import.h"
#include "support/test_png.h"

namespace ispace {
namespace ros_map_test {

/// A folder of the running test's own.
class RosMap : public ::testing::Test {
  protected:
    RosMap()
        : folder_(std::filesystem::path(testing::buildPath("ros_map_test")) /
                  ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
        std::filesystem::create_directories(folder_);
    }
    ~RosMap() override { std::filesystem::remove_all(folder_); }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    /// Writes map.pgm: '.' free, '#' occupied, ' ' unknown.
    void writeImage(const std::vector<std::string>& rows) const {
        std::string bytes = "P5\n" + std::to_string(rows.front().size()) + ' ' +
                            std::to_string(rows.size()) + "\n255\n";
        for (const std::string& row : rows)
            for (const char c : row)
                bytes += static_cast<char>(c == '.' ? 254 : c == '#' ? 0 : 205);
        writeAll(path("map.pgm"), bytes);
    }

    Document read(const std::string& yaml, const ImportOptions& options = {}) const {
        return readRosMap(yaml, path("map.yaml"), options, sceneSchemas());
    }

    /// All findings, without the folder.
    [[nodiscard]] std::string errorsOf(const std::string& yaml) const {
        try {
            read(yaml);
        } catch (const FormatError& error) {
            std::string all;
            for (const Diagnostic& diagnostic : error.diagnostics())
                all += diagnostic.text().substr(folder_.string().size() + 1) + '\n';
            return all;
        }
        return "no error";
    }

    std::filesystem::path folder_;
};

const std::string kHeader = "image: map.pgm\nresolution: 0.5\norigin: [-1, 2, 0]\n";

std::string textOf(const Document& document) { return writeRecordText(document); }

TEST_F(RosMap, KnowsAMap) {
    EXPECT_TRUE(isRosMap(kHeader));
    EXPECT_TRUE(isRosMap("{resolution: 0.1, image: a.png}"));
    EXPECT_FALSE(isRosMap("image: map.pgm\n"));
    EXPECT_FALSE(isRosMap("# image resolution\ndesk: {at: [1, 2]}\n"));
    EXPECT_FALSE(isRosMap("image: [resolution\n"));
    EXPECT_FALSE(isRosMap("- image\n- resolution\n"));
    EXPECT_FALSE(isRosMap(""));
    EXPECT_FALSE(isRosMap("image resolution " + std::string(100000, '[')));
}

TEST_F(RosMap, RoomWithPillar) {
    writeImage({"        ",  //
                " ###### ",  //
                " #....# ",  //
                " #.#..# ",  //
                " #....# ",  //
                " ###### "});
    // Unknown and occupied cells are no floor; cell (0, 0) has its corner at the origin.
    EXPECT_EQ(textOf(read(kHeader)),
              "#env 1\n"
              "fence path=0,2.5;2,2.5;2,4;0,4 closed=yes\n"
              "fence path=0.5,3;0.5,3.5;1,3.5;1,3 closed=yes\n"
              "inside at=0.25,2.75\n");
    const Environment room = environmentOf(read(kHeader));
    EXPECT_DOUBLE_EQ(room.indoor().area(), 11 * 0.25);
    EXPECT_EQ(room.indoor().parts.at(0).holes.size(), 1U);
    EXPECT_DOUBLE_EQ(room.height(), 2.5);
}

TEST_F(RosMap, OptionsSetHeightAndTolerance) {
    writeImage({"....####", ".....###", "......##", ".......#", "........", "........"});
    ImportOptions options;
    options.wall_height = 3;
    options.simplify = 0;
    const Document exact = read(kHeader, options);
    EXPECT_EQ(exact.records.front().number("height"), 3);
    EXPECT_EQ(exact.records.front().list("path").size(), 12U);
    EXPECT_LT(read(kHeader).records.front().list("path").size(), 8U);
}

TEST_F(RosMap, PngIsReadAsPgm) {
    writeImage({"....", ".##.", "... "});
    const std::string pgm = textOf(read(kHeader));
    const std::string row = "\xfe\xfe\xfe\xfe", middle("\xfe\x00\x00\xfe", 4);
    // The suffix does not count.
    writeAll(path("map.pgm"), pngFile(4, 8, 0, {row, middle, "\xfe\xfe\xfe\xcd"}));
    const Document png = read(kHeader);
    EXPECT_EQ(textOf(png), pgm);
    EXPECT_EQ(png.sources, std::vector<std::string>{path("map.pgm")});
    EXPECT_TRUE(png.notes.empty());
}

TEST_F(RosMap, ShadesOfUnknownStayUnknownWhateverTheThreshold) {
    writeImage({"..  ", "..  "});
    const std::string nav2 = kHeader + "free_thresh: 0.25\n";
    const Document document = read(nav2);
    EXPECT_DOUBLE_EQ(environmentOf(document).indoor().area(), 4 * 0.25);
    const auto told = [](const Document& map) {
        std::string shades;
        for (const Diagnostic& warning : map.warnings)
            if (warning.message.find("shade 205") != std::string::npos) shades += warning.message;
        return shades;
    };
    EXPECT_EQ(told(document),
              "4 pixels of shade 205, which map_server writes for unknown, are unknown, though "
              "`free_thresh` is 0.25; --unknown free takes them as free");
    ImportOptions lenient;
    lenient.unknown = "free";
    for (const std::string& yaml : {nav2, kHeader}) {
        const Document all = read(yaml, lenient);
        EXPECT_DOUBLE_EQ(environmentOf(all).indoor().area(), 8 * 0.25);
        EXPECT_EQ(told(all), "");
    }
    EXPECT_EQ(told(read(kHeader + "free_thresh: 0.196\n")), "");
    writeImage({".. .", ".. ."});
    EXPECT_EQ(read(kHeader).notes,
              std::vector<std::string>{"2 free cells apart from the room dropped; the room has 4"});
}

TEST_F(RosMap, YawTurnsAboutTheLowerLeftCorner) {
    writeImage({"..", "..", ".."});
    const std::string turned =
        "image: map.pgm\nresolution: 0.5\norigin: [10, 20, 1.5707963267948966]\n";
    EXPECT_EQ(textOf(read(turned)),
              "#env 1\n"
              "fence path=10,20;10,21;8.5,21;8.5,20 closed=yes\n"
              "inside at=9.75,20.25\n");
}

TEST_F(RosMap, LargestPieceIsTheRoomAndNegateIsHeeded) {
    writeImage({".#...", ".#...", "##..."});
    ImportOptions exact;
    exact.simplify = 0;
    const auto area = [&](const std::string& yaml) {
        return environmentOf(read(yaml, exact)).indoor().area();
    };
    EXPECT_DOUBLE_EQ(area(kHeader), 9 * 0.25);
    EXPECT_DOUBLE_EQ(area(kHeader + "negate: 1\n"), 4 * 0.25);
}

TEST_F(RosMap, FindingsNameTheirPlace) {
    writeImage({"..", ".."});
    EXPECT_EQ(errorsOf("image: map.pgm\n"
                       "resolution: -0.05\n"
                       "negate: maybe\n"
                       "free_thresh: 1.5\n"
                       "occupied_thresh: nan\n"
                       "mode: trinar\n"),
              "map.yaml:2:13: error: `resolution`: found `-0.05`, wanted a number from 0.001 to "
              "1000\n"
              "map.yaml:1:1: error: missing key `origin` of a ROS map\n"
              "map.yaml:6:7: error: `mode`: found `trinar`, wanted trinary, scale or raw, did you "
              "mean `trinary`?\n"
              "map.yaml:3:9: error: `negate`: found `maybe`, wanted 0 or 1\n"
              "map.yaml:5:18: error: `occupied_thresh`: found `nan`, wanted a number from 0 to 1\n"
              "map.yaml:4:14: error: `free_thresh`: found `1.5`, wanted a number from 0 to 1\n");
    EXPECT_EQ(
        errorsOf("image: map.pgm\nresolution: 0.05\norigin: [1]\n"),
        "map.yaml:3:9: error: `origin`: wanted a list of two or three numbers, [x, y, yaw]\n");
    EXPECT_EQ(errorsOf("image: map.pgm\nresolution: 0.05\norigin: [1, .inf]\n"),
              "map.yaml:3:13: error: `origin`: found `.inf`, wanted a number from -100000000 to "
              "100000000\n");
    EXPECT_EQ(errorsOf("image: [a]\nresolution: [1]\norigin: [1, 2]\n"),
              "map.yaml:1:8: error: `image`: wanted the name of a picture\n"
              "map.yaml:2:13: error: `resolution`: found a list or map, wanted a number from 0.001 "
              "to 1000\n");
    EXPECT_EQ(errorsOf("image: map.pgm\nresolution: 0.05\n  origin: [1, 2]\n").substr(0, 34),
              "map.yaml:3:9: error: bad YAML: ill");
}

TEST_F(RosMap, BadImages) {
    const std::string rest = "\nresolution: 0.5\norigin: [0, 0]\n";
    EXPECT_EQ(errorsOf("image: none.pgm" + rest),
              "map.yaml:1:8: error: picture `none.pgm` cannot be opened: No such file or "
              "directory; it is looked for beside the map\n");
    EXPECT_EQ(errorsOf("image: /dev/zero" + rest),
              "map.yaml:1:8: error: picture `/dev/zero` cannot be opened: it is no regular file\n");
    writeImage({"##", "  "});
    EXPECT_EQ(errorsOf(kHeader),
              "map.pgm: error: no free cell among 2 x 2: check `negate` and `free_thresh` of the "
              "map\n");
    writeAll(path("map.pgm"), "P5\n9 9\n255\nxx");
    EXPECT_EQ(errorsOf(kHeader), "map.pgm: error: truncated: 2 of 81 bytes\n");
    writeImage({std::string(20, '.')});
    EXPECT_EQ(errorsOf("image: map.pgm\nresolution: 1000\norigin: [0, 0]\n"),
              "map.pgm: error: 20 x 1 cells of 1000 m are more than 10000 m: is `resolution` in "
              "metres?\n");
}

TEST_F(RosMap, ImageMayBeElsewhere) {
    writeImage({"..", ".."});
    std::filesystem::create_directories(folder_ / "sub");
    std::filesystem::rename(path("map.pgm"), path("sub/map.pgm"));
    const std::string rest = "\nresolution: 0.5\norigin: [0, 0]\n";
    EXPECT_EQ(read("image: sub/map.pgm" + rest).records.size(), 2U);
    EXPECT_EQ(read("image: " + path("sub/map.pgm") + rest).records.size(), 2U);
}

TEST_F(RosMap, RoomsOfNoiseKeepTheirFloor) {
    std::mt19937_64 random(1312);
    for (int round = 0; round < 40; ++round) {
        const auto size = static_cast<std::size_t>(5 + round);
        std::vector<std::string> rows(size, std::string(size, '.'));
        for (std::string& row : rows)
            for (char& c : row)
                if (random() % 100 < 8U + static_cast<unsigned>(round) % 30) c = '#';
        writeImage(rows);
        ImportOptions exact;
        exact.simplify = 0;
        const Environment cells = environmentOf(read(kHeader, exact));
        const double count = cells.indoor().area() / 0.25;
        EXPECT_NEAR(count, std::round(count), 1e-6);
        const Environment room = environmentOf(read(kHeader));
        EXPECT_EQ(room.indoor().locate(room.inside()), Side::Inside);
        EXPECT_LE(std::abs(room.indoor().area() - cells.indoor().area()),
                  0.5 * cells.indoor().boundaryLength());
    }
}

/// The real maps, if the machine has them.
class RealMaps : public ::testing::Test {
  protected:
    void SetUp() override {
        if (std::getenv("ISPACE_TEST_DATA") == nullptr)
            GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of maps";
    }

    static Document read(const std::string& name, const ImportOptions& options = {}) {
        const std::string path = std::string(std::getenv("ISPACE_TEST_DATA")) + '/' + name;
        return readRosMap(readAll(path), path, options, sceneSchemas());
    }

    /// All messages of its warnings.
    static std::string warningsOf(const Document& document) {
        std::string all;
        for (const Diagnostic& warning : document.warnings) all += warning.message + '\n';
        return all;
    }

    static std::size_t verticesOf(const Document& document) {
        std::size_t count = 0;
        for (const Record& record : document.records)
            if (record.keyword() == "fence") count += record.list("path").size();
        return count;
    }
};

TEST_F(RealMaps, PillarsOfTheArenaAreHoles) {
    const Document document = read("turtlebot3.yaml");
    const Environment room = environmentOf(document);
    EXPECT_EQ(room.indoor().parts.at(0).holes.size(), 9U);
    EXPECT_NEAR(room.indoor().area(), 7936 * 0.0025, 7936 * 0.0025 * 0.01);
    // The origin lies in a pillar, so the inside point cannot be the origin.
    EXPECT_EQ(room.indoor().locate({0, 0}), Side::Outside);
    EXPECT_EQ(room.indoor().locate(room.inside()), Side::Inside);
    EXPECT_EQ(warningsOf(document), "");
}

TEST_F(RealMaps, OfficeLosesItsNoiseAndKeepsItsFloor) {
    ImportOptions exact;
    exact.simplify = 0;
    EXPECT_NEAR(environmentOf(read("willow-full.yaml", exact)).indoor().area(), 1312.46, 1e-6);
    const Document document = read("willow-full.yaml");
    const Environment room = environmentOf(document);
    // Beams through windows and doorways, which are no floor, are 2 % of it.
    EXPECT_NEAR(room.indoor().area(), 1312.46, 26.2);
    // Of 846 holes most were specks.
    EXPECT_LT(room.indoor().parts.at(0).holes.size(), 100U);
    EXPECT_GT(room.indoor().parts.at(0).holes.size(), 60U);
    EXPECT_LT(verticesOf(document), 2000U);
    // Rays through a window do leave the picture.
    EXPECT_NE(warningsOf(document).find("the room leaves the picture over 2.10 m at"),
              std::string::npos);
}

/// Areas counted by a program that shares no code with this one.
TEST_F(RealMaps, RoomsAreTheRightOnes) {
    const std::pair<const char*, double> maps[] = {
        {"tb3_sandbox", 19.74}, {"smoothers_world", 198.6}, {"cave", 195.5},
        {"empty_room", 96.0},   {"frieburg", 683.5},        {"hospital", 2083}};
    for (const auto& [name, area] : maps) {
        SCOPED_TRACE(name);
        const Document document = read(std::string("more/") + name + ".yaml");
        EXPECT_NEAR(environmentOf(document).indoor().area(), area, 0.01 * area);
        EXPECT_EQ(warningsOf(document), "");
    }
}

TEST_F(RealMaps, PointChoosesTheCorridorThatAWarningNames) {
    const Document solid = read("more/sal2.yaml");
    EXPECT_NE(warningsOf(solid).find("less than half of the free floor is kept, 298.0 m2 of"),
              std::string::npos);
    EXPECT_NE(warningsOf(solid).find("the largest region left out, 226.8 m2"), std::string::npos);
    ImportOptions options;
    // The middle of pixel (400, 80) of 887 x 407.
    options.inside = {{400.5 * 0.05, (407 - 80.5) * 0.05}};
    const Document corridor = read("more/sal2.yaml", options);
    EXPECT_NEAR(environmentOf(corridor).indoor().area(), 226.8, 2.26);
    EXPECT_NE(warningsOf(corridor).find("the room leaves the picture over 1.95 m at"),
              std::string::npos);
}

}  // namespace ros_map_test
}  // namespace ispace
