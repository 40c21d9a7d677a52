// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/passages/landing_check.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "site/site_scene.h"
#include "site/storeys.h"

namespace ispace::passages {
namespace landing_check_test {

using Messages = std::vector<std::string>;

/// Returns the findings of stairs of these keys, from a storey with this outline to a large one.
Messages landings(const std::string& path, const std::string& keys) {
    const std::string text =
        "- storey: {id: ground, height: 3, records: [{fence: {path: [" + path +
        "], closed: yes}}]}\n"
        "- storey: {id: upper, z: 3, height: 2.5, records: [{fence: {path: [[-4, -6], [8, -6], "
        "[8, 15], [-4, 15]], closed: yes}}]}\n"
        "- stairs: {id: s, storeys: 'ground,upper', heading: 90, " +
        keys + "}\n";
    Messages messages;
    for (const Diagnostic& finding :
         landingFindings(makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {})))
        messages.push_back(finding.message);
    return messages;
}

TEST(LandingCheck, FindsLandingsTooShallowToWalk) {
    const auto hall = [](const std::string& keys) {
        return landings("[0, 0], [8, 0], [8, 6], [0, 6]", keys);
    };
    // Wall at y = 0; a person is 0.51 m wide.
    EXPECT_EQ(hall("at: [2, 1], size: [1.2, 3]"), Messages()) << "one waits beside it";
    EXPECT_EQ(hall("at: [2, 0.6], size: [1.2, 3]"),
              Messages({"stairs s has a landing too narrow on ground: 0.6 m before the steps, "
                        "where movers need 0.81 m"}));
    EXPECT_EQ(hall("at: [0.6, 1], size: [1.2, 3]"), Messages()) << "a wall beside it";
    EXPECT_EQ(landings("[0, 0], [8, 0], [8, 6], [0, 6], [0, 0.4], [1.9, 0.4], [1.9, 0]",
                       "at: [2, 0.9], size: [1.2, 3]"),
              Messages())
        << "half of it is deep";
    EXPECT_EQ(hall("at: [2, 1], size: [1.2, 13.5]").size(), 1U) << "at the top";
    EXPECT_EQ(hall("at: [2, 1], size: [1.2, 13.5], top: [4, 14.5]"), Messages()) << "it turns";
}

TEST(LandingCheck, FindsWallsAcrossTheEndOfAFlight) {
    // The wall is on the upper storey; the flight ends at y = 4.
    const auto across = [](double y, double from, double to) {
        const std::string room = "fence: {path: [[0, 0], [8, 0], [8, 9], [0, 9]], closed: yes}";
        const std::string text =
            "- storey: {id: ground, height: 3, records: [{" + room +
            "}]}\n- storey: {id: upper, z: 3, height: 2.5, records: [{" + room +
            "}, {wall: {from: [" + std::to_string(from) + ", " + std::to_string(y) + "], to: [" +
            std::to_string(to) + ", " + std::to_string(y) + "]}}]}\n" +
            "- stairs: {id: s, storeys: 'ground,upper', heading: 90, at: [4, 1], size: [1.2, 3]}\n";
        return landingFindings(makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {}));
    };
    for (const double y : {3.9, 4.0, 4.01, 4.1}) EXPECT_EQ(across(y, 2, 6).size(), 1U) << y;
    EXPECT_TRUE(across(2, 2, 6).empty()) << "over the steps, where one walks below it";
    EXPECT_TRUE(across(4, 4.6, 6).empty()) << "beside the steps";
    EXPECT_TRUE(across(5, 2, 6).empty()) << "a metre ahead";
    // The steps as a body of the lower storey.
    EXPECT_EQ(landings("[0, 0], [8, 0], [8, 6], [0, 6]], closed: yes}}, {cube: {at: [2, 2.5], "
                       "size: [1.2, 3, 3]}}, {fence: {path: [[7, 5], [7.5, 5], [7.5, 5.5]",
                       "at: [2, 1], size: [1.2, 3]"),
              Messages());
}

TEST(LandingCheck, FindsCorridorsTooNarrowToPassThoseThatWait) {
    const auto corridor = [](const std::string& left, const std::string& right, double foot) {
        return landings("[-4, -6], [6, -6], [6, 0], [" + right + ", 0], [" + right + ", 12], [" +
                            left + ", 12], [" + left + ", 0], [-4, 0]",
                        "at: [0, " + std::to_string(foot) + "], size: [1, 4.2]");
    };
    const Messages narrow = {
        "stairs s has a landing too narrow on ground: those that come off it cannot pass those "
        "that wait; make the way to it 1.83 m wide"};
    EXPECT_EQ(corridor("-0.6", "0.6", 6), narrow);
    EXPECT_EQ(corridor("-0.6", "0.6", 4), narrow);
    EXPECT_EQ(corridor("-0.6", "0.6", 1), Messages()) << "they wait in the hall";
    EXPECT_EQ(corridor("-1.2", "1.2", 6), Messages()) << "they wait at its side";
}

}  // namespace landing_check_test
}  // namespace ispace::passages
