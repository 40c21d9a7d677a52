// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <numbers>

#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "io/plan/line_plan.h"
#include "support/test_import.h"
#include "support/test_work.h"

namespace ispace::cad {
namespace drawn_doors_test {

Polygon arcOf(Point2 center, double radius, double from, double to, int pieces = 12) {
    Polygon points;
    for (int i = 0; i <= pieces; ++i) {
        const double angle = (from + (to - from) * i / pieces) * std::numbers::pi / 180;
        points.push_back(center + radius * Vec2{std::cos(angle), std::sin(angle)});
    }
    return points;
}

/// Among these and a wall far away.
std::size_t doorsIn(std::vector<PlanPath> walls) {
    walls.push_back({{{-30, 0}, {-20, 0}}, false, 9});
    return takeDrawnDoors(walls, ampleWork()).swings.size();
}

TEST(DrawnDoors, ALeafAndItsSwing) {
    const PlanPath wall{{{-3, 0}, {0, 0}}, false, 1};
    const DrawnDoors found = takeDrawnDoors(
        {wall, {{{0, 0}, {0, 0.9}}, false, 2}, {arcOf({0, 0}, 0.9, 0, 90), false, 3}}, ampleWork());
    ASSERT_EQ(found.swings.size(), 1U);
    EXPECT_EQ(found.walls, std::vector{wall});
    const PlanChord& chord = found.swings[0].chords.at(0);
    EXPECT_EQ(chord.center, (Point2{0, 0}));
    EXPECT_NEAR(distance(chord.line.a, Point2{0.9, 0}), 0, 1e-9) << "the closed door";
    EXPECT_NEAR(distance(chord.line.b, Point2{0, 0.9}), 0, 1e-9);
    EXPECT_EQ(found.swings[0].path.line, 3);
}

TEST(DrawnDoors, HoweverTheyAreDrawn) {
    const PlanPath swing{arcOf({0, 0}, 0.9, 0, 90), false, 1};
    // A thin leaf as an outline; in one path with the swing; as a sector.
    EXPECT_EQ(doorsIn({swing, {{{0, 0}, {0, 0.9}, {-0.05, 0.9}, {-0.05, 0}}, true, 2}}), 1U);
    const PlanPath wall{{{-3, 0}, {0, 0}}, false, 1};
    EXPECT_EQ(takeDrawnDoors({swing, {{{0, 0}, {0, 0.9}, {-0.05, 0.9}, {-0.05, 0}}, true, 2}, wall},
                             ampleWork())
                  .walls,
              std::vector{wall});
    Polygon one = swing.points;
    one.push_back({0, 0});
    EXPECT_EQ(doorsIn({{one, false, 1}}), 1U);
    EXPECT_EQ(doorsIn({{one, true, 1}}), 1U) << "with its threshold";
    // Hardly open, and about a point that is no hinge.
    EXPECT_EQ(doorsIn({{arcOf({0, 0}, 0.9, 0, 18, 3), false, 1},
                       {{{0, 0}, {0.92 * std::cos(0.28), 0.92 * std::sin(0.28)}}, false, 2}}),
              1U);
    EXPECT_EQ(
        doorsIn({{arcOf({0.35, 0}, 0.55, 0, 25, 4), false, 1}, {{{0, 0}, {0.84, 0.24}}, false, 2}}),
        1U);
    // Both leaves of a double door.
    EXPECT_EQ(doorsIn({swing,
                       {{{0, 0}, {0, 0.9}}, false, 2},
                       {arcOf({1.8, 0}, 0.9, 180, 90), false, 3},
                       {{{1.8, 0}, {1.8, 0.9}}, false, 4}}),
              2U);
}

TEST(DrawnDoors, WhatIsNone) {
    const PlanPath swing{arcOf({0, 0}, 0.9, 0, 90), false, 1};
    EXPECT_EQ(doorsIn({swing}), 0U) << "no leaf";
    EXPECT_TRUE(takeDrawnDoors({swing, {{{0, 0}, {0, 0.9}}, false, 2}}, ampleWork()).swings.empty())
        << "a drawing of a door alone";
    EXPECT_EQ(doorsIn({swing, {{{0, 0}, {0, 3}}, false, 2}}), 0U) << "a wall";
    EXPECT_EQ(doorsIn({swing, {{{0.4, 0.1}, {0.4, 0.9}}, false, 2}}), 0U) << "from no hinge";
    EXPECT_EQ(doorsIn({{arcOf({0, 0}, 0.9, 0, 180), false, 1}, {{{0, 0}, {0.9, 0}}, false, 2}}), 0U)
        << "half a table";
    EXPECT_EQ(doorsIn({{arcOf({0, 0}, 5, 0, 90, 60), false, 1}, {{{0, 0}, {5, 0}}, false, 2}}), 0U)
        << "a round wall";
    EXPECT_EQ(doorsIn({{{{0, 0}, {0.9, 0.1}, {1.8, 0}}, false, 1}, {{{0, 0}, {0, 1}}, false, 2}}),
              0U)
        << "a wall that bends";
}

TEST(DrawnDoors, AWallBesideTheSwingStays) {
    // The threshold ends at other walls, the leaf nowhere.
    const PlanPath threshold{{{0, 0}, {0.9, 0}}, false, 2}, wall{{{0.9, 0}, {4, 0}}, false, 3};
    const DrawnDoors found = takeDrawnDoors(
        {{arcOf({0, 0}, 0.9, 0, 90), false, 1}, threshold, wall, {{{0, 0}, {0, 0.9}}, false, 4}},
        ampleWork());
    EXPECT_EQ(found.walls, (std::vector{threshold, wall}));
}

/// Two rooms of 3 m x 3 m with a gap of 0.9 m in the wall between them.
std::string rooms() {
    return rectangle("0", 0, 0, 6, 3) + line("0", 3, 0, 3, 1) + line("0", 3, 1.9, 3, 3);
}
Document read(const std::string& entities, const std::string& blocks = "") {
    return readDxf(drawing(entities, blocks, 6), "flat.dxf", {}, sceneSchemas());
}

TEST(DrawnDoors, JoinTheRoomsOfDrawings) {
    // Into the left room; the sector about the hinge (3, 1) from the leaf to the latch.
    const std::string leaf = line("0", 3, 1, 2.1, 1), swing = arc("0", 3, 1, 0.9, 90, 180);
    for (const std::string& door :
         {leaf + swing,
          polyline("0", false, {{3, 1}, {2.1, 1, -std::tan(std::numbers::pi / 8)}, {3, 1.9}}),
          rectangle("0", 2.1, 1, 3, 0.95) + swing}) {
        const Document document = read(rooms() + door);
        EXPECT_EQ(countOf(document, "door"), 1U) << door;
        EXPECT_NEAR(environmentOf(document).indoor().area(), 18, 1e-9) << door;
        EXPECT_NE(
            notesOf(document).find("leaves and swings of 1 door among the walls close no room\n"),
            std::string::npos)
            << notesOf(document);
    }
    const std::string blocks = block("D", 0, 0, line("0", 0, 0, 0, 1) + arc("0", 0, 0, 1, 0, 90));
    const Document document = read(
        rooms() + insert("D", "0", 3, 1, group(50, 90) + group(41, 0.9) + group(42, 0.9)), blocks);
    EXPECT_EQ(countOf(document, "door"), 1U);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 18, 1e-9);
}

TEST(DrawnDoors, JambsMarkADoorwayWithoutALeaf) {
    // Five rooms of 3 m x 3 m; three doors with a leaf and jambs, and jambs alone.
    std::string plan = rectangle("0", 0, 0, 15, 3);
    for (const double x : {3.0, 6.0, 9.0, 12.0}) {
        plan += line("0", x, 0, x, 3) + line("0", x - 0.05, 1, x + 0.05, 1);
        if (x < 12) plan += line("0", x, 1, x - 0.9, 1) + arc("0", x, 1, 0.9, 90, 180);
        if (x < 12) plan += line("0", x - 0.05, 1.9, x + 0.05, 1.9);
    }
    EXPECT_NEAR(environmentOf(read(plan)).indoor().area(), 36, 1e-9) << "one jamb is no doorway";
    const Document document = read(plan + line("0", 11.95, 1.9, 12.05, 1.9));
    EXPECT_EQ(countOf(document, "door"), 4U);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 45, 1e-9);
    // Where doors have no jambs, short lines across a wall are no doorway.
    EXPECT_NEAR(environmentOf(read(rooms() + line("0", 3, 1, 2.1, 1) +
                                   arc("0", 3, 1, 0.9, 90, 180) + line("0", 4, 0, 4, 3) +
                                   line("0", 3.95, 1, 4.05, 1) + line("0", 3.95, 2, 4.05, 2)))
                    .indoor()
                    .area(),
                12, 1e-9);
}

TEST(DrawnDoors, OnWallsThatRunOn) {
    // The wall between the rooms has no gap; the swing ends a little beside it.
    const std::string walls = rectangle("0", 0, 0, 6, 3) + line("0", 3, 0, 3, 3);
    const Document document =
        read(walls + line("0", 3, 1, 2.2, 1.3) + arc("0", 3, 1, 0.86, 87, 160));
    EXPECT_EQ(countOf(document, "door"), 1U);
    EXPECT_NEAR(environmentOf(document).indoor().area(), 18, 1e-9);
    // The sides of a shower lie on walls: that is no door.
    const Document shower = read(walls + line("0", 0, 0, 0.9, 0) + line("0", 0, 0, 0, 0.9) +
                                 arc("0", 0, 0, 0.9, 0, 90));
    EXPECT_EQ(countOf(shower, "door"), 0U);
    EXPECT_NEAR(environmentOf(shower).indoor().area(), 9, 1e-9);
}

}  // namespace drawn_doors_test
}  // namespace ispace::cad
