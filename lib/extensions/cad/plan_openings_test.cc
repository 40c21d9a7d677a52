// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/line_plan.h"

#include <cmath>
#include <numbers>

#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"
#include "support/test_work.h"

namespace ispace::cad {
namespace plan_openings_test {

using Lines = std::vector<Segment2>;

/// A wall along x with a gap of 0.9 m from x = 2.
Lines wallWithGap() { return {{{0, 0}, {2, 0}}, {{2.9, 0}, {6, 0}}}; }

PlanShape straight(Point2 a, Point2 b) { return {{{a, b}, false, 5}, {{{a, b}, {}}}, "D"}; }
PlanShape swing(Point2 hinge, Point2 a, Point2 b) {
    return {{{a, b}, false, 6}, {{{a, b}, hinge}}, "D"};
}

TEST(PlanOpenings, ALineAcrossAGap) {
    const auto found = findOpenings(std::vector{straight({2.03, 0.02}, {2.88, 0})}, {},
                                    wallWithGap(), ampleWork());
    ASSERT_EQ(found.openings.size(), 1U);
    EXPECT_EQ(found.openings[0].line, (Segment2{{2, 0}, {2.9, 0}}));
    EXPECT_FALSE(found.openings[0].wall);
    EXPECT_FALSE(found.openings[0].is_window);
    EXPECT_EQ(found.openings[0].drawn_on, 5);
    EXPECT_EQ(found.unused, 0U);
}

TEST(PlanOpenings, ALineAlongAWall) {
    const auto found = findOpenings({}, std::vector{straight({3.5, 0.01}, {4.5, -0.01})},
                                    wallWithGap(), ampleWork());
    ASSERT_EQ(found.openings.size(), 1U);
    EXPECT_EQ(found.openings[0].line, (Segment2{{3.5, 0}, {4.5, 0}}));
    EXPECT_EQ(found.openings[0].wall, 1U);
    EXPECT_TRUE(found.openings[0].is_window);
}

TEST(PlanOpenings, SwingsOpenFromTheHingeToTheWall) {
    // Hinged at the left end, drawn open upwards, with its leaf.
    const auto found =
        findOpenings(std::vector{swing({2, 0}, {2.9, 0}, {2, 0.9}), straight({2, 0}, {2, 0.9})}, {},
                     wallWithGap(), ampleWork());
    ASSERT_EQ(found.openings.size(), 1U);
    EXPECT_EQ(found.openings[0].line, (Segment2{{2, 0}, {2.9, 0}}));
    EXPECT_EQ(found.unused, 0U) << "the leaf is no line that spans nothing";
    // The leaf's end may be at a wall as well: it is still the leaf.
    Lines walls = wallWithGap();
    walls.push_back({{1, 0.9}, {2, 0.9}});
    const auto corner = findOpenings(
        std::vector{swing({2.9, 0}, {2.0, 0.02}, {2.9, 0.9}), straight({2.9, 0}, {2.9, 0.9})}, {},
        walls, ampleWork());
    ASSERT_EQ(corner.openings.size(), 1U);
    EXPECT_EQ(corner.openings[0].line, (Segment2{{2.9, 0}, {2, 0}}));
}

TEST(PlanOpenings, SwingsEndAtTheFacesOfThickWalls) {
    // A wall of 0.3 m, drawn by its middle.
    const std::vector<double> thickness{0.3, 0.3};
    const std::vector door{swing({2, 0.15}, {2.9, 0.15}, {2, 1.05})};
    const auto found = findOpenings(door, {}, wallWithGap(), ampleWork(), nullptr, thickness);
    ASSERT_EQ(found.openings.size(), 1U);
    EXPECT_EQ(found.openings[0].line, (Segment2{{2, 0}, {2.9, 0}}));
    EXPECT_TRUE(findOpenings(door, {}, wallWithGap(), ampleWork()).openings.empty());
}

TEST(PlanOpenings, DoubleDoors) {
    const auto found = findOpenings(
        std::vector{swing({2, 0}, {2.45, 0}, {2, 0.45}), swing({2.9, 0}, {2.9, 0.45}, {2.45, 0}),
                    straight({2, 0}, {2, 0.45})},
        {}, wallWithGap(), ampleWork());
    ASSERT_EQ(found.openings.size(), 1U);
    EXPECT_EQ(found.openings[0].line, (Segment2{{2, 0}, {2.9, 0}}));
    EXPECT_EQ(found.unused, 0U);
}

TEST(PlanOpenings, EachOnce) {
    // An arc, the threshold, and it again from the other side; a window in the same gap.
    const auto found =
        findOpenings(std::vector{swing({2, 0}, {2.9, 0}, {2, 0.9}), straight({2, 0}, {2.9, 0}),
                                 straight({2.9, 0}, {2, 0}), straight({3, 0}, {4, 0}),
                                 straight({3.5, 0}, {4.5, 0})},
                     std::vector{straight({2, 0}, {2.9, 0}), straight({4, 0}, {5, 0})},
                     wallWithGap(), ampleWork());
    ASSERT_EQ(found.openings.size(), 3U);
    EXPECT_EQ(found.openings[1].line, (Segment2{{3, 0}, {4, 0}}));
    EXPECT_TRUE(found.openings[2].is_window);
    EXPECT_EQ(found.openings[2].line, (Segment2{{4, 0}, {5, 0}}));
}

TEST(PlanOpenings, WhatSpansNothing) {
    const auto found = findOpenings(std::vector{straight({2, 0}, {2, 1}),    // into the air
                                                straight({2, 0}, {2.2, 0}),  // too short
                                                straight({2, 5}, {2.9, 5}),  // far away
                                                swing({10, 10}, {11, 10}, {10, 11})},
                                    {}, wallWithGap(), ampleWork());
    EXPECT_TRUE(found.openings.empty());
    EXPECT_EQ(found.unused, 4U);
    EXPECT_EQ(findOpenings(std::vector{straight({0, 0}, {1, 0})}, {}, Lines{}, ampleWork()).unused,
              1U);
}

/// A closed rectangle about the wall along x, `off` above and below it.
PlanShape across(double from, double to, double off) {
    const Point2 a{from, -off}, b{to, -off}, c{to, off}, d{from, off};
    return {{{a, b, c, d}, true, 7}, {{{a, b}, {}}, {{b, c}, {}}, {{c, d}, {}}, {{d, a}, {}}}, "D"};
}

TEST(PlanOpenings, RectanglesAcrossAWall) {
    for (const double off : {0.005, 0.02, 0.05, 0.1, 0.15, 0.3}) {
        const auto found =
            findOpenings({}, std::vector{across(3.5, 4.5, off)}, wallWithGap(), ampleWork());
        ASSERT_EQ(found.openings.size(), 1U) << off;
        const Segment2 line = found.openings[0].line;
        EXPECT_EQ(std::min(line.a.x, line.b.x), 3.5) << off;
        EXPECT_EQ(std::max(line.a.x, line.b.x), 4.5) << off;
        EXPECT_EQ(line.a.y, 0) << off;
        EXPECT_EQ(found.openings[0].wall, 1U);
        EXPECT_TRUE(found.lost.empty());
    }
    // Both lines of a wall.
    const Lines wall{{{0, 0}, {6, 0}}, {{0, 0.12}, {6, 0.12}}};
    EXPECT_EQ(findOpenings(std::vector{across(2, 3, 0.2)}, {}, wall, ampleWork()).openings.size(),
              2U);
    // A leaf beside a wall, a rectangle too deep, one across the wall's end.
    PlanShape leaf = across(3.5, 4.5, 0.02);
    for (Point2& p : leaf.path.points) p.y += 0.15;
    for (PlanChord& chord : leaf.chords)
        chord.line = {{chord.line.a.x, chord.line.a.y + 0.15},
                      {chord.line.b.x, chord.line.b.y + 0.15}};
    const auto none = findOpenings(std::vector{leaf, across(3.5, 5, 0.35), across(5.5, 6.5, 0.2)},
                                   {}, wallWithGap(), ampleWork());
    EXPECT_TRUE(none.openings.empty());
    ASSERT_EQ(none.lost.size(), 3U);
    EXPECT_EQ(none.lost[0].drawn_on, 7);
    EXPECT_NEAR(none.lost[0].at.y, 0.15, 1e-12);
}

TEST(PlanOpenings, PiecesTooNarrowStayShut) {
    // The part of a symbol 0.5 m wide that a wall fills, up to the wall's end.
    const auto opened = [](double filled) {
        const Lines wall{{{0, 0}, {2 + filled, 0}}};
        return findOpenings(std::vector{across(2, 2.5, 0.2)}, {}, wall, ampleWork());
    };
    EXPECT_EQ(opened(0.41).openings.size(), 1U);
    EXPECT_TRUE(opened(0.39).openings.empty());
    EXPECT_EQ(opened(0.39).lost.size(), 1U);
    const Lines pillar{{{2, 0}, {2.15, 0}}, {{2.15, 0.15}, {2, 0.15}}};
    EXPECT_TRUE(
        findOpenings(std::vector{across(1.9, 2.4, 0.3)}, {}, pillar, ampleWork()).openings.empty());
}

TEST(PlanOpenings, ManySymbolsInOnePlace) {
    std::vector<PlanShape> symbols;
    for (int i = 0; i < 20'000; ++i) {
        symbols.push_back(swing({10, 10}, {11, 10}, {10, 11}));
        symbols.push_back(straight({2, 0}, {2.9, 0}));
    }
    EXPECT_EQ(findOpenings(symbols, {}, wallWithGap(), ampleWork()).openings.size(), 1U);
}

/// Two rooms of 3 m x 3 m with a gap in the wall between them, one in the outer wall, a door
/// symbol and a window.
std::string flat() {
    return line("WALL", 0, 0, 6, 0) + line("WALL", 6, 0, 6, 3) + line("WALL", 6, 3, 5, 3) +
           line("WALL", 4, 3, 0, 3) + line("WALL", 0, 3, 0, 0) + line("WALL", 3, 0, 3, 1) +
           line("WALL", 3, 1.9, 3, 3) + insert("DOOR", "DOORS", 3, 1, group(50, 90)) +
           line("WINDOWS", 4, 3, 5, 3) + line("WINDOWS", 1, 0, 2, 0) + line("DOORS", 6, 1, 6, 2);
}
/// A leaf along y and its swing from x, hinged at the origin.
std::string doorBlock() {
    return block("DOOR", 0, 0, line("0", 0, 0, 0, 0.9) + arc("0", 0, 0, 0.9, 0, 90));
}
ImportOptions layers() {
    ImportOptions options;
    options.door_layers = {"DOOR*"};
    options.window_layers = {"win*"};
    return options;
}

TEST(PlanOpenings, OfADrawing) {
    const Document document =
        readDxf(drawing(flat(), doorBlock(), 6), "flat.dxf", layers(), sceneSchemas());
    EXPECT_EQ(writeRecordText(document),
              "#env 1\n"
              "fence id=f1 path=4,3;0,3;0,0;6,0;6,3;5,3\n"
              "fence path=3,0;3,1\n"
              "fence path=3,1.9;3,3\n"
              "wall id=gap from=3,1 to=3,1.9\n"
              "door wall=gap from=3,1 to=3,1.9 open=yes\n"
              "door wall=f1 from=6,1 to=6,2 open=yes\n"
              "wall id=gap-2 from=4,3 to=5,3\n"
              "window wall=gap-2 from=4,3 to=5,3\n"
              "window wall=f1 from=1,0 to=2,0\n"
              "inside at=1.5,1.5\n");
    EXPECT_NE(
        notesOf(document).find("kept the largest region, 18.0 m2 in 2 rooms\n2 doors, 2 windows\n"),
        std::string::npos)
        << notesOf(document);
}

TEST(PlanOpenings, AcrossWallsThatMeetInLine) {
    const auto text_of = [](const std::string& walls) {
        return writeRecordText(readDxf(
            drawing(rectangle("WALL", 0, 0, 8, 6) + walls + rectangle("DOORS", 3.8, 2, 4.2, 3), "",
                    6),
            "flat.dxf", layers(), sceneSchemas()));
    };
    const std::string wanted =
        "#env 1\n"
        "fence path=0,0;8,0;8,6;0,6 closed=yes\n"
        "fence id=f2 path=4,0;4,6\n"
        "door wall=f2 from=4,2 to=4,3 open=yes\n"
        "inside at=2,3\n";
    EXPECT_EQ(text_of(line("WALL", 4, 0, 4, 6)), wanted);
    EXPECT_EQ(text_of(line("WALL", 4, 0, 4, 2.5) + line("WALL", 4, 2.5, 4, 6)), wanted);
    EXPECT_EQ(text_of(line("WALL", 4, 0, 4, 2.5) + line("WALL", 4, 6, 4, 2.9) +
                      line("WALL", 4, 2.9, 4, 2.5)),
              wanted);
    EXPECT_EQ(text_of(polyline("WALL", false, {{4, 0}, {4, 2.5}, {4, 6}})), wanted);
    // A third wall that ends there.
    EXPECT_EQ(text_of(line("WALL", 4, 0, 4, 2.5) + line("WALL", 4, 2.5, 4, 6) +
                      line("WALL", 4, 2.5, 8, 2.5))
                  .find("door"),
              std::string::npos);
}

TEST(PlanOpenings, WarnsOfSymbolsThatOpenNoWall) {
    const std::string lost =
        line("DOORS", 2, 1, 2, 2) + line("WINDOWS", 1, 1, 2, 1) + line("DOORS", 5, 1, 5, 1.9);
    const Document document =
        readDxf(drawing(flat() + lost, doorBlock(), 6), "flat.dxf", layers(), sceneSchemas());
    ASSERT_EQ(document.warnings.size(), 2U);
    EXPECT_EQ(document.warnings[0].message,
              "2 shapes on the layer DOORS open no wall, the first at 2.00,1.50: doors and windows "
              "lie on a wall, or across it with sides at most 0.6 m apart");
    EXPECT_EQ(document.warnings[1].message,
              "1 shape on the layer WINDOWS opens no wall, at 1.50,1.00: doors and windows lie on "
              "a wall, or across it with sides at most 0.6 m apart");
}

TEST(PlanOpenings, WarnsOfLayersThatNoLineIsOn) {
    ImportOptions options = layers();
    options.wall_layers = {"WALL"};
    options.door_layers = {"DOOR*", "DORS"};
    options.window_layers = {"GLASS"};
    const auto warnings_of = [&](const std::string& dxf) {
        std::string text;
        for (const Diagnostic& warning : readDxf(dxf, "flat.dxf", options, sceneSchemas()).warnings)
            text += warning.message + '\n';
        return text;
    };
    const std::string seen = "layers with lines: DOORS (3), WALL (7), WINDOWS (2)\n";
    EXPECT_EQ(warnings_of(drawing(flat(), doorBlock(), 6)),
              "no line on the layers of --door-layer DORS; " + seen +
                  "no line on the layers of --window-layer GLASS; " + seen);
    options.door_layers.pop_back();
    options.window_layers = {"W*W*"};
    EXPECT_EQ(warnings_of(drawing(flat(), doorBlock(), 6)), "");
    EXPECT_NE(warnings_of(drawing(flat(), doorBlock(), 6, layer("WINDOWS", -7, 0)))
                  .find("--window-layer W*W*; layers with lines: DOORS (3), WALL (7); off or "
                        "frozen: WINDOWS (2)\n"),
              std::string::npos);
}

TEST(PlanOpenings, DrawingsCompile) {
    const auto area_of = [](const ImportOptions& options) {
        return environmentOf(
                   readDxf(drawing(flat(), doorBlock(), 6), "flat.dxf", options, sceneSchemas()))
            .indoor()
            .area();
    };
    EXPECT_NEAR(area_of(layers()), 18, 1e-9);
    ImportOptions low = layers();
    low.wall_height = 0.5;
    low.wall_thickness = 0.1;
    EXPECT_NEAR(area_of(low), 18, 1e-9);
}

TEST(PlanOpenings, LowWallsHaveLowOpenings) {
    ImportOptions options = layers();
    options.wall_height = 1;
    const Document document =
        readDxf(drawing(flat(), doorBlock(), 6), "flat.dxf", options, sceneSchemas());
    for (const Record& record : document.records) {
        if (record.keyword() == "door") {
            EXPECT_EQ(record.number("height"), 1);
        } else if (record.keyword() == "window") {
            EXPECT_LE(record.number("sill") + record.number("height"), 1);
        }
    }
}

}  // namespace plan_openings_test
}  // namespace ispace::cad
