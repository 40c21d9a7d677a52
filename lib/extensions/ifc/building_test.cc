// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ifc/reader/building.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "extensions/ifc/ifc_import.h"
#include "extensions/ifc/reader/building_limits.h"
#include "extensions/ifc/reader/ifc_mesh.h"
#include "extensions/ifc/storey_plan.h"
#include "extensions/ifc/tests/test_ifc.h"
#include "geom/arrangement.h"
#include "support/test_damage.h"
#include "support/test_work.h"

namespace ispace::ifc {
namespace building_test {

Building cabin(const std::string& name) {
    return readBuilding(ifcBytes(name), std::nullopt, ampleWork());
}

class Cabins : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Schemas, Cabins,
                         ::testing::Values("cabin-2x3-mm.ifc", "cabin-4-feet.ifc"));

// The same house in IFC2x3 and millimetres, and in IFC4, feet, turned, on a hill, in no order.
TEST_P(Cabins, AreReadByTheirMeaning) {
    const Building building = cabin(GetParam());
    ASSERT_EQ(building.storeys.size(), 3U);
    const BuildingStorey& ground = building.storeys[1];
    EXPECT_EQ(ground.name, "Ground floor");
    EXPECT_EQ(ground.building, "House");
    EXPECT_EQ(ground.walls, 5U);
    EXPECT_EQ(ground.doors, 2U);
    EXPECT_EQ(ground.windows, 1U);
    EXPECT_NEAR(ground.elevation - building.storeys[0].elevation, 1, 1e-6);
    ASSERT_EQ(building.spaces.size(), 2U);
    EXPECT_EQ(building.spaces[0].number, "1");
    EXPECT_EQ(building.spaces[0].name, "Küche");
    EXPECT_EQ(building.spaces[0].storey, 1U);
    EXPECT_NEAR(areaOfSection(building.spaces[0].outline), 14.8, 1e-5);
    EXPECT_NEAR(areaOfSection(building.spaces[1].outline), 8.8, 1e-5);
    ASSERT_EQ(building.spaces[1].areas.size(), 1U);
    EXPECT_EQ(building.spaces[1].areas[0].name, "NetFloorArea");
    EXPECT_NEAR(building.spaces[1].areas[0].area, 7, 1e-9);
    EXPECT_TRUE(building.unread.empty());
}

TEST_P(Cabins, HaveRoomsBetweenTheirWalls) {
    const Building building = cabin(GetParam());
    const StoreyWalls walls = wallsOf(building, 1, ampleWork());
    ASSERT_EQ(walls.solids.size(), 1U);
    ASSERT_EQ(walls.solids[0].outline.size(), 4U);
    ASSERT_EQ(walls.solids[0].holes.size(), 2U);
    EXPECT_NEAR(-signedArea(walls.solids[0].holes[0]) - signedArea(walls.solids[0].holes[1]), 23.6,
                1e-4);
    EXPECT_NEAR(walls.top - building.storeys[1].elevation, 2.8, 1e-6);
    ASSERT_EQ(walls.columns.size(), 1U);
    EXPECT_TRUE(walls.columns[0].is_round);
    const WallFaces faces(walls, ampleWork());
    ASSERT_EQ(building.openings.size(), 4U);
    for (const BuildingOpening& opening : building.openings) {
        EXPECT_TRUE(opening.has_hole);
        const auto found = faces.find(opening.box, true);
        ASSERT_TRUE(found);
        EXPECT_TRUE(found->curve);
        // All are wider than their walls are thick; of the hatch the file does not say along which.
        const auto [depth, width] = std::minmax({opening.box.length, opening.box.width});
        EXPECT_NEAR(distance(found->line.a, found->line.b), width, 1e-5);
        EXPECT_NEAR(found->depth, depth, 1e-5);
        EXPECT_EQ(found->others.size(), 1U);
        EXPECT_EQ(found->reveals().size(), 2U);
    }
}

TEST(WallFaces, GapsAndWallsWithoutHoles) {
    StoreyWalls walls;
    walls.solids = {{{{0, 0}, {2, 0}, {2, 0.2}, {0, 0.2}}, {}},
                    {{{3, 0}, {6, 0}, {6, 0.2}, {3, 0.2}}, {}}};
    const WallFaces faces(walls, ampleWork());
    const auto box = [](double x, double y, Vec2 along) {
        BuildingBox box;
        box.center = {x, y};
        box.along = along;
        box.length = 0.9;
        box.width = 0.06;
        box.top = 2;
        return box;
    };
    // Across the gap, to the ends of the walls.
    const auto gap = faces.find(box(2.5, 0.1, {1, 0}), false);
    ASSERT_TRUE(gap);
    EXPECT_FALSE(gap->curve);
    EXPECT_NEAR(distance(gap->line.a, gap->line.b), 1, 1e-9);
    // A door's body alone, in a wall; its axis may lie across, too.
    for (const Vec2 along : {Vec2{1, 0}, Vec2{0, 1}}) {
        BuildingBox leaf = box(4.5, 0.1, along);
        if (along.y == 1) std::swap(leaf.length, leaf.width);
        const auto in_wall = faces.find(leaf, false);
        ASSERT_TRUE(in_wall);
        EXPECT_TRUE(in_wall->curve);
        EXPECT_NEAR(in_wall->depth, 0.2, 1e-9);
    }
    // Off all walls a pane is a wall itself, a hole is none.
    const auto pane = faces.find(box(4.5, 3, {1, 0}), false);
    ASSERT_TRUE(pane);
    EXPECT_FALSE(pane->curve);
    EXPECT_NEAR(distance(pane->line.a, pane->line.b), 0.9, 1e-9);
    EXPECT_FALSE(faces.find(box(4.5, 3, {1, 0}), true));
}

TEST(StoreyWalls, NichesKeepTheirSize) {
    const auto area_without = [](Vec2 along, double length, double width, Point2 center) {
        StoreyWalls walls;
        walls.solids = {{{{0, 0}, {4, 0}, {4, 0.2}, {0, 0.2}}, {}}};
        BuildingBox hole;
        hole.center = center;
        hole.along = along;
        hole.length = length;
        hole.width = width;
        carve(walls, {&hole, 1});
        return Regions{walls.solids}.area();
    };
    // 1 m long and 0.1 m deep, out of one face.
    EXPECT_NEAR(area_without({1, 0}, 1, 0.2, {2, 0}), 0.7, 1e-9);
    EXPECT_NEAR(area_without({0, 1}, 0.2, 1, {2, 0}), 0.7, 1e-9);
    // Through the wall, 1 cm short of both faces.
    EXPECT_NEAR(area_without({1, 0}, 1, 0.18, {2, 0.1}), 0.6, 1e-9);
}

/// A wall of a storey at 0, cut at 1 m.
BuildingWall wallOn(double from_x, double from_y, double to_x, double to_y, double top,
                    double bottom = 0) {
    BuildingWall wall;
    wall.is_inside = true;
    wall.section.parts = {{{{{from_x, from_y}, {to_x, from_y}, {to_x, to_y}, {from_x, to_y}}}, {}}};
    wall.box.center = {(from_x + to_x) / 2, (from_y + to_y) / 2};
    wall.box.length = to_x - from_x;
    wall.box.width = to_y - from_y;
    wall.box.bottom = bottom;
    wall.box.top = top;
    return wall;
}

TEST(StoreyWalls, KeepTheirHeights) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 4, 0, 0}, {"upper", "", 3, 4, 0, 0, 0}};
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7), wallOn(0, 0.2, 0.2, 6, 3.1),
                      wallOn(0.2, 3, 4, 3.1, 1.2), wallOn(6, 3, 6.2, 4, 5)};
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    EXPECT_EQ(walls.top, 2.7);
    // The first two meet; the outer one is higher by the slab. The partition ends at them.
    ASSERT_EQ(walls.solids.size(), 3U);
    EXPECT_NEAR(walls.solids[0].area(), 8 * 0.2 + 0.2 * 5.8, 1e-6);
    EXPECT_EQ(walls.topOf(0), 2.7);
    EXPECT_EQ(walls.topOf(1), 2.7);  // up to the next floor
    EXPECT_EQ(walls.topOf(2), 1.2);
    EXPECT_NEAR(walls.solids[2].area(), 3.8 * 0.1, 1e-6);
}

TEST(StoreyWalls, GablesEndWithMost) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 4, 0, 0}};
    building.walls = {wallOn(0, 0, 10, 0.2, 3), wallOn(0, 4.8, 10, 5, 3),
                      wallOn(0, 0.2, 0.2, 4.8, 5.5), wallOn(9.8, 0.2, 10, 4.8, 5.5)};
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    EXPECT_EQ(walls.top, 3);
    ASSERT_EQ(walls.solids.size(), 1U);
    EXPECT_EQ(walls.topOf(0), 3);
}

TEST(StoreyWalls, OfOtherStoreysGiveTheHeightWhereItsOwnAreLow) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 4, 0, 0}};
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7), wallOn(2, 2, 5, 2.1, 1.2)};
    building.walls[0].is_inside = false;
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    EXPECT_EQ(walls.top, 2.7);
    ASSERT_EQ(walls.solids.size(), 2U);
    EXPECT_EQ(walls.topOf(0), 2.7);
    EXPECT_EQ(walls.topOf(1), 1.2);
}

TEST(StoreyWalls, MeetThoughOneIsLower) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 2, 0, 0}};
    // They overlap, and a corner between them gets the height of the higher one.
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7), wallOn(2, 0.1, 2.1, 3, 1.2)};
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    ASSERT_EQ(walls.solids.size(), 2U);
    EXPECT_NEAR(walls.solids[0].area(), 1.6, 1e-6);
    EXPECT_NEAR(walls.solids[1].area(), 0.28, 1e-6);
    EXPECT_EQ(walls.topOf(1), 1.2);
}

TEST(StoreyWalls, HangingWallsThatTouchNoOtherLeaveTheFloor) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 2, 0, 0}};
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7), wallOn(2, 2, 5, 2.2, 2, 0.9),
                      wallOn(2, 0.2, 2.2, 1, 2.7, 0.9)};
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    ASSERT_EQ(walls.raised.size(), 1U);
    EXPECT_EQ(walls.raised[0].length, 3);
    ASSERT_EQ(walls.solids.size(), 1U);
    EXPECT_NEAR(walls.solids[0].area(), 1.6 + 0.16, 1e-6);
}

TEST(StoreyWalls, HangingWallsThatTouchEachOtherAreWalls) {
    Building building;
    building.storeys = {{"g", "", 0, 1, 4, 0, 0}};
    // The storey lies 0.45 m below the feet of all walls.
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7, 0.45), wallOn(0, 5.8, 8, 6, 2.7, 0.45),
                      wallOn(0, 0.2, 0.2, 5.8, 2.7, 0.45), wallOn(7.8, 0.2, 8, 5.8, 2.7, 0.45)};
    const StoreyWalls ring = wallsOf(building, 0, ampleWork());
    EXPECT_TRUE(ring.raised.empty());
    ASSERT_EQ(ring.solids.size(), 1U);
    ASSERT_EQ(ring.solids[0].holes.size(), 1U);
    EXPECT_NEAR(ring.solids[0].area(), 8 * 6 - 7.6 * 5.6, 1e-6);
    EXPECT_EQ(ring.top, 2.7);
    EXPECT_EQ(ring.topOf(0), 2.7);
    // Copies of one wall touch each other, too, but are one. A column at it stands free.
    building.walls = {wallOn(0, 0, 8, 0.2, 2.7), wallOn(2, 2, 5, 2.2, 2, 0.9),
                      wallOn(2, 2, 5, 2.2, 2, 0.9), wallOn(5, 2, 5.2, 2.2, 2)};
    building.walls.back().is_column = true;
    const StoreyWalls copies = wallsOf(building, 0, ampleWork());
    EXPECT_EQ(copies.raised.size(), 1U);
    EXPECT_EQ(copies.columns.size(), 1U);
    EXPECT_EQ(copies.solids.size(), 1U);
}

TEST(StoreyWalls, CornersOfThinWallsAreNotBent) {
    // Walls of 5 mm that meet at 45 degrees, with the piece of their mitre.
    const double h = 0.0025, d = h * std::sqrt(0.5);
    Building building;
    building.storeys = {{"g", "", 0, 1, 2, 0, 0}};
    BuildingWall level = wallOn(0, -h, 2, h, 2.5), slope = level, mitre = level;
    slope.section.parts[0].curves = {{{d, -d}, {-d, d}, {-1 - d, -1 + d}, {-1 + d, -1 - d}}};
    mitre.section.parts[0].curves = {{{0, 0}, {0, h}, {-h * (std::sqrt(2) - 1), h}, {-d, d}}};
    building.walls = {level, mitre, slope};
    const StoreyWalls walls = wallsOf(building, 0, ampleWork());
    ASSERT_EQ(walls.solids.size(), 1U);
    EXPECT_EQ(walls.solids[0].outline.size(), 6U);
    EXPECT_NEAR(walls.solids[0].area(), (2 + std::sqrt(2)) * 2 * h, 1e-5);
}

TEST(Building, BrokenPartsAreCounted) {
    const Building building = cabin("broken-4-m.ifc");
    EXPECT_EQ(building.spaces.size(), 2U);
    EXPECT_EQ(building.storeys[1].walls, 5U);
    std::string unread;
    for (const auto& [type, count] : unreadKinds(building))
        unread += type + ' ' + std::to_string(count) + '\n';
    EXPECT_EQ(unread,
              "IFCSWEPTDISKSOLID 1\nIFCWALL without a body 1\na missing instance 1\n"
              "a number that is missing 1\n"
              "curves in a loop 1\nplacements in a loop 1\nshapes in a loop 2\n");
}

/// A building of a storey `g`, in whose placement (#13) these products are.
std::string oneStorey(const std::string& data, const std::string& contained) {
    return ifcWith(
        "#10=IFCCARTESIANPOINT((0.,0.,0.));\n#11=IFCDIRECTION((0.,0.,1.));\n"
        "#12=IFCAXIS2PLACEMENT3D(#10,$,$);\n#13=IFCLOCALPLACEMENT($,#12);\n"
        "#14=IFCBUILDINGSTOREY('g',$,'g',$,$,#13,$,$,.ELEMENT.,0.);\n"
        "#15=IFCRELCONTAINEDINSPATIALSTRUCTURE('r',$,$,$,(" +
        contained +
        "),#14);\n"
        "#16=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,5.4,0.2);\n"
        "#17=IFCEXTRUDEDAREASOLID(#16,#12,#11,2.5);\n"
        "#18=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#17));\n"
        "#19=IFCPRODUCTDEFINITIONSHAPE($,$,(#18));\n" +
        data);
}

TEST(Building, PartsOfWallsAreWallsWhateverTheirClass) {
    for (const char* type : {"IFCMEMBER", "IFCCOLUMN", "IFCBUILDINGELEMENTPROXY", "IFCCOVERING",
                             "IFCBUILDINGELEMENTPART"}) {
        const Building building = readBuilding(
            oneStorey("#30=IFCWALL('w',$,'w',$,$,#13,$,$,$);\n#31=" + std::string(type) +
                          "('m',$,'m',$,$,#13,#19,$,$);\n"
                          "#32=IFCRELAGGREGATES('a',$,$,$,#30,(#31));\n",
                      "#30"),
            std::nullopt, ampleWork());
        ASSERT_EQ(building.walls.size(), 1U) << type;
        EXPECT_FALSE(building.walls[0].is_column) << type;
        EXPECT_TRUE(building.things.empty()) << type;
        EXPECT_TRUE(building.unread.empty()) << type;
    }
    // Alone, a long member is a brace.
    EXPECT_TRUE(readBuilding(oneStorey("#31=IFCMEMBER('m',$,'m',$,$,#13,#19,$,$);\n", "#31"),
                             std::nullopt, ampleWork())
                    .walls.empty());
}

TEST(Building, WallsWithoutABodyAreCounted) {
    const Building building = readBuilding(
        oneStorey("#30=IFCWALL('w',$,'w',$,$,#13,$,$,$);\n", "#30"), std::nullopt, ampleWork());
    ASSERT_EQ(building.unread.size(), 1U);
    EXPECT_EQ(building.unread.front().kind, "IFCWALL without a body");
}

TEST(Building, WallsBelowTheCutAreThings) {
    std::string data = oneStorey("#30=IFCWALL('w',$,'low',$,$,#13,#19,$,$);\n", "#30");
    data.replace(data.find("#11,2.5)"), 8, "#11,0.9)");
    const Building low = readBuilding(data, std::nullopt, ampleWork());
    EXPECT_TRUE(low.walls.empty());
    ASSERT_EQ(low.things.size(), 1U);
    EXPECT_TRUE(low.things[0].is_low_wall);
    EXPECT_FALSE(low.things[0].is_bent);
    EXPECT_NEAR(low.things[0].boxes.at(0).top, 0.9, 1e-9);
    EXPECT_EQ(readBuilding(data, 0.5, ampleWork()).walls.size(), 1U);
    const std::string profile = "IFCRECTANGLEPROFILEDEF(.AREA.,$,$,5.4,0.2)";
    data.replace(data.find(profile), profile.size(), "IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#50)");
    data.insert(data.find("#30="),
                "#50=IFCPOLYLINE((#51,#52,#53,#54,#55,#56,#51));\n"
                "#51=IFCCARTESIANPOINT((0.,0.));\n#52=IFCCARTESIANPOINT((4.,0.));\n"
                "#53=IFCCARTESIANPOINT((4.,0.2));\n#54=IFCCARTESIANPOINT((0.2,0.2));\n"
                "#55=IFCCARTESIANPOINT((0.2,3.));\n#56=IFCCARTESIANPOINT((0.,3.));\n");
    const Building bent = readBuilding(data, std::nullopt, ampleWork());
    ASSERT_EQ(bent.things.size(), 1U);
    EXPECT_TRUE(bent.things[0].is_bent);
}

TEST(Building, WallsEndWhereThoseOnThemEnd) {
    const auto top_with = [](const std::string& upper, const char* ids) {
        const Building building = readBuilding(
            oneStorey("#40=IFCEXTRUDEDAREASOLID(#16,#12,#11,1.2);\n"
                      "#41=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#40));\n"
                      "#42=IFCPRODUCTDEFINITIONSHAPE($,$,(#41));\n"
                      "#43=IFCCARTESIANPOINT((0.,0.,1.2));\n#44=IFCAXIS2PLACEMENT3D(#43,$,$);\n"
                      "#45=IFCLOCALPLACEMENT(#13,#44);\n"
                      "#30=IFCWALL('w',$,'w',$,$,#13,#42,$,$);\n" +
                          upper,
                      ids),
            std::nullopt, ampleWork());
        return building.walls.at(0).box.top;
    };
    EXPECT_NEAR(top_with("", "#30"), 1.2, 1e-9);
    EXPECT_NEAR(top_with("#31=IFCWALL('u',$,'u',$,$,#45,#42,$,$);\n", "#30,#31"), 2.4, 1e-9);
    EXPECT_NEAR(top_with("#31=IFCWINDOW('u',$,'u',$,$,#45,#42,$,1.2,5.4);\n", "#30,#31"), 2.4,
                1e-9);
}

TEST(Building, SolidsWithoutFacesAreCounted) {
    const Building building =
        readBuilding(oneStorey("#30=IFCWALL('w',$,'north:1',$,$,#13,#90,$,$);\n"
                               "#90=IFCPRODUCTDEFINITIONSHAPE($,$,(#91));\n"
                               "#91=IFCSHAPEREPRESENTATION($,'Body','AdvancedBrep',(#92));\n"
                               "#92=IFCADVANCEDBREP($);\n",
                               "#30"),
                     std::nullopt, ampleWork());
    ASSERT_EQ(building.unread.size(), 1U);
    EXPECT_EQ(building.unread.front().kind, "IFCADVANCEDBREP without faces");
    EXPECT_EQ(building.unread.front().owner, "IFCWALL north");
    EXPECT_EQ(building.unread.front().storey, 0U);
}

TEST(Building, ASpaceWithPartialPartsIsASpace) {
    const auto spaces = [](const char* shape, const char* kind) {
        return readBuilding(oneStorey("#30=IFCSPACE('w',$,'w',$,$,#13," + std::string(shape) +
                                          ",$,.ELEMENT.,.INTERNAL.,0.);\n"
                                          "#31=IFCSPACE('p',$,'p',$,$,#13,#19,$," +
                                          kind +
                                          ",.INTERNAL.,0.);\n"
                                          "#32=IFCRELAGGREGATES('a',$,$,$,#30,(#31));\n",
                                      "#40"),
                            std::nullopt, ampleWork())
            .spaces;
    };
    const auto both = spaces("#19", ".PARTIAL.");
    ASSERT_EQ(both.size(), 2U);
    EXPECT_FALSE(both[0].is_part);
    EXPECT_TRUE(both[1].is_part);
    // Of a whole that is divided into spaces only these remain.
    EXPECT_EQ(spaces("#19", ".ELEMENT.").size(), 1U);
    const auto alone = spaces("$", ".PARTIAL.");
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_FALSE(alone[0].is_part);
}

TEST(Building, TheGroundFloorIsReadByDefault) {
    Building building;
    building.storeys = {{"cellar", "", -2.8, -1.8, 4, 2, 0},
                        {"ground", "", 0, 1, 4, 2, 0},
                        {"upper", "", 2.8, 3.8, 4, 2, 0}};
    EXPECT_EQ(chosenStorey(building, {}), 1U);
    building.storeys[1].doors = 0;
    EXPECT_EQ(chosenStorey(building, {}), 0U);
}

// A wall whose placement is missing does not stand in the origin.
TEST(Building, MissingPlacementsAndShapesAreCounted) {
    const std::string whole = ifcBytes("broken-4-m.ifc");
    const std::size_t walls = readBuilding(whole, std::nullopt, ampleWork()).walls.size();
    const std::string south = "'south',$,$,#34,#43";
    const auto unread_with = [&](const std::string& references, const char* what) {
        std::string bytes = whole;
        bytes.replace(bytes.find(south), south.size(), "'south',$,$," + references);
        const Building building = readBuilding(bytes, std::nullopt, ampleWork());
        EXPECT_LT(building.walls.size(), walls) << references;
        return unreadKinds(building)[what];
    };
    EXPECT_EQ(unread_with("#9999,#43", "a missing placement"), 1U);
    EXPECT_EQ(unread_with("#34,#9999", "a missing shape"), 1U);
    EXPECT_EQ(unread_with("#3,#43", "IFCSIUNIT"), 1U);
}

TEST(Building, WithoutStoreysItsDoorsStandOnTheFloor) {
    std::string bytes = ifcBytes("cabin-2x3-mm.ifc");
    for (std::size_t at = 0; (at = bytes.find("IFCBUILDINGSTOREY", at)) != std::string::npos;)
        bytes.replace(at, 17, "IFCZONEOFANYKINDX");
    const Building building = readBuilding(bytes, std::nullopt, ampleWork());
    ASSERT_EQ(building.storeys.size(), 1U);
    EXPECT_NEAR(building.storeys[0].elevation, 0, 1e-9);
    EXPECT_EQ(wallsOf(building, 0, ampleWork()).solids.size(), 1U);
    EXPECT_THROW(readBuilding("ISO-10303-21;", std::nullopt, ampleWork()), std::runtime_error);
}

TEST(Building, WallsOfTheSiteDoNotLowerAStorey) {
    Building building = cabin("cabin-2x3-mm.ifc");
    const auto wall = std::find_if(
        building.walls.begin(), building.walls.end(),
        [](const BuildingWall& w) { return w.storey == 1 && !w.is_column && w.is_inside; });
    ASSERT_NE(wall, building.walls.end());
    BuildingWall fence = *wall;
    fence.is_inside = false;
    fence.box.length = 1000;
    fence.box.top = building.storeys[1].elevation + 1.2;
    building.walls.push_back(fence);
    EXPECT_NEAR(wallsOf(building, 1, ampleWork()).top - building.storeys[1].elevation, 2.8, 1e-6);
    // A file that says of no wall where it belongs.
    std::erase_if(building.walls, [](const BuildingWall& w) { return w.is_inside; });
    EXPECT_NEAR(wallsOf(building, 1, ampleWork()).top - building.storeys[1].elevation, 1.2, 1e-6);
}

TEST(Building, SliceTakesTheStoreyBelow) {
    const Building building = readBuilding(ifcBytes("cabin-2x3-mm.ifc"), 0.2, ampleWork());
    EXPECT_EQ(building.storeys[1].cut, 0.2);
    EXPECT_EQ(building.storeys[2].cut, 4);
}

TEST(Building, DamageIsSurvived) {
    for (const char* name : {"cabin-2x3-mm.ifc", "cabin-4-feet.ifc", "broken-4-m.ifc"})
        surviveDamage(
            ifcBytes(name).substr(0, 4000),
            [](const std::string& bytes) {
                try {
                    (void)unpackedBuilding(
                        packedBuilding(readBuilding(bytes, std::nullopt, ampleWork())));
                } catch (const std::runtime_error&) {
                }
            },
            0);
    std::mt19937_64 random(7);
    const std::string good = ifcBytes("broken-4-m.ifc");
    for (int round = 0; round < 300; ++round) {
        std::string bytes = good;
        for (int n = 0; n < 4; ++n) {
            // References and numbers that mean something else, and signs.
            const std::size_t at = bytes.find_first_of("#0123456789.(,", random() % bytes.size());
            if (at == std::string::npos) continue;
            bytes[at] = "#0123456789.()$,'E-"[random() % 19];
        }
        try {
            const Building building = readBuilding(bytes, std::nullopt, ampleWork());
            (void)unpackedBuilding(packedBuilding(building));
            for (std::size_t i = 0; i < building.storeys.size(); ++i)
                (void)wallsOf(building, i, ampleWork());
        } catch (const std::runtime_error&) {
        }
    }
}

TEST(IfcMesh, HasProductsWithoutSpacesAndHoles) {
    const TriangleMesh mesh = ifcMesh(ifcBytes("cabin-2x3-mm.ifc"), ampleWork());
    std::array<float, 3> low = mesh.vertices.at(0), high = low;
    for (const auto& vertex : mesh.vertices)
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::min(low[i], vertex[i]);
            high[i] = std::max(high[i], vertex[i]);
        }
    EXPECT_EQ(low, (std::array<float, 3>{0, 0, -1}));
    EXPECT_EQ(high, (std::array<float, 3>{6.6F, 4.6F, 5.5F}));
    // Of 12 triangles each 7 walls and a table, and a post.
    EXPECT_GT(mesh.triangles.size(), 8U * 12);
    EXPECT_LT(mesh.triangles.size(), 8U * 12 + 1000);
    EXPECT_TRUE(ifcMesh("ISO-10303-21;", ampleWork()).triangles.empty());
}

TEST(BuildingLimits, AllowMoreTimeThanMeshes) {
    EXPECT_GT(buildingLimits(0).seconds, meshLimits(0).seconds);
    EXPECT_LT(buildingLimits(SIZE_MAX).seconds, 6 * 3600U);
}

TEST(Building, PackedIsNotTrusted) {
    const std::string good = packedBuilding(cabin("cabin-2x3-mm.ifc"));
    const Building again = unpackedBuilding(good);
    EXPECT_EQ(packedBuilding(again), good);
    for (std::size_t i = 0; i < good.size(); i += 7)
        EXPECT_THROW(unpackedBuilding(good.substr(0, i)), std::runtime_error) << i;
    EXPECT_THROW(unpackedBuilding(good + '\0'), std::runtime_error);
    Building wrong = again;
    wrong.walls[0].storey = 3;
    EXPECT_THROW(unpackedBuilding(packedBuilding(wrong)), std::runtime_error);
    wrong = again;
    wrong.spaces[0].storey = 3;
    EXPECT_THROW(unpackedBuilding(packedBuilding(wrong)), std::runtime_error);
    wrong = again;
    wrong.openings[0].box.width = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(unpackedBuilding(packedBuilding(wrong)), std::runtime_error);
    wrong = again;
    wrong.openings[0].kind = static_cast<BuildingOpening::Kind>(9);
    EXPECT_THROW(unpackedBuilding(packedBuilding(wrong)), std::runtime_error);
    wrong = again;
    wrong.openings[0].pane = static_cast<BuildingOpening::Pane>(9);
    EXPECT_THROW(unpackedBuilding(packedBuilding(wrong)), std::runtime_error);
    // Counts that would take all memory.
    for (std::size_t at = 0; at + 8 <= good.size(); at += 3) {
        std::string bytes = good;
        std::memset(&bytes[at], 0xff, 8);
        try {
            (void)unpackedBuilding(bytes);
        } catch (const std::runtime_error&) {
        }
    }
}

}  // namespace building_test
}  // namespace ispace::ifc
