// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "building/building_coverage.h"

namespace ispace {
namespace {

/// Two storeys; each has a door in its south wall, and only the lower one a camera before it.
BuildingScene houseWithDoors() {
    return makeBuildingScene(
        readBuilding("- storey: {id: g, height: 3, records: [{ispace: {size: 8 x 6, id: s}}, "
                     "{door: {id: front, wall: s, at: [0, -3], size: 1}}, "
                     "{zone: {id: hall, at: [0, 0], size: 2 x 2}}, "
                     "{camera: {id: c, at: [0, 2.5, 2.5], heading: -90, tilt: -30}}]}\n"
                     "- storey: {id: u, z: 3, records: [{ispace: {size: 8 x 6, id: s}}, "
                     "{door: {id: back, wall: s, at: [0, -3], size: 1}}]}\n",
                     "house.yaml", {}),
        {}, {});
}

std::string rulesIn(const BuildingScene& building, const std::string& text) {
    const BuildingCoverage coverage = measureBuilding(building, {});
    const FacingRule rule = parseFacing(text);
    std::string all;
    for (const JudgedRule& one :
         judgedInBuilding(building, measureBuildingFacing(building, coverage, {&rule, 1})))
        all += one.rule + (one.is_met ? " met\n" : " not met\n");
    return all;
}

TEST(BuildingFacing, IsByStoreyAndDoor) {
    const BuildingScene building = houseWithDoors();
    EXPECT_EQ(rulesIn(building, "door:*,1m,45deg=50%"),
              "g: facing door:front,1 within 45 degrees of 90 met\n"
              "u: facing door:back,1 within 45 degrees of 90 not met\n");
    EXPECT_EQ(rulesIn(building, "g/door:*=50%"),
              "g: facing door:front,1.5 within 45 degrees of 90 met\n");
    EXPECT_EQ(rulesIn(building, "g/hall,60deg,90=50%"),
              "g: facing hall within 60 degrees of 90 met\n");
}

TEST(BuildingFacing, UnknownDoorsListThoseOfAllStoreys) {
    const BuildingScene building = houseWithDoors();
    const auto message = [&](const std::string& text) {
        try {
            return rulesIn(building, text);
        } catch (const UsageError& error) {
            return std::string(error.what());
        }
    };
    EXPECT_EQ(message("u/door:front"),
              "--facing: `u/door:front,1.5` meets no door; the doors of the building: g/front "
              "(1.00 m), u/back (1.00 m)");
    EXPECT_EQ(message("lobby,45deg,0"),
              "--facing: `lobby` meets no zone; the zones of the building: g/hall");
    EXPECT_EQ(message("u/ba*,45deg,0"),
              "--facing: `u/ba*` meets no zone; doors have this name: u/door:ba*; the zones of the "
              "building: g/hall");
}

}  // namespace
}  // namespace ispace
