// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <string>

#include "extensions/camerarules/site_rules.h"

namespace ispace::camerarules {
namespace site_rules_test {

/// Two storeys; each has a door in its south wall, and only the lower one a camera before it.
SiteScene houseWithDoors() {
    return makeSiteScene(
        readBuilding("- storey: {id: g, height: 3, records: [{ispace: {size: 8 x 6, id: s}}, "
                     "{door: {id: front, wall: s, at: [0, -3], size: 1}}, "
                     "{zone: {id: hall, at: [0, 0], size: 2 x 2}}, "
                     "{camera: {id: c, at: [0, 2.5, 2.5], heading: -90, tilt: -30}}]}\n"
                     "- storey: {id: u, z: 3, records: [{ispace: {size: 8 x 6, id: s}}, "
                     "{door: {id: back, wall: s, at: [0, -3], size: 1}}]}\n",
                     "house.yaml", {}),
        {}, {});
}

std::string rulesIn(const SiteScene& building, const std::string& text) {
    const SiteCoverage coverage = measureSite(building, {});
    const FacingRule rule = parseFacing(text);
    std::string all;
    for (const JudgedRule& one :
         judgedInSite(building, measureSiteRules(building, coverage, {}, {&rule, 1}, {})))
        all += one.rule + (one.is_met ? " met\n" : " not met\n");
    return all;
}

std::string privacyIn(const SiteScene& building, const std::string& text) {
    const SiteCoverage coverage = measureSite(building, {});
    const PrivacyRule rule = parsePrivacy(text);
    std::string all;
    for (const JudgedRule& one :
         judgedInSite(building, measureSiteRules(building, coverage, {}, {}, {&rule, 1})))
        all += one.rule + ": " + one.finding + '\n';
    return all;
}

TEST(BuildingFacing, IsByStoreyAndDoor) {
    const SiteScene building = houseWithDoors();
    EXPECT_EQ(rulesIn(building, "door:*,1m,45deg=50%"),
              "g: facing door:front,1 within 45 degrees of 90 met\n"
              "u: facing door:back,1 within 45 degrees of 90 not met\n");
    EXPECT_EQ(rulesIn(building, "g/door:*=50%"),
              "g: facing door:front,1.5 within 45 degrees of 90 met\n");
    EXPECT_EQ(rulesIn(building, "g/hall,60deg,90=50%"),
              "g: facing hall within 60 degrees of 90 met\n");
}

TEST(BuildingPrivacy, IsThatOfTheRoomsAlone) {
    const SiteScene building = houseWithDoors();
    for (const char* const text : {"hall", "hall,90", "g/hall,400", "hall,4000"}) {
        std::string zone = text;
        if (zone.starts_with("g/")) zone.erase(0, 2);
        const PrivacyRule rule = parsePrivacy(zone);
        const std::vector<PrivacyResult> alone = measurePrivacy(*building.scenes[0], 0, {&rule, 1});
        ASSERT_EQ(alone.size(), 1U);
        const std::vector<PrivacyRule> rules{parsePrivacy(text)};
        const SiteCoverage coverage = measureSite(building, {});
        const std::vector<CameraRules> found = measureSiteRules(building, coverage, {}, {}, rules);
        ASSERT_EQ(found[0].privacy.size(), 1U) << text;
        EXPECT_TRUE(found[1].privacy.empty());
        EXPECT_NEAR(found[0].privacy[0].seen.value(), alone[0].seen.value(), 1e-9) << text;
        EXPECT_EQ(isMet(found[0].privacy[0]), isMet(alone[0]));
    }
    EXPECT_EQ(privacyIn(building, "hall"), "g: privacy of hall: 2.38 of 4.00 m2 is seen by g/c\n");
    EXPECT_EQ(privacyIn(building, "hall,4000"),
              "g: privacy of hall from 4000 pixels a metre: is kept\n");
}

TEST(BuildingPrivacy, CountsCamerasOfOtherStoreys) {
    // A shaft of 4 m x 4 m, over a zone below, and a camera on the upper floor at its rim.
    const SiteScene building = makeSiteScene(
        readBuilding("- storey: {id: g, height: 3, records: [{ispace: {size: 10 x 8}}, "
                     "{zone: {id: till, at: [0, 0], size: 1 x 1}}]}\n"
                     "- storey: {id: u, z: 3, height: 3, records: [{ispace: {size: 10 x 8}}, "
                     "{camera: {id: c, at: [-2.5, 0, 2.5], heading: 0, tilt: -60, fov: 90}}]}\n"
                     "- shaft: {storeys: 'g,u', path: '-2,-2;2,-2;2,2;-2,2'}\n",
                     "atrium.yaml", {}),
        {}, {});
    EXPECT_EQ(privacyIn(building, "till"), "g: privacy of till: 1.00 of 1.00 m2 is seen by u/c\n");
    EXPECT_EQ(privacyIn(building, "g/till,5000"),
              "g: privacy of till from 5000 pixels a metre: is kept\n");
}

TEST(BuildingPrivacy, UnknownZonesListThoseOfAllStoreys) {
    try {
        privacyIn(houseWithDoors(), "u/hall");
        ADD_FAILURE();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "--privacy: `u/hall` meets no zone; the zones of the building: g/hall");
    }
}

TEST(BuildingFacing, UnknownDoorsListThoseOfAllStoreys) {
    const SiteScene building = houseWithDoors();
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
    EXPECT_EQ(message("*/H*,45deg,0"),
              "--facing: `*/H*` meets no zone, did you mean `h*`?; the zones of the building: "
              "g/hall");
    EXPECT_EQ(message("u/ba*,45deg,0"),
              "--facing: `u/ba*` meets no zone; doors have this name: u/door:ba*; the zones of the "
              "building: g/hall");
}

}  // namespace site_rules_test
}  // namespace ispace::camerarules
