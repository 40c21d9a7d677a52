// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings that writeDxf() made, read back.
#include "extensions/cad/cad.h"
#include "extensions/cad/dxf_plan.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"
#include "support/test_scenes.h"

namespace ispace::cad {
namespace dxf_room_test {

std::string ours(const std::string& entities, int units = 6) {
    std::string layers;
    for (const char* name : {"walls", "doors", "windows", "objects", "inside"})
        layers += layer(name, 7, 0);
    return drawing(entities, "", units, layers);
}

Document readOurs(const std::string& entities) {
    return readDxf(ours(entities), "room.dxf", {}, sceneSchemas());
}

std::string circle(const std::string& layer, double x, double y, double radius) {
    return group(0, "CIRCLE") + group(8, layer) + group(10, x) + group(20, y) + group(40, radius);
}

/// Two rooms, the smaller with an inside point, and things in it.
std::string roomsAt(double x, double y) {
    return rectangle("walls", x, y, x + 8, y + 5) + rectangle("walls", x + 9, y, x + 12, y + 5) +
           rectangle("objects", x + 10, y + 1, x + 11, y + 3) + group(39, 0.7) +
           circle("objects", x + 10.5, y + 4, 0.25) + group(39, 1) +
           rectangle("zones", x + 9, y, x + 10, y + 1) +
           rectangle("floors", x + 10, y + 4, x + 11, y + 5) +
           circle("inside", x + 9.5, y + 2, 0.05);
}

TEST(DxfRoom, MovesWholeFromSurveyorsCoordinates) {
    const std::string home = writeRecordText(readOurs(roomsAt(-9, 0)));
    EXPECT_NE(home.find("inside at=0.5,2\n"), std::string::npos) << home;
    EXPECT_EQ(writeRecordText(readOurs(roomsAt(399'991, 500'000))), home);
}

/// A room with windows in one wall, each a metre wide, above one another.
std::string stackedWindows(int count, double height) {
    std::string entities = rectangle("walls", 0, 0, 8, 5);
    for (int i = 0; i < count; ++i)
        entities += polyline("windows", false, {{1, 0}, {2, 0}}) + group(38, 0.5 + i * height) +
                    group(39, height);
    return entities;
}

TEST(DxfRoom, WindowsAboveOneAnother) {
    const auto windows_of = [](const std::string& entities) {
        return countOf(readOurs(entities), "window");
    };
    EXPECT_EQ(windows_of(stackedWindows(3, 0.5)), 3U);
    EXPECT_EQ(windows_of(stackedWindows(3, 0.5) + stackedWindows(3, 0.5)), 3U);
    EXPECT_EQ(windows_of(stackedWindows(3, 0)), 1U);  // of unknown height
    EXPECT_EQ(windows_of(stackedWindows(3, 0.5) + polyline("windows", false, {{1.9, 0}, {2.9, 0}}) +
                         group(38, 1.9) + group(39, 1)),
              3U);
}

TEST(DxfRoom, WindowsInOneWallCostWork) {
    EXPECT_EQ(errorsOf([] { readOurs(stackedWindows(10'000, 1e-4)); }).find("room.dxf: error: "),
              0U);
    ImportOptions options;
    options.max_work.max = 100'000;
    const std::string dxf = ours(stackedWindows(3000, 1e-4));
    EXPECT_NE(errorsOf([&] {
                  readDxf(dxf, "room.dxf", options, sceneSchemas());
              }).find("openings on one wall make more than 100000 units of work"),
              std::string::npos);
}

/// A door whose extended data holds one more group, in a drawing in millimetres.
std::string doorWith(const std::string& more, const std::string& application = "ISPACE") {
    const std::string entities = rectangle("walls", 0, 0, 8000, 5000) +
                                 polyline("doors", false, {{1000, 0}, {1900, 0}}) +
                                 group(39, 2000) + group(1001, application) + more;
    const std::string dxf = ours(entities, 4);
    const std::string text = writeRecordText(readDxf(dxf, "room.dxf", {}, sceneSchemas()));
    const std::size_t start = text.find("door ");
    return text.substr(start, text.find('\n', start) - start);
}

TEST(DxfRoom, DepthsOfOpenings) {
    const std::string plain = "door wall=f1 from=1,0 to=1.9,0 open=yes";
    EXPECT_EQ(doorWith(""), plain);
    EXPECT_EQ(doorWith(group(1041, 700)), "door wall=f1 from=1,0 to=1.9,0 size=0.9,0.7 open=yes");
    EXPECT_EQ(doorWith(group(1040, 700)), plain);  // CAD programs do not scale these
    EXPECT_EQ(doorWith(group(1041, 700), "OTHER"), plain);
    for (const double unsound : {-700., 1e-4, 1e12})
        EXPECT_EQ(doorWith(group(1041, unsound)), plain);
    EXPECT_NE(doorWith(group(1041, 1e9)), plain);  // as deep as `size` allows
}

std::string again(const std::string& records) {
    return writeRecordText(
        readDxf(writeDxf(sceneOf(records), std::nullopt), "room.dxf", {}, sceneSchemas()));
}

TEST(DxfRoom, WallsOffTheFloorStayThere) {
    const std::string records = again("ispace size=8,6\nwall at=0,0,1 size=3,0.2,1\n");
    EXPECT_NE(records.find("wall at=0,0,1 size=3,0.2,1\n"), std::string::npos) << records;
}

TEST(DxfRoom, PanesKeepTheirGlass) {
    const std::string room = "ispace id=r size=8,6\nwall id=m from=0,-3 to=0,3\n";
    const std::string window = "window wall=m offset=3 size=2 ";
    const auto pane = [&](const std::string& keys) {
        const std::string records = again(room + window + keys + "\n");
        const std::size_t at = records.find("window");
        return records.substr(at, records.find('\n', at) - at);
    };
    const std::string clear = pane("");
    EXPECT_EQ(clear.find("glass"), std::string::npos) << clear;
    for (const char* keys : {"glass=opaque", "glass=none", "open=yes", "blind=yes"})
        EXPECT_NE((pane(keys) + ' ').find(' ' + std::string(keys) + ' '), std::string::npos)
            << pane(keys);
}

}  // namespace dxf_room_test
}  // namespace ispace::cad
