// SPDX-License-Identifier: GPL-3.0-or-later
#include "site/storey_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "record/text.h"
#include "site/site_coverage.h"
#include "site/storeys.h"
#include "support/test_arrange_building.h"
#include "support/test_layout.h"

namespace ispace {
namespace storey_sight_test {

/// Two storeys around a shaft, the upper one turned by a quarter.
constexpr const char* kTurned =
    "- storey: {id: ground, height: 2.7, records: [{fence: {path: [[0, 0], [6, 0], [6, 4], [0, "
    "4]], closed: yes, height: 2.7}}, {desk: {at: [3, 2.4], height: 0.8}}]}\n"
    "- storey: {id: upper, z: 3, height: 2.7, at: [6, 0], heading: 90, records: [{fence: {path: "
    "[[0, 0], [4, 0], [4, 6], [0, 6]], closed: yes, height: 2.7}}]}\n"
    "- shaft: {storeys: 'ground,upper', path: [[2.5, 1], [3.5, 1], [3.5, 3], [2.5, 3]]}\n";

SiteScene placed(const std::string& building, const std::string& layout) {
    StoreyedDocument document = readBuilding(building, "house.yaml", {});
    const std::vector<Document> layouts = layoutsOf(testing::layoutDocument(layout), document);
    return makeSiteScene(std::move(document), layouts, testing::devices());
}

CoverageOptions coarseFloor() {
    CoverageOptions options;
    options.cells = CellSize{0.25};
    options.exact = false;
    return options;
}

TEST(StoreySight, CellsAreThoseOfTheRegionsSeen) {
    const SiteScene empty = placed(kTurned, "");
    const Coupling coupling(empty);
    const StoreySight sight(coupling, 0);
    EXPECT_TRUE(sight.joinsRooms());
    std::mt19937_64 engine(3);
    const auto uniform = [&engine](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    };
    std::size_t seen = 0;
    for (int round = 0; round < 40; ++round) {
        const std::string pose = " at=" + std::to_string(uniform(0.3, 3.7)) + ',' +
                                 std::to_string(uniform(0.3, 5.7)) + ',' +
                                 std::to_string(uniform(0.5, 2.6)) +
                                 " heading=" + std::to_string(uniform(-180, 180)) +
                                 " tilt=" + std::to_string(uniform(-90, -20));
        const SiteScene building =
            placed(kTurned, "camera id=upper/c fov=83 pixels=100,80 range=9" + pose + "\n");
        const Sensor& camera = building.scenes[1]->sensors.front();
        const SiteCoverage coverage = measureSite(building, coarseFloor());
        const Coverage& ground = coverage.storeys[0];
        CellSet cells(ground.target.grid.size());
        for (const SensorView& view : ground.sensors) cells |= view.cells;
        CellParts parts;
        CellSet looked(cells.size());
        if (sight.maySee(1, camera, 0)) {
            sight.look(1, {&camera, 1}, 0, ground.target.grid, parts);
            looked = cellsOf(parts, 0, cells.size());
        }
        EXPECT_FALSE(sight.maySee(0, camera, 1)) << "a floor is not seen from below";
        seen += cells.count();
        EXPECT_LE(cells.count() + looked.count() - 2 * countCommon(cells, looked), 1U) << pose;
    }
    EXPECT_GT(seen, 100U);
}

TEST(StoreySight, TheProofHoldsForAllLayoutsOfTheBuilding) {
    const std::string text =
        "- storey: {id: ground, height: 2.7, records: [{fence: {path: [[0, 0], [6, 0], [6, 4], "
        "[0, 4]], closed: yes, height: 2.7}}, {wall: {from: [3.9, 0], to: [3.9, 2.6]}}]}\n"
        "- storey: {id: upper, z: 3, height: 2.7, records: [{fence: {path: [[0, 0], [6, 0], [6, "
        "4], [0, 4]], closed: yes, height: 2.7}}]}\n"
        "- shaft: {storeys: 'ground,upper', path: [[2.5, 1], [3.5, 1], [3.5, 3], [2.5, 3]]}\n";
    const std::string camera = "camera fov=83 pixels=100,100 range=7 tilt=-52.3";
    ArrangeOptions options;
    options.strategy = Strategy::Grid;
    options.x = 2;
    options.y = 1;
    options.headings = 4;
    options.cells = CellSize{0.25};
    options.mount.on = MountOn::Ceiling;
    options.mount.heights = {2.47};
    options.search.optimizer = Optimizer::Exact;
    // All pairs of positions and headings.
    std::vector<std::string> places;
    for (const char* storey : {"ground", "upper"})
        for (const char* at : {"2,2", "4,2"})
            for (const char* heading : {"0", "90", "180", "-90"})
                places.push_back(std::string(storey) + "/c" + std::to_string(places.size()) +
                                 " at=" + at + ",2.47 heading=" + heading);
    double best = 0, best_apart = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = i + 1; k < places.size(); ++k) {
            std::string layout;
            for (const std::size_t of : {i, k})
                layout.append(camera).append(" id=").append(places[of]).append("\n");
            const SiteScene building = placed(text, layout);
            const SiteCoverage both = measureSite(building, coarseFloor());
            best = std::max(best, both.coverage.grid.value_or(0));
            double apart = 0;
            for (const auto& floor : both.floors) {
                RayScenes worlds(floor->environment);
                const Coverage own = measureCoverage(*floor, worlds, coarseFloor());
                apart += own.report.coverage.grid.value_or(0) * own.report.indoor_area;
            }
            best_apart = std::max(best_apart, apart / both.indoor_area);
        }
    EXPECT_GT(best, best_apart + 0.01) << "the shaft counts";
    const SiteScene building = placed(text, "");
    Record record(*sceneSchemas().find("camera"));
    record.set("fov", Tuple{83});
    record.set("pixels", Tuple{100, 100});
    record.set("range", Tuple{7});
    record.set("tilt", -52.3);
    const ArrangedBuilding result = arrangedIn(building, {{record, 2}}, options);
    const Arrangement& found = result.found;
    EXPECT_EQ(found.candidates, places.size());
    EXPECT_NEAR(found.candidate_value, best, 1e-12);
    EXPECT_LE(result.gap(), found.rounding + 1e-12) << "proven";
    EXPECT_LT(found.rounding, 1e-5);
    EXPECT_EQ(result.counts[0] + result.counts[1], 2);
    EXPECT_GE(found.bound, found.candidate_value);
    // The written layout has that value.
    const SiteScene again = written(building, result);
    EXPECT_NEAR(measureSite(again, coarseFloor()).coverage.grid.value_or(0), best, 1e-9);
    EXPECT_NEAR(measureSite(again, {}).coverage.grid.value_or(0), found.coverage, 1e-12);
}

/// Two storeys around an atrium.
constexpr const char* kAtrium =
    "- storey: {id: ground, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], [0, "
    "6]], closed: yes, height: 2.8}}]}\n"
    "- storey: {id: gallery, z: 3, height: 2.8, records: [{fence: {path: [[0, 0], [8, 0], [8, 6], "
    "[0, 6]], closed: yes, height: 2.8}}]}\n"
    "- shaft: {storeys: 'ground,gallery', path: [[2, 1.5], [6, 1.5], [6, 4.5], [2, 4.5]]}\n";

/// A tilted camera to place.
Record cameraToPlace(double fov, double tilt) {
    Record record(*sceneSchemas().find("camera"));
    record.set("fov", Tuple{fov});
    record.set("tilt", tilt);
    record.set("range", Tuple{8});
    return record;
}

TEST(StoreySight, TheCoverageOfALayoutIsAtTheDensityOfTheSearch) {
    const SiteScene building = placed(kAtrium, "");
    ArrangeOptions options;
    options.density = {1, 1, 4};
    options.cells = CellSize{0.25};
    options.mount.on = MountOn::Wall;
    options.plane = 0.5;
    options.pixel_density = 60;
    const ArrangedBuilding result = arrangedIn(building, {{cameraToPlace(90, -50), 2}}, options);
    const SiteScene again = written(building, result);
    CoverageOptions measure;
    measure.plane = options.plane;
    const double any = measureSite(again, measure).coverage.grid.value_or(0);
    measure.density = options.pixel_density;
    const double dense = measureSite(again, measure).coverage.grid.value_or(0);
    EXPECT_LT(dense, any - 0.01) << "the density matters";
    EXPECT_NEAR(result.found.coverage, dense, 1e-12);
}

TEST(StoreySight, TheValueOfALayoutIsItsCoverageByCells) {
    // Rims of openings run through centres of cells, as seen from these heights.
    for (const char* text : {kAtrium, kTurned})
        for (const double plane : {0.0, 0.6})
            for (const double density : {0.0, 45.0}) {
                const SiteScene building = placed(text, "");
                ArrangeOptions options;
                options.density = {1, 1, 4};
                options.cells = CellSize{0.1};
                options.mount.on = MountOn::Wall;
                options.mount.heights = {2.4};
                options.plane = plane;
                options.pixel_density = density;
                const ArrangedBuilding result =
                    arrangedIn(building, {{cameraToPlace(90, -50), 1}}, options);
                CoverageOptions measure;
                measure.cells = CellSize{0.1};
                measure.plane = plane;
                measure.density = density;
                for (const bool is_exact : {false, true}) {
                    measure.exact = is_exact;
                    const double covered =
                        measureSite(written(building, result), measure).coverage.grid.value_or(0);
                    EXPECT_NEAR(result.found.value.value_or(0), covered, 1e-9)
                        << text << plane << ' ' << density;
                    EXPECT_GE(result.found.bound, covered - 1e-9);
                }
            }
}

}  // namespace storey_sight_test
}  // namespace ispace
