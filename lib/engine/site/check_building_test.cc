// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "site/site_scene.h"
#include "site/storeys.h"

namespace ispace {
namespace check_building_test {

constexpr const char* kRoom =
    "{fence: {id: f, path: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes}}";

/// A building in YAML of two storeys of one room, with more records.
std::string twoStoreys(const std::string& more = "", double z = 3) {
    return "- storey: {id: ground, height: 3, records: &room [" + std::string(kRoom) + "]}\n" +
           "- storey: {id: upper, z: " + std::to_string(z) + ", height: 2.5, records: *room}\n" +
           more;
}

StoreyedDocument buildingOf(const std::string& text) {
    return readBuilding(text, "house.yaml", {});
}

std::vector<std::string> findingsIn(const std::string& text) {
    std::vector<std::string> messages;
    for (const Diagnostic& finding : checkBuilding(makeSiteScene(buildingOf(text), {}, {})))
        messages.push_back(finding.message);
    return messages;
}

/// Returns the number of findings of two storeys around a courtyard, with a shaft.
std::size_t findingsAtCourtyard(const std::string& path) {
    const std::string room =
        "records: [{fence: {path: [[0, 0], [8, 0], [8, 8], [0, 8]], closed: yes}}, {fence: {path: "
        "[[2, 2], [6, 2], [6, 6], [2, 6]], closed: yes}}, {inside: {at: [1, 1]}}]}\n";
    const std::string building = "- storey: {id: a, " + room + "- storey: {id: b, z: 3, " + room +
                                 "- shaft: {storeys: 'a,b', path: " + path + "}\n";
    return findingsIn(building).size();
}

TEST(BuildingCheck, FindsShaftsInCourtyards) {
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [5, 3], [5, 5], [3, 5]]"), 2U) << "of both storeys";
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [3, 5], [5, 5], [5, 3]]"), 2U) << "clockwise";
    EXPECT_EQ(findingsAtCourtyard("[[3, 3], [7, 3], [7, 5], [3, 5]]"), 0U) << "in part";
    EXPECT_EQ(findingsAtCourtyard("[[1, 1], [7, 1], [7, 7], [1, 7]]"), 0U) << "around it";
}

TEST(BuildingCheck, FindsStairsThatEndInWalls) {
    const auto stairs = [](const std::string& keys) {
        return findingsIn(twoStoreys("- stairs: {id: s, storeys: 'ground,upper', size: [1.2, 3], " +
                                     keys + "}\n"));
    };
    using Messages = std::vector<std::string>;
    EXPECT_EQ(stairs("at: [2, 1], heading: 90"), Messages());
    EXPECT_EQ(stairs("at: [2, 3], heading: 90"),
              Messages({"stairs s ends in a wall or object of upper at (2.0, 6.0)"}));
    EXPECT_EQ(stairs("at: [2, 4], heading: 90"),
              Messages({"stairs s ends outside of the rooms of upper at (2.0, 7.0)"}));
    EXPECT_EQ(stairs("at: [2, 0], heading: 90"),
              Messages({"stairs s begins in a wall or object of ground at (2.0, 0.0)"}));
    // A flight that turns back ends where `top` says.
    EXPECT_EQ(stairs("at: [2, 4], heading: 90, top: [3.5, 4]"), Messages());
    EXPECT_EQ(stairs("at: [2, 1], heading: 90, top: [2, -4]"),
              Messages({"stairs s ends outside of the rooms of upper at (2.0, -4.0)"}));
}

TEST(BuildingCheck, ConvertsToTheFramesOfStoreys) {
    const std::string turned =
        "- storey: {id: ground, height: 3, records: &room [" + std::string(kRoom) + "]}\n" +
        "- storey: {id: upper, z: 3, at: [20, 0], heading: 90, records: *room}\n" +
        "- stairs: {id: s, storeys: 'ground,upper', at: [2, 1], heading: 0, size: [1, 3], ";
    EXPECT_TRUE(findingsIn(turned + "top: [15, 1]}\n").empty());
    EXPECT_EQ(findingsIn(turned + "top: [21, 1]}\n").size(), 1U);
    const StoreyedDocument building = buildingOf(turned + "top: [15, 1]}\n");
    EXPECT_NEAR(inStorey(building.storeys[1], {15, 1}).x, 1, 1e-12);
    EXPECT_NEAR(inStorey(building.storeys[1], {15, 1}).y, 5, 1e-12);
}

TEST(BuildingCheck, FindsLiftsWithoutDoorsOrOutsideRooms) {
    const auto lift = [](const std::string& keys) {
        return findingsIn(twoStoreys("- lift: {id: l, storeys: 'ground,upper', size: [1.6, 1.4], " +
                                     keys + "}\n"));
    };
    using Messages = std::vector<std::string>;
    EXPECT_EQ(lift("at: [4, 3], door: 0.9, capacity: 630kg"), Messages());
    EXPECT_EQ(lift("at: [4, 3]"),
              Messages({"lift l has no door: give its width, such as door=0.9"}));
    EXPECT_EQ(lift("at: [4, 3], door: 1.7"),
              Messages({"lift l has a door that is wider than its cabin"}));
    EXPECT_EQ(lift("at: [7.3, 3], door: 0.9").size(), 2U);  // of both storeys
    EXPECT_EQ(lift("at: [8.5, 3], door: 0.9, heading: 180"), Messages());
}

TEST(BuildingCheck, FindsStoreysThatOverlapInHeight) {
    EXPECT_EQ(
        findingsIn(twoStoreys("", 2.9)),
        std::vector<std::string>({"storeys ground and upper overlap: ground reaches up to 3.0 "
                                  "m, and upper begins at 2.9 m"}));
    EXPECT_TRUE(findingsIn(twoStoreys("", 3)).empty());
    // Wings beside each other may be level.
    const std::string room(kRoom);
    const std::string wing = "- storey: {id: b, at: [8, 0], records: [" + room + "]}\n";
    EXPECT_TRUE(findingsIn("- storey: {id: a, records: [" + room + "]}\n" + wing).empty());
    EXPECT_EQ(findingsIn("- storey: {id: a, at: [1, 0], records: [" + room + "]}\n" + wing).size(),
              1U);
}

TEST(BuildingCheck, ComparesABoundedNumberOfStoreys) {
    // Angles in each other, with a jagged side: all boxes meet, no areas.
    std::string path = "[0, 0], [300, 0], [300, 1], [1, 1], [1, 300]";
    for (int i = 0; i < 500; ++i)
        path += ", [" + std::string(i % 2 == 0 ? "0" : "0.2") + ", " +
                std::to_string(300 - 0.5 * i) + ']';
    std::string text;
    for (int i = 0; i < 100; ++i) {
        const std::string at = std::to_string(1.5 * i);
        text += "- storey: {id: s" + std::to_string(i) + ", at: [" + at + ", " + at +
                "], records: " +
                (i == 0 ? "&room [fence: {closed: yes, path: [" + path + "]}]" : "*room") + "}\n";
    }
    EXPECT_EQ(findingsIn(text),
              std::vector<std::string>({"too many storeys reach into others to compare all"}));
    // One finding for each storey.
    EXPECT_EQ(findingsIn(twoStoreys("- storey: {id: top, z: 2, records: *room}\n", 1)).size(), 2U);
}

TEST(BuildingCheck, FindsShaftsWithoutArea) {
    const auto shaft = [](const std::string& path) {
        return findingsIn(
            twoStoreys("- shaft: {id: o, storeys: 'ground,upper', path: " + path + "}\n"));
    };
    EXPECT_TRUE(shaft("[[1, 1], [2, 1], [2, 2]]").empty());
    EXPECT_EQ(shaft("[[1, 1], [2, 1]]").size(), 1U);
    EXPECT_EQ(shaft("[[1, 1], [2, 2], [2, 1], [1, 2]]").size(), 1U);
}

}  // namespace check_building_test
}  // namespace ispace
