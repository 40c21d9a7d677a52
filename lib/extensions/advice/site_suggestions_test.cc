// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/advice/site_suggestions.h"

#include <gtest/gtest.h>

#include <string>

#include "site/site_coverage.h"
#include "site/site_sight.h"

namespace ispace::advice {
namespace site_suggestions_test {

SiteScene sceneOf(const std::string& text) {
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

TEST(BuildingSuggestions, AddNoSensorInAShaft) {
    const SiteScene building = sceneOf(
        "- storey: {id: g, height: 3, records: [{ispace: {size: 10 x 10}}]}\n"
        "- storey: {id: u, z: 3, records: [{ispace: {size: 10 x 10}}, "
        "{laser: {id: l, at: [-4.8, -4.8, 1], range: 4, fov: 360}}]}\n"
        "- shaft: {id: s, storeys: 'g,u', path: '-2,-2;4,-2;4,4;-2,4'}\n");
    const auto whole = wholeScenes(building);
    const auto floors = Coupling(building).floors();
    int added = 0;
    SilentProgress silent;
    for (const Suggestion& one : suggestForStorey(building, 1, whole, {}, silent)) {
        const SiteScene changed = editedStorey(building, 1, *whole[1], one.edits);
        for (const Sensor& sensor : changed.scenes[1]->sensors)
            EXPECT_EQ(floors[1]->environment.indoor().locate(sensor.pose.position.onFloor()),
                      Side::Inside)
                << one.text;
        if (one.kind != Suggestion::Kind::Add) continue;
        ++added;
        // The gain is that of the floor around the shaft, as measured after the change.
        const auto share = [](const SiteScene& of) {
            const SiteCoverage measured = measureSite(of, {});
            return measured.storeys[1].report.coverage.exact.value();
        };
        EXPECT_NEAR(one.gained, (share(changed) - share(building)) * 64, 1e-6);
    }
    EXPECT_EQ(added, 1);
}

TEST(BuildingSuggestions, AreForTheLowestOfEqualStoreys) {
    const SiteScene building = sceneOf(
        "- storey: {id: a, height: 3, records: &room [{ispace: {size: 8 x 6}}, "
        "{laser: {id: l, at: [3, -2, 1], range: 3}}]}\n"
        "- storey: {id: b, z: 3, records: *room}\n- storey: {id: c, z: 6, records: *room}\n"
        "- storey: {id: d, z: 9, records: *room}\n"
        "- shaft: {id: s, storeys: 'b,c,d', path: '-1,-1;1,-1;1,1;-1,1'}\n");
    const auto whole = wholeScenes(building);
    ASSERT_EQ(whole.size(), 4U);
    EXPECT_NE(whole[0], nullptr);
    EXPECT_EQ(whole[1], nullptr);  // as the lowest: the shaft opens the floors above
    ASSERT_NE(whole[2], nullptr);
    EXPECT_EQ(whole[2]->ids, (std::vector<std::string>{"c/ispace1", "c/l"}));
    EXPECT_EQ(whole[3], nullptr);
    SilentProgress silent;
    EXPECT_FALSE(suggestForStorey(building, 2, whole, {}, silent).empty());
}

/// Two storeys with a private zone that its camera sees; the upper one has a face to be seen.
SiteScene privateHouse() {
    return sceneOf(
        "- storey: {id: g, height: 3, records: [{ispace: {size: 8 x 6}}, "
        "{zone: {id: desk, path: '1,-1;3,-1;3,1;1,1'}}, "
        "{camera: {id: c, at: [-3.8, 0, 2.6], fov: 70, tilt: -30}}]}\n"
        "- storey: {id: u, z: 3, height: 3, records: [{ispace: {size: 9 x 6}}, "
        "{zone: {id: desk, path: '1,-1;3,-1;3,1;1,1'}}, "
        "{camera: {id: c, at: [-4.3, 0, 2.6], fov: 70, tilt: -30}}]}\n");
}

TEST(BuildingSuggestions, MeetRulesOfPrivacyOnAllStoreys) {
    const SiteScene building = privateHouse();
    SuggestOptions options;
    options.privacy = {camerarules::parsePrivacy("*/desk")};
    const SiteCoverage coverage = measureSite(building, options.measure);
    const auto missing = [&](const SiteScene& of) {
        return missingFloor(camerarules::measureSiteRules(of, measureSite(of, options.measure),
                                                          options.measure, {}, options.privacy));
    };
    ASSERT_GT(missing(building), 4);
    SilentProgress silent;
    const auto found = suggestForSite(building, coverage, options, silent);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].kind, Suggestion::Kind::Together);
    EXPECT_NEAR(found[0].required, missing(building), 1e-6);
    const auto whole = wholeScenes(building);
    SiteScene changed = building;
    for (const std::size_t storey : {0U, 1U}) {
        std::vector<Edit> own;
        for (const Edit& edit : found[0].edits)
            if (edit.text.starts_with(building.document.storeys[storey].id + '/'))
                own.push_back(edit);
        EXPECT_FALSE(own.empty());
        changed.scenes[storey] = editedStorey(building, storey, *whole[storey], own).scenes[storey];
    }
    EXPECT_EQ(missing(changed), 0);
    for (const Suggestion& one : found) EXPECT_GE(one.required, 0) << one.text;
}

/// Changes that meet the rules of cameras do not claim to meet what coverage still misses.
TEST(BuildingSuggestions, TellTheFloorThatRequirementsStillMiss) {
    const SiteScene building = privateHouse();
    SuggestOptions options;
    options.privacy = {camerarules::parsePrivacy("*/desk")};
    options.requirements = {parseRequirement("free:99%")};
    const SiteCoverage coverage = measureSite(building, options.measure);
    SilentProgress silent;
    const auto found = suggestForSite(building, coverage, options, silent);
    ASSERT_FALSE(found.empty());
    ASSERT_EQ(found[0].kind, Suggestion::Kind::Together);
    EXPECT_GT(found[0].unmet, 1);
    EXPECT_EQ(gainText(found[0]).find("all requirements"), std::string::npos);
    options.requirements = {parseRequirement("free:1%")};
    const auto easy = suggestForSite(building, coverage, options, silent);
    EXPECT_EQ(easy.at(0).unmet, 0);
    EXPECT_NE(gainText(easy[0]).find("; meets all requirements"), std::string::npos);
}

TEST(BuildingSuggestions, RegardRulesOfOneStorey) {
    const SiteScene building = privateHouse();
    SuggestOptions options;
    options.facing = {camerarules::parseFacing("u/desk,45deg,0=90%")};
    const SiteCoverage coverage = measureSite(building, options.measure);
    const camerarules::StoreyRules lower =
        camerarules::rulesOfStorey(building, coverage, 0, options.facing, {});
    const camerarules::StoreyRules upper =
        camerarules::rulesOfStorey(building, coverage, 1, options.facing, {});
    EXPECT_TRUE(lower.facing.empty());
    ASSERT_EQ(upper.facing.size(), 1U);
    EXPECT_EQ(upper.facing[0].zone, "u/desk");
    SilentProgress silent;
    const auto found = suggestForSite(building, coverage, options, silent);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].kind, Suggestion::Kind::Together) << found[0].text;
    for (const Edit& edit : found[0].edits) EXPECT_NE(edit.text.find("u/"), std::string::npos);
}

}  // namespace site_suggestions_test
}  // namespace ispace::advice
