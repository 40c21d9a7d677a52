// SPDX-License-Identifier: GPL-3.0-or-later
// Tests the search for sensors that detect people on the storeys of a building.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "extensions/presence/presence.h"
#include "extensions/presence/presence_demand.h"
#include "extensions/presence/site_presence.h"
#include "extensions/radars/radars_test.h"
#include "scene/placement_schemas.h"
#include "site/site_coverage.h"
#include "support/test_arrange_building.h"

namespace ispace::presence {
namespace site_demand_with_radars_test {

SiteScene twoStoreys(const std::string& more = "") {
    const std::string text =
        "- storey: {id: ground, records: [{ispace: {size: 8 x 6 x 2.5}}, {wall: {from: [0, -3], "
        "to: [0, 2.9]}}]}\n"
        "- storey: {id: upper, z: 3, records: [{ispace: {size: 5 x 4 x 2.5}}]}\n" +
        more;
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

/// Ways of so many metres along y.
PeoplePaths wayOf(Point2 from, double metres) {
    PathCutter cutter;
    for (int i = 0; i <= 20; ++i) cutter.add("ann", i * kPathStep, from + Vec2{0, metres * i / 20});
    return cutter.finish();
}

std::vector<PeoplePaths> waysInBoth() { return {wayOf({-3, -2}, 3), wayOf({-2, -1.5}, 2)}; }

ArrangeOptions coarse() {
    ArrangeOptions options;
    options.density = {1, 1, 8};
    options.cells = CellSize{0.25};
    options.search.optimizer = Optimizer::Exact;
    return options;
}

SensorSpec radars(int count) {
    Record record(*sceneSchemas().find("radar"));
    record.set("range", Tuple{2});
    return {record, count};
}

std::shared_ptr<const Demand> demandOf(const PeoplePaths& ways) {
    return presenceDemand(std::make_shared<PeoplePaths>(ways), 0);
}

ArrangedBuilding arrangedFor(const SiteScene& building, int sensors,
                             const std::vector<PeoplePaths>& ways) {
    ArrangeOptions options = coarse();
    std::vector<RoomGoals> goals(ways.size());
    for (std::size_t i = 0; i < ways.size(); ++i) {
        goals[i].demand = demandOf(ways[i]);
        goals[i].counts = !ways[i].pieces.empty();
    }
    options.demand = goals[0].demand;
    return arrangedIn(building, {radars(sensors)}, options, goals);
}

/// The share of all ways that the sensors detect, as coverage --presence measures it.
double presenceIn(const SiteScene& building, const ArrangedBuilding& arranged,
                  const std::vector<PeoplePaths>& ways) {
    std::vector<Presence> storeys;
    for (std::size_t i = 0; i < ways.size(); ++i)
        storeys.push_back(measurePresence(
            withPlaced(*building.scenes[i], arranged.groups, arranged.found.sensors, i), ways[i],
            0));
    return sumOverStoreys(storeys).all.share;
}

/// The length detected by the best sensors in a room alone, and its bound.
CurvePoint alone(const Scene& scene, int sensors, const PeoplePaths& ways) {
    ArrangeOptions options = coarse();
    options.demand = demandOf(ways);
    const SensorSpec spec = radars(sensors);
    SilentProgress progress;
    double length = 0;
    for (const PathPiece& piece : ways.pieces) length += piece.length;
    const Arrangement found =
        arrange(scene, groupsToPlace(scene, std::span(&spec, 1), {}, false), options, progress);
    return {sensors, length * found.value.value_or(0), length * found.bound};
}

TEST(BuildingDemand, ValueIsTheShareThatCoverageMeasuresAndTheBestSplit) {
    const SiteScene building = twoStoreys();
    const std::vector<PeoplePaths> ways = waysInBoth();
    for (int sensors = 1; sensors <= 3; ++sensors) {
        const ArrangedBuilding result = arrangedFor(building, sensors, ways);
        ASSERT_TRUE(result.found.value);
        EXPECT_NEAR(*result.found.value, presenceIn(building, result, ways), 1e-6) << sensors;
        double best = 0, bound = 0;
        for (int ground = 0; ground <= sensors; ++ground) {
            const CurvePoint none{};
            const CurvePoint below =
                ground > 0 ? alone(*building.scenes[0], ground, ways[0]) : none;
            const CurvePoint above =
                ground < sensors ? alone(*building.scenes[1], sensors - ground, ways[1]) : none;
            best = std::max(best, below.value + above.value);
            bound = std::max(bound, below.value + above.value);
        }
        EXPECT_NEAR(*result.found.value, best / 5, 1e-6) << sensors;
        EXPECT_GE(result.found.bound, bound / 5 - 1e-6) << sensors;
        EXPECT_NEAR(*result.found.value, result.found.bound, 1e-6) << "proven";
    }
}

TEST(BuildingDemand, AStoreyOfNobodyDoesNotMatter) {
    const SiteScene building = twoStoreys();
    const std::vector<PeoplePaths> ways = {waysInBoth()[0], PeoplePaths()};
    const ArrangedBuilding result = arrangedFor(building, 2, ways);
    EXPECT_EQ(result.counts, (std::vector<int>{2, 0}));
    EXPECT_NEAR(*result.found.value, alone(*building.scenes[0], 2, ways[0]).value / 3, 1e-6);
    EXPECT_EQ(result.found.cells, ways[0].pieces.size());
}

TEST(BuildingDemand, SeveralKindsAndATargetAreOneProblem) {
    const SiteScene building = twoStoreys();
    const std::vector<PeoplePaths> ways = waysInBoth();
    ArrangeOptions options = coarse();
    std::vector<RoomGoals> goals(2);
    for (std::size_t i = 0; i < 2; ++i) goals[i].demand = demandOf(ways[i]);
    options.demand = goals[0].demand;
    options.target = 0.9;
    SensorSpec small = radars(9);
    small.record.set("range", Tuple{1.0});
    const ArrangedBuilding few = arrangedIn(building, {radars(9), small}, options, goals);
    EXPECT_TRUE(few.found.is_reached);
    EXPECT_GE(presenceIn(building, few, ways), 0.9 - 1e-6);
    EXPECT_EQ(few.found.least, few.found.sensors.size()) << "proven";
}

TEST(BuildingDemand, SensorsServeTheirOwnStorey) {
    // The shaft does not change what counts.
    const std::vector<PeoplePaths> ways = waysInBoth();
    const ArrangedBuilding closed = arrangedFor(twoStoreys(), 1, ways);
    const SiteScene open = twoStoreys(
        "- shaft: {storeys: 'ground,upper', path: [[1, -1], [2, -1], [2, 1], [1, 1]]}\n");
    const ArrangedBuilding result = arrangedFor(open, 1, ways);
    EXPECT_NEAR(*result.found.value, *closed.found.value, 1e-9);
    EXPECT_NEAR(*result.found.value, presenceIn(open, result, ways), 1e-6);
}

}  // namespace site_demand_with_radars_test
}  // namespace ispace::presence
