// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --privacy in buildings.
#include "extensions/camerarules/layout_privacy.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "record/text.h"
#include "scene/placement_schemas.h"
#include "site/arranged_site.h"
#include "support/test_arrange_building.h"

namespace ispace::camerarules {
namespace layout_privacy_test {

/// Of the lower storey.
const std::vector<std::vector<PrivacyRule>> kRules = {{parsePrivacy("desk")}, {}};

/// A layout, and its privacy.
struct Searched {
    ArrangedBuilding arranged;
    std::vector<PrivacyResult> privacy;
};

Searched searched(const SiteScene& building, const std::vector<SensorSpec>& sensors,
                  ArrangeOptions options, std::vector<RoomGoals> goals) {
    std::vector<const Environment*> rooms;
    for (const auto& scene : building.scenes) rooms.push_back(&scene->environment);
    askPrivacy(kRules, rooms, options, goals);
    Searched result{arrangedIn(building, sensors, options, goals), {}};
    const BuildingSite site(building, options, std::move(goals));
    result.privacy = measurePrivacy(site.site(), result.arranged.groups, result.arranged.found,
                                    options.plane, kRules)
                         .results;
    return result;
}

TEST(LayoutPrivacy, HoldsInItsStorey) {
    const SiteScene building = makeSiteScene(
        readBuilding("- storey: {id: ground, height: 2.8, records: [{ispace: {size: 5 x 4}}, "
                     "{zone: {id: desk, at: [1, 1], size: 1 x 1}}]}\n"
                     "- storey: {id: upper, z: 3, height: 2.8, records: [{ispace: {size: 5 x "
                     "4}}]}\n",
                     "house.yaml", {}),
        {}, {});
    Record camera(*sceneSchemas().find("camera"));
    camera.set("fov", Tuple{90});
    ArrangeOptions options;
    options.density = {1, 1, 4};
    options.cells = CellSize{0.25};
    const ArrangedBuilding open = arrangedIn(building, {{camera, 4}}, options);
    const Searched secret = searched(building, {{camera, 4}}, options, std::vector<RoomGoals>(2));
    ASSERT_EQ(secret.privacy.size(), 1U);
    EXPECT_EQ(secret.privacy[0].zone, "ground/desk");
    EXPECT_TRUE(isMet(secret.privacy[0]));
    EXPECT_FALSE(isMet(measurePrivacy(
        withPlaced(*building.scenes[0], open.groups, open.found.sensors, 0), 0, kRules[0])[0]));
    EXPECT_LE(secret.arranged.found.candidate_value, open.found.candidate_value + 1e-12);
}

/// Two storeys around an atrium, with a zone below it.
SiteScene atrium(const std::string& layout = "") {
    StoreyedDocument document = readBuilding(
        "- storey: {id: ground, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], [0, "
        "6]], closed: yes, height: 2.8}}, {zone: {id: desk, at: [4, 3], size: 2 x 1}}]}\n"
        "- storey: {id: gallery, z: 3, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, "
        "6], [0, 6]], closed: yes, height: 2.8}}]}\n"
        "- shaft: {storeys: 'ground,gallery', path: [[2, 1.5], [6, 1.5], [6, 4.5], [2, 4.5]]}\n",
        "house.yaml", {});
    std::vector<Document> layouts;
    if (!layout.empty())
        layouts = layoutsOf(readRecordText("#3dm 1\n" + layout, "l.3dm", sceneSchemas()), document);
    return makeSiteScene(std::move(document), layouts, {});
}

TEST(LayoutPrivacy, HoldsAgainstCamerasAbove) {
    Record camera(*sceneSchemas().find("camera"));
    camera.set("fov", Tuple{90});
    camera.set("tilt", -50.0);
    camera.set("range", Tuple{8});
    ArrangeOptions options;
    options.density = {1, 1, 8};
    options.cells = CellSize{0.25};
    std::vector<RoomGoals> goals(2);
    goals[0].takes_sensors = false;
    const Searched result = searched(atrium(), {{camera, 1}}, options, goals);
    ASSERT_EQ(result.privacy.size(), 1U);
    EXPECT_TRUE(isMet(result.privacy[0]));
    EXPECT_GT(result.arranged.found.coverage, 0);
    // A standing camera over the zone is named.
    const std::string above = "camera id=gallery/c fov=90 at=4,3,2.5 tilt=-90 range=8\n";
    const Searched seen = searched(atrium(above), {{camera, 1}}, options, goals);
    ASSERT_EQ(seen.privacy.size(), 1U);
    EXPECT_FALSE(isMet(seen.privacy[0]));
    EXPECT_EQ(seen.privacy[0].cameras, std::vector<std::string>{"gallery/c"});
}

}  // namespace layout_privacy_test
}  // namespace ispace::camerarules
