// SPDX-License-Identifier: GPL-3.0-or-later
// Walls in all entities that draw them, on the layers that hold them. Areas are sums of rectangles.
#include <numbers>
#include <string>
#include <string_view>

#include "base/file.h"
#include "base/number.h"
#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace dxf_walls_test {

Document read(const std::string& dxf, const ImportOptions& options = {}) {
    return readDxf(dxf, "plan.dxf", options, sceneSchemas());
}
double areaOf(const std::string& dxf, const ImportOptions& options = {}) {
    return environmentOf(read(dxf, options)).indoor().area();
}
/// Groups from text, as "0 LINE 8 W": a code and a value each.
std::string groups(std::string_view text) {
    std::string lines(text);
    for (char& c : lines)
        if (c == ' ') c = '\n';
    return lines + '\n';
}

const std::string kRoom = rectangle("W", 0, 0, 8, 6);

TEST(DxfWalls, Mline) {
    const std::string mline = groups(
        "0 MLINE 8 W 2 STANDARD 40 0.2 70 1 71 1 72 2 73 2 10 3 20 0 30 0 210 0 220 0 230 1 11 3 "
        "21 "
        "0 31 0 12 0 22 1 32 0 13 -1 23 0 33 0 74 2 41 0.1 41 0 75 0 74 2 41 -0.1 41 0 75 0 11 3 "
        "21 "
        "6 31 0 12 0 22 1 32 0 13 -1 23 0 33 0 74 2 41 0.1 41 0 75 0 74 2 41 -0.1 41 0 75 0");
    EXPECT_NEAR(areaOf(drawing(kRoom + mline, "", 6)), 29.4, 1e-9);
    // A door cut out of both lines joins the rooms: 8 x 6 less the wall's pieces.
    std::string cut = mline;
    for (std::size_t at = 0; (at = cut.find("74\n2\n", at)) != std::string::npos; at += 5) {
        const std::size_t end = cut.find("\n41\n0\n", at);
        cut.replace(end, 6, "\n41\n0\n41\n2\n41\n2.9\n");
    }
    ImportOptions open;
    open.close_gaps = 0;
    EXPECT_GT(areaOf(drawing(kRoom + cut, "", 6), open), 46);
    // Without vertices it cannot be read.
    const Document damaged = read(drawing(kRoom + groups("0 MLINE 8 W 71 1 11 3 21 0"), "", 6));
    EXPECT_NE(warningsOf(damaged).find("MLINE (1), on the layer W"), std::string::npos);
}

TEST(DxfWalls, SplineThroughPoints) {
    const std::string spline = groups(
        "0 SPLINE 8 W 70 8 71 3 72 0 73 0 74 3 11 3 21 0 31 0 11 3.5 21 3 31 0 11 3 21 6 31 0");
    // The natural cubic spline through symmetric points: 18 + 6 * 0.5 * 5 / 8.
    EXPECT_NEAR(areaOf(drawing(kRoom + spline, "", 6)), 48 - 18 - 1.875, 0.01);
    EXPECT_NEAR(
        areaOf(drawing(kRoom + groups("0 SPLINE 8 W 70 8 71 3 11 3 21 0 11 3 21 6"), "", 6)), 30,
        1e-9);
}

TEST(DxfWalls, SolidsTracesAndFaces) {
    for (const char* kind : {"SOLID", "TRACE"})
        EXPECT_NEAR(
            areaOf(drawing(kRoom + groups(std::string("0 ") + kind +
                                          " 8 W 10 3 20 0 11 3.2 21 0 12 3 22 6 13 3.2 23 6"),
                           "", 6)),
            4.8 * 6, 1e-9)
            << kind;
    EXPECT_NEAR(
        areaOf(drawing(kRoom + groups("0 3DFACE 8 W 10 3 20 0 30 0 11 3.2 21 0 31 0 12 3.2 22 6 32 "
                                      "0 13 3 23 6 33 0"),
                       "", 6)),
        4.8 * 6, 1e-9);
    // An upright face is a line.
    EXPECT_NEAR(
        areaOf(drawing(kRoom + groups("0 3DFACE 8 W 10 3 20 0 30 0 11 3 21 6 31 0 12 3 22 6 32 "
                                      "2.5 13 3 23 0 33 2.5"),
                       "", 6)),
        30, 1e-9);
}

TEST(DxfWalls, PolyfaceMeshes) {
    const auto vertex = [](const char* x, const char* y) {
        return groups(std::string("0 VERTEX 8 W 10 ") + x + " 20 " + y + " 30 0 70 192");
    };
    const std::string mesh = groups("0 POLYLINE 8 W 66 1 70 64 71 4 72 1") + vertex("3", "0") +
                             vertex("3.2", "0") + vertex("3.2", "6") + vertex("3", "6") +
                             groups("0 VERTEX 8 W 10 0 20 0 30 0 70 128 71 1 72 2 73 3 74 4") +
                             groups("0 SEQEND 8 W");
    EXPECT_NEAR(areaOf(drawing(kRoom + mesh, "", 6)), 4.8 * 6, 1e-9);
}

TEST(DxfWalls, HatchesAsNarrowAsWalls) {
    const auto hatch = [](const std::string& x0, const std::string& x1) {
        return groups(
            "0 HATCH 8 W 10 0 20 0 30 0 210 0 220 0 230 1 2 SOLID 70 1 71 0 91 1 92 3 72 0 "
            "73 1 93 4 10 " +
            x0 + " 20 0 10 " + x1 + " 20 0 10 " + x1 + " 20 6 10 " + x0 +
            " 20 6 97 0 75 1 76 1 98 0");
    };
    EXPECT_NEAR(areaOf(drawing(kRoom + hatch("3", "3.2"), "", 6)), 4.8 * 6, 1e-9);
    EXPECT_NEAR(areaOf(drawing(kRoom + hatch("3", "6"), "", 6)), 48, 1e-9);  // a floor
    const std::string edges = groups(
        "0 HATCH 8 W 10 0 20 0 30 0 2 SOLID 70 1 71 0 91 1 92 1 93 4 72 1 10 3 20 0 11 3.2 21 "
        "0 72 1 10 3.2 20 0 11 3.2 21 6 72 1 10 3.2 20 6 11 3 21 6 72 1 10 3 20 6 11 3 21 0 "
        "97 0 75 1 76 1 98 0");
    EXPECT_NEAR(areaOf(drawing(kRoom + edges, "", 6)), 4.8 * 6, 1e-9);
}

TEST(DxfWalls, DashedLinesCloseNoRoom) {
    const std::string types =
        groups("0 LTYPE 2 Strich 73 2 40 0.75 49 0.5 49 -0.25 0 LTYPE 2 CONTINUOUS 73 0 40 0");
    const auto across = [](const char* layer, const char* type) {
        return groups("0 LINE 8 " + std::string(layer) + " 6 " + type + " 10 3 20 0 11 3 21 6");
    };
    const auto area_with = [&](const std::string& line, const std::string& tables) {
        return areaOf(drawing(kRoom + line, "", 6, tables));
    };
    EXPECT_NEAR(area_with(across("0", "STRICH"), types), 48, 1e-9);
    EXPECT_NEAR(area_with(across("0", "CENTER2"), ""), 48, 1e-9);  // a table is missing
    EXPECT_NEAR(area_with(across("0", "Continuous"), types), 30, 1e-9);
    EXPECT_NEAR(area_with(across("0", "Unknown"), types), 30, 1e-9);
    // Of the layer, unless the line has a type itself.
    const std::string layers = types + groups("0 LAYER 2 0 70 0 62 7 6 Strich");
    EXPECT_NEAR(area_with(line("0", 3, 0, 3, 6), layers), 48, 1e-9);
    EXPECT_NEAR(area_with(across("0", "BYLAYER"), layers), 48, 1e-9);
    EXPECT_NEAR(area_with(across("0", "CONTINUOUS"), layers), 30, 1e-9);
    // Walls by name, and layers that an option names, have dashed walls.
    EXPECT_NEAR(area_with(across("A-WALL", "STRICH"), types), 30, 1e-9);
    ImportOptions all;
    all.wall_layers = {"*"};
    EXPECT_NEAR(areaOf(drawing(kRoom + across("0", "STRICH"), "", 6, types), all), 30, 1e-9);
    // So has a drawing that has no other lines.
    const std::string room =
        groups("0 LWPOLYLINE 8 0 6 STRICH 90 4 70 1 10 0 20 0 10 8 20 0 10 8 20 6 10 0 20 6");
    EXPECT_NEAR(areaOf(drawing(room, "", 6, types)), 48, 1e-9);
}

// A door as leaf, swing and both thresholds between two rooms.
TEST(DxfWalls, DoorsOpenBothThresholds) {
    const std::string wall = rectangle("0", 4, 0, 4.2, 2) + rectangle("0", 4, 2.9, 4.2, 6);
    const std::string door = line("0", 4, 2, 3.1, 2) + arc("0", 4, 2, 0.9, 90, 180);
    const std::string thresholds = line("0", 4, 2, 4, 2.9) + line("0", 4.2, 2, 4.2, 2.9);
    EXPECT_NEAR(areaOf(drawing(kRoom + wall + door + thresholds, "", 6)), 48 - 0.2 * (6 - 0.9),
                1e-3);
    EXPECT_NEAR(areaOf(drawing(kRoom + wall + door, "", 6)), 48 - 0.2 * (6 - 0.9), 1e-3);
    // Without a door they close the room.
    EXPECT_LT(areaOf(drawing(kRoom + wall + thresholds, "", 6)), 25);
}

TEST(DxfWalls, ColouredHatchesWiderThanWallsAreReported) {
    const auto fill = [](double x0, double y0, double x1, double y1) {
        const std::string a = formatDouble(x0), b = formatDouble(y0), c = formatDouble(x1),
                          d = formatDouble(y1);
        return groups("0 HATCH 8 W 10 0 20 0 30 0 2 SOLID 70 1 71 0 91 1 92 3 72 0 73 1 93 4 10 " +
                      a + " 20 " + b + " 10 " + c + " 20 " + b + " 10 " + c + " 20 " + d + " 10 " +
                      a + " 20 " + d + " 97 0 75 1 76 1 98 0");
    };
    const auto warnings = [](const std::string& entities) {
        return warningsOf(read(drawing(kRoom + entities, "", 6)));
    };
    // A pier of 2 m x 2 m.
    EXPECT_NE(warnings(fill(0.5, 0.5, 2.5, 2.5))
                  .find("not read, though it may be a wall: HATCH of a colour, wider than walls "
                        "(1), on the layer W at 0.50,0.50 of the file"),
              std::string::npos);
    // Lines outline the pier, the colour is that of the floor, or the pier is elsewhere.
    EXPECT_EQ(warnings(fill(0.5, 0.5, 2.5, 2.5) + rectangle("W", 0.5, 0.5, 2.5, 2.5)), "");
    EXPECT_EQ(warnings(fill(0, 0, 8, 6)), "");
    EXPECT_EQ(warnings(fill(12, 0, 14, 2)), "");
}

TEST(DxfWalls, HatchesBehindCurves) {
    // A quarter of a ring of ellipses, half axes 4 x 3 and 3.8 x 2.8, cuts a corner off.
    const std::string ring = groups(
        "0 HATCH 8 W 10 0 20 0 30 0 2 SOLID 70 1 71 0 91 1 92 1 93 4 72 3 10 0 20 0 11 4 21 0 40 "
        "0.75 50 0 51 90 73 1 72 1 10 0 20 3 11 0 21 2.8 72 3 10 0 20 0 11 3.8 21 0 40 "
        "0.736842105263 50 270 51 360 73 0 72 1 10 3.8 20 0 11 4 21 0 97 0 75 1 76 1 98 0");
    EXPECT_NEAR(areaOf(drawing(kRoom + ring, "", 6)), 48 - 3 * std::numbers::pi, 0.01);
    // A Bézier curve as a spline, and back along one 0.2 m beside it.
    const std::string strip = groups(
        "0 HATCH 8 W 10 0 20 0 30 0 2 SOLID 70 1 71 0 91 1 92 1 93 4 72 4 94 3 73 0 74 0 95 8 96 4 "
        "40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 1 10 3 20 0 10 4 20 2 10 4 20 4 10 3 20 6 97 0 72 1 "
        "10 3 20 6 11 2.8 21 6 72 4 94 3 73 0 74 0 95 8 96 4 40 0 40 0 40 0 40 0 40 1 40 1 40 1 40 "
        "1 10 2.8 20 6 10 3.8 20 4 10 3.8 20 2 10 2.8 20 0 97 0 72 1 10 2.8 20 0 11 3 21 0 97 0 75 "
        "1 76 1 98 0");
    // It bulges by 3 t (1 - t) over 6 m.
    EXPECT_NEAR(areaOf(drawing(kRoom + strip, "", 6)), 48 - 18 - 3, 0.01);
}

TEST(DxfWalls, UnreadEntitiesWarn) {
    const auto of = [](const std::string& entity) {
        return warningsOf(read(drawing(kRoom + groups(entity), "", 6)));
    };
    EXPECT_EQ(
        of("0 AEC_WALL 5 F1 8 A-WALL"),
        "plan.dxf:40: warning: not read, though it may be a wall: AEC_WALL (1), on the layer "
        "A-WALL: explode it, or "
        "bind the reference, in the program that drew it, and export lines; --wall-layer names "
        "the layers that count\n");
    EXPECT_NE(of("0 3DSOLID 8 W").find("3DSOLID (1)"), std::string::npos);
    EXPECT_NE(of("0 REGION 8 W").find("REGION (1)"), std::string::npos);
    EXPECT_NE(of("0 ACAD_PROXY_ENTITY 8 W").find("ACAD_PROXY_ENTITY (1)"), std::string::npos);
    EXPECT_NE(of("0 INSERT 8 W 2 shell 10 0 20 0").find("missing block shell (1)"),
              std::string::npos);
    EXPECT_EQ(of("0 3DSOLID 8 W 67 1"), "");  // in paper space
    EXPECT_EQ(of("0 3DSOLID 8 A-FURN"), "");  // furniture
    EXPECT_EQ(of("0 MTEXT 8 W 10 1 20 1"), "");
}

TEST(DxfWalls, UnreadEntitiesWarnWhereWallsMayBe) {
    const auto warns = [](const std::string& entities, const std::string& head = "") {
        return warningsOf(read(drawing(kRoom + entities, head, 6)))
                   .find("not read, though it may be a wall") != std::string::npos;
    };
    const auto mesh = [](double x0, double y0, double x1, double y1) {
        std::string text = groups("0 MESH 8 W 71 2 72 0 91 1 92 4");
        for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
            text += group(10, x) + group(20, y) + group(30, 0.0);
        return text;
    };
    EXPECT_TRUE(warns(mesh(4, 0, 4.2, 6)));
    EXPECT_FALSE(warns(mesh(4, 1, 4.1, 1.1)));   // smaller than walls
    EXPECT_FALSE(warns(mesh(14, 0, 14.2, 6)));   // off the room
    EXPECT_TRUE(warns(mesh(8.1, 0, 8.3, 6)));    // beside it
    EXPECT_TRUE(warns(mesh(-50, -50, 50, 50)));  // around it
    // Rows of a mesh, and an outline that stands upright: its x and y are y and z of the world.
    const std::string rows = groups(
        "0 POLYLINE 8 W 66 1 70 16 71 2 72 2 0 VERTEX 8 W 10 4 20 0 70 64 0 VERTEX 8 W 10 4 20 6 "
        "70 64 0 SEQEND 8 W");
    EXPECT_TRUE(warns(rows));
    const auto upright = [](const char* layer, double height, double end) {
        return groups("0 LWPOLYLINE 8 " + std::string(layer) + " 90 2 70 0 210 1 220 0 230 0") +
               group(38, height) + group(10, 0.0) + group(20, 0.0) + group(10, end) +
               group(20, 2.5);
    };
    EXPECT_TRUE(warns(upright("W", 4, 6)));
    EXPECT_FALSE(warns(upright("W", 40, 6)));
    EXPECT_FALSE(warns(upright("W", 4, 0.3)));
    EXPECT_FALSE(warns(upright("A-FURN", 4, 6)));
    // In blocks they lie where those are inserted, on their layers.
    const std::string block = groups("0 SECTION 2 BLOCKS 0 BLOCK 2 part 10 0 20 0 70 0") +
                              groups("0 MESH 8 0 10 0 20 0 10 0 20 6 0 ENDBLK 0 ENDSEC");
    const auto insert = [](const char* layer, double x) {
        return groups("0 INSERT 2 part 8 " + std::string(layer) + " 20 0") + group(10, x);
    };
    EXPECT_TRUE(warns(insert("W", 4), block));
    EXPECT_FALSE(warns(insert("W", 40), block));
    EXPECT_FALSE(warns(insert("A-FURN", 4), block));
}

TEST(DxfWalls, LayersThatAreNotPlotted) {
    const std::string line_at_3 = line("Defpoints", 3, 0, 3, 6);
    EXPECT_NEAR(areaOf(drawing(kRoom + line_at_3, "", 6)), 48, 1e-9);
    const std::string unplotted = groups("0 LAYER 2 Hilf 70 0 62 7 290 0");
    EXPECT_NEAR(areaOf(drawing(kRoom + line("Hilf", 3, 0, 3, 6), "", 6, unplotted)), 48, 1e-9);
}

TEST(DxfWalls, LayersThatHoldNoWallsByName) {
    for (const char* name :
         {"A-FURN",   "Furniture", "Möbel",       "MOEBEL",     "Mobiliario",  "mobilier",
          "Arredi",   "meubilair", "Мебель",      "家具",       "Bemaßung",    "DIMENSIONES",
          "Cotas",    "quote",     "Размеры",     "尺寸标注",   "A-ANNO-TEXT", "Beschriftung",
          "Texte",    "Schraffur", "A-WALL-PATT", "hachures",   "Achsen",      "S-GRID",
          "ejes",     "E-LITE",    "Elektro",     "Electrical", "P-FIXT",      "Sanitär",
          "Plumbing", "给排水",    "HVAC",        "Nábytek",    "Meble",       "Bútor",
          "kalusteet"})
        EXPECT_NEAR(areaOf(drawing(kRoom + line(name, 3, 0, 3, 6), "", 6)), 48, 1e-9) << name;
    for (const char* name :
         {"W", "0", "Partitions", "Wände", "A-WALL", "Plan", "Cloison", "Layer1"})
        EXPECT_NEAR(areaOf(drawing(rectangle(name, 0, 0, 8, 6) + line(name, 3, 0, 3, 6), "", 6)),
                    30, 1e-9)
            << name;
    // No other layer: the names lie.
    EXPECT_NEAR(areaOf(drawing(rectangle("text", 0, 0, 8, 6), "", 6)), 48, 1e-9);
    ImportOptions all;
    all.wall_layers = {"*"};
    EXPECT_NEAR(areaOf(drawing(kRoom + line("A-FURN", 3, 0, 3, 6), "", 6), all), 30, 1e-9);
}

TEST(DxfWalls, NamedWallsThatTheRestClutters) {
    const std::string walls = rectangle("Wand", 0, 0, 8, 6);
    const Document document = read(drawing(walls + line("0", 3, 0, 3, 6), "", 6));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-9);
    EXPECT_NE(notesOf(document).find("--wall-layer Wand"), std::string::npos);
    // Advice never has no floor.
    EXPECT_EQ(warningsOf(read(drawing(kRoom + line("Wand", 3, 0, 3, 6), "", 6))), "");
}

TEST(DxfWalls, WidthsAreThickness) {
    const auto wall = [](const std::string& ends) {
        return groups("0 LWPOLYLINE 8 W 90 2 70 0 43 0.2 " + ends);
    };
    const Document document =
        read(drawing(wall("10 0 20 0 10 8 20 0") + wall("10 8 20 0 10 8 20 6") +
                         wall("10 8 20 6 10 0 20 6") + wall("10 0 20 6 10 0 20 0"),
                     "", 6));
    EXPECT_NE(writeRecordText(document).find("closed=yes thickness=0.2"), std::string::npos);
    EXPECT_NE(notesOf(document).find("walls of that thickness: 0.2 m"), std::string::npos);
}

TEST(DxfWalls, StraysAreLeftOut) {
    const std::string stray = line("W", 3000, 3000, 3001, 3001);
    const Document document = read(drawing(kRoom + rectangle("W", 8, 0, 16, 6) + stray, "", 6));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 48, 1e-9);
    EXPECT_NE(warningsOf(document).find("left out 1 line far from all others, at 3000.0,3000.0 m"),
              std::string::npos);
    // At the origin of a plan in surveyors' coordinates.
    const Document utm = read(
        drawing(rectangle("W", 448262, 5428611, 448270, 5428617) + line("W", 0, 0, 1, 1), "", 6));
    EXPECT_NEAR(environmentOf(utm).indoor().area(), 48, 1e-6);
    // Half of the lines are no stray.
    const Document two = read(drawing(kRoom + rectangle("W", 500, 0, 508, 6), "", 6));
    EXPECT_EQ(warningsOf(two).find("far from all others"), std::string::npos);
}

TEST(DxfWalls, OneEncodingForAFile) {
    const auto of = [](const std::string& version, const std::string& page,
                       const std::string& layer) {
        std::string dxf = drawing(rectangle(layer, 0, 0, 8, 6), "", 6);
        dxf.insert(dxf.find("9\n$INSUNITS"),
                   "9\n$ACADVER\n1\n" + version + "\n9\n$DWGCODEPAGE\n3\n" + page + "\n");
        return notesOf(read(dxf));
    };
    EXPECT_NE(of("AC1015", "ANSI_936", "\xC7\xBD").find("墙 (1)"), std::string::npos);
    EXPECT_NE(of("AC1015", "ANSI_936", "墙").find("墙 (1)"), std::string::npos);
    EXPECT_NE(of("AC1027", "ANSI_936", "墙").find("墙 (1)"), std::string::npos);
    EXPECT_NE(of("AC1015", "ANSI_1252", "W\xE4nde").find("Wände (1)"), std::string::npos);
    EXPECT_NE(of("AC1032", "ANSI_1252", "Wände").find("Wände (1)"), std::string::npos);
    EXPECT_NE(of("AC1015", "ANSI_932", "\x95\xC7").find("壁 (1)"), std::string::npos);
}

/// Areas that a person would mean; `options` where a person has to say something.
void expectArea(const std::string& file, double area, const ImportOptions& options = {}) {
    const char* folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const Document document =
        readDxf(readAll(std::string(folder) + "/more/" + file), file, options, sceneSchemas());
    EXPECT_NEAR(environmentOf(document).indoor().area(), area, 0.01 * area) << file;
}

TEST(RealPlans, FrontDoorOpen) { expectArea("front_door_open.dxf", 84.2); }
TEST(RealPlans, UnitsAsAsked) {
    ImportOptions options;
    options.units = "m";
    expectArea("units_lie.dxf", 57.3, options);
}

TEST(RealPlans, UnitsThatLieAreSaid) {
    expectArea("units_lie.dxf", 57.3);
    const char* folder = std::getenv("ISPACE_TEST_DATA");
    if (folder == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    const std::string warned = warningsOf(readDxf(
        readAll(std::string(folder) + "/more/units_lie.dxf"), "units_lie.dxf", {}, sceneSchemas()));
    EXPECT_NE(warned.find("states mm ($INSUNITS), but is read in m, in which walls are 0.20 m"),
              std::string::npos)
        << warned;
}

}  // namespace dxf_walls_test
}  // namespace ispace::cad
