// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/number.h"
#include "extensions/gazebo/gazebo.h"
#include "extensions/meshes/meshes_test.h"
#include "geom/curve.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_folder.h"
#include "support/test_import.h"

namespace ispace::gazebo {
namespace sdf_import_test {

std::string worldOf(const std::string& models) {
    return "<sdf version='1.9'>\n<world name='w'>\n" + models + "\n</world>\n</sdf>\n";
}

/// A model with one box.
std::string boxModel(const std::string& name, const std::string& pose, const std::string& size) {
    return "<model name='" + name + "'><pose>" + pose +
           "</pose><link name='l'><collision name='c'><geometry><box><size>" + size +
           "</size></box></geometry></collision></link></model>";
}

std::string recordsOf(const std::string& sdf) {
    Document document = readSdf(sdf, "test.sdf", {}, sceneSchemas());
    document.history = {};
    const std::string text = writeRecordText(document);
    return text.substr(text.find('\n') + 1);
}

std::string errorOf(const std::string& sdf) {
    try {
        readSdf(sdf, "test.sdf", {}, sceneSchemas());
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

TEST(SdfImport, KnowsItsRoot) {
    EXPECT_TRUE(isSdf("<?xml version='1.0'?>\n<!-- a world -->\n<sdf version='1.6'>"));
    EXPECT_FALSE(isSdf("<svg xmlns='http://www.w3.org/2000/svg'/>"));
    EXPECT_FALSE(isSdf("sdf"));
    EXPECT_FALSE(isSdf(""));
}

TEST(SdfImport, CapsulesConesAndEllipsoidsAreTheCylindersAroundThem) {
    const auto record = [](const std::string& geometry) {
        return recordsOf(
            worldOf("<model name='a'><pose>1 2 0.5 0 0 0</pose><link name='l'>"
                    "<collision name='c'><geometry>" +
                    geometry + "</geometry></collision></link></model>"));
    };
    EXPECT_EQ(record("<cone><radius>0.5</radius><length>1</length></cone>"),
              "cylinder id=a at=1,2 size=1,1,1\n");
    EXPECT_EQ(record("<capsule><radius>0.3</radius><length>0.4</length></capsule>"),
              "cylinder id=a at=1,2 size=0.6,0.6,1\n");
    EXPECT_EQ(record("<ellipsoid><radii>0.4 0.4 0.5</radii></ellipsoid>"),
              "cylinder id=a at=1,2 size=0.8,0.8,1\n");
    EXPECT_EQ(record("<ellipsoid><radii>0.6 0.4 0.5</radii></ellipsoid>"),
              "cube id=a at=1,2 size=1.2,0.8,1\n");
}

TEST(SdfImport, SpheresStandAndShapesThatAreNotReadWarn) {
    const std::string room = boxModel("s", "4 0 1.25 0 0 0", "8.2 0.2 2.5") +
                             boxModel("n", "4 6 1.25 0 0 0", "8.2 0.2 2.5") +
                             boxModel("w", "0 3 1.25 0 0 0", "0.2 6 2.5") +
                             boxModel("e", "8 3 1.25 0 0 0", "0.2 6 2.5");
    const auto warnings = [&](const std::string& model) {
        return warningsOf(readSdf(worldOf(room + model), "test.sdf", {}, sceneSchemas()));
    };
    const auto shape = [](const std::string& pose, const std::string& geometry) {
        return "<model name='a'><pose>" + pose +
               "</pose><link name='l'><collision name='c'><geometry>" + geometry +
               "</geometry></collision></link></model>";
    };
    EXPECT_NE(
        recordsOf(worldOf(room + shape("4 3 .5 0 0 0", "<sphere><radius>.5</radius></sphere>")))
            .find("cylinder id=a at=4,3 size=1,1,1"),
        std::string::npos);
    EXPECT_EQ(warnings(boxModel("a", "4 3 1.25 0 0.2 0", "0.2 6 2.5")),
              "test.sdf:3: warning: not read, though it may be a wall: box or cylinder that leans "
              "(1), in the model a at 4.00,3.00 of the file: if it is a wall, make it an upright "
              "box, or a mesh without scale and turn\n");
    EXPECT_EQ(warnings(boxModel("a", "14 3 1.25 0 0.2 0", "0.2 6 2.5")), "");  // off the room
    EXPECT_EQ(warnings(boxModel("a", "4 3 0.2 0 0.2 0", "0.2 0.2 0.3")), "");  // small
    EXPECT_NE(warnings(shape("4 3 0 0 0 0", "<image><uri>a.png</uri></image>")).find("image (1)"),
              std::string::npos);
    EXPECT_NE(warnings(shape("4 3 1 0 0 0",
                             "<polyline><point>0 0</point><point>2 0</point><point>2 1</point>"
                             "<height>1</height></polyline>"))
                  .find("polyline off the floor (1)"),
              std::string::npos);
    EXPECT_EQ(warnings(shape("4 3 0 0 0 0", "<plane><normal>0 0 1</normal></plane>")), "");
}

TEST(SdfImport, EllipticPolylinesAreCylinders) {
    const auto record = [](const std::string& pose, const Polygon& outline) {
        std::string points;
        for (const Point2 p : outline)
            points += "<point>" + formatDouble(p.x) + ' ' + formatDouble(p.y) + "</point>";
        return recordsOf(worldOf("<model name='a'><pose>" + pose +
                                 "</pose><link name='l'><collision name='c'><geometry><polyline>" +
                                 points +
                                 "<height>0.5</height></polyline></geometry></collision>"
                                 "</link></model>"));
    };
    const Ellipse oval({0, 0}, 1.6, 1, Angle());
    EXPECT_EQ(record("1 2 0 0 0 0", outlineOf(oval)), "cylinder id=a at=1,2 size=1.6,1,0.5\n");
    EXPECT_EQ(record("1 2 0.7 0 0 1.5708", outlineOf(oval)),
              "cylinder id=a at=1,2,0.7 heading=90 size=1.6,1,0.5\n");
    EXPECT_EQ(record("1 2 0 0 0 0", outlineOf(Ellipse({0, 0}, 1, 1, Angle()))),
              "cylinder id=a at=1,2 size=1,1,0.5\n");
    Polygon dented = outlineOf(oval);
    dented[3] = Point2() + 0.9 * (dented[3] - Point2());
    EXPECT_TRUE(record("1 2 0 0 0 0", dented).starts_with("fence id=a "));
}

/// A room of 8 m x 6 m about the origin.
std::string roomAbout() {
    return boxModel("n", "0 3 1 0 0 0", "8 0.2 2") + boxModel("s", "0 -3 1 0 0 0", "8 0.2 2") +
           boxModel("e", "4 0 1 0 0 0", "0.2 6 2") + boxModel("v", "-4 0 1 0 0 0", "0.2 6 2");
}

TEST(SdfImport, SlabsUnderARoomAreItsFloor) {
    const auto cubes = [](const std::string& model) {
        return countOf(readSdf(worldOf(roomAbout() + model), "test.sdf", {}, sceneSchemas()),
                       "cube");
    };
    EXPECT_EQ(cubes(boxModel("floor", "0 0 0 0 0 0", "8 6 0.1")), 0U);
    EXPECT_EQ(cubes(boxModel("floor", "0 0 0.1 0 0 0", "20 20 0.2")), 0U);
    EXPECT_EQ(cubes(boxModel("stage", "0 0 0.25 0 0 0", "8 6 0.5")), 1U);
    EXPECT_EQ(cubes(boxModel("plinth", "0 0 0.05 0 0 0", "2 2 0.1")), 1U);
}

TEST(SdfImport, PodiumsInSmallRoomsAreNoFloor) {
    ImportOptions options;
    options.rooms = RoomChoice::All;
    // A wall cuts a cell of 2 m x 5.8 m off the room.
    const std::string rooms = roomAbout() + boxModel("w", "-1.8 0 1 0 0 0", "0.2 6 2");
    const auto cubes = [&](const std::string& model) {
        return countOf(readSdf(worldOf(rooms + model), "test.sdf", options, sceneSchemas()),
                       "cube");
    };
    EXPECT_EQ(cubes(boxModel("podium", "-2.9 0 0.075 0 0 0", "2 5.8 0.15")), 1U);
    // Under the wall, and under a part of the large room.
    EXPECT_EQ(cubes(boxModel("stage", "-2.4 0 0.05 0 0 0", "3 6 0.1")), 1U);
    EXPECT_EQ(cubes(boxModel("floor", "-2.9 0 0.05 0 0 0", "2 5.8 0.1")), 0U);
    EXPECT_EQ(cubes(boxModel("floor", "0 0 0.1 0 0 0", "8 6 0.2")), 0U);
}

TEST(SdfImport, ModelsStandWhereTheStateOfTheWorldPutsThem) {
    const std::string model = boxModel("m", "0 0 0.5 0 0 0", "1 0.9 1");
    const auto state = [](const std::string& poses) {
        return "<state world_name='w'><model name='m'>" + poses + "</model></state>";
    };
    EXPECT_EQ(recordsOf(worldOf(model + state("<pose>2 2 0.5 1e-4 0 1.5708</pose>"))),
              "cube id=m at=2,2 heading=90 size=1,0.9,1\n");
    EXPECT_EQ(recordsOf(worldOf(model + state("<pose>2 2 0.5 0 0 0</pose><link name='l'>"
                                              "<pose>3 1 0.5 0 0 0</pose></link>"))),
              "cube id=m at=3,1 size=1,0.9,1\n");
    EXPECT_EQ(recordsOf(worldOf(model + "<state world_name='w'><model name='n'/></state>")),
              "cube id=m size=1,0.9,1\n");
}

TEST(SdfImport, BoxesStandWhereAllPosesTogetherPutThem) {
    // Nested twice, each turned by a quarter: 1 m ahead of what looks along -x.
    EXPECT_EQ(recordsOf(worldOf("<model name='a'><pose>5 5 0 0 0 1.57079632679</pose>"
                                "<model name='b'><pose>0 0 0.2 0 0 1.57079632679</pose>"
                                "<link name='l'><pose>1 0 0.3 0 0 0</pose>"
                                "<collision name='c'><geometry><box><size>0.5 0.4 0.6</size></box>"
                                "</geometry></collision></link></model></model>")),
              "cube id=a at=4,5,0.2 heading=180 size=0.5,0.4,0.6\n");
    // On its side: y is up.
    EXPECT_EQ(recordsOf(worldOf(boxModel("c", "1 2 0.5 1.5708 0 0", "0.4 1 0.3"))),
              "cube id=c at=1,2 size=0.4,0.3,1\n");
}

TEST(SdfImport, RelativePosesFollowFramesInAnyOrder) {
    // The first link names the second, which names a frame attached to a nested model's link.
    EXPECT_EQ(
        recordsOf(worldOf(
            "<model name='m'><pose>1 1 0 0 0 0</pose>"
            "<link name='one'><pose relative_to='two'>0 0 0 0 0 0</pose><visual name='v'><geometry>"
            "<cylinder><radius>0.2</radius><length>1</length></cylinder></geometry></visual></link>"
            "<link name='two'><pose relative_to='f'>0 1 0 0 0 0</pose></link>"
            "<frame name='f' attached_to='n::deep'><pose>0 0 0.5 0 0 0</pose></frame>"
            "<model name='n'><pose>1 0 0 0 0 0</pose><link name='deep'/></model></model>")),
        "cylinder id=m at=2,2 size=0.4,0.4,1\n");
}

TEST(SdfImport, ThinHighBoxesAreWallsThatMeetAtMidLines) {
    const std::string records = recordsOf(worldOf(
        boxModel("s", "2 0 1 0 0 0", "4.2 0.2 2") + boxModel("n", "2 3 1 0 0 0", "4.2 0.2 2") +
        boxModel("w", "0 1.5 1 0 0 1.5708", "2.8 0.2 2") +
        boxModel("e", "4 1.5 1 0 0 1.5708", "2.8 0.2 2") +
        boxModel("shelf", "1 1 0.3 0 0 0", "0.9 0.4 0.6")));
    EXPECT_NE(records.find("wall id=w from=0,0 to=0,3 height=2 thickness=0.2"), std::string::npos)
        << records;
    EXPECT_NE(records.find("cube id=shelf at=1,1 size=0.9,0.4,0.6"), std::string::npos) << records;
    EXPECT_NE(records.find("inside at="), std::string::npos) << records;
    Document document =
        readSdf(worldOf(boxModel("s", "2 0 1 0 0 0", "4 0.2 2")), "test.sdf", {}, sceneSchemas());
    EXPECT_EQ(document.records.front().keyword(), "wall");
}

/// A room of 6 m x 4 m whose east wall has a gap from y = 1 up.
std::string roomWithGap(double gap) {
    const double rest = 3 - gap;
    return worldOf(boxModel("south", "3 0 1.25 0 0 0", "6 0.1 2.5") +
                   boxModel("north", "3 4 1.25 0 0 0", "6 0.1 2.5") +
                   boxModel("west", "0 2 1.25 0 0 0", "0.1 4 2.5") +
                   boxModel("low", "6 0.5 1.25 0 0 0", "0.1 1 2.5") +
                   boxModel("high", "6 " + formatDouble(4 - rest / 2) + " 1.25 0 0 0",
                            "0.1 " + formatDouble(rest) + " 2.5"));
}

TEST(SdfImport, GapsOfADoorsWidthAreDoors) {
    const Document door = readSdf(roomWithGap(0.9), "test.sdf", {}, sceneSchemas());
    EXPECT_NEAR(environmentOf(door).indoor().area(), 24, 1e-6);
    EXPECT_EQ(countOf(door, "door"), 1U);
    EXPECT_EQ(countOf(door, "fence"), 0U);
    const std::string records = recordsOf(roomWithGap(0.9));
    EXPECT_NE(records.find("door wall=gap from=6,1 to=6,1.9 open=yes"), std::string::npos)
        << records;
    // Cracks and missing walls are none.
    for (const double gap : {0.3, 2.3}) {
        const Document none = readSdf(roomWithGap(gap), "test.sdf", {}, sceneSchemas());
        EXPECT_EQ(countOf(none, "door"), 0U) << gap;
        EXPECT_EQ(countOf(none, "fence"), 1U) << gap;
    }
}

TEST(SdfImport, RoomsAreListedOnce) {
    FoundRooms found;
    ImportOptions options;
    options.found = &found;
    (void)readSdf(roomWithGap(0.9), "test.sdf", options, sceneSchemas());
    EXPECT_EQ(found.rooms.size(), 1U);
    EXPECT_EQ(found.closed_gaps.size(), 1U);
}

TEST(SdfImport, ErrorsNameTheLine) {
    EXPECT_EQ(errorOf("<sdf version='1.9'/>"),
              "test.sdf:1:1: error: no `world` and no `model` in it");
    EXPECT_EQ(errorOf(worldOf("")), "test.sdf: error: no box, cylinder, polyline or mesh in it");
    EXPECT_EQ(errorOf(worldOf(boxModel("m", "1 2", "1 1 1"))),
              "test.sdf:3:1: error: `pose`: found `1 2`, wanted 6 numbers");
    EXPECT_EQ(errorOf(worldOf(boxModel("m", "0 0 0 0 0 nan", "1 1 1"))),
              "test.sdf:3:1: error: `pose`: found `0 0 0 0 0 nan`, wanted 6 numbers");
    EXPECT_EQ(errorOf(worldOf(boxModel("m", "", "1 1 0"))),
              "test.sdf:3:1: error: a box with a side of 0");
    EXPECT_EQ(errorOf(worldOf(boxModel("m", "1e7 0 0 0 0 0", "1 1 1"))),
              "test.sdf:3:1: error: lies more than 900 km from the origin");
    EXPECT_EQ(errorOf(worldOf("<model name='m'><pose relative_to='x'/><link name='l'/></model>")),
              "test.sdf:3:1: error: no frame called `x` beside it");
    EXPECT_NE(errorOf("<sdf version='1.9'><world name='w'><model").find("bad XML"),
              std::string::npos);
}

TEST(SdfImport, WhatIsMissingOrEnclosesNoRoomIsNamed) {
    const std::string mesh =
        "<model name='m'><link name='l'><collision name='c'><geometry><mesh><uri>model://m/m.obj"
        "</uri></mesh></geometry></collision></link></model>";
    EXPECT_NE(errorOf(worldOf(mesh)).find("meshes that are not in the folders of models"),
              std::string::npos)
        << errorOf(worldOf(mesh));
    // Walls 0.4 m above the floor, which only another height takes as walls.
    std::string raised;
    for (const auto& [pose, size] : {std::pair{"0 2 1.4 0 0 0", "6 0.1 2"},
                                     {"0 -2 1.4 0 0 0", "6 0.1 2"},
                                     {"3 0 1.4 0 0 0", "0.1 4 2"},
                                     {"-3 0 1.4 0 0 0", "0.1 4 2"}})
        raised += boxModel("w", pose, size);
    const std::string warnings =
        warningsOf(readSdf(worldOf(raised), "test.sdf", {}, sceneSchemas()));
    EXPECT_NE(warnings.find("the walls enclose no room"), std::string::npos) << warnings;
    EXPECT_NE(warnings.find("--slice-walls M"), std::string::npos) << warnings;
}

TEST(SdfImport, HostileWorldsAreRefused) {
    const std::string loop =
        "<model name='a'><pose relative_to='b'>1 0 0 0 0 0</pose><link name='l'/></model>\n"
        "<model name='b'><pose relative_to='a'>1 0 0 0 0 0</pose><link name='l'/></model>";
    EXPECT_NE(errorOf(worldOf(loop)).find("its pose is relative to itself"), std::string::npos);
    std::string deep;
    for (int i = 0; i < 1000; ++i) deep += "<model name='m'>";
    for (int i = 0; i < 1000; ++i) deep += "</model>";
    EXPECT_NE(errorOf(worldOf(deep)).find("nested more than 64 deep"), std::string::npos);
    ImportOptions few;
    few.max_work.max = 170;
    const std::string box = boxModel("m", "", "1 1 1");
    EXPECT_THROW(readSdf(worldOf(box + box + box), "test.sdf", few, sceneSchemas()), FormatError);
    // Entities are not expanded.
    EXPECT_NE(errorOf("<!DOCTYPE sdf [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;'>]><sdf><world "
                      "name='w'>&b;</world></sdf>")
                  .find("no box"),
              std::string::npos);
}

TEST(SdfImport, SurvivesDamage) {
    surviveDamage(
        worldOf("<model name='a' placement_frame='f'><pose degrees='true'>1 1 0 0 0 30</pose>\n"
                "<frame name='f' attached_to='l'><pose relative_to='l'>0 0 0 0 0 0</pose></frame>\n"
                "<link name='l'><collision name='c'>\n"
                "<geometry><box><size>1 2 3</size></box></geometry></collision>\n"
                "<collision name='d'><geometry><polyline><point>0 0</point><point>1 0</point>\n"
                "<point>0 1</point><height>1</height></polyline></geometry></collision>\n"
                "</link></model>"),
        [](const std::string& bytes) { readSdf(bytes, "test.sdf", {}, sceneSchemas()); });
}

TEST(SdfImport, FilesOutsideOfItsFolderAreNotOpened) {
    const Document document = readSdf(
        worldOf(boxModel("m", "", "1 1 1") +
                "<model name='x'><link name='l'><visual name='v'><geometry><mesh><uri>"
                "file:///etc/../etc/mesh.stl</uri></mesh></geometry></visual></link></model>"),
        "test.sdf", {}, sceneSchemas());
    EXPECT_EQ(document.records.size(), 1U);
    ASSERT_EQ(document.warnings.size(), 1U);
    EXPECT_NE(document.warnings.front().message.find("/etc/../etc/mesh.stl (1)"),
              std::string::npos);
}

/// A world of one model whose walls are a mesh: a ring of walls 0.2 m thick and 2 m high around
/// 6 m x 4 m, with a doorway of the given width in the south.
class SdfMeshWalls : public ::testing::Test {
  protected:
    SdfMeshWalls() { testing::addMeshesOnce(); }

    void writeWalls(double door) const {
        const double left = -door / 2, right = door / 2;
        const std::array<std::array<double, 4>, 5> boxes{{{-3.2, -2.2, left, -2},
                                                          {right, -2.2, 3.2, -2},
                                                          {-3.2, 2, 3.2, 2.2},
                                                          {-3.2, -2.2, -3, 2.2},
                                                          {3, -2.2, 3.2, 2.2}}};
        std::string obj;
        int first = 1;
        for (const auto& [x0, y0, x1, y1] : boxes) {
            for (const double z : {0.0, 2.0})
                for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
                    obj += "v " + formatDouble(x) + ' ' + formatDouble(y) + ' ' + formatDouble(z) +
                           '\n';
            for (const char* face : {"0321", "4567", "0154", "1265", "2376", "3047"}) {
                obj += 'f';
                for (int i = 0; i < 4; ++i) obj += ' ' + std::to_string(first + face[i] - '0');
                obj += '\n';
            }
            first += 8;
        }
        writeAll((folder_ / "walls.obj").string(), obj);
    }
    [[nodiscard]] Document read(const std::string& more = "",
                                const ImportOptions& options = {}) const {
        const std::string mesh =
            "<model name='house'><link name='l'><collision name='c'><geometry><mesh><uri>"
            "walls.obj</uri></mesh></geometry></collision></link></model>";
        return readSdf(worldOf(mesh + more), (folder_ / "w.sdf").string(), options, sceneSchemas());
    }

    const testing::TestFolder folder_;
};

TEST_F(SdfMeshWalls, AreCutWhereBoxesEncloseNoRoom) {
    writeWalls(0.9);
    const Document document = read(boxModel("crate", "1 1 0.5 0 0 0", "0.8 0.8 1"));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 24.09, 0.1);  // the doorway is closed
    EXPECT_EQ(countOf(document, "mesh"), 0U);
    EXPECT_EQ(countOf(document, "cube"), 1U);
    EXPECT_NE(warningsOf(document).find("boxes and polylines enclose no room: 1 mesh cut at a "
                                        "height of 0.3 m into walls; --slice-walls sets the"),
              std::string::npos)
        << warningsOf(document);
    const Record& wall = document.records.front();
    EXPECT_EQ(wall.text("id"), "house");
    EXPECT_EQ(wall.number("height"), 2);
}

TEST_F(SdfMeshWalls, AreReadWithinTheWorkOfTheirWorld) {
    writeWalls(0.9);
    std::string nodes, list;
    for (int i = 0; i < 30001; ++i) {
        nodes += std::string(i > 0 ? "," : "") + "{\"mesh\":0}";
        list += (i > 0 ? "," : "") + std::to_string(i);
    }
    writeAll((folder_ / "odd.gltf").string(),
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[" + list +
                 "]}],\"nodes\":[" + nodes +
                 "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
                 "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
                 "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
                 "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
                 "\"min\":[0,0,0],\"max\":[1,1,0]}]}");
    ImportOptions few;
    few.max_work.max = 20000;
    const Document document = read(
        "<model name='odd'><link name='l'><collision name='c'><geometry><mesh><uri>odd.gltf"
        "</uri></mesh></geometry></collision></link></model>",
        few);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 24.09, 0.1);
    EXPECT_NE(warningsOf(document).find("mesh file `odd.gltf` is left out: nodes that repeat "
                                        "meshes make more than 20000 units of work"),
              std::string::npos)
        << warningsOf(document);
}

TEST_F(SdfMeshWalls, StayMeshesWhereBoxesDo) {
    writeWalls(0.9);
    const std::string room =
        boxModel("s", "0 -5 1 0 0 0", "10 0.2 2") + boxModel("n", "0 5 1 0 0 0", "10 0.2 2") +
        boxModel("w", "-5 0 1 0 0 0", "0.2 10 2") + boxModel("e", "5 0 1 0 0 0", "0.2 10 2");
    EXPECT_EQ(countOf(read(room), "mesh"), 1U);
    // Unless the user says otherwise.
    ImportOptions cut;
    cut.slice_walls = 1;
    const Document document = read(room, cut);
    EXPECT_EQ(countOf(document, "mesh"), 0U);
    EXPECT_GT(countOf(document, "fence"), 0U);
    EXPECT_NE(notesOf(document).find("1 mesh cut at a height of 1 m"), std::string::npos);
    cut.slice_walls = 3;  // above all of them
    EXPECT_NE(notesOf(read(room, cut)).find("0 meshes cut at a height of 3 m"), std::string::npos);
}

TEST(SdfImport, BadMeshesAreLeftOut) {
    testing::addMeshesOnce();
    const testing::TestFolder folder;
    writeAll(folder.file("bad.dae"), "<COLLADA>");
    std::string world = "<sdf version='1.7'><world name='w'>";
    const auto box = [&](double x, double y, double length, double width) {
        world += "<model name='wall'><static>1</static><pose>" + formatDouble(x) + ' ' +
                 formatDouble(y) +
                 " 1 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>" +
                 formatDouble(length) + ' ' + formatDouble(width) +
                 " 2</size></box></geometry></collision></link></model>";
    };
    box(3, 0, 6.2, 0.2);
    box(3, 4, 6.2, 0.2);
    box(0, 2, 0.2, 4.2);
    box(6, 2, 0.2, 4.2);
    world +=
        "<model name='desk'><pose>3 2 0 0 0 0</pose><link name='l'><collision name='c'><geometry>"
        "<mesh><uri>bad.dae</uri></mesh></geometry></collision></link></model></world></sdf>";
    const Document document = readSdf(world, folder.file("w.sdf"), {}, sceneSchemas());
    EXPECT_EQ(countOf(document, "mesh"), 0U);
    EXPECT_GT(environmentOf(document).indoor().area(), 20);
    EXPECT_NE(warningsOf(document).find("mesh file `bad.dae` is left out: "), std::string::npos)
        << warningsOf(document);
}

}  // namespace sdf_import_test
}  // namespace ispace::gazebo
