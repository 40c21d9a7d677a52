// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms that are written as IFC and read again.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "extensions/ifc/ifc.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_import.h"

namespace ispace::ifc {

namespace round_trip_test {

Document readBack(const std::string& records, const ImportOptions& options = {}) {
    const Document document = readRecordText("#env 1\n" + records, "room", sceneSchemas());
    const std::string ifc =
        writeIfc(makeScene(document, nullptr, DeviceCatalogue()), "room").product;
    return readIfc(ifc, "room.ifc", options, sceneSchemas());
}

double areaOfBack(const std::string& records) {
    return environmentOf(readBack(records)).indoor().area();
}

// Walls of the room itself come back 5 mm thick.
constexpr double kRoom = (8 - 0.005) * (6 - 0.005);

TEST(IfcRoundTrip, RoomsAroundAWallInTheirMiddle) {
    const std::string room = "ispace size=8,6\n";
    EXPECT_NEAR(areaOfBack(room + "wall from=-1,0 to=1,0 thickness=0.2\n"), kRoom - 0.4, 1e-3);
    EXPECT_NEAR(areaOfBack(room + "wall from=-1,0 to=4,0 thickness=0.2\n"), kRoom - 1, 1e-3);
    const std::string core =
        "wall from=-1,-1 to=1,-1 thickness=0.2\nwall from=1,-1 to=1,1 thickness=0.2\n"
        "wall from=1,1 to=-1,1 thickness=0.2\nwall from=-1,1 to=-1,-1 thickness=0.2\n";
    EXPECT_NEAR(areaOfBack(room + core + "inside at=3,2\n"), kRoom - 2.2 * 2.2, 1e-3);
}

TEST(IfcRoundTrip, ZonesAroundAWallInTheirMiddle) {
    const Document back =
        readBack("ispace size=8,6\nwall from=-1,0 to=1,0 thickness=0.2\nzone id=z size=4,4\n");
    EXPECT_NEAR(environmentOf(back).indoor().area(), kRoom - 0.4, 1e-3);
    EXPECT_EQ(countOf(back, "zone"), 2U);
    EXPECT_EQ(countOf(back, "inside"), 1U);
}

std::vector<double> numbersOf(const Document& document, const char* keyword, const char* key) {
    std::vector<double> all;
    for (const Record& record : document.records)
        if (record.keyword() == keyword) all.push_back(record.number(key));
    return all;
}

TEST(IfcRoundTrip, WallsKeepTheirHeights) {
    const Document back =
        readBack("ispace size=8,6\nwall from=0,-1 to=0,1 height=1.2 thickness=0.1\n");
    EXPECT_EQ(numbersOf(back, "fence", "height"), (std::vector<double>{2.5, 2.5, 1.2}));
    EXPECT_NEAR(environmentOf(back).indoor().area(), kRoom - 0.2, 1e-3);
    const Document low =
        readBack("fence path=0,0;6,0;6,4;0,4 closed=yes height=1.2\ninside at=1,1\n");
    for (const double height : numbersOf(low, "fence", "height")) EXPECT_NEAR(height, 1.2, 1e-6);
}

TEST(IfcRoundTrip, AWallOffTheFloorLeavesTheFloorFree) {
    const Document back = readBack("ispace size=8,6\nwall at=0,0,1 size=3,0.2,1\n");
    EXPECT_NEAR(environmentOf(back).indoor().area(), kRoom, 1e-3);
    EXPECT_EQ(countOf(back, "cube"), 1U);
}

TEST(IfcRoundTrip, WallsBelowTheCutAreKept) {
    const Document back =
        readBack("ispace size=8,6\nwall from=1,-1 to=1,1 height=0.9 thickness=0.2\n");
    EXPECT_NEAR(environmentOf(back).indoor().area(), kRoom, 1e-3);
    ASSERT_EQ(countOf(back, "cube"), 1U);
    for (const Record& record : back.records)
        if (record.keyword() == "cube") {
            EXPECT_EQ(record.tuple("size"), (Tuple{2, 0.2, 0.9})) << formatRecord(record);
        }
    // Where all are low, the error tells the height that cuts them.
    const std::string error = errorsOf(
        [] { readBack("fence path=0,0;6,0;6,4;0,4 closed=yes height=0.9\ninside at=1,1\n"); });
    EXPECT_NE(error.find("4 walls are lower than the cut at 1.00 m: try --slice-walls 0.45"),
              std::string::npos)
        << error;
}

TEST(IfcRoundTrip, WindowsKeepTheirGlass) {
    const auto glass_of = [](const std::string& window) {
        for (const Record& record :
             readBack("ispace id=r size=8,6\nwall id=m from=0,-3 to=0,3\nwindow wall=m offset=3 "
                      "size=2 " +
                      window + "\ninside at=-1,0\ninside at=1,0\n")
                 .records)
            if (record.keyword() == "window") return record.text("glass");
        return std::string("no window");
    };
    EXPECT_EQ(glass_of("glass=clear"), "clear");
    EXPECT_EQ(glass_of("glass=opaque"), "opaque");
    EXPECT_EQ(glass_of("blind=yes"), "opaque");
    EXPECT_EQ(glass_of("open=yes"), "none");
}

TEST(IfcRoundTrip, CornersOf45DegreesStayStraight) {
    const Document back = readBack("fence path=0,0;4,0;4,4;2,4;0,2 closed=yes\n");
    EXPECT_EQ(warningsOf(back), "");
    EXPECT_EQ(countOf(back, "fence"), 2U);
    for (const Record& record : back.records)
        if (record.keyword() == "fence") {
            EXPECT_EQ(record.list("path").size(), 5U);
        }
}

}  // namespace round_trip_test

}  // namespace ispace::ifc
