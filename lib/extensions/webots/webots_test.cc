// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/webots/webots.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "extensions/webots/vrml.h"
#include "support/test_damage.h"
#include "support/test_import.h"

namespace ispace::webots {
namespace webots_test {

std::string worldOf(const std::string& nodes) { return "#VRML_SIM R2023b utf8\n" + nodes; }

Document read(const std::string& nodes, const ImportOptions& options = {}) {
    return readWebots(worldOf(nodes), "w.wbt", options, sceneSchemas());
}

std::string errorOf(const std::string& world, const ImportOptions& options = {}) {
    try {
        readWebots(world, "w.wbt", options, sceneSchemas());
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

const Record* find(const Document& document, const char* keyword, std::size_t index = 0) {
    for (const Record& record : document.records)
        if (record.keyword() == keyword && index-- == 0) return &record;
    return nullptr;
}

std::string box(const std::string& size) { return "Shape { geometry Box { size " + size + " } }"; }

/// A room of 4 m x 3 m between the mid-lines of its walls.
const std::string kRoom =
    "Wall { translation 2 0 0 rotation 0 0 1 1.5708 size 0.2 4.2 2 }\n"
    "Wall { translation 2 3 0 rotation 0 0 1 1.5708 size 0.2 4.2 2 }\n"
    "Wall { translation 0 1.5 0 size 0.2 3.2 2 }\n"
    "Wall { translation 4 1.5 0 size 0.2 3.2 2 }\n";

TEST(Webots, ThinBoxesAreWalls) {
    const Document document = read(kRoom);
    EXPECT_EQ(countOf(document, "wall"), 4U);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 12, 1e-6);
    EXPECT_EQ(warningsOf(document), "");
}

TEST(Webots, ShortWallsAreWalls) {
    const Document document = read(kRoom + "Wall { translation 2 0.15 0 size 0.2 0.3 2 }\n");
    EXPECT_EQ(countOf(document, "wall"), 5U);
    EXPECT_EQ(countOf(document, "cube"), 0U);
}

TEST(Webots, SolidsArePosedByAllNodesAroundThem) {
    const Document document =
        read(kRoom +
             "DEF THING Pose { translation 2 1 0 rotation 0 0 1 1.570796 children [\n"
             "  Transform { translation 0.5 0 0.25 scale 2 1 0.5 children [ " +
             box("0.1 0.4 1") + " ] }\n] }\n");
    const Record* cube = find(document, "cube");
    ASSERT_NE(cube, nullptr);
    EXPECT_EQ(cube->text("id"), "thing");
    const Tuple& at = cube->tuple("at");
    EXPECT_NEAR(at[0], 2, 1e-6);
    EXPECT_NEAR(at[1], 1.5, 1e-6);
    const Tuple& size = cube->tuple("size");
    EXPECT_NEAR(size[0], 0.4, 1e-6);
    EXPECT_NEAR(size[1], 0.2, 1e-6);
    EXPECT_NEAR(size[2], 0.5, 1e-6);
}

TEST(Webots, ScalesThatALaterTurnMixesAreLeftOut) {
    const Document document =
        read(kRoom + "Transform { scale 2 1 1 children [ Pose { rotation 0 0 1 0.5 children [ " +
             box("1 1 1") + " ] } ] }\n");
    EXPECT_EQ(countOf(document, "cube"), 0U);
    EXPECT_NE(notesOf(document).find("stretched node that is turned (1)"), std::string::npos);
}

TEST(Webots, BoundingObjectsStandForShapes) {
    const Document document = read(
        kRoom + "Solid { translation 1 1 0.5 children [ " + box("2 2 1") +
        " Solid { translation 1 1 0 children [ Shape { geometry Sphere { radius 0.1 } } ] } ]\n"
        "  name \"plant\" boundingObject Group { children [ Cylinder { radius 0.2 height 1 } ] } "
        "}\n");
    EXPECT_EQ(countOf(document, "cube"), 0U);
    EXPECT_EQ(countOf(document, "cylinder"), 2U);
    EXPECT_EQ(find(document, "cylinder")->text("id"), "plant");
}

TEST(Webots, UsedNodesStandWhereTheyAreUsed) {
    const Document document =
        read(kRoom + "Pose { translation 1 1 0.5 children [ DEF A " + box("0.3 0.3 1") +
             " ] }\nPose { translation 3 1 0.5 children [ USE A ] }\n");
    EXPECT_EQ(countOf(document, "cube"), 2U);
    EXPECT_NEAR(find(document, "cube", 1)->tuple("at")[0], 3, 1e-9);
}

TEST(Webots, DoorsAndWindowsOpenWalls) {
    const Document document = read(kRoom +
                                   "Wall { translation 2 0.75 0 size 0.2 1.3 2 }\n"
                                   "Door { translation 2 1.9 0 size 0.2 1 2 position 1.5 }\n"
                                   "Wall { translation 2 2.7 0 size 0.2 0.6 2 }\n");
    const Record* door = find(document, "door");
    ASSERT_NE(door, nullptr);
    EXPECT_NEAR(door->tuple("from")[1] + door->tuple("to")[1], 3.8, 1e-6);
    EXPECT_NEAR(std::abs(door->tuple("to")[1] - door->tuple("from")[1]), 0.9, 1e-6);
    EXPECT_TRUE(door->flag("open"));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 12, 1e-6);  // both rooms

    const Document glazed =
        read("Window { translation 2 0 0 rotation 0 0 1 1.5708 size 0.2 4.2 2.4 }\n" +
             kRoom.substr(kRoom.find('\n') + 1));
    const Record* window = find(glazed, "window");
    ASSERT_NE(window, nullptr);
    EXPECT_NEAR(window->number("sill"), 0.7, 1e-9);
    EXPECT_NEAR(window->number("height"), 1.4, 1e-9);
}

TEST(Webots, DoorsAndWindowsKeepTheirNames) {
    const Document document =
        read("Window { translation 2 0 0 rotation 0 0 1 1.5708 size 0.2 4.2 2.4 name \"W 1\" }\n" +
             kRoom.substr(kRoom.find('\n') + 1) +
             "Wall { translation 2 0.75 0 size 0.2 1.3 2 }\n"
             "Door { translation 2 1.9 0 size 0.2 1 2 name \"d\" }\n"
             "Wall { translation 2 2.7 0 size 0.2 0.6 2 }\n");
    const Record* door = find(document, "door");
    ASSERT_NE(door, nullptr);
    EXPECT_EQ(door->text("id"), "d");
    EXPECT_EQ(door->text("wall"), "d-wall");
    const Record* window = find(document, "window");
    ASSERT_NE(window, nullptr);
    EXPECT_EQ(window->text("id"), "w-1");
    EXPECT_EQ(window->text("wall"), "w-1-wall");
    environmentOf(document);  // has those walls
}

TEST(Webots, DoorsWithoutAJointStayShut) {
    const auto is_open = [](const std::string& fields) {
        const Document document =
            read("Door { translation 2 0 0 rotation 0 0 1 1.5708 size 0.2 4.2 2 " + fields +
                 " }\n" + kRoom.substr(kRoom.find('\n') + 1));
        return find(document, "door")->flag("open");
    };
    EXPECT_FALSE(is_open("canBeOpen FALSE position 1.2"));
    EXPECT_TRUE(is_open("canBeOpen TRUE position 1.2"));
    EXPECT_TRUE(is_open("position -1.2"));
    EXPECT_FALSE(is_open("canBeOpen TRUE"));
}

TEST(Webots, WindowsWhoseSizesContradictHaveThoseOfWebots) {
    for (const auto& [fields, fault] : {
             std::pair("size 0.2 4 2.4 bottomWallHeight 3",
                       "bottomWallHeight 3 and windowHeight 1.4 are more than the height in size, "
                       "2.4"),
             std::pair("size 0.2 4 2.4 windowHeight 0.1",
                       "frameSize leaves no glass of windowHeight 0.1"),
             std::pair("size 0.1 4 2.4", "frameSize leaves no glass of the thickness in size, 0.1"),
         }) {
        // The walls beside it leave 0.8 m.
        const Document document = read(
            "Wall { translation 0.75 0 0 rotation 0 0 1 1.5708 size 0.2 1.7 2 }\n"
            "Wall { translation 3.25 0 0 rotation 0 0 1 1.5708 size 0.2 1.7 2 }\n"
            "DEF W Window { translation 2 0 0 rotation 0 0 1 1.5708 " +
            std::string(fields) + " }\nUSE W\n" + kRoom.substr(kRoom.find('\n') + 1));
        EXPECT_EQ(warningsOf(document),
                  "w.wbt:4: warning: Window: " + std::string(fault) +
                      ": taken with the sizes that Webots gives it, 0.2 0.8 2.4\n")
            << fields;
        const Record* window = find(document, "window");
        ASSERT_NE(window, nullptr) << fields;
        EXPECT_NEAR(std::abs(window->tuple("to")[0] - window->tuple("from")[0]), 0.76, 1e-6);
        EXPECT_NEAR(window->number("sill"), 0.7, 1e-9);
    }
}

TEST(Webots, AxesOfAnyLengthTurn) {
    const auto size_of = [](const std::string& rotation) {
        const Document document = read(kRoom + "Pose { translation 2 1 0.5 rotation " + rotation +
                                       " children [ " + box("0.6 0.4 1") + " ] }\n");
        const Record* cube = find(document, "cube");
        return cube == nullptr ? Tuple{} : cube->tuple("size");
    };
    // Half a turn about the diagonal swaps x and y.
    for (const char* rotation : {"1 1 0 3.14159265", "1e300 1e300 0 3.14159265",
                                 "1.7e308 1.7e308 0 3.14159265", "1e-320 1e-320 0 3.14159265"}) {
        const Tuple size = size_of(rotation);
        ASSERT_EQ(size.size(), 3U) << rotation;
        EXPECT_NEAR(size[0], 0.6, 1e-6) << rotation;
        EXPECT_NEAR(size[1], 0.4, 1e-6) << rotation;
        EXPECT_NEAR(size[2], 1, 1e-6) << rotation;
    }
    // Leans, whatever the length of the axis.
    EXPECT_TRUE(size_of("1 1 0 1").empty());
    EXPECT_TRUE(size_of("1e300 1e300 0 1").empty());
}

TEST(Webots, TheAxisOfZerosIsUpright) {
    const Document document =
        read(kRoom + "Pose { translation 2 1 0.5 rotation 0 0 0 0.5 children [ " +
             box("0.6 0.4 1") + " ] }\n");
    const Record* cube = find(document, "cube");
    ASSERT_NE(cube, nullptr);
    EXPECT_NEAR(cube->number("heading"), 28.64789, 1e-4);
}

TEST(Webots, ArenasHaveFourWalls) {
    const Document document = read("RectangleArena { floorSize 4 3 }\n");
    EXPECT_EQ(countOf(document, "wall"), 4U);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 4.01 * 3.01, 1e-6);
    EXPECT_NE(notesOf(document).find("floor (1)"), std::string::npos);
}

TEST(Webots, WhatIsNotReadIsCounted) {
    const Document document =
        read(kRoom + "Desk { }\nDesk { translation 1 1 0 }\nRobot { children [ " + box("1 1 1") +
             " ] }\nSolid { children [ Shape { geometry IndexedFaceSet { coord Coordinate { point "
             "[ 1 1 0, 3 1 0, 1 2 2 ] } coordIndex [ 0 1 2 -1 ] } } ] name \"sail\" }\n");
    EXPECT_NE(notesOf(document).find("IndexedFaceSet (1), PROTO Desk (2), Robot (1)"),
              std::string::npos)
        << notesOf(document);
    EXPECT_NE(warningsOf(document).find("IndexedFaceSet"), std::string::npos);
    EXPECT_NE(warningsOf(document).find("the solid sail"), std::string::npos);

    const Document nameless =
        read(kRoom + "Solid { children [ Shape { geometry Mesh { } } ] }\n" +
             "Pose { rotation 1 0 0 0.5 children [ " + box("1 1 1") + " ] }\n");
    EXPECT_NE(warningsOf(nameless).find("Mesh (1), at 0.00,0.00 of the file; box or cylinder that "
                                        "leans (1), at 0.00,0.00 of the file: "),
              std::string::npos)
        << warningsOf(nameless);
}

TEST(Webots, FacesOfABoxAreABox) {
    const Document document = read(
        kRoom +
        "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 1 1 0 2 1 0 2 2 0 1 2 0\n"
        "1 1 1 2 1 1 2 2 1 1 2 1 ] } coordIndex [ 0 1 2 3 -1 ] } }\n");
    const Record* cube = find(document, "cube");
    ASSERT_NE(cube, nullptr);
    EXPECT_NEAR(cube->tuple("at")[0], 1.5, 1e-9);
}

TEST(Webots, YUpwardsIsTurned) {
    // North x, up y, east z.
    std::string walls;
    for (const char* wall : {"0 1 2 box 0.2 2 4.2", "3 1 2 box 0.2 2 4.2", "1.5 1 0 box 3.2 2 0.2",
                             "1.5 1 4 box 3.2 2 0.2"}) {
        const std::string text = wall;
        const std::size_t at = text.find(" box ");
        walls += "Pose { translation " + text.substr(0, at) + " children [ " +
                 box(text.substr(at + 5)) + " ] }\n";
    }
    const Document document = read("WorldInfo { coordinateSystem \"NUE\" }\n" + walls);
    const Box2 limits = environmentOf(document).limits();
    EXPECT_NEAR(limits.width(), 4, 0.3);
    EXPECT_NEAR(limits.depth(), 3, 0.3);
}

TEST(Webots, ErrorsNameTheirLine) {
    const auto error = [](const std::string& nodes) { return errorOf(worldOf(nodes)); };
    EXPECT_EQ(error("Wall {\n  size 0.2 1\n}\n"), "w.wbt:2:1: error: size has 2 numbers, wanted 3");
    EXPECT_EQ(error("Wall {\n  size 0.2 0 1\n}\n"),
              "w.wbt:2:1: error: size of Wall is 0, wanted a length above 0");
    EXPECT_EQ(error("Solid {\n  children [\n    USE A\n"),
              "w.wbt:4:1: error: no node before is called `A`");
    EXPECT_EQ(error("DEF A Solid {\n  children [\n    USE A\n  ]\n}\n"),
              "w.wbt:4:1: error: no node before is called `A`");
    EXPECT_EQ(error("Solid {\n  name \"a\n"), "w.wbt:3:1: error: a text without its closing quote");
    EXPECT_EQ(error("Solid {\n  name IS name\n}\n"),
              "w.wbt:3:1: error: found `IS`, wanted a value");
    EXPECT_EQ(error("Solid {\n"),
              "w.wbt:3:1: error: the file ends, wanted the name of a field or }");
    EXPECT_EQ(error("PROTO Chair [\n]\n"), "w.wbt:2:1: error: a PROTO, wanted a world (.wbt)");
    EXPECT_EQ(error("WorldInfo {\n}\n"), "w.wbt: error: no box, cylinder, polyline or mesh in it");
    EXPECT_EQ(errorOf("#VRML_SIM\nSolid { }\n"),
              "w.wbt:1:1: error: the first line has no version, wanted one like #VRML_SIM R2023b "
              "utf8");
    EXPECT_NE(errorOf("#VRML_SIM R2019b utf8\nSolid { }\n")
                  .find("w.wbt:1:1: error: a world of Webots `R2019b`, which had other axes"),
              std::string::npos);
}

TEST(Webots, WorkAndDepthAreBounded) {
    std::string nested;
    for (int i = 0; i < 300; ++i) nested += "Group { children [ ";
    EXPECT_NE(errorOf(worldOf(nested)).find("nodes nested more than 128 deep"), std::string::npos);

    // Each node uses the one before twice.
    std::string doubled = "DEF N0 " + box("1 1 1") + "\n";
    for (int i = 1; i < 60; ++i)
        doubled += "DEF N" + std::to_string(i) + " Group { children [ USE N" +
                   std::to_string(i - 1) + " USE N" + std::to_string(i - 1) + " ] }\n";
    EXPECT_NE(errorOf(worldOf(doubled)).find("units of work"), std::string::npos);

    // Each node uses the one before once, so that the nesting grows without braces.
    std::string chain = "DEF N0 " + box("1 1 1") + "\n";
    for (int i = 1; i < 5000; ++i)
        chain += "DEF N" + std::to_string(i) + " Group { children USE N" + std::to_string(i - 1) +
                 " }\n";
    ImportOptions options;
    options.max_work.max = 20'000'000;
    EXPECT_NE(errorOf(worldOf(chain), options).find("nodes nested more than 128 deep"),
              std::string::npos);
}

TEST(Webots, DamagedFilesAreRefusedOrRead) {
    surviveDamage(
        worldOf(kRoom + "DEF A Pose { children [ " + box("1 1 1") + " ] }\nUSE A\n"),
        [](const std::string& bytes) { readWebots(bytes, "w.wbt", {}, sceneSchemas()); }, 300);
}

}  // namespace webots_test
}  // namespace ispace::webots
