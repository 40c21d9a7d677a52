// SPDX-License-Identifier: GPL-3.0-or-later
// Drawings that writeDxf() made, read back.
#include "io/importers.h"
#include "support/test_dxf.h"
#include "support/test_import.h"

namespace ispace {
namespace {

std::string ours(const std::string& entities) {
    std::string layers;
    for (const char* name : {"walls", "doors", "windows", "objects", "inside"})
        layers += layer(name, 7, 0);
    return drawing(entities, "", 6, layers);
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

}  // namespace
}  // namespace ispace
