// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the search for layouts of buildings that hold in several cases: mountings,
// crowds, other furniture and failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "extensions/robustness/robust_cases.h"
#include "scene/placement_schemas.h"
#include "site/site_coverage.h"
#include "site/storey_people.h"
#include "support/test_arrange_building.h"

namespace ispace::robustness {
namespace site_cases_test {

SiteScene buildingOf(const std::string& text) {
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

const char* const kApart =
    "- storey: {id: ground, records: [{ispace: {size: 5 x 4 x 2.5}}]}\n"
    "- storey: {id: upper, z: 3, records: [{ispace: {size: 3 x 2 x 2.5}}]}\n";
const char* const kAtrium =
    "- storey: {id: ground, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], [0, "
    "6]], closed: yes, height: 2.8}}]}\n"
    "- storey: {id: gallery, z: 3, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], "
    "[0, 6]], closed: yes, height: 2.8}}]}\n"
    "- shaft: {storeys: 'ground,gallery', path: [[2, 1.5], [6, 1.5], [6, 4.5], [2, 4.5]]}\n";

constexpr std::size_t kPeople = 4;

ArrangeOptions coarse(std::shared_ptr<const LayoutCases> cases = nullptr) {
    ArrangeOptions options;
    options.density = {2, 2, 4};
    options.cells = CellSize{0.25};
    options.cases = std::move(cases);
    return options;
}

SensorSpec rangers(int count) {
    Record record(*sceneSchemas().find("laser"));
    record.set("range", Tuple{3});
    record.set("fov", 180.0);
    return {record, count};
}

SensorSpec cameras(int count) {
    Record record(*sceneSchemas().find("camera"));
    record.set("fov", Tuple{90});
    record.set("tilt", -50.0);
    record.set("range", Tuple{8});
    return {record, count};
}

using SiteCrowds = std::vector<std::vector<Crowd>>;

/// Crowds as `coverage --crowd` draws them, by storey.
SiteCrowds crowdsOf(const SiteScene& building) {
    const std::vector<std::size_t> people = spreadOverStoreys(measureSite(building, {}), kPeople);
    SiteCrowds crowds;
    for (std::size_t i = 0; i < people.size(); ++i)
        crowds.push_back(crowdsIn(*building.scenes[i], people[i], seedOfStorey(0, i)));
    return crowds;
}

std::shared_ptr<const LayoutCases> inCrowds(SiteCrowds crowds, bool is_worst) {
    return std::make_shared<const CrowdCases>(is_worst, kPeople, std::move(crowds));
}

/// \param storeys numbers of those of the site
std::shared_ptr<const LayoutCases> mounted(const std::vector<std::size_t>& storeys, bool is_worst,
                                           const char* tolerance = "5cm,3deg") {
    std::vector<std::uint64_t> seeds;
    seeds.reserve(storeys.size());
    for (const std::size_t storey : storeys) seeds.push_back(seedOfStorey(0, storey));
    return std::make_shared<const MountingCases>(is_worst, parseTolerance(tolerance),
                                                 std::move(seeds));
}

/// The mean and the least coverage in the crowds of the search, as coverage measures them.
std::pair<double, double> coverageIn(const SiteCrowds& crowds, const SiteScene& building,
                                     const ArrangedBuilding& arranged) {
    const SiteScene placed = written(building, arranged);
    double sum = 0, least = 1;
    for (std::size_t k = 0; k < kSearchedSamples; ++k) {
        SiteScene crowded = placed;
        for (std::size_t i = 0; i < crowds.size(); ++i)
            crowded.scenes[i] =
                std::make_shared<const Scene>(withCrowd(*placed.scenes[i], crowds[i][k]));
        const double share =
            *measureSite(crowded, {.cells = CellSize{0.25}, .exact = false}).coverage.grid;
        sum += share / kSearchedSamples;
        least = std::min(least, share);
    }
    return {sum, least};
}

TEST(BuildingCases, ValuesInCrowdsAreThoseOfCoverage) {
    for (const char* text : {kApart, kAtrium}) {
        const SiteScene building = buildingOf(text);
        const SiteCrowds crowds = crowdsOf(building);
        const std::vector<SensorSpec> sensors = {text == kApart ? rangers(3) : cameras(3)};
        const ArrangedBuilding result =
            arrangedIn(building, sensors, coarse(inCrowds(crowds, false)));
        const auto [mean, least] = coverageIn(crowds, building, result);
        ASSERT_TRUE(result.found.cases);
        EXPECT_NEAR(result.found.cases->mean, mean, 2e-3);
        EXPECT_NEAR(result.found.cases->worst, least, 2e-3);
        EXPECT_EQ(result.found.cases->shares.size(), std::size_t{kSearchedSamples});
        EXPECT_GE(result.found.bound, result.found.cases->mean - 1e-9);
    }
}

TEST(BuildingCases, AStoreyThatDoesNotMatterChangesNothing) {
    const SiteScene both = buildingOf(kApart);
    const SiteScene alone =
        buildingOf("- storey: {id: ground, records: [{ispace: {size: 5 x 4 x 2.5}}]}\n");
    const SiteCrowds below = crowdsOf(alone);
    const SiteCrowds empty_above = {below.front(), std::vector<Crowd>(below.front().size())};
    for (const bool is_crowd : {true, false})
        for (const bool is_worst : {false, true}) {
            SilentProgress progress;
            std::vector<RoomGoals> goals(2);
            // Floor above that does not count, and takes no sensor.
            goals[1].counts = goals[1].takes_sensors = false;
            const ArrangedBuilding result = arrangedIn(
                both, {rangers(2)},
                coarse(is_crowd ? inCrowds(empty_above, is_worst) : mounted({0, 1}, is_worst)),
                goals);
            const ArrangeOptions options =
                coarse(is_crowd ? inCrowds(below, is_worst) : mounted({0}, is_worst));
            const SensorSpec spec = rangers(2);
            const Scene& room = *alone.scenes[0];
            const Arrangement wanted = arrange(
                room, groupsToPlace(room, std::span(&spec, 1), {}, false), options, progress);
            EXPECT_EQ(result.counts, (std::vector<int>{2, 0}));
            ASSERT_TRUE(result.found.cases && wanted.cases);
            EXPECT_NEAR(result.found.cases->mean, wanted.cases->mean, 1e-6);
            EXPECT_NEAR(result.found.cases->worst, wanted.cases->worst, 1e-6);
            EXPECT_NEAR(result.found.bound, wanted.bound, 1e-6);
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_EQ(result.found.sensors[i].pose, wanted.sensors[i].pose);
        }
}

TEST(BuildingCases, JointLayoutsAreNeverWorseThanApart) {
    const SiteScene building = buildingOf(kApart);
    const ArrangedBuilding result =
        arrangedIn(building, {rangers(3)}, coarse(mounted({0, 1}, false)));
    SilentProgress progress;
    for (int ground = 1; ground <= 2; ++ground) {
        double apart = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const ArrangeOptions own = coarse(mounted({i}, false));
            const SensorSpec spec = rangers(i == 0 ? ground : 3 - ground);
            const Scene& room = *building.scenes[i];
            const Arrangement one =
                arrange(room, groupsToPlace(room, std::span(&spec, 1), {}, false), own, progress);
            apart += room.environment.indoor().area() * one.cases->mean / 26;
        }
        EXPECT_GE(result.found.cases->mean, apart - 2e-3) << ground;
        EXPECT_GE(result.found.bound, apart - 1e-6) << ground;
    }
    EXPECT_GE(result.found.bound, result.found.cases->mean - 1e-9);
}

TEST(BuildingCases, CamerasThatMayTurnSeeTheFloorBelowInEachMounting) {
    const SiteScene building = buildingOf(kAtrium);
    std::vector<RoomGoals> goals(2);
    goals[0].takes_sensors = false;
    const ArrangedBuilding shaken =
        arrangedIn(building, {cameras(1)}, coarse(mounted({0, 1}, false)), goals);
    const ArrangedBuilding still =
        arrangedIn(building, {cameras(1)}, coarse(mounted({0, 1}, false, "0,0")), goals);
    const ArrangedBuilding plain = arrangedIn(building, {cameras(1)}, coarse(), goals);
    EXPECT_NEAR(still.found.cases->mean, plain.found.candidate_value, 1e-6)
        << "without errors all cases are the plain one";
    EXPECT_NEAR(still.found.cases->worst, still.found.cases->mean, 1e-6);
    EXPECT_LT(shaken.found.cases->worst, shaken.found.cases->mean);
    EXPECT_NEAR(shaken.found.cases->mean, plain.found.candidate_value, 0.05);
}

/// The same buildings with other furniture.
const char* const kApartMoved =
    "- storey: {id: ground, records: [{ispace: {size: 5 x 4 x 2.5}}, {screen: {at: [0, 0], size: "
    "0.05 x 3 x 2}}]}\n"
    "- storey: {id: upper, z: 3, records: [{ispace: {size: 3.2 x 2 x 2.5}}]}\n";
const char* const kAtriumMoved =
    "- storey: {id: ground, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], [0, "
    "6]], closed: yes, height: 2.8}}, {desk: {at: [4, 3]}}]}\n"
    "- storey: {id: gallery, z: 3, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], "
    "[0, 6]], closed: yes, height: 2.8}}]}\n"
    "- shaft: {storeys: 'ground,gallery', path: [[2, 1.5], [4, 1.5], [4, 4.5], [2, 4.5]]}\n";

/// Options of a search in this building, and in another one.
ArrangeOptions inBoth(const SiteScene& other, bool is_worst) {
    const auto site = std::make_shared<const BuildingSite>(other, coarse());
    return coarse(std::make_shared<const OtherSites>(
        is_worst, "house",
        std::vector<NamedSite>{
            {"moved", std::shared_ptr<const ArrangeSite>(site, &site->site())}}));
}

double shareIn(const SiteScene& building) {
    return *measureSite(building, {.cells = CellSize{0.25}, .exact = false}).coverage.grid;
}

TEST(BuildingCases, ValuesInOtherBuildingsAreThoseOfCoverage) {
    for (const bool is_apart : {true, false})
        for (const bool is_worst : {true, false}) {
            const SiteScene building = buildingOf(is_apart ? kApart : kAtrium);
            const SiteScene moved = buildingOf(is_apart ? kApartMoved : kAtriumMoved);
            const ArrangeOptions options = inBoth(moved, is_worst);
            const std::vector<SensorSpec> sensors = {is_apart ? rangers(3) : cameras(3)};
            const ArrangedBuilding result = arrangedIn(building, sensors, options);
            SiteScene other = moved;
            for (std::size_t i = 0; i < 2; ++i)
                other.scenes[i] = std::make_shared<const Scene>(
                    withPlaced(*moved.scenes[i], result.groups, result.found.sensors, i));
            ASSERT_TRUE(result.found.cases);
            EXPECT_EQ(options.cases->rows(*result.found.cases)[1].name, "moved");
            ASSERT_EQ(result.found.cases->shares.size(), 2U);
            EXPECT_NEAR(result.found.cases->shares[0], shareIn(written(building, result)), 2e-3);
            EXPECT_NEAR(result.found.cases->shares[1], shareIn(other), 2e-3);
            const double value = is_worst ? result.found.cases->worst : result.found.cases->mean;
            EXPECT_GE(result.found.bound, value - 1e-9);
            // No worse there than the layout that is best here.
            const ArrangedBuilding best = arrangedIn(building, sensors, coarse());
            EXPECT_LE(result.found.cases->shares[0], best.found.candidate_bound + 1e-6);
        }
}

TEST(BuildingCases, OtherBuildingsApartAreNeverBetterThanJoint) {
    const SiteScene building = buildingOf(kApart), moved = buildingOf(kApartMoved);
    const ArrangedBuilding result = arrangedIn(building, {rangers(3)}, inBoth(moved, false));
    SilentProgress progress;
    const double areas[2][2] = {{20, 6}, {20, 6.4}};
    for (int ground = 1; ground <= 2; ++ground) {
        double apart = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            ArrangeSite other;
            other.rooms.push_back({"", moved.scenes[i]});
            const ArrangeOptions own = coarse(std::make_shared<const OtherSites>(
                false, "house",
                std::vector<NamedSite>{{"moved", std::make_shared<const ArrangeSite>(other)}}));
            const SensorSpec spec = rangers(i == 0 ? ground : 3 - ground);
            const Scene& room = *building.scenes[i];
            const Arrangement one =
                arrange(room, groupsToPlace(room, std::span(&spec, 1), {}, false), own, progress);
            for (std::size_t k = 0; k < 2; ++k)
                apart += areas[k][i] * one.cases->shares[k] / (areas[k][0] + areas[k][1]) / 2;
        }
        EXPECT_GE(result.found.cases->mean, apart - 2e-3) << ground;
        EXPECT_GE(result.found.bound, apart - 1e-3) << ground;
    }
}

TEST(BuildingCases, AFailedSensorMayBeInAnyStorey) {
    const SiteScene building = buildingOf(
        "- storey: {id: ground, records: [{fence: {path: [[0, 0], [5, 0], [5, 3], [0, 3]], closed: "
        "yes}}, {wall: {from: [2, 0], to: [2, 2]}}]}\n"
        "- storey: {id: upper, z: 3, records: [{ispace: {size: 3 x 2}}]}\n");
    const ArrangedBuilding result =
        arrangedIn(building, {rangers(3)}, coarse(std::make_shared<const SensorFailures>(true, 1)));
    ASSERT_TRUE(result.found.cases);
    double worst = 1;
    for (std::size_t failed = 0; failed < result.found.sensors.size(); ++failed) {
        ArrangedBuilding rest = result;
        rest.found.sensors.erase(rest.found.sensors.begin() + static_cast<std::ptrdiff_t>(failed));
        worst = std::min(worst, shareIn(written(building, rest)));
    }
    EXPECT_NEAR(result.found.cases->worst, worst, 1e-5);
    ASSERT_EQ(result.found.cases->failed.size(), 1U);
    EXPECT_NE(result.found.cases->failed[0].find('/'), std::string::npos) << "across the site";
}

}  // namespace site_cases_test
}  // namespace ispace::robustness
