// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the search for layouts of buildings that hold in random cases: mountings and crowds.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "coverage/crowd.h"
#include "scene/placement_schemas.h"
#include "site/site_coverage.h"
#include "site/storey_people.h"
#include "support/test_arrange_building.h"

namespace ispace {
namespace {

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

ArrangeOptions coarse(RobustChoice::Of of, bool is_worst) {
    ArrangeOptions options;
    options.density = {2, 2, 4};
    options.cells = CellSize{0.25};
    options.robust = {
        .of = of, .is_worst = is_worst, .people = 4, .tolerance = parseTolerance("5cm,3deg")};
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

/// Goals with crowds as `coverage --crowd` draws them.
std::vector<RoomGoals> goalsOf(const SiteScene& building, const ArrangeOptions& options) {
    std::vector<RoomGoals> goals(building.scenes.size());
    const std::vector<std::size_t> people = spreadOverStoreys(
        measureSite(building, {}), static_cast<std::size_t>(options.robust.people));
    for (std::size_t i = 0; i < goals.size(); ++i) {
        if (options.robust.of == RobustChoice::Of::Mounting) {
            goals[i].case_seed = seedOfStorey(options.seed, i);
            continue;
        }
        goals[i].crowds = crowdsIn(*building.scenes[i], people[i], seedOfStorey(options.seed, i));
    }
    return goals;
}

/// The mean and the least coverage in the crowds of the search, as coverage measures them.
std::pair<double, double> inCrowds(const SiteScene& building, const ArrangedBuilding& arranged,
                                   const std::vector<RoomGoals>& goals) {
    const SiteScene placed = written(building, arranged);
    double sum = 0, least = 1;
    for (std::size_t k = 0; k < kRobustSamples; ++k) {
        SiteScene crowded = placed;
        for (std::size_t i = 0; i < goals.size(); ++i)
            crowded.scenes[i] =
                std::make_shared<const Scene>(withCrowd(*placed.scenes[i], goals[i].crowds[k]));
        const double share =
            *measureSite(crowded, {.cells = CellSize{0.25}, .exact = false}).coverage.grid;
        sum += share / kRobustSamples;
        least = std::min(least, share);
    }
    return {sum, least};
}

TEST(BuildingCases, ValuesInCrowdsAreThoseOfCoverage) {
    for (const char* text : {kApart, kAtrium}) {
        const SiteScene building = buildingOf(text);
        const ArrangeOptions options = coarse(RobustChoice::Of::Crowd, false);
        const std::vector<RoomGoals> goals = goalsOf(building, options);
        const std::vector<SensorSpec> sensors = {text == kApart ? rangers(3) : cameras(3)};
        const ArrangedBuilding result = arrangedIn(building, sensors, options, goals);
        const auto [mean, least] = inCrowds(building, result, goals);
        ASSERT_TRUE(result.found.robust);
        EXPECT_NEAR(result.found.robust->mean, mean, 2e-3);
        EXPECT_NEAR(result.found.robust->worst, least, 2e-3);
        EXPECT_EQ(result.found.robust->shares.size(), std::size_t{kRobustSamples});
        EXPECT_GE(result.found.bound, result.found.robust->mean - 1e-9);
    }
}

TEST(BuildingCases, AStoreyThatDoesNotMatterChangesNothing) {
    const SiteScene both = buildingOf(kApart);
    const SiteScene alone =
        buildingOf("- storey: {id: ground, records: [{ispace: {size: 5 x 4 x 2.5}}]}\n");
    for (const auto of : {RobustChoice::Of::Crowd, RobustChoice::Of::Mounting})
        for (const bool is_worst : {false, true}) {
            ArrangeOptions options = coarse(of, is_worst);
            SilentProgress progress;
            std::vector<RoomGoals> goals = goalsOf(alone, options);
            goals.emplace_back();  // floor above that does not count, and takes no sensor
            goals[1].crowds.resize(goals[0].crowds.size());
            goals[1].counts = goals[1].takes_sensors = false;
            const ArrangedBuilding result = arrangedIn(both, {rangers(2)}, options, goals);
            const SensorSpec spec = rangers(2);
            const Scene& room = *alone.scenes[0];
            const Arrangement wanted = arrange(
                room, groupsToPlace(room, std::span(&spec, 1), {}, false), options, progress);
            EXPECT_EQ(result.counts, (std::vector<int>{2, 0}));
            ASSERT_TRUE(result.found.robust && wanted.robust);
            EXPECT_NEAR(result.found.robust->mean, wanted.robust->mean, 1e-6);
            EXPECT_NEAR(result.found.robust->worst, wanted.robust->worst, 1e-6);
            EXPECT_NEAR(result.found.bound, wanted.bound, 1e-6);
            for (std::size_t i = 0; i < 2; ++i)
                EXPECT_EQ(result.found.sensors[i].pose, wanted.sensors[i].pose);
        }
}

TEST(BuildingCases, JointLayoutsAreNeverWorseThanApart) {
    const SiteScene building = buildingOf(kApart);
    const ArrangeOptions options = coarse(RobustChoice::Of::Mounting, false);
    const std::vector<RoomGoals> goals = goalsOf(building, options);
    const ArrangedBuilding result = arrangedIn(building, {rangers(3)}, options, goals);
    SilentProgress progress;
    for (int ground = 1; ground <= 2; ++ground) {
        double apart = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            ArrangeOptions own = options;
            own.seed = *goals[i].case_seed;
            const SensorSpec spec = rangers(i == 0 ? ground : 3 - ground);
            const Scene& room = *building.scenes[i];
            const Arrangement one =
                arrange(room, groupsToPlace(room, std::span(&spec, 1), {}, false), own, progress);
            apart += room.environment.indoor().area() * one.robust->mean / 26;
        }
        EXPECT_GE(result.found.robust->mean, apart - 2e-3) << ground;
        EXPECT_GE(result.found.bound, apart - 1e-6) << ground;
    }
    EXPECT_GE(result.found.bound, result.found.robust->mean - 1e-9);
}

TEST(BuildingCases, CamerasThatMayTurnSeeTheFloorBelowInEachMounting) {
    const SiteScene building = buildingOf(kAtrium);
    ArrangeOptions options = coarse(RobustChoice::Of::Mounting, false);
    std::vector<RoomGoals> goals = goalsOf(building, options);
    goals[0].takes_sensors = false;
    const ArrangedBuilding shaken = arrangedIn(building, {cameras(1)}, options, goals);
    options.robust.tolerance = {};
    const ArrangedBuilding still = arrangedIn(building, {cameras(1)}, options, goals);
    options.robust = {};
    const ArrangedBuilding plain = arrangedIn(building, {cameras(1)}, options, goals);
    EXPECT_NEAR(still.found.robust->mean, plain.found.candidate_value, 1e-6)
        << "without errors all cases are the plain one";
    EXPECT_NEAR(still.found.robust->worst, still.found.robust->mean, 1e-6);
    EXPECT_LT(shaken.found.robust->worst, shaken.found.robust->mean);
    EXPECT_NEAR(shaken.found.robust->mean, plain.found.candidate_value, 0.05);
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
    ArrangeOptions options = coarse(RobustChoice::Of::Rooms, is_worst);
    const auto site = std::make_shared<const BuildingSite>(other, options);
    options.robust.name = "house";
    options.robust.rooms = {{"moved", {site, &site->site()}}};
    return options;
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
            ASSERT_TRUE(result.found.robust);
            EXPECT_EQ(result.found.robust->names, (std::vector<std::string>{"house", "moved"}));
            ASSERT_EQ(result.found.robust->shares.size(), 2U);
            EXPECT_NEAR(result.found.robust->shares[0], shareIn(written(building, result)), 2e-3);
            EXPECT_NEAR(result.found.robust->shares[1], shareIn(other), 2e-3);
            const double value = is_worst ? result.found.robust->worst : result.found.robust->mean;
            EXPECT_GE(result.found.bound, value - 1e-9);
            // No worse there than the layout that is best here.
            ArrangeOptions plain = options;
            plain.robust = {};
            const ArrangedBuilding best = arrangedIn(building, sensors, plain);
            EXPECT_LE(result.found.robust->shares[0], best.found.candidate_bound + 1e-6);
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
            ArrangeOptions own = coarse(RobustChoice::Of::Rooms, false);
            ArrangeSite other;
            other.rooms.push_back({"", moved.scenes[i]});
            own.robust.rooms = {{"moved", std::make_shared<const ArrangeSite>(other)}};
            const SensorSpec spec = rangers(i == 0 ? ground : 3 - ground);
            const Scene& room = *building.scenes[i];
            const Arrangement one =
                arrange(room, groupsToPlace(room, std::span(&spec, 1), {}, false), own, progress);
            for (std::size_t k = 0; k < 2; ++k)
                apart += areas[k][i] * one.robust->shares[k] / (areas[k][0] + areas[k][1]) / 2;
        }
        EXPECT_GE(result.found.robust->mean, apart - 2e-3) << ground;
        EXPECT_GE(result.found.bound, apart - 1e-3) << ground;
    }
}

}  // namespace
}  // namespace ispace
