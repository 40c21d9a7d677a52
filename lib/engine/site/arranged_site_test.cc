// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/arranged_site.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "base/error.h"
#include "env/zone.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "site/site_coverage.h"
#include "support/test_arrange_building.h"
#include "support/test_splits.h"

namespace ispace {
namespace arranged_site_test {

/// Two storeys: one room with a wall across, and one hall.
SiteScene twoStoreys() {
    const std::string text =
        "- storey: {id: ground, records: [{fence: {path: [[0, 0], [5, 0], [5, 3], [0, 3]], closed: "
        "yes}}, {wall: {from: [2, 0], to: [2, 2]}}]}\n"
        "- storey: {id: upper, z: 3, records: [{ispace: {size: 3 x 2}}]}\n";
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

ArrangeOptions coarse() {
    ArrangeOptions options;
    options.strategy = Strategy::Grid;
    options.x = 3;
    options.y = 2;
    options.headings = 4;
    options.cells = CellSize{0.25};
    options.search.optimizer = Optimizer::Exact;
    return options;
}

SensorSpec lasers(int count) {
    Record record(*sceneSchemas().find("laser"));
    record.set("range", Tuple{2});
    record.set("fov", 90.0);
    return {record, count};
}

/// Arranges sensors on one storey as arrange does in a room.
Arrangement alone(const Scene& scene, int count) {
    const SensorSpec spec = lasers(count);
    SilentProgress progress;
    return arrange(scene, groupsToPlace(scene, std::span(&spec, 1), {}, false), coarse(), progress);
}

TEST(BuildingSite, ProvesTheBestOfEverySplitSolvedApart) {
    const SiteScene building = twoStoreys();
    constexpr int kSensors = 4;
    const double ground = building.scenes[0]->environment.indoor().area();
    const double upper = building.scenes[1]->environment.indoor().area();
    double best = 0, bound = 0;
    std::vector<int> best_counts;
    forEachSplit(2, kSensors, [&](const std::vector<int>& counts) {
        double value = 0, most = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            if (counts[i] == 0) continue;
            const Arrangement one = alone(*building.scenes[i], counts[i]);
            EXPECT_NEAR(one.candidate_value, one.candidate_bound, 1e-12);  // proven
            value += (i == 0 ? ground : upper) * one.candidate_value;
            most += (i == 0 ? ground : upper) * one.candidate_bound;
        }
        bound = std::max(bound, most);
        if (value > best) best_counts = counts;
        best = std::max(best, value);
    });
    const ArrangedBuilding result = arrangedIn(building, {lasers(kSensors)}, coarse());
    EXPECT_NEAR(result.found.candidate_value, best / (ground + upper), 1e-12);
    EXPECT_NEAR(result.found.candidate_bound, bound / (ground + upper), result.found.rounding);
    EXPECT_LE(result.gap(), result.found.rounding + 1e-12) << "proven";
    EXPECT_LT(result.found.rounding, 1e-5);
    EXPECT_EQ(std::accumulate(result.counts.begin(), result.counts.end(), 0), kSensors);
    EXPECT_EQ(result.counts, best_counts);
    EXPECT_GT(result.counts[0], 0);
    EXPECT_GT(result.counts[1], 0);
}

SensorSpec ranger() {
    Record record(*sceneSchemas().find("ranger"));
    record.set("range", Tuple{1.5});
    return {record, 1};
}

double areaOf(const SiteScene& building, std::size_t storey) {
    return building.scenes[storey]->environment.indoor().area();
}

TEST(BuildingSite, SeveralKindsAreOneProblem) {
    const SiteScene building = twoStoreys();
    const std::vector<SensorSpec> kinds = {lasers(1), ranger()};
    SilentProgress progress;
    const auto value_in = [&](std::size_t storey, std::span<const SensorSpec> sensors) {
        const Scene& scene = *building.scenes[storey];
        return areaOf(building, storey) *
               arrange(scene, groupsToPlace(scene, sensors, {}, false), coarse(), progress)
                   .candidate_value;
    };
    const std::span<const SensorSpec> all(kinds);
    double best = std::max(value_in(0, all), value_in(1, all));
    for (const std::size_t storey : {0U, 1U})
        best = std::max(best, value_in(storey, all.first(1)) + value_in(1 - storey, all.last(1)));
    const ArrangedBuilding result = arrangedIn(building, kinds, coarse());
    EXPECT_NEAR(result.found.candidate_value, best / (areaOf(building, 0) + areaOf(building, 1)),
                1e-6);
    EXPECT_LE(result.gap(), result.found.rounding + 1e-12) << "proven";
}

ArrangeOptions connected() {
    ArrangeOptions options = coarse();
    options.is_connected = true;
    return options;
}

TEST(BuildingSite, ViewsHangTogetherInEachStorey) {
    const SiteScene building = twoStoreys();
    SilentProgress progress;
    const auto value_in = [&](std::size_t storey, int count, bool has_ranger) {
        std::vector<SensorSpec> sensors;
        if (count > 0) sensors.push_back(lasers(count));
        if (has_ranger) sensors.push_back(ranger());
        if (sensors.empty()) return 0.0;
        const Scene& scene = *building.scenes[storey];
        return areaOf(building, storey) *
               arrange(scene, groupsToPlace(scene, sensors, {}, false), connected(), progress)
                   .candidate_value;
    };
    double best = 0;
    for (int ground = 0; ground <= 3; ++ground)
        for (const bool is_below : {false, true})
            best =
                std::max(best, value_in(0, ground, is_below) + value_in(1, 3 - ground, !is_below));
    const ArrangedBuilding result = arrangedIn(building, {lasers(3), ranger()}, connected());
    EXPECT_NEAR(result.found.candidate_value, best / (areaOf(building, 0) + areaOf(building, 1)),
                1e-6);
    EXPECT_LE(result.gap(), result.found.rounding + 1e-12) << "proven";
    const ArrangedBuilding free = arrangedIn(building, {lasers(3), ranger()}, coarse());
    EXPECT_LT(result.found.candidate_value, free.found.candidate_value);
    // With a budget for as many, any kinds may be bought.
    ArrangeOptions buying = connected();
    buying.budget = 4;
    const ArrangedBuilding bought = arrangedIn(building, {lasers(3), ranger()}, buying);
    EXPECT_GE(bought.found.candidate_value, result.found.candidate_value - 1e-9);
    EXPECT_GE(bought.found.candidate_bound, bought.found.candidate_value - 1e-9);
}

TEST(BuildingSite, FewestAndRefinedViewsHangTogether) {
    const SiteScene building = twoStoreys();
    ArrangeOptions options = connected();
    options.target = 0.5;
    const ArrangedBuilding fewest = arrangedIn(building, {lasers(9)}, options);
    ASSERT_TRUE(fewest.found.is_reached);
    const auto count = static_cast<int>(fewest.found.sensors.size());
    EXPECT_EQ(fewest.found.least, count) << "proven";
    const ArrangedBuilding plain = arrangedIn(building, {lasers(count)}, connected());
    EXPECT_GE(plain.found.candidate_value, 0.5);
    EXPECT_LT(arrangedIn(building, {lasers(count - 1)}, connected()).found.candidate_value, 0.5);
    options = connected();
    options.refine = true;
    const ArrangedBuilding refined = arrangedIn(building, {lasers(count)}, options);
    EXPECT_EQ(refined.found.candidate_value, plain.found.candidate_value);
    EXPECT_GE(refined.found.coverage, plain.found.coverage - 1e-9);
    options = connected();
    options.alternatives = 2;
    const ArrangedBuilding others = arrangedIn(building, {lasers(2)}, options);
    ASSERT_EQ(others.found.alternatives.size(), 2U);
    for (const Arrangement& other : others.found.alternatives) {
        EXPECT_LE(other.candidate_value, others.found.candidate_value + 1e-9);
        EXPECT_EQ(other.sensors.size(), 2U);
    }
}

TEST(BuildingSite, ATargetIsThatOfAllRooms) {
    const SiteScene building = twoStoreys();
    ArrangeOptions options = coarse();
    options.target = 0.6;
    const ArrangedBuilding fewest = arrangedIn(building, {lasers(9)}, options);
    ASSERT_TRUE(fewest.found.is_reached);
    const auto count = static_cast<int>(fewest.found.sensors.size());
    EXPECT_EQ(fewest.found.least, count) << "proven";
    EXPECT_GE(arrangedIn(building, {lasers(count)}, coarse()).found.candidate_value, 0.6);
    EXPECT_LT(arrangedIn(building, {lasers(count - 1)}, coarse()).found.candidate_value, 0.6);
}

/// Two sites on the ground, and one in the upper storey.
std::vector<RoomGoals> threePlaces() {
    std::vector<RoomGoals> goals(2);
    goals[0].places = {{{1, 1}, {Angle()}}, {{4, 1}, {Angle::degrees(90)}}};
    goals[1].places = {{{0, 0}, {Angle::degrees(45), Angle::degrees(225)}}};
    return goals;
}

ArrangeOptions listed() {
    ArrangeOptions options = coarse();
    options.strategy = Strategy::List;
    return options;
}

TEST(BuildingSite, PlacesOfAllStoreysAreOneList) {
    const SiteScene building = twoStoreys();
    const std::vector<RoomGoals> goals = threePlaces();
    for (int count = 1; count <= 3; ++count) {
        const ArrangedBuilding result = arrangedIn(building, {lasers(count)}, listed(), goals);
        EXPECT_EQ(result.found.candidates, 4U);
        // Every set of candidates, by hand.
        std::vector<std::vector<double>> values(2);  // by storey, [n] of its best n
        for (std::size_t storey = 0; storey < 2; ++storey) {
            values[storey].push_back(0);
            ArrangeOptions options = listed();
            options.list = goals[storey].places;
            const Scene& scene = *building.scenes[storey];
            for (int n = 1; n <= count; ++n) {
                const SensorSpec spec = lasers(n);
                SilentProgress progress;
                values[storey].push_back(
                    areaOf(building, storey) *
                    arrange(scene, groupsToPlace(scene, std::span(&spec, 1), {}, false), options,
                            progress)
                        .candidate_value);
            }
        }
        double best = 0;
        for (std::size_t n = 0; n < values[0].size(); ++n)
            best = std::max(best, values[0][n] + values[1][static_cast<std::size_t>(count) - n]);
        EXPECT_NEAR(result.found.candidate_value,
                    best / (areaOf(building, 0) + areaOf(building, 1)), 1e-6)
            << count;
        EXPECT_LE(result.gap(), result.found.rounding + 1e-12) << "proven";
        for (const Placement& sensor : result.found.sensors) {
            const std::vector<Site>& places = goals[sensor.room].places;
            EXPECT_TRUE(std::any_of(places.begin(), places.end(), [&](const Site& site) {
                return site.place == sensor.pose.position.onFloor();
            }));
        }
    }
}

TEST(BuildingSite, AStoreyWithoutPlacesTakesNoSensor) {
    const SiteScene building = twoStoreys();
    std::vector<RoomGoals> goals = threePlaces();
    goals[1].places.clear();
    goals[1].takes_sensors = false;
    const ArrangedBuilding result = arrangedIn(building, {lasers(2)}, listed(), goals);
    EXPECT_EQ(result.counts, (std::vector<int>{2, 0}));
}

TEST(BuildingSite, TracesAndGainsAreOfAllStoreys) {
    const SiteScene building = twoStoreys();
    ArrangeOptions options = coarse();
    options.wants_trace = options.wants_gains = true;
    const ArrangedBuilding result = arrangedIn(building, {lasers(3)}, options);
    ASSERT_EQ(result.found.tried.size(), result.found.candidates);
    EXPECT_EQ(std::count_if(result.found.tried.begin(), result.found.tried.end(),
                            [](const TriedPose& pose) { return pose.is_chosen; }),
              3);
    // Each candidate adds what the room alone says, by its share of the floor.
    for (std::size_t storey = 0; storey < 2; ++storey) {
        const SensorSpec spec = lasers(1);
        const Scene& scene = *building.scenes[storey];
        SilentProgress progress;
        const Arrangement wanted =
            arrange(scene, groupsToPlace(scene, std::span(&spec, 1), {}, false), options, progress);
        const double share = areaOf(building, storey) / (areaOf(building, 0) + areaOf(building, 1));
        std::vector<TriedPose> own;
        for (const TriedPose& pose : result.found.tried)
            if (pose.room == building.document.storeys[storey].id) own.push_back(pose);
        ASSERT_EQ(own.size(), wanted.tried.size());
        for (std::size_t i = 0; i < own.size(); ++i) {
            EXPECT_EQ(own[i].pose, wanted.tried[i].pose);
            EXPECT_NEAR(own[i].value, share * wanted.tried[i].value, 1e-6);
            EXPECT_EQ(own[i].slice_area, wanted.tried[i].slice_area);
        }
    }
    ASSERT_EQ(result.found.gains.size(), 3U);
    double sum = 0;
    for (const GainMap& map : result.found.gains) {
        EXPECT_NE(map.sensor.find('/'), std::string::npos) << map.sensor;
        for (const TriedPose& pose : map.poses)
            if (pose.is_chosen) sum += pose.value;
    }
    EXPECT_NEAR(sum, result.found.candidate_value, 1e-6);
}

TEST(BuildingSite, OneStoreyIsARoom) {
    const std::string room =
        "- storey: {id: only, records: [{fence: {path: [[0, 0], [5, 0], [5, 3], [0, 3]], closed: "
        "yes}}, {wall: {from: [2, 0], to: [2, 2]}}]}\n";
    const SiteScene building = makeSiteScene(readBuilding(room, "house.yaml", {}), {}, {});
    const ArrangedBuilding result = arrangedIn(building, {lasers(2)}, coarse());
    const Arrangement wanted = alone(*building.scenes[0], 2);
    ASSERT_EQ(result.found.sensors.size(), wanted.sensors.size());
    for (std::size_t i = 0; i < wanted.sensors.size(); ++i) {
        EXPECT_EQ(result.found.sensors[i].pose, wanted.sensors[i].pose);
        EXPECT_EQ(result.found.sensors[i].sensor, wanted.sensors[i].sensor);
    }
    EXPECT_NEAR(result.found.candidate_value, wanted.candidate_value, 1e-12);
    EXPECT_EQ(result.found.coverage, wanted.coverage);
    EXPECT_EQ(result.found.area, wanted.area);
}

TEST(BuildingSite, ZonesOfOneStoreyCountAlone) {
    const SiteScene building = twoStoreys();
    std::vector<RoomGoals> goals(2);
    const NamedZone zone = readZone("rect:-1,-1,0.5,0.5", building.scenes[1]->environment);
    goals[1].weights.targets = {zone};
    goals[0].counts = false;
    ArrangeOptions options = coarse();
    options.weights.targets = {zone};
    const ArrangedBuilding result = arrangedIn(building, {lasers(1)}, options, goals);
    EXPECT_EQ(result.counts, (std::vector<int>{0, 1}));
    SilentProgress progress;
    const SensorSpec one = lasers(1);
    const Scene& upper = *building.scenes[1];
    const Arrangement wanted =
        arrange(upper, groupsToPlace(upper, {&one, 1}, {}, false), options, progress);
    EXPECT_NEAR(result.found.candidate_value, wanted.candidate_value, 1e-12);
    ASSERT_TRUE(result.found.value.has_value());
    EXPECT_NEAR(*result.found.value, wanted.value.value_or(0), 1e-12);
    EXPECT_EQ(result.found.sensors[0].pose, wanted.sensors[0].pose);
}

TEST(BuildingSite, SensorsAreKeptToRoomsOfTheirZones) {
    const SiteScene building = twoStoreys();
    std::vector<RoomGoals> goals(2);
    goals[0].keep_in = {readZone("rect:0,0,1.5,3", building.scenes[0]->environment)};
    goals[1].takes_sensors = false;
    const ArrangedBuilding result = arrangedIn(building, {lasers(2)}, coarse(), goals);
    EXPECT_EQ(result.counts, (std::vector<int>{2, 0}));
    for (const Placement& sensor : result.found.sensors) EXPECT_LE(sensor.pose.position.x, 1.5);
}

TEST(BuildingSite, StandingSensorsOfOpenStoreysCount) {
    const std::string text =
        "- storey: {id: ground, height: 2.8, records: [{ispace: {size: 5 x 4}}]}\n"
        "- storey: {id: gallery, z: 3, height: 2.8, records: [{ispace: {size: 5 x 4}}]}\n"
        "- shaft: {storeys: 'ground,gallery', path: [[-3, -3], [3, -3], [3, 3], [-3, 3]]}\n";
    StoreyedDocument document = readBuilding(text, "house.yaml", {});
    const Document layout =
        readRecordText("#3dm 1\ncamera id=gallery/c fov=90 at=0,0,2.5 tilt=-90 range=9\n", "l.3dm",
                       sceneSchemas());
    const SiteScene building = makeSiteScene(document, layoutsOf(layout, document), {});
    const double before = measureSite(building, {}).coverage.grid.value_or(0);
    ASSERT_GT(before, 0.5);
    ArrangeOptions options = coarse();
    options.cells = CellSize{0.1};
    const ArrangedBuilding result = arrangedIn(building, {lasers(1)}, options);
    EXPECT_GE(result.found.candidate_value, before - 1e-6);
    EXPECT_NEAR(result.found.candidate_value, result.found.coverage, 0.01);
    EXPECT_FALSE(result.found.rooms[1].has_floor);
}

TEST(BuildingSite, ATargetThatIsMetExactlyIsReached) {
    const SiteScene building = makeSiteScene(
        readBuilding("- storey: {id: big, records: [{ispace: {size: 12 x 8}}]}\n"
                     "- storey: {id: small, z: 3, records: [{ispace: {size: 6 x 4}}]}\n",
                     "house.yaml", {}),
        {}, {});
    ArrangeOptions options = coarse();
    options.x = 1;
    options.y = 1;
    options.target = 0.2;
    Record laser(*sceneSchemas().find("laser"));
    laser.set("range", Tuple{20});
    laser.set("fov", 360.0);
    std::vector<RoomGoals> goals(2);
    goals[0].takes_sensors = false;
    const ArrangedBuilding result = arrangedIn(building, {{laser, 1}}, options, goals);
    EXPECT_TRUE(result.found.is_reached);
    EXPECT_NEAR(result.found.candidate_value, 0.2, 1e-6);
}

TEST(BuildingSite, StandingSensorsAndPendingOnesKeepTheirStoreys) {
    const SiteScene empty = twoStoreys();
    const Document layout = readRecordText(
        "#3dm 1\nlaser id=upper/a range=2 fov=90 at=0,0 heading=0\n"
        "laser id=ground/b range=2 fov=90\n",
        "layout.3dm", sceneSchemas());
    const SiteScene building = makeSiteScene(empty.document, layoutsOf(layout, empty.document), {});
    const ArrangedBuilding result = arrangedIn(building, {lasers(1)}, coarse());
    ASSERT_EQ(result.found.sensors.size(), 2U);
    const auto pending = std::find_if(result.found.sensors.begin(), result.found.sensors.end(),
                                      [](const Placement& one) { return one.sensor == "b"; });
    ASSERT_NE(pending, result.found.sensors.end());
    EXPECT_EQ(pending->room, 0U);
    const Document written =
        buildingLayout({{}, "house.yaml", building.document.digest(), "grid", "exact"}, building,
                       &layout, result.groups, result.found);
    std::vector<std::string> ids;
    for (const Record& record : written.records)
        if (record.keyword() == "laser") ids.push_back(record.writtenId());
    ASSERT_EQ(ids.size(), 3U);
    EXPECT_EQ(ids[0], "upper/a");
    EXPECT_EQ(ids[1], "ground/b");
}

TEST(BuildingSite, RefinesEachRoomAndNeverLosesValue) {
    const SiteScene building = twoStoreys();
    ArrangeOptions options = coarse();
    options.refine = true;
    const ArrangedBuilding result = arrangedIn(building, {lasers(2)}, options);
    EXPECT_GT(result.found.refined_after, result.found.refined_before);
    EXPECT_GE(*result.found.value, result.found.candidate_value - 1e-5);
    EXPECT_GE(result.found.bound, *result.found.value - 1e-9);
    EXPECT_LT(result.found.bound, 0.6) << "two quarters of a disc of 2 m on 21 m2, and their edges";
}

TEST(BuildingSite, LeavesOutStoreysThatAreAllOpen) {
    const auto storeys = [](bool has_middle) {
        std::string text =
            "- storey: {id: ground, height: 2, records: [{ispace: {size: 5 x 3}}]}\n";
        if (has_middle)
            text += "- storey: {id: middle, z: 3, height: 2, records: [{ispace: {size: 5 x 3}}]}\n";
        text += "- storey: {id: top, z: 6, height: 2, records: [{ispace: {size: 4 x 2}}]}\n";
        if (has_middle)
            text +=
                "- shaft: {storeys: 'ground,middle', path: [[-3, -2], [3, -2], [3, 2], [-3, "
                "2]]}\n";
        return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
    };
    const SiteScene whole = storeys(true), rest = storeys(false);
    SensorSpec cameras = lasers(3);
    cameras.record = Record(*sceneSchemas().find("camera"));
    cameras.record.set("fov", Tuple{90});
    cameras.record.set("tilt", -40.0);
    for (const SensorSpec& sensor : {lasers(3), cameras}) {
        const ArrangedBuilding result = arrangedIn(whole, {sensor}, coarse());
        const ArrangedBuilding wanted = arrangedIn(rest, {sensor}, coarse());
        EXPECT_TRUE(result.found.rooms[0].has_floor);
        EXPECT_FALSE(result.found.rooms[1].has_floor);
        EXPECT_TRUE(result.found.rooms[2].has_floor);
        EXPECT_EQ(result.counts, (std::vector<int>{wanted.counts[0], 0, wanted.counts[1]}));
        EXPECT_NEAR(result.found.candidate_value, wanted.found.candidate_value, 1e-6);
        EXPECT_NEAR(result.found.candidate_bound, wanted.found.candidate_bound, 1e-5);
        EXPECT_NEAR(result.found.coverage, wanted.found.coverage, 1e-6);
    }
}

TEST(BuildingSite, NeedsAFloor) {
    const std::string text =
        "- storey: {id: ground, z: 0, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- storey: {id: upper, z: 3, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- storey: {id: cellar, z: -3, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- shaft: {storeys: 'cellar,ground,upper', path: [[-3, -2], [3, -2], [3, 2], [-3, 2]]}\n";
    const SiteScene building = makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
    const ArrangedBuilding result = arrangedIn(building, {lasers(1)}, coarse());
    EXPECT_TRUE(result.found.rooms[0].has_floor) << "the lowest has one";
    EXPECT_FALSE(result.found.rooms[1].has_floor);
    EXPECT_FALSE(result.found.rooms[2].has_floor);
}

TEST(BuildingSite, CoversAsMuchAsCoverageSays) {
    const SiteScene building = twoStoreys();
    const ArrangedBuilding result = arrangedIn(building, {lasers(3)}, coarse());
    const Document layout =
        buildingLayout({{}, "house.yaml", building.document.digest(), "grid", "exact"}, building,
                       nullptr, result.groups, result.found);
    ASSERT_EQ(layout.records.size(), 5U);  // environment, sensors, result
    const SiteCoverage coverage = measureSite(written(building, result), {});
    EXPECT_NEAR(result.found.coverage, coverage.coverage.grid.value_or(0), 1e-12);
    double covered = 0;
    for (const Coverage& storey : coverage.storeys)
        covered += storey.report.coverage.exact.value_or(0) * storey.report.indoor_area;
    EXPECT_NEAR(coverage.coverage.exact.value_or(0), covered / coverage.indoor_area, 1e-12);
    EXPECT_NEAR(coverage.indoor_area, 21, 1e-9);
    EXPECT_NEAR(std::accumulate(coverage.redundancy.begin(), coverage.redundancy.end(), 0.0), 1,
                1e-9);
    ASSERT_FALSE(coverage.storeys[0].report.sensors.empty());
    for (const SensorMetrics& sensor : coverage.storeys[0].report.sensors)
        EXPECT_TRUE(sensor.id.starts_with("ground/"));
}

}  // namespace arranged_site_test
}  // namespace ispace
