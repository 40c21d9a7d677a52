// SPDX-License-Identifier: GPL-3.0-or-later
#include "building/share_out.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "base/error.h"
#include "building/building_arrange.h"
#include "building/building_coverage.h"
#include "scene/placement_schemas.h"

namespace ispace {
namespace {

double at(const std::vector<double>& curve, int n) {
    return curve[std::min(static_cast<std::size_t>(n), curve.size() - 1)];
}

/// Calls visit(counts) for every split of `sensors` over the storeys.
void forEachSplit(std::size_t storeys, int sensors,
                  const std::function<void(const std::vector<int>&)>& visit) {
    std::vector<int> counts(storeys);
    const std::function<void(std::size_t, int)> split = [&](std::size_t i, int left) {
        if (i + 1 == storeys) {
            counts[i] = left;
            return visit(counts);
        }
        for (counts[i] = 0; counts[i] <= left; ++counts[i]) split(i + 1, left - counts[i]);
    };
    split(0, sensors);
}

TEST(ShareOut, IsTheBestOfAllSplits) {
    std::mt19937_64 engine(7);
    const auto below = [&engine](std::uint64_t end) { return engine() % end; };
    for (int round = 0; round < 200; ++round) {
        std::vector<StoreyCurve> curves(1 + below(4));
        for (StoreyCurve& curve : curves) {
            curve = {{0}, {0}};
            // Not concave: two sensors together may see more than twice one.
            for (std::uint64_t n = below(6); n-- > 0;) {
                curve.values.push_back(curve.values.back() + static_cast<double>(below(9)));
                curve.bounds.push_back(std::max(
                    curve.bounds.back(), curve.values.back() + static_cast<double>(below(3))));
            }
        }
        const int sensors = static_cast<int>(below(8));
        double value = 0, bound = 0;
        forEachSplit(curves.size(), sensors, [&](const std::vector<int>& counts) {
            double sum = 0, most = 0;
            for (std::size_t i = 0; i < curves.size(); ++i) {
                sum += at(curves[i].values, counts[i]);
                most += at(curves[i].bounds, counts[i]);
            }
            value = std::max(value, sum);
            bound = std::max(bound, most);
        });
        const SharedSensors shared = shareOut(curves, sensors);
        EXPECT_EQ(shared.value, value);
        EXPECT_EQ(shared.bound, bound);
        EXPECT_EQ(std::accumulate(shared.counts.begin(), shared.counts.end(), 0), sensors);
        double sum = 0;
        for (std::size_t i = 0; i < curves.size(); ++i)
            sum += at(curves[i].values, shared.counts[i]);
        EXPECT_EQ(sum, value);
    }
}

TEST(ShareOut, PrefersLowerStoreys) {
    const StoreyCurve curve{{0, 5, 7}, {0, 5, 7}};
    EXPECT_EQ(shareOut(std::vector<StoreyCurve>{curve, curve}, 3).counts, (std::vector<int>{2, 1}));
    EXPECT_EQ(shareOut(std::vector<StoreyCurve>{curve, curve}, 9).counts, (std::vector<int>{7, 2}));
    EXPECT_TRUE(shareOut({}, 3).counts.empty());
}

/// Two storeys: one room with a wall across, and one hall.
BuildingScene twoStoreys() {
    const std::string text =
        "- storey: {id: ground, records: [{fence: {path: [[0, 0], [5, 0], [5, 3], [0, 3]], closed: "
        "yes}}, {wall: {from: [2, 0], to: [2, 2]}}]}\n"
        "- storey: {id: upper, z: 3, records: [{ispace: {size: 3 x 2}}]}\n";
    return makeBuildingScene(readBuilding(text, "house.yaml", {}), {}, {});
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

TEST(BuildingArrange, ProvesTheBestOfEverySplitSolvedApart) {
    const BuildingScene building = twoStoreys();
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
    SilentProgress progress;
    const BuildingArrangement found =
        arrangeBuilding(building, lasers(kSensors), kSensors, coarse(), progress);
    EXPECT_NEAR(found.value, best / (ground + upper), 1e-12);
    EXPECT_NEAR(found.bound, bound / (ground + upper), 1e-12);
    EXPECT_EQ(std::accumulate(found.counts.begin(), found.counts.end(), 0), kSensors);
    EXPECT_EQ(found.counts, best_counts);
    EXPECT_GT(found.counts[0], 0);
    EXPECT_GT(found.counts[1], 0);
}

TEST(BuildingArrange, LeavesOutStoreysThatAreAllOpen) {
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
        return makeBuildingScene(readBuilding(text, "house.yaml", {}), {}, {});
    };
    SilentProgress progress;
    const BuildingScene whole = storeys(true), rest = storeys(false);
    SensorSpec cameras = lasers(3);
    cameras.record = Record(*sceneSchemas().find("camera"));
    cameras.record.set("fov", Tuple{90});
    cameras.record.set("tilt", -40.0);
    for (const SensorSpec& sensor : {lasers(3), cameras}) {
        const BuildingArrangement found = arrangeBuilding(whole, sensor, 3, coarse(), progress);
        const BuildingArrangement wanted = arrangeBuilding(rest, sensor, 3, coarse(), progress);
        EXPECT_EQ(found.has_floor, (std::vector<bool>{true, false, true}));
        EXPECT_EQ(found.counts, (std::vector<int>{wanted.counts[0], 0, wanted.counts[1]}));
        EXPECT_NEAR(found.value, wanted.value, 1e-6);
        EXPECT_NEAR(found.bound, wanted.bound, 1e-6);
        EXPECT_NEAR(found.coverage, wanted.coverage, 1e-6);
    }
}

TEST(BuildingArrange, NeedsAFloor) {
    const std::string text =
        "- storey: {id: ground, z: 0, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- storey: {id: upper, z: 3, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- storey: {id: cellar, z: -3, height: 2, records: [{ispace: {size: 5 x 3}}]}\n"
        "- shaft: {storeys: 'cellar,ground,upper', path: [[-3, -2], [3, -2], [3, 2], [-3, 2]]}\n";
    SilentProgress progress;
    const BuildingScene building = makeBuildingScene(readBuilding(text, "house.yaml", {}), {}, {});
    const BuildingArrangement found = arrangeBuilding(building, lasers(1), 1, coarse(), progress);
    EXPECT_EQ(found.has_floor, (std::vector<bool>{true, false, false})) << "the lowest has one";
}

TEST(BuildingArrange, CoversAsMuchAsCoverageSays) {
    const BuildingScene building = twoStoreys();
    SilentProgress progress;
    const BuildingArrangement found = arrangeBuilding(building, lasers(3), 3, coarse(), progress);
    const Document layout = buildingLayout(
        {{}, "house.yaml", building.document.digest(), "grid", "exact"}, building, found);
    ASSERT_EQ(layout.records.size(), 5U);  // environment, sensors, result
    const BuildingScene placed = makeBuildingScene(
        building.document, layoutsOf(layout, building.document), building.devices);
    const BuildingCoverage coverage = measureBuilding(placed, {});
    EXPECT_NEAR(found.coverage, coverage.coverage.grid.value_or(0), 1e-12);
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

}  // namespace
}  // namespace ispace
