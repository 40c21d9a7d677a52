// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/storeys.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/file.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "site/site_scene.h"
#include "support/test_folder.h"

namespace ispace {
namespace storeys_test {

namespace fs = std::filesystem;

constexpr const char* kRoom =
    "{fence: {id: f, path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes}}";

/// A building in YAML of two storeys of one room, with more records.
std::string twoStoreys(const std::string& more = "", double z = 3) {
    return "- storey: {id: ground, height: 3, records: &room [" + std::string(kRoom) + "]}\n" +
           "- storey: {id: upper, z: " + std::to_string(z) + ", height: 2.5, records: *room}\n" +
           more;
}

StoreyedDocument read(const std::string& text) { return readBuilding(text, "house.yaml", {}); }

/// Returns the messages of the error, or "" without one.
template <typename Act>
std::string errorOf(const Act& act) {
    try {
        act();
    } catch (const FormatError& error) {
        std::string text;
        for (const Diagnostic& finding : error.diagnostics()) text += finding.text() + '\n';
        return text;
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Writes files into a folder of its own.
class RoomFolder {
  public:
    std::string write(const std::string& name, const std::string& text) const {
        const std::string path = folder_.file(name);
        fs::create_directories(fs::path(path).parent_path());
        writeAll(path, text);
        return path;
    }

  private:
    testing::TestFolder folder_;
};

TEST(Building, IsToldFromRooms) {
    EXPECT_TRUE(isBuilding("#env 1\n# by hand\n  storey id=a file=a.env\n"));
    EXPECT_TRUE(isBuilding(twoStoreys()));
    EXPECT_TRUE(isBuilding("storey: [{id: a, file: a.env}]\n"));
    EXPECT_FALSE(isBuilding("#env 1\ndesk id=storey\n# storey\nzone id=z name=\"storey x\"\n"));
    EXPECT_FALSE(isBuilding("- desk: {id: storey}\n"));
    EXPECT_FALSE(isBuilding("storeys: 3\n"));
    EXPECT_FALSE(isBuilding(""));
    EXPECT_FALSE(isBuilding("- storey: {unclosed"));
}

TEST(Building, MeshesAreToldByTheirFirstLine) {
    std::string mesh = "# 2000000 vertices of a storey\no hall\n";
    for (int i = 0; i < 2'000'000; ++i) mesh += "v 1 2 3.5\n";
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(isBuilding(mesh));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
    for (const char* text : {"# c\n---\nstorey: {id: a}\n", "storey:\n  id: a\n",
                             "%YAML 1.2\n---\n- storey: {id: a}\n", "{storey: {id: a}}",
                             "[{\"storey\": {}}]", "levels:\n  L1:\n    vertices: []\n"})
        EXPECT_TRUE(isBuilding(text)) << text;
}

TEST(Building, SortsStoreysByHeightAndSharesEqualRooms) {
    const StoreyedDocument building =
        read("- storey: {id: attic, z: 6, records: [" + std::string(kRoom) + "]}\n" + twoStoreys());
    EXPECT_EQ(building.storeyList(), "ground, upper, attic");
    EXPECT_EQ(building.storeys[0].room, building.storeys[1].room);
    EXPECT_NE(building.storeys[0].room, building.storeys[2].room);
    const SiteScene scene = makeSiteScene(building, {}, {});
    EXPECT_EQ(scene.scenes[0], scene.scenes[1]);
    EXPECT_DOUBLE_EQ(scene.height(0), 3);
    EXPECT_DOUBLE_EQ(scene.height(2), 2.5);  // of its walls
}

TEST(Building, SurvivesYaml) {
    const StoreyedDocument building = read(twoStoreys(
        "- stairs: {storeys: 'ground,upper', at: [2, 1], heading: 90, size: [1, 3]}\n"
        "- lift: {id: l, storeys: 'upper,ground', at: [5, 3], size: [1.6, 1.4], door: 0.9}\n"));
    const std::string text = writeBuildingYaml(building);
    const StoreyedDocument again = read(text);
    EXPECT_EQ(again.digest(), building.digest());
    EXPECT_EQ(writeBuildingYaml(again), text);
    EXPECT_EQ(again.storeys[0].room, again.storeys[1].room);
    ASSERT_EQ(again.passages.size(), 2U);
    EXPECT_EQ(again.passages[0].id, "stairs1");
    EXPECT_EQ(again.passages[1].storeys, (std::vector<std::size_t>{0, 1}));
}

TEST(Building, PartsAndDefaultsHoldInTheirRoom) {
    const std::string parts =
        "- storey: {id: a, records: {defaults: {desk: {height: 0.9}}, parts: {p: [desk: {id: d}]}, "
        "ispace: {size: 8 x 6}, place: {part: p, id: w, at: [1, 1]}}}\n";
    const StoreyedDocument building =
        read(parts + "- storey: {id: b, z: 3, records: [{ispace: {size: 8 x 6}}, {desk: {}}]}\n");
    ASSERT_EQ(building.storeys[0].room->records.size(), 2U);
    EXPECT_EQ(building.storeys[0].room->records[1].writtenId(), "w/d");
    EXPECT_DOUBLE_EQ(building.storeys[0].room->records[1].number("height"), 0.9);
    EXPECT_FALSE(building.storeys[1].room->records[1].has("height"));
    EXPECT_TRUE(contains(errorOf([&] {
                             (void)read(parts +
                                        "- storey: {id: b, z: 3, records: [{place: {part: "
                                        "p}}]}\n");
                         }),
                         "error: unknown part `p`"));
    // Ids are those of the room, and findings of all rooms come together.
    const std::string error = errorOf([] {
        (void)read(
            "- storey: {id: a, records: [{desk: {id: d}}, {desk: {id: d}}]}\n"
            "- storey: {id: b, z: 3, records: [{desk: {hight: 1}}]}\n");
    });
    EXPECT_TRUE(contains(error, "doubled id `d`"));
    EXPECT_TRUE(contains(error, "unknown key `hight`"));
}

TEST(Building, HasAtMostTwoHundredStoreys) {
    std::string text = "- storey: {records: &room [" + std::string(kRoom) + "]}\n";
    for (std::size_t i = 1; i < kMaxStoreys; ++i)
        text += "- storey: {z: " + std::to_string(i) + ", records: *room}\n";
    EXPECT_EQ(read(text).storeys.size(), kMaxStoreys);
    EXPECT_TRUE(contains(errorOf([&] { (void)read(text + "- storey: {records: *room}\n"); }),
                         "more than 200 storeys"));
}

TEST(Building, DigestIsThatOfRoomsFramesAndPassages) {
    const std::string digest = read(twoStoreys()).digest();
    EXPECT_EQ(digest, read("# a comment\n" + twoStoreys()).digest());
    EXPECT_NE(digest, read(twoStoreys("", 3.1)).digest());
    EXPECT_NE(digest, read(twoStoreys("- shaft: {storeys: 'ground,upper', path: [[0, 0], [1, 0], "
                                      "[0, 1]]}\n"))
                          .digest());
}

TEST(Building, ReadsFilesInItsFolderOnce) {
    const RoomFolder folder;
    const std::string room = "#env 1\nispace size=4,3\nmesh id=m file=part.obj\n";
    folder.write("house/rooms/a.env", room);
    folder.write("outside.env", room);
    const std::string name = folder.write("house/house.env", "");
    ImportOptions options;
    options.load_files = false;
    const std::string storeys = "#env 1\nstorey id=a file=rooms/a.env\n";
    const StoreyedDocument building =
        readBuilding(storeys + "storey id=b file=rooms/../rooms/a.env z=3\n", name, options);
    EXPECT_EQ(building.storeys[0].room, building.storeys[1].room);
    EXPECT_EQ(building.sources.size(), 1U);
    // Names in the room are relative to the building.
    EXPECT_EQ(building.storeys[0].room->records[1].text("file"), "rooms/part.obj");

    const std::string outside = "#env 1\nstorey id=a file=../outside.env\n";
    EXPECT_TRUE(contains(errorOf([&] { readBuilding(outside, name, options); }),
                         "the room `../outside.env` lies outside the folder "
                         "of the building"));
    options.includes = IncludeFiles::Anywhere;
    EXPECT_EQ(readBuilding(outside, name, options).storeys.size(), 1U);
    EXPECT_TRUE(contains(
        errorOf([&] { readBuilding("#env 1\nstorey id=a file=none.env\n", name, options); }),
        "the room `none.env` cannot be opened"));
    folder.write("house/house.env", storeys);
    EXPECT_TRUE(contains(
        errorOf([&] { readBuilding("#env 1\nstorey id=a file=house.env\n", name, options); }),
        "a storey is one room, and `house.env` is a building"));
    folder.write("house/best.3dm", "#3dm 1\n");
    EXPECT_TRUE(contains(
        errorOf([&] { readBuilding("#env 1\nstorey id=a file=best.3dm\n", name, options); }),
        "is a layout"));
}

TEST(Building, ItsRoomsShareOneBudget) {
    const RoomFolder folder;
    const std::string crowd =
        "ispace: {size: [8, 6]}\ncube: {size: 0.1, repeat: {count: 500, step: [0, 0]}}\n";
    std::string storeys = "#env 1\n";
    for (int i = 0; i < 4; ++i) {
        const std::string file = "r" + std::to_string(i) + ".yaml";
        folder.write(file, crowd);
        storeys += "storey file=" + file + " z=" + std::to_string(3 * i) + '\n';
    }
    const std::string name = folder.write("house.env", "");
    ImportOptions options;
    options.max_work.max = 14'000;
    const std::string error = errorOf([&] { readBuilding(storeys, name, options); });
    EXPECT_TRUE(contains(error,
                         "r2.yaml:2:1: error: parts and repetitions make more than 14000 "
                         "units of work (`--max-work 28000` allows more)"))
        << error;
    EXPECT_FALSE(contains(error, "r3.yaml")) << "one error";
    options.max_work.max = 40'000;
    EXPECT_EQ(readBuilding(storeys, name, options).storeys.size(), 4U);
}

TEST(Building, PaysForThePicturesOfItsMaps) {
    const RoomFolder folder;
    constexpr int kSide = 64;
    std::string picture = "P5 64 64 255\n", storeys = "#env 1\n";
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            picture += std::min({x, y, kSide - 1 - x, kSide - 1 - y}) < 2 ? '\0' : '\xfe';
    folder.write("map.pgm", picture);
    for (const char* id : {"a", "b", "c"}) {
        folder.write(std::string(id) + ".yaml",
                     "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n"
                     "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
        storeys += std::string("storey id=") + id + " file=" + id + ".yaml\n";
    }
    const std::string name = folder.write("house.env", "");
    ImportOptions options;
    options.max_work.max = 200;  // a map takes 128
    const std::string error = errorOf([&] { readBuilding(storeys, name, options); });
    EXPECT_TRUE(contains(error,
                         "map.pgm: error: 64 x 64 cells, and the maps of the building make more "
                         "than 200 units of work (`--max-work 400` allows more)"))
        << error;
    options.max_work.max = 400;
    EXPECT_EQ(readBuilding(storeys, name, options).storeys.size(), 3U);
}

TEST(Building, LevelsOfASitePayForAliases) {
    std::string levels;
    for (int i = 0; i < 3; ++i)
        levels += "  L" + std::to_string(i) + ": {elevation: " + std::to_string(3 * i) +
                  ", vertices: " +
                  (i == 0 ? "&v [[0, 0], [8, 0], [8, 6], [0, 6]], walls: &w "
                            "[[0, 1], [1, 2], [2, 3], [3, 0]]}\n"
                          : "*v, walls: *w}\n");
    const std::string site = "coordinate_system: cartesian_meters\nlevels:\n" + levels;
    ImportOptions options;
    options.max_work.max = 200;
    const std::string error = errorOf([&] { readBuilding(site, "b.yaml", options); });
    EXPECT_TRUE(contains(error, "`walls` of the levels make more than 200 units of work")) << error;
    options.max_work.max = 300;
    EXPECT_EQ(readBuilding(site, "b.yaml", options).storeys.size(), 3U);
}

TEST(Building, RejectsWhatJoinsNoStoreys) {
    const auto passage = [](const std::string& storeys) {
        return errorOf([&] {
            (void)read(twoStoreys("- lift: {id: l, storeys: '" + storeys +
                                  "', at: [5, 3], size: [1, 1]}\n"));
        });
    };
    EXPECT_TRUE(contains(passage("ground,uper"), "no storey `uper`, did you mean `upper`?"));
    EXPECT_TRUE(contains(passage("ground"), "it joins one storey"));
    EXPECT_TRUE(contains(passage("ground,upper,ground"), "a storey is named twice"));
    EXPECT_TRUE(contains(passage(""), "no storey"));
    EXPECT_TRUE(
        contains(errorOf([] { (void)read("- storey: {id: a}\n"); }), "its room is missing"));
    EXPECT_TRUE(contains(
        errorOf([] { (void)read("- storey: {id: a/b, records: [" + std::string(kRoom) + "]}\n"); }),
        "`/` in the id of a storey"));
    EXPECT_TRUE(contains(
        errorOf([] { (void)read("- storey: {id: .., records: [" + std::string(kRoom) + "]}\n"); }),
        "`..` is a name of folders, not of a storey"));
    const auto lift = [](const std::string& keys) {
        return errorOf([&] {
            (void)read(twoStoreys(
                "- lift: {storeys: 'ground,upper', at: [4, 3], size: [1.6, 1.4], " + keys + "}\n"));
        });
    };
    EXPECT_TRUE(contains(lift("id: ../../evil"), "`/` in the id of a lift"));
    for (const std::string load : {"many", "0kg", "-5", "630lb", ".inf"})
        EXPECT_TRUE(contains(lift("capacity: " + load), "is no load such as 630kg")) << load;
    EXPECT_TRUE(contains(lift("speed: 1e-15"), "`speed`"));
    EXPECT_EQ(lift("capacity: 630kg, speed: 0.01"), "");
    EXPECT_TRUE(contains(errorOf([] { (void)read(twoStoreys("- desk: {at: [1, 1]}\n")); }),
                         "records of a room stand in `records` of its storey"));
    EXPECT_TRUE(contains(errorOf([] { (void)read(twoStoreys() + twoStoreys("").substr(0, 20)); }),
                         "house.yaml"));
    EXPECT_TRUE(
        contains(errorOf([] { (void)read(twoStoreys()).storey("cellar"); }), "no storey `cellar`"));
}

TEST(Building, SplitsLayoutsByTheStoreysOfTheirIds) {
    const StoreyedDocument building = read(twoStoreys());
    const auto split = [&](const std::string& text) {
        return layoutsOf(readRecordText("#3dm 1\n" + text, "best.3dm", sceneSchemas()), building);
    };
    const std::vector<Document> layouts = split(
        "environment file=house.yaml\nrobot id=upper/r at=1,1\nlaser id=upper/l on=upper/r\n"
        "laser id=ground/a/b at=2,2\nresult coverage=50%\n");
    ASSERT_EQ(layouts.size(), 2U);
    ASSERT_EQ(layouts[0].records.size(), 1U);
    EXPECT_EQ(layouts[0].records[0].writtenId(), "a/b");
    ASSERT_EQ(layouts[1].records.size(), 2U);
    EXPECT_EQ(layouts[1].records[1].text("on"), "r");
    const Record whole = inBuilding(building.storeys[1], layouts[1].records[1], "l");
    EXPECT_EQ(whole.writtenId(), "upper/l");
    EXPECT_EQ(whole.text("on"), "upper/r");
    const std::string error =
        errorOf([&] { (void)split("laser id=l at=1,1\nlaser at=1,1\nlaser id=upper/x at=1,1\n"); });
    EXPECT_TRUE(contains(error,
                         "best.3dm:2:10: error: `l`, wanted one that begins with its "
                         "storey, such as `ground/l`; storeys: ground, upper"));
    EXPECT_TRUE(contains(error, "best.3dm:3:1: error: laser has no id"));
    // Layouts make scenes of their own, which share the walls of the room.
    const SiteScene scene = makeSiteScene(building, layouts, {});
    EXPECT_NE(scene.scenes[0], scene.scenes[1]);
    EXPECT_EQ(&scene.scenes[0]->environment.indoor(), &scene.scenes[1]->environment.indoor());
}

}  // namespace storeys_test
}  // namespace ispace
