// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/cad.h"

#include <cmath>
#include <cstdlib>

#include "base/file.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace house_expo_test {

Document read(const std::string& json, const ImportOptions& options = {}) {
    return readHouseExpo(json, "plan.json", options, sceneSchemas());
}
std::string errorOf(const std::string& json) {
    return errorsOf([&] { read(json); });
}

const std::string kRoom = R"({"id": "a", "room_num": 1,
 "verts": [[0, 0], [0, 3], [4, 3], [4, 0], [4, 0]],
 "holes": [[[1, 1], [2, 1], [2, 2], [1, 2]]],
 "room_category": {"Kitchen": [[0, 0, 2, 3], [2, 0, 4, 3]], "Living Room": [[1, 1, 1, 3]], "N/A": [[0, 0, 4, 3]]}})";

TEST(HouseExpo, OutlineHolesAndZones) {
    const Document document = read(kRoom);
    EXPECT_EQ(document.kind, DocumentKind::Environment);
    EXPECT_EQ(writeRecordText(document),
              "#env 1\n"
              "fence path=0,0;4,0;4,3;0,3 closed=yes\n"
              "fence path=1,1;1,2;2,2;2,1 closed=yes\n"
              "inside at=3,1.5\n"
              "zone id=kitchen at=1,1.5 size=2,3\n"
              "zone id=kitchen-2 at=3,1.5 size=2,3\n"
              "zone id=n-a at=2,1.5 size=4,3\n");
    EXPECT_EQ(notesOf(document),
              "kept the largest region, 11.0 m2 in 1 room\n"
              "1 box of `room_category` without area left out\n");
    EXPECT_EQ(warningsOf(document), "");
    const Environment room = environmentOf(document);
    EXPECT_DOUBLE_EQ(room.indoor().area(), 11);
    EXPECT_DOUBLE_EQ(room.height(), 2.5);
}

TEST(HouseExpo, Options) {
    ImportOptions options;
    options.wall_height = 3;
    options.wall_thickness = 0.1;
    options.simplify = 0.02;
    // A chamfer of a centimetre and a point on a side.
    const Document document =
        read(R"({"verts": [[0.01, 0], [0, 0.01], [0, 1.5], [0, 3], [4, 3], [4, 0]]})", options);
    EXPECT_EQ(document.records[0].number("height"), 3);
    EXPECT_EQ(document.records[0].number("thickness"), 0.1);
    EXPECT_EQ(document.records[0].list("path").size(), 4U);
    ImportOptions snap;
    snap.snap = 0.02;
    EXPECT_EQ(read(R"({"verts": [[0.01, 0], [0, 0.01], [0, 3], [4, 3], [4, 0]]})", snap)
                  .records[0]
                  .list("path")
                  .size(),
              4U);
}

TEST(HouseExpo, RingsMayTouchAndCross) {
    // A figure of eight, the right half larger.
    const Document eight = read(R"({"verts": [[0, 0], [6, 3], [6, 0], [0, 2]]})");
    EXPECT_EQ(notesOf(eight), "kept the largest region, 5.4 m2 in 1 room\n");
    EXPECT_LT(environmentOf(eight).indoor().area(), 6);
    // A hole across the outline, and one that cuts the room in two.
    EXPECT_DOUBLE_EQ(environmentOf(read(R"({"verts": [[0,0],[4,0],[4,3],[0,3]],
        "holes": [[[3,1],[5,1],[5,2],[3,2]]]})"))
                         .indoor()
                         .area(),
                     11);
    EXPECT_DOUBLE_EQ(environmentOf(read(R"({"verts": [[0,0],[4,0],[4,3],[0,3]],
        "holes": [[[1,-1],[2,-1],[2,4],[1,4]]]})"))
                         .indoor()
                         .area(),
                     6);
    // The hole may be larger than the corridor about it.
    EXPECT_DOUBLE_EQ(environmentOf(read(R"({"verts": [[0,0],[9,0],[9,9],[0,9]],
        "holes": [[[1,1],[8,1],[8,8],[1,8]]]})"))
                         .indoor()
                         .area(),
                     32);
}

TEST(HouseExpo, NamesWhatIsWrong) {
    ImportOptions coarse;
    coarse.snap = 10;
    EXPECT_EQ(errorsOf([&] { read(R"({"verts": [[0, 0], [0, 3], [4, 3], [4, 0]]})", coarse); }),
              "plan.json: error: `verts`: nothing is left of an outline of 4 points after snapping "
              "and simplifying, wanted less of that (--snap, --simplify)\n");
    EXPECT_EQ(errorOf("{}"),
              "plan.json: error: JSON without `verts`: wanted a HouseExpo plan, an object with "
              "`verts`, the outline as a list of [x, y]\n");
    EXPECT_EQ(errorOf("[1]"),
              "plan.json:1:1: error: found a list, wanted a HouseExpo plan, an object\n");
    EXPECT_EQ(errorOf("{\"verts\": [[0, 0],\n [1, \"x\"]]}"),
              "plan.json:2:8: error: `verts`: found a string, wanted a list of [x, y] in metres\n");
    EXPECT_EQ(
        errorOf("{\"verts\": [[0, 0, 1]]}"),
        "plan.json:1:20: error: `verts`: found a list of 3 numbers, wanted a list of [x, y] in "
        "metres\n");
    EXPECT_NE(errorOf("{\"verts\": [0, 1]}").find("`verts`: found a number"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": 5}").find("`verts`: found a number"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": null}").find("`verts`: found null"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[{}]]}").find("`verts`: found an object"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[1e9, 0]]}").find("1000000000 is too far away"),
              std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[1e999, 0]]}").find("bad JSON"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[NaN, 0]]}").find("bad JSON near"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [], \"verts\": []}").find("a second `verts`"),
              std::string::npos);
    EXPECT_EQ(errorOf("{\"verts\": []}"),
              "plan.json: error: `verts`: an outline of 0 points encloses nothing, wanted three "
              "corners or more\n");
    EXPECT_NE(errorOf("{\"verts\": [[0,0],[1,1],[2,2],[1,1]]}").find("encloses nothing"),
              std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[0,0],[1,0],[0,1]], \"holes\": [[0, 0]]}")
                  .find("`holes`: found a number"),
              std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": [[0,0],[1,0],[0,1]]").find("plan.json:1:"), std::string::npos);
    EXPECT_NE(errorOf("").find("bad JSON"), std::string::npos);
}

TEST(HouseExpo, DepthCostsNothing) {
    const std::string deep(2'000'000, '[');
    EXPECT_NE(errorOf("{\"x\": " + deep).find("bad JSON"), std::string::npos);
    EXPECT_NE(errorOf("{\"verts\": " + deep).find("`verts`: found a list"), std::string::npos);
}

TEST(HouseExpo, SurvivesDamage) {
    surviveDamage(kRoom, [](const std::string& bytes) { read(bytes); });
}

TEST(HouseExpo, KnowsJson) {
    EXPECT_TRUE(isJson(" {\n \"verts\": 1}"));
    EXPECT_TRUE(isJson("[[1]]"));
    EXPECT_FALSE(isJson("{desk: {at: [1, 2]}}"));
    EXPECT_FALSE(isJson("desk: 1"));
    EXPECT_FALSE(isJson(""));
}

TEST(HouseExpo, RealPlans) {
    const char* folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA names no folder of plans";
    const auto load = [&](const std::string& name, const ImportOptions& options = {}) {
        const std::string path = std::string(folder) + "/plans/" + name;
        return readHouseExpo(readAll(path), path, options, sceneSchemas());
    };
    const Document house = load("he_0a1b29db_raw.json");
    EXPECT_NEAR(environmentOf(house).indoor().area(), 116.6, 0.05);
    EXPECT_EQ(countOf(house, "fence"), 1U);
    ImportOptions coarse;
    coarse.simplify = 0.03;
    const Document simple = load("he_0a1b29db_raw.json", coarse);
    EXPECT_LT(simple.records[0].list("path").size(), house.records[0].list("path").size() / 2);
    EXPECT_NEAR(environmentOf(simple).indoor().area(), 116.6, 1);
    EXPECT_GT(countOf(load("syn_10.json"), "fence"), 1U);
    EXPECT_NEAR(environmentOf(load("syn_20.json")).indoor().area(), 4405, 1);
}

}  // namespace house_expo_test
}  // namespace ispace::cad
