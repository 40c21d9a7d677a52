// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/site_robustness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "site/coupling.h"
#include "site/storey_people.h"

namespace ispace::robustness {
namespace site_robustness_test {

SiteScene sceneOf(const std::string& text) {
    return makeSiteScene(readBuilding(text, "house.yaml", {}), {}, {});
}

const std::string kRoom =
    "[{ispace: {size: 6 x 5}}, {zone: {id: z, path: '-2,-2;0,-2;0,0;-2,0'}}, "
    "{laser: {id: a, at: [-2.5, -2, 1], range: 4}}, {laser: {id: b, at: [2, 2, 1], heading: -120, "
    "range: 3}}]";

/// Two storeys with a shaft, through which a camera above sees the floor below.
SiteScene house() {
    return sceneOf(
        "- storey: {id: g, height: 3, records: " + kRoom +
        "}\n- storey: {id: u, z: 3, records: [{ispace: {size: 6 x 5}}, {camera: {id: c, at: [-1, "
        "-1.8, 2], tilt: -70, fov: 90}}, {laser: {id: d, at: [2.5, -2, 1], heading: 120, range: "
        "4}}]}\n"
        "- shaft: {id: s, storeys: 'g,u', path: '-1.5,-1;1,-1;1,1;-1.5,1'}\n");
}

/// The building without some of its sensors, by whole id.
SiteScene without(const SiteScene& building, const std::vector<std::string>& failing) {
    SiteScene left = building;
    for (std::size_t i = 0; i < left.scenes.size(); ++i) {
        Scene scene = *building.scenes[i];
        std::erase_if(scene.sensors, [&](const Sensor& sensor) {
            const std::string id = wholeId(building.document.storeys[i], sensor.id);
            return std::find(failing.begin(), failing.end(), id) != failing.end();
        });
        left.scenes[i] = std::make_shared<const Scene>(std::move(scene));
    }
    return left;
}

TEST(BuildingRobustness, FailuresAreTheWorstOfAllSets) {
    const SiteScene building = house();
    const SiteCoverage coverage = measureSite(building, {});
    const std::vector<std::string> ids = {"g/a", "g/b", "u/c", "u/d"};
    for (const int count : {1, 2}) {
        double least = 1, least_zone = 1;
        for (std::size_t i = 0; i < ids.size(); ++i)
            for (std::size_t j = i; j < ids.size(); ++j) {
                if ((count == 1) != (i == j)) continue;
                const CoverageReport left =
                    sumOfStoreys(measureSite(without(building, {ids[i], ids[j]}), {}));
                least = std::min(least, left.coverage.exact.value());
                least_zone = std::min(least_zone, left.zones.at(0).coverage.exact.value());
            }
        const std::vector<FigureLoss> losses = worstFailuresOfSite(coverage, count, {});
        ASSERT_EQ(losses.size(), 3U);
        EXPECT_TRUE(losses[0].is_exact);
        EXPECT_NEAR(losses[0].planned, coverage.coverage.exact.value(), 1e-9);
        EXPECT_NEAR(losses[0].worst, least, 1e-6) << count;
        EXPECT_NEAR(losses[2].worst, least_zone, 1e-6) << count;
        EXPECT_EQ(losses[2].figure.zone, "g/z");
        // By its own account, too.
        const CoverageReport left =
            sumOfStoreys(measureSite(without(building, losses[0].sensors), {}));
        EXPECT_NEAR(left.coverage.exact.value(), losses[0].worst, 1e-6);
    }
}

TEST(BuildingRobustness, TheOnlyStoreySuffersAsItsRoom) {
    const SiteScene building = sceneOf("- storey: {id: g, height: 3, records: " + kRoom + "}\n");
    const Scene& room = *Coupling(building).floors()[0];
    const SiteCoverage planned = measureSite(building, {});
    RayScenes worlds(room.environment);
    const Coverage alone = measureCoverage(room, worlds, {});
    SilentProgress silent;
    const MountingTolerance tolerance{0.1, Angle::degrees(5)};
    const auto values = [](const SampledFigures& sampled) {
        std::vector<std::vector<double>> all;
        for (const FigureSpread& figure : sampled.figures) all.push_back(figure.values);
        return all;
    };
    const auto expect_equal = [&](const SampledFigures& one, const SampledFigures& other) {
        const auto a = values(one), b = values(other);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            ASSERT_EQ(a[i].size(), b[i].size());
            for (std::size_t k = 0; k < a[i].size(); ++k) EXPECT_NEAR(a[i][k], b[i][k], 1e-9);
        }
    };
    expect_equal(perturbSite(building, planned, {}, tolerance, 5, 7, {}, silent),
                 perturbMounting(room, alone.report, {}, tolerance, 5, 7, {}, silent));
    const CrowdFloor floor(room);
    std::vector<Crowd> crowds;
    std::vector<SiteCrowd> building_crowds;
    for (std::uint64_t k = 0; k < 4; ++k) {
        crowds.push_back(floor.draw(5, {.seed = 7, .frame = k}));
        building_crowds.push_back({crowds.back()});
    }
    expect_equal(crowdSite(building, planned, {}, building_crowds, {}, silent),
                 measureCrowds(room, alone.report, {}, crowds, {}, silent));
    EXPECT_EQ(seedOfStorey(7, 0), 7U);
    EXPECT_NE(seedOfStorey(7, 1), 7U);
}

TEST(BuildingRobustness, SumsAreSharesOfAllFloor) {
    const SiteScene building = house();
    SiteCoverage coverage = measureSite(building, {});
    const CoverageReport sum = sumOfStoreys(coverage);
    // A camera stands above alone: none of the floor below has its pixels, but for those through
    // the shaft.
    ASSERT_FALSE(sum.densities.indoor.empty());
    const CoverageReport &ground = coverage.storeys[0].report, &upper = coverage.storeys[1].report;
    const auto share = [](const CoverageReport& report) {
        return report.densities.indoor.empty() ? 0.0 : *report.densities.indoor[0].grid;
    };
    EXPECT_NEAR(*sum.densities.indoor[0].grid * sum.indoor_area,
                share(ground) * ground.indoor_area + share(upper) * upper.indoor_area, 1e-9);
    // Beside itself nothing is gained or lost; beside fewer sensors something is gained.
    const SiteCoverage same = coverage;
    compareStoreys(coverage, same, "same");
    EXPECT_NEAR(*coverage.comparison->gained.exact, 0, 1e-9);
    const SiteCoverage fewer = measureSite(without(building, {"g/a"}), {});
    compareStoreys(coverage, fewer, "fewer");
    EXPECT_NEAR(*coverage.comparison->gained.exact,
                (*coverage.coverage.exact - *fewer.coverage.exact) * coverage.indoor_area, 1e-6);
}

}  // namespace site_robustness_test
}  // namespace ispace::robustness
