// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the search for sensors that localise on the storeys of a building.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "extensions/goals/localisation.h"
#include "extensions/goals/localise_search.h"
#include "scene/placement_schemas.h"
#include "site/site_coverage.h"
#include "support/test_arrange_building.h"

namespace ispace::goals {
namespace site_localise_test {

SiteScene twoStoreys() {
    const std::string text =
        "- storey: {id: ground, records: [{ispace: {size: 8 x 6 x 2.5}}, {wall: {from: [0, -3], "
        "to: [0, 2.9]}}]}\n"
        "- storey: {id: upper, z: 3, records: [{ispace: {size: 5 x 4 x 2.5}}]}\n";
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

ArrangeOptions coarse() {
    ArrangeOptions options;
    options.density = {1, 1, 8};
    options.cells = CellSize{0.25};
    options.search.optimizer = Optimizer::Exact;
    return options;
}

Localisation localisedIn(const SiteScene& building, const ArrangedBuilding& arranged,
                         double within) {
    std::vector<Localisation> storeys;
    const SiteCoverage coverage = measureSite(written(building, arranged), {});
    for (std::size_t i = 0; i < coverage.storeys.size(); ++i)
        storeys.push_back(localise(*coverage.floors[i], coverage.storeys[i], within));
    return localisedOver(storeys, coverage.storeys);
}

SensorSpec preciseLasers(int count) {
    Record record(*sceneSchemas().find("laser"));
    record.set("range", Tuple{20});
    record.set("fov", 360.0);
    record.set("sigma", Tuple{0.05});
    return {record, count};
}

TEST(BuildingLocalise, ValuesAreThoseOfCoverageAndNoSplitIsBetterThanTheBound) {
    const SiteScene building = twoStoreys();
    ArrangeOptions options = coarse();
    options.objective = std::make_shared<const LocaliseObjective>(0.2);
    const ArrangedBuilding result = arrangedIn(building, {preciseLasers(2)}, options);
    ASSERT_TRUE(result.found.value);
    EXPECT_EQ(result.found.whole, 0.2);
    EXPECT_NEAR(*localisedIn(building, result, 0.2).mean, (1 - *result.found.value) * 0.2, 2e-3);
    EXPECT_NEAR(result.found.candidate_value, *result.found.value, 1e-6);
    const double ground = building.scenes[0]->environment.indoor().area();
    const double upper = building.scenes[1]->environment.indoor().area();
    SilentProgress progress;
    double apart = 0;
    for (std::size_t storey = 0; storey < 2; ++storey) {
        const SensorSpec one = preciseLasers(1);
        const Scene& scene = *building.scenes[storey];
        apart +=
            (storey == 0 ? ground : upper) *
            arrange(scene, groupsToPlace(scene, std::span(&one, 1), {}, false), options, progress)
                .value.value_or(0) /
            (ground + upper);
    }
    EXPECT_GE(*result.found.value, apart - 1e-3) << "never worse than one on each storey";
    EXPECT_GE(result.found.bound, apart);
    EXPECT_GE(result.found.bound, *result.found.value);
}

TEST(LocalisedOver, CountsCellsByTheirArea) {
    const SiteScene building =
        makeSiteScene(readBuilding("- storey: {id: g, records: [{ispace: {size: 6 x 5}}, "
                                   "{laser: {id: a, at: [-2.5, -2, 1], range: 4}}]}\n"
                                   "- storey: {id: u, z: 3, records: [{ispace: {size: 4 x 3}}, "
                                   "{laser: {id: b, at: [1, 1, 1], heading: -120, range: 3}}]}\n",
                                   "house.yaml", {}),
                      {}, {});
    const SiteCoverage coverage = measureSite(building, {});
    std::vector<Localisation> rooms;
    for (std::size_t i = 0; i < 2; ++i)
        rooms.push_back(localise(*coverage.floors[i], coverage.storeys[i], 0.5));
    const Localisation all = localisedOver(rooms, coverage.storeys);
    const auto area = [&](std::size_t i) {
        const Target& target = coverage.storeys[i].target;
        return static_cast<double>(target.indoor.count()) * target.grid.cellArea();
    };
    EXPECT_NEAR(*all.localised * (area(0) + area(1)),
                *rooms[0].localised * area(0) + *rooms[1].localised * area(1), 1e-9);
    EXPECT_NEAR(*all.mean * (area(0) + area(1)),
                *rooms[0].mean * area(0) + *rooms[1].mean * area(1), 1e-9);
    EXPECT_GE(*all.share_within, std::min(*rooms[0].share_within, *rooms[1].share_within));
}

}  // namespace site_localise_test
}  // namespace ispace::goals
