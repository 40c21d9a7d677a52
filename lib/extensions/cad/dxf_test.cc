// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/cad.h"

#include <cmath>
#include <numbers>

#include "extensions/cad/dxf_drawing.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace dxf_test {

Document read(const std::string& dxf, const ImportOptions& options = {}) {
    return readDxf(dxf, "plan.dxf", options, sceneSchemas());
}
std::string textOf(const std::string& dxf, const ImportOptions& options = {}) {
    return writeRecordText(read(dxf, options));
}
std::string errorOf(const std::string& dxf, const ImportOptions& options = {}) {
    return errorsOf([&] { read(dxf, options); });
}
double areaOf(const std::string& dxf, const ImportOptions& options = {}) {
    return environmentOf(read(dxf, options)).indoor().area();
}

TEST(Dxf, Known) {
    EXPECT_TRUE(isDxf(drawing("")));
    EXPECT_TRUE(isDxf("999\r\nby hand\r\n  0\r\nSECTION\r\n"));
    EXPECT_FALSE(isDxf("0\nEOF\n"));
    EXPECT_FALSE(isDxf("0"));
    EXPECT_FALSE(isDxf("#env 1\n"));
    EXPECT_FALSE(isDxf(""));
}

TEST(Dxf, LinesBecomeOneClosedFence) {
    const std::string dxf = drawing(line("W", 0, 0, 4000, 0) + line("W", 4000, 3000, 4000, 0) +
                                    line("W", 0, 3000, 4000, 3002) + line("W", 0, 3001, 0, 0) +
                                    line("W", 0, 0, 4000, 0));
    const Document document = read(dxf);
    EXPECT_EQ(writeRecordText(document),
              "#env 1\nfence path=0,0;4,0;4,3;0,3 closed=yes\ninside at=2,1.5\n");
    EXPECT_EQ(notesOf(document),
              "unit: mm, as $INSUNITS of the drawing says\n"
              "layers of walls: W (5)\n"
              "kept the largest region, 12.0 m2 in 1 room\n");
    EXPECT_EQ(document.records.front().place().line, 16);
    EXPECT_EQ(*document.records.front().place().file, "plan.dxf");
}

TEST(Dxf, Units) {
    const std::string room = rectangle("W", 0, 0, 4, 3);
    const auto with = [&](int code) { return areaOf(drawing(room, "", code)); };
    EXPECT_DOUBLE_EQ(with(6), 12);
    EXPECT_NEAR(with(2), 12 * 0.3048 * 0.3048, 1e-5);
    EXPECT_NEAR(with(10), 12 * 0.9144 * 0.9144, 1e-5);
    ImportOptions options;
    options.units = "cm";
    EXPECT_NEAR(areaOf(drawing(room, "", 6), options), 12e-4, 1e-9);
    EXPECT_NEAR(areaOf(drawing(room, "", 0), options), 12e-4, 1e-9);
    options.units = "ell";
    EXPECT_NE(errorOf(drawing(room), options).find("unknown unit ell"), std::string::npos);
    EXPECT_EQ(errorOf(drawing(room, "", 0)),
              "plan.dxf: error: the drawing does not say its unit ($INSUNITS); most likely is m, "
              "in which the plan is 4.0 m wide: say its unit, for example with --units m, or how "
              "wide it is, with --width-is 4.00\n");
    EXPECT_EQ(errorOf("0\nSECTION\n2\nENTITIES\n" + room + "0\nENDSEC\n0\nEOF\n"),
              errorOf(drawing(room, "", 0)));
    EXPECT_NE(errorOf(drawing(room, "", 12)).find("$INSUNITS is 12, wanted 1 (inch)"),
              std::string::npos);
    EXPECT_NE(
        errorOf(drawing(rectangle("W", 0, 0, 40000, 3), "", 6)).find("the plan is 40000 m wide"),
        std::string::npos);
    EXPECT_NE(
        errorOf(drawing(rectangle("W", 1e9, 0, 2e9, 3), "", 6)).find("900 km from the origin"),
        std::string::npos);
}

TEST(Dxf, SurveyorsCoordinatesMoveToTheOrigin) {
    // A room with a quarter circle, and a door in a block, in millimetres.
    const auto room = [](double x, double y) {
        return drawing(polyline("W", true,
                                {{x, y},
                                 {x + 4000, y},
                                 {x + 4000, y + 3000, std::tan(std::numbers::pi / 8)},
                                 {x, y + 3000}}) +
                       line("D", x + 1000, y, x + 2000, y));
    };
    ImportOptions options;
    options.door_layers = {"D"};
    ImportReport report;
    options.report = &report;
    const double area = areaOf(room(0, 0), options);
    EXPECT_TRUE(report.choices.empty());
    const Document moved = read(room(450'000'250, 5'400'000'500), options);
    EXPECT_NEAR(environmentOf(moved).indoor().area(), area, 1e-5);
    ASSERT_EQ(report.choices.size(), 1U);
    EXPECT_NE(report.choices[0].message.find("moved by (-450001.0, -5400000.0) m: the drawing "
                                             "stands in surveyors' coordinates"),
              std::string::npos)
        << report.choices[0].message;
    const std::string text = writeRecordText(moved);
    EXPECT_NE(text.find("path=-0.75,0.5;3.25,0.5;"), std::string::npos) << text;
    EXPECT_NE(text.find("\ndoor "), std::string::npos) << text;
    // Stray entities do not decide.
    const std::string near = rectangle("W", 0, 0, 4, 3) + rectangle("W", 0, 0, 2, 3);
    EXPECT_NE(warningsOf(read(drawing(near + line("W", 2e6, 2e6, 2e6, 2e6 + 1), "", 6)))
                  .find("left out 1 line far from all others"),
              std::string::npos);
}

TEST(Dxf, ArcsAndCircles) {
    // A half disc of radius 1: an ARC and its chord.
    const std::string half = arc("W", 0, 0, 1, 0, 180) + line("W", -1, 0, 1, 0);
    EXPECT_NEAR(areaOf(drawing(half, "", 6)), std::numbers::pi / 2, 0.003);
    EXPECT_NEAR(areaOf(drawing(
                    group(0, "CIRCLE") + group(8, "W") + group(10, 5) + group(20, 5) + group(40, 2),
                    "", 6)),
                4 * std::numbers::pi, 0.01);
    // 270 degrees through the zero direction.
    const std::string three =
        arc("W", 0, 0, 1, 270, 180) + line("W", 0, 0, -1, 0) + line("W", 0, 0, 0, -1);
    EXPECT_NEAR(areaOf(drawing(three, "", 6)), 0.75 * std::numbers::pi, 0.004);
    const std::string ellipse = group(0, "ELLIPSE") + group(8, "W") + group(10, 1) + group(20, 1) +
                                group(11, 0) + group(21, 2) + group(40, 0.5) + group(41, 0) +
                                group(42, 2 * std::numbers::pi);
    EXPECT_NEAR(areaOf(drawing(ellipse, "", 6)), 2 * std::numbers::pi, 0.01);
    EXPECT_EQ(errorOf(drawing(arc("W", 0, 0, -1, 0, 180), "", 6)),
              "plan.dxf:16:1: error: a radius of -1\n");
    // A circle without radius draws no line.
    EXPECT_NEAR(areaOf(drawing(half + arc("W", 5, 5, 0, 0, 180), "", 6)), std::numbers::pi / 2,
                0.003);
}

TEST(Dxf, BulgesAreArcs) {
    // A square with a half circle of radius 1 to the right on its right side.
    const std::string square = polyline("W", true, {{0, 0}, {2, 0, 1}, {2, 2}, {0, 2}});
    EXPECT_NEAR(areaOf(drawing(square, "", 6)), 4 + std::numbers::pi / 2, 0.003);
    const std::string dent = polyline("W", true, {{0, 0}, {2, 0, -1}, {2, 2}, {0, 2}});
    EXPECT_NEAR(areaOf(drawing(dent, "", 6)), 4 - std::numbers::pi / 2, 0.003);
    // A quarter circle: tan(90 / 4).
    const std::string quarter =
        polyline("W", true, {{0, 0}, {2, 0, std::tan(std::numbers::pi / 8)}, {0, 2}});
    EXPECT_NEAR(areaOf(drawing(quarter, "", 6)), std::numbers::pi, 0.004);
    // As an old POLYLINE, with a point of the frame of a curve that does not count.
    EXPECT_NEAR(areaOf(drawing(oldPolyline("W", true, {{0, 0}, {2, 0, 1}, {2, 2}, {0, 2}}), "", 6)),
                4 + std::numbers::pi / 2, 0.003);
}

TEST(Dxf, PointsOfArcsLieOnThem) {
    ImportOptions options;
    options.units = "m";
    for (const double radius : {0.01, 0.3, 2.0, 50.0, 3000.0}) {
        const Document document = read(drawing(group(0, "CIRCLE") + group(8, "W") + group(10, 0) +
                                                   group(20, 0) + group(40, radius),
                                               "", 6),
                                       options);
        const TupleList& path = document.records.front().list("path");
        for (const Tuple& p : path) EXPECT_NEAR(std::hypot(p[0], p[1]), radius, 1e-6);
        const double sagitta =
            radius * (1 - std::cos(std::numbers::pi / static_cast<double>(path.size())));
        EXPECT_LE(sagitta, std::max(0.001, 1e-5 * radius)) << radius;
        EXPECT_LE(path.size(), 7200U);
    }
}

TEST(Dxf, BlocksAreTurnedScaledMirroredAndRepeated) {
    // A room of 2 x 1 about the point (1, 1) of its block.
    const std::string blocks = block("ROOM", 1, 1, rectangle("0", 1, 1, 3, 2));
    const auto path_of = [&](const std::string& more) {
        return textOf(drawing(insert("ROOM", "W", 10, 20, more), blocks, 6)).substr(7);
    };
    EXPECT_EQ(path_of("").substr(0, 48), "fence path=10,20;12,20;12,21;10,21 closed=yes\nin");
    EXPECT_EQ(path_of(group(50, 90)).substr(0, 46),
              "fence path=10,20;10,22;9,22;9,20 closed=yes\nin");
    EXPECT_EQ(path_of(group(41, 2) + group(42, 3)).substr(0, 44),
              "fence path=10,20;14,20;14,23;10,23 closed=ye");
    EXPECT_EQ(path_of(group(41, -1)).substr(0, 40), "fence path=10,20;8,20;8,21;10,21 closed=");
    // Seen from below: the insert's own x is turned, too.
    EXPECT_EQ(path_of(group(230, -1)).substr(0, 42), "fence path=-10,20;-12,20;-12,21;-10,21 clo");
    // Three columns and two rows, turned; only the first room found is kept.
    const std::string grid =
        group(70, 3) + group(71, 2) + group(44, 3) + group(45, 5) + group(50, 90);
    const Document all =
        read(drawing(insert("ROOM", "W", 0, 0, grid) + rectangle("W", -9, -1, 2, 9), blocks, 6));
    EXPECT_EQ(countOf(all, "fence"), 7U);
    EXPECT_EQ(environmentOf(all).indoor().parts.at(0).holes.size(), 6U);
}

TEST(Dxf, EntitiesOnLayerZeroOfABlockAreOnThatOfTheInsert) {
    const std::string blocks =
        block("A", 0, 0, rectangle("0", 0, 0, 4, 3) + rectangle("OTHER", 1, 1, 2, 2));
    ImportOptions options;
    options.wall_layers = {"wall*"};
    EXPECT_DOUBLE_EQ(areaOf(drawing(insert("A", "Walls", 0, 0), blocks, 6), options), 12);
    options.wall_layers = {"0", "OTHER"};
    EXPECT_DOUBLE_EQ(areaOf(drawing(insert("A", "Walls", 0, 0), blocks, 6), options), 1);
    options.wall_layers = {"X"};
    EXPECT_EQ(
        errorOf(drawing(insert("A", "Walls", 0, 0), blocks, 6), options),
        "plan.dxf: error: no line on the layers of walls; layers with lines: OTHER (1), Walls "
        "(1)\n");
}

TEST(Dxf, FramesOfSheetsWarn) {
    const auto warningsOf = [](const std::string& entities) {
        ImportReport report;
        ImportOptions options;
        options.report = &report;
        const Document document = read(drawing(entities, "", 6), options);
        std::string text;
        for (const Diagnostic& warning : document.warnings) text += warning.message + '\n';
        for (const Diagnostic& doubt : report.doubts) text += doubt.message + '\n';
        return text;
    };
    const std::string frame = rectangle("W", -3, -3, 11, 8);
    EXPECT_EQ(
        warningsOf(frame + rectangle("W", 0, 0, 8, 5)),
        "the room is the rectangle around the whole drawing: if that is the frame of a sheet, or a "
        "plot around a house, --inside X,Y chooses a room in it, the largest has 40.0 m2 about "
        "(4.0, 2.5)\n");
    // An open plan, with a title block in the corner.
    EXPECT_EQ(
        warningsOf(frame + rectangle("W", 7, -3, 11, -1.5) + line("W", 0, 0, 8, 0) +
                   line("W", 8, 0, 8, 5) + line("W", 8, 5, 0, 5)),
        "the room is the rectangle around the whole drawing: if that is the frame of a sheet, or a "
        "plot around a house, leave it out, for example with --wall-layer\n");
    // A small house on its plot.
    EXPECT_NE(warningsOf(rectangle("W", -5, -5, 20, 20) + rectangle("W", 0, 0, 8, 6))
                  .find("a plot around a house, --inside X,Y chooses a room in it, the largest has "
                        "48.0 m2 about (4.0, 3.0)"),
              std::string::npos);
    // The same with a front door, which joins the house and its plot.
    const std::string house = line("W", 2, 0, 8, 0) + line("W", 8, 0, 8, 6) +
                              line("W", 8, 6, 0, 6) + line("W", 0, 6, 0, 0) +
                              line("W", 0, 0, 1.1, 0) + line("W", 1.1, 0, 1.1, 0.9) +
                              arc("W", 1.1, 0, 0.9, 0, 90);
    EXPECT_NE(warningsOf(rectangle("W", -5, -5, 20, 20) + house).find("a plot around a house"),
              std::string::npos);
    // Pillars and rooms at the walls are no drawing in a frame.
    EXPECT_EQ(warningsOf(frame + rectangle("W", 0, 0, 1, 1) + rectangle("W", 6, 4, 7, 5)), "");
    EXPECT_EQ(warningsOf(frame + line("W", -3, 2, 4, 2) + line("W", 4, 2, 4, 8)), "");
}

TEST(Dxf, ALineAroundAHouseIsReported) {
    const auto warnings = [](const std::string& entities) {
        return warningsOf(read(drawing(entities, "", 6)));
    };
    // A house of thick walls, whose front door is a gap that its leaf closes.
    const std::string house = polyline("0", true,
                                       {{3, 0},
                                        {8, 0},
                                        {8, 6},
                                        {0, 6},
                                        {0, 0},
                                        {2, 0},
                                        {2, 0.3},
                                        {0.3, 0.3},
                                        {0.3, 5.7},
                                        {7.7, 5.7},
                                        {7.7, 0.3},
                                        {3, 0.3}}) +
                              line("0", 2, 0, 2, 1) + arc("0", 2, 0, 1, 0, 90);
    // The edge of its roof: the room within is larger than the ground between.
    EXPECT_NE(warnings(house + rectangle("0", -0.5, -0.5, 8.5, 6.5))
                  .find("the room is the rectangle around the whole drawing"),
              std::string::npos);
    // A plot that is no rectangle.
    const std::string plot = polyline("0", true, {{-20, -10}, {30, -14}, {24, 20}, {-8, 26}});
    EXPECT_NE(warnings(house + plot).find("up to a single line: if that bounds a plot"),
              std::string::npos)
        << warnings(house + plot);
    EXPECT_EQ(warnings(house), "");
}

TEST(Dxf, TilesAreReported) {
    std::string tiles = rectangle("0", 0, 0, 8, 6) + line("0", 4, 0, 4, 6);
    for (int i = 1; i < 15; ++i) tiles += line("0", 4, 0.4 * i, 8, 0.4 * i);
    for (int i = 1; i < 10; ++i) tiles += line("0", 4 + 0.4 * i, 0, 4 + 0.4 * i, 6);
    EXPECT_NE(warningsOf(read(drawing(tiles, "", 6)))
                  .find("150 faces of 24.0 m2 in sum are too small to be rooms"),
              std::string::npos)
        << warningsOf(read(drawing(tiles, "", 6)));
}

TEST(Dxf, WallsByNameOnAPlotAreTaken) {
    const std::string plot = rectangle("0", -5, -5, 20, 20);
    for (const char* layer : {"墙", "外墙", "벽", "СТЕНЫ", "جدران", "קירות", "Cloisons"})
        EXPECT_NEAR(environmentOf(read(drawing(plot + rectangle(layer, 0, 0, 8, 6), "", 6)))
                        .indoor()
                        .area(),
                    48, 1e-9)
            << layer;
    // Inner walls of a house that are named, and outer ones that are not.
    EXPECT_NEAR(
        environmentOf(
            read(drawing(rectangle("0", -1, -1, 9, 7) + rectangle("A-WALL", 3, 2, 5, 4), "", 6)))
            .indoor()
            .area(),
        80 - 4, 1e-9);
    // A boundary is one line, as small a house of thick walls as it has; a hall around a core has
    // thick walls itself.
    const auto thick = [](const char* layer, double x0, double y0, double x1, double y1) {
        return rectangle(layer, x0, y0, x1, y1) +
               rectangle(layer, x0 + 0.3, y0 + 0.3, x1 - 0.3, y1 - 0.3);
    };
    const auto area_of = [](const std::string& entities) {
        return environmentOf(read(drawing(entities, "", 6))).indoor().area();
    };
    EXPECT_NEAR(area_of(rectangle("0", -40, -30, 40, 30) + thick("A-WALL", 0, 0, 8, 6)), 7.4 * 5.4,
                1e-9);
    EXPECT_NEAR(area_of(thick("0", -10, -8, 16, 14) + thick("A-WALL", 0, 0, 8, 6)),
                25.4 * 21.4 - 48, 1e-9);
}

TEST(Dxf, BlocksInBlocksEnd) {
    const std::string loop =
        block("A", 0, 0, insert("B", "0", 0, 0)) + block("B", 0, 0, insert("A", "0", 1, 0));
    EXPECT_EQ(errorOf(drawing(insert("A", "0", 0, 0), loop, 6)),
              "plan.dxf:58:1: error: blocks in each other more than 16 deep: does `A` contain "
              "itself?\n");
    // Each level doubles twice ten times over.
    std::string bomb = block("L0", 0, 0, line("0", 0, 0, 1, 1));
    for (int i = 1; i < 15; ++i) {
        const std::string inner = "L" + std::to_string(i - 1);
        bomb += block("L" + std::to_string(i), 0, 0,
                      insert(inner, "0", 0, 0,
                             group(70, 100) + group(71, 100) + group(44, 1) + group(45, 1)));
    }
    EXPECT_NE(errorOf(drawing(insert("L14", "0", 0, 0), bomb, 6))
                  .find("blocks and curves of the drawing make more"),
              std::string::npos);
    EXPECT_NE(
        errorOf(drawing(insert("L0", "0", 0, 0, group(70, 2147483647) + group(71, 2147483647)),
                        block("L0", 0, 0, ""), 6))
            .find("blocks and curves of the drawing make more"),
        std::string::npos);
    ImportOptions few;
    few.max_work.max = 9;
    const std::string two = drawing(rectangle("W", 0, 0, 4, 3) + rectangle("V", 0, 0, 4, 3), "", 6);
    EXPECT_EQ(
        errorOf(two, few),
        "plan.dxf:40:1: error: blocks and curves of the drawing make more than 9 units of work "
        "(`--max-work 18` allows more); is a block inserted by mistake, or in too large a grid? "
        "--wall-layer 'A-WALL*' leaves layers out\n");
    few.wall_layers = {"W"};
    EXPECT_DOUBLE_EQ(areaOf(two, few), 12);
    EXPECT_EQ(
        notesOf(read(drawing(rectangle("W", 0, 0, 4, 3) + insert("XREF", "W", 0, 0), "", 6)))
                .find("inserts of blocks that the file lacks: XREF (1)\n") != std::string::npos,
        true);
}

TEST(Dxf, WhatIsNoPlanIsLeftOut) {
    const std::string entities =
        rectangle("W", 0, 0, 4, 3) + group(0, "TEXT") + group(8, "W") + group(10, 1) +
        group(1, "hall") + group(0, "HATCH") + group(8, "W") + group(91, 1) + group(10, 1) +
        group(0, "TEXT") + group(1, "99999999999999") + line("W", 1, 1, 2, 2) + group(67, 1) +
        line("W", 1, 2, 2, 2) + group(60, 1) + arc("W", 1, 1, 1, 0, 90) + group(210, 1) +
        group(230, 0) + rectangle("OFF", 1, 1, 2, 2) + rectangle("FROZEN", 1, 1, 2, 2);
    const std::string layers = layer("OFF", -7, 0) + layer("FROZEN", 7, 1) + layer("W", 7, 0);
    const Document document = read(drawing(entities, "", 6, layers));
    EXPECT_EQ(countOf(document, "fence"), 1U);
    EXPECT_NE(notesOf(document).find("entities left out: HATCH (1), TEXT (2), in paper space (1), "
                                     "invisible (1), not in the plane of the plan (1)\n"),
              std::string::npos)
        << notesOf(document);
    EXPECT_NE(notesOf(document).find(
                  "layers left out because they are off or frozen: FROZEN (1), OFF (1)\n"),
              std::string::npos);
}

TEST(Dxf, SeenFromBelow) {
    // OCS: an arc is mirrored with its normal, a line is not.
    const std::string half = arc("W", -5, 0, 1, 0, 180) + group(230, -1) + line("W", 4, 0, 6, 0);
    EXPECT_NEAR(areaOf(drawing(half, "", 6)), std::numbers::pi / 2, 0.003);
    // The upper half of an ellipse, whose parameter runs clockwise.
    const std::string ellipse = group(0, "ELLIPSE") + group(8, "W") + group(10, 0) + group(20, 0) +
                                group(11, 2) + group(21, 0) + group(40, 0.5) +
                                group(41, std::numbers::pi) + group(42, 2 * std::numbers::pi) +
                                group(230, -1);
    const std::string below =
        line("W", -2, 0, -2, -1) + line("W", -2, -1, 2, -1) + line("W", 2, -1, 2, 0);
    EXPECT_NEAR(areaOf(drawing(ellipse + below, "", 6)), 4 + std::numbers::pi, 0.01);
}

TEST(Dxf, OnlyTheLargestRegionIsKept) {
    const std::string plan = rectangle("W", 0, 0, 4, 3) + rectangle("W", 10, 0, 12, 2) +
                             line("W", 1, 1, 2, 1) + line("W", -5, 0, -6, 0) +
                             line("W", 4, 1, 6, 1);
    const Document document = read(drawing(plan, "", 6));
    EXPECT_EQ(writeRecordText(document),
              "#env 1\n"
              "fence path=0,0;4,0;4,3;0,3 closed=yes\n"
              "fence path=1,1;2,1\n"
              "inside at=2,1.5\n");
    EXPECT_NE(notesOf(document).find("left out outside of it: 6 lines and 0 openings\n"),
              std::string::npos);
    const Document open = read(drawing(line("W", 0, 0, 4, 0) + line("W", 4, 0, 4, 3), "", 6));
    EXPECT_EQ(writeRecordText(open), "#env 1\nfence path=0,0;4,0;4,3\n");
    EXPECT_NE(notesOf(open).find("nothing is enclosed: all lines are kept\n"), std::string::npos);
}

TEST(Dxf, HatchingIsRefused) {
    std::string hatch;
    for (int i = 0; i < 700; ++i) hatch += line("H", i, 0, i, 700) + line("H", 0, i, 700, i);
    EXPECT_NE(errorOf(drawing(hatch, "", 6)).find("cross each other too often"), std::string::npos);
}

TEST(Dxf, NamesWhatIsWrong) {
    EXPECT_EQ(errorOf("0\nSECTION\n2\nENTITIES\nabc\n"),
              "plan.dxf:5:1: error: found `abc`, wanted a group code\n");
    EXPECT_EQ(errorOf("0\nSECTION\n2\nENTITIES\n0\n"),
              "plan.dxf:5:1: error: truncated: group code 0 without value\n");
    EXPECT_EQ(errorOf("0\nSECTION\n2\nENTITIES\n"),
              "plan.dxf:4:1: error: truncated: the drawing ends without `EOF`\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LINE") + group(10, "1,5"), "", 6)),
              "plan.dxf:18:1: error: found `1,5`, wanted a number\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LINE") + group(10, "nan"), "", 6)),
              "plan.dxf:18:1: error: found `nan`, wanted a number\n");
    EXPECT_EQ(
        errorOf(drawing(group(0, "LINE") + group(10, 1) + group(20, 2) + group(11, 1), "", 6)),
        "plan.dxf:16:1: error: LINE without group 21\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LWPOLYLINE") + group(42, 1), "", 6)),
              "plan.dxf:18:1: error: group 42 before the first vertex of its polyline\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LWPOLYLINE") + group(10, 1) + group(10, 1), "", 6)),
              "plan.dxf:18:1: error: a vertex without group 20\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LWPOLYLINE") + group(70, "x"), "", 6)),
              "plan.dxf:18:1: error: found `x`, wanted a whole number\n");
    EXPECT_EQ(errorOf(drawing(group(0, "LINE") + group(8, std::string(300, 'x')), "", 6)),
              "plan.dxf:18:1: error: a name of 300 characters, wanted at most 255\n");
    EXPECT_EQ(errorOf(drawing("", "", 6)),
              "plan.dxf: error: no line to make a wall of; layers with lines: none\n");
    EXPECT_EQ(
        errorOf(drawing(group(0, "SOLID") + line("OFF", 0, 0, 1, 0), "", 6, layer("OFF", -7, 0))),
        "plan.dxf: error: no line to make a wall of; layers with lines: none; off or frozen: "
        "OFF (1); left out: SOLID (1)\n");
    EXPECT_NE(
        errorOf(drawing("", group(0, "BLOCK") + group(2, "A"), 6)).find("a BLOCK without ENDBLK"),
        std::string::npos);
}

TEST(Dxf, CountsOfTheFileAreNotBelieved) {
    const auto with = [](const std::string& count) {
        return drawing(group(0, "LWPOLYLINE") + group(90, count) + group(70, 1) + group(10, 0) +
                           group(20, 0) + group(10, 4) + group(20, 0) + group(10, 4) + group(20, 3),
                       "", 6);
    };
    for (const char* count :
         {"3", "2147483647", "-1", "0", "-2147483648", "99999999999999999999", "x"})
        EXPECT_DOUBLE_EQ(areaOf(with(count)), 6) << count;
    EXPECT_NE(errorOf(drawing(group(0, "LWPOLYLINE") + group(90, 5), "", 6))
                  .find("no line to make a wall of"),
              std::string::npos);
}

TEST(Dxf, OutlinesThatCrossThemselvesCompile) {
    const std::string dxf =
        drawing(polyline("0", true,
                         {{0, 0}, {5.2, 0}, {4, 2}, {6, 2}, {4.8, 0}, {10, 0}, {10, 10}, {0, 10}}),
                "", 6);
    EXPECT_EQ(errorsOf([&] { EXPECT_GT(areaOf(dxf), 95); }), "no error") << textOf(dxf);
}

TEST(Dxf, ExtrusionsThatAreNearlyUpright) {
    std::string dxf = drawing(oldPolyline("W", true, {{1, 0}, {5, 0}, {5, 4}, {1, 4}}), "", 6);
    dxf.replace(dxf.find(group(70, "1")), group(70, "1").size(),
                group(70, "9") + group(210, 0.0001) + group(230, 1000));
    EXPECT_DOUBLE_EQ(areaOf(dxf), 16);
}

TEST(Dxf, FlagsOutOfRange) {
    for (const char* flags : {"-9223372036854775808", "-2147483648", "2147483648"})
        EXPECT_NE(errorOf(drawing(group(0, "LWPOLYLINE") + group(70, flags), "", 6))
                      .find("wanted a whole number"),
                  std::string::npos);
}

TEST(Dxf, LargeCirclesAreAMillimetreOff) {
    const double radius = 4000;
    const double area = std::numbers::pi * radius * radius;
    ImportOptions options;
    options.units = "m";
    EXPECT_NEAR(
        areaOf(drawing(arc("W", 0, 0, radius, 0, 180) + arc("W", 0, 0, radius, 180, 360), "", 6),
               options),
        area, 2 * std::numbers::pi * radius * 0.001);
}

TEST(Dxf, SimplifyOnRequest) {
    std::string plan = line("W", 10, 0, 10, 8) + line("W", 10, 8, 0, 8) + line("W", 0, 8, 0, 0);
    for (int i = 0; i < 100; ++i)
        plan += line("W", 0.1 * i, 0.002 * (i % 2), 0.1 * (i + 1), 0.002 * ((i + 1) % 2));
    // A wall that ends on the noisy one, and a door in that.
    plan += line("W", 4.05, 0.001, 4.05, 8) + line("D", 6.01, 0.001, 6.09, 0.001);
    ImportOptions options;
    options.door_layers = {"D"};
    const double exact = areaOf(drawing(plan, "", 6), options);
    options.simplify = 0.01;
    const Document document = read(drawing(plan, "", 6), options);
    std::size_t points = 0;
    for (const Record& record : document.records)
        if (record.keyword() == "fence") points += record.list("path").size();
    EXPECT_LT(points, 15U) << writeRecordText(document);
    EXPECT_NEAR(environmentOf(document).indoor().area(), exact, 0.02);
}

TEST(Dxf, SurvivesDamage) {
    ImportOptions options;
    options.door_layers = {"D*"};
    options.window_layers = {"G"};
    options.max_work.max = 3000;
    const std::string dxf =
        drawing(rectangle("W", 0, 0, 4, 3) + line("D1", 1, 0, 2, 0) + line("G", 1, 3, 2, 3) +
                    arc("D1", 4, 1, 1, 90, 180) +
                    insert("B", "W", 1, 1, group(70, 2) + group(71, 2) + group(44, 1)) +
                    oldPolyline("W", false, {{0, 0}, {1, 1, 0.5}, {2, 1}}) +
                    polyline("W", true, {{3, 1}, {3.5, 1, 0.3}, {3.5, 2}}),
                block("B", 0, 0, line("0", 0, 0, 0.3, 0.3) + arc("0", 0, 0, 0.2, 0, 90)), 6,
                layer("W", 7, 0));
    read(dxf, options);
    surviveDamage(
        dxf, [&](const std::string& bytes) { read(bytes, options); }, 3000);
}

TEST(Dxf, SameBytesTwice) {
    const std::string dxf =
        drawing(rectangle("W", 0, 0, 4, 3) + arc("W", 2, 1.5, 0.5, 0, 270), "", 6);
    EXPECT_EQ(textOf(dxf), textOf(dxf));
}

}  // namespace dxf_test
}  // namespace ispace::cad
