// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "site/coupling.h"
#include "site/site_coverage.h"
#include "site/storey_people.h"

namespace ispace {
namespace site_sums_test {

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

TEST(SiteCoverage, SumsHaveEachSensorOnce) {
    const SiteCoverage coverage = measureSite(house(), {});
    const CoverageReport sum = sumOfStoreys(coverage);
    ASSERT_EQ(sum.sensors.size(), 4U);
    const auto camera = std::find_if(sum.sensors.begin(), sum.sensors.end(),
                                     [](const SensorMetrics& one) { return one.id == "u/c"; });
    ASSERT_NE(camera, sum.sensors.end());
    double area = 0, marginal = 0, weighted = 0, farthest = 0;
    std::size_t rooms = 0;
    for (const Coverage& storey : coverage.storeys)
        for (const SensorMetrics& one : storey.report.sensors) {
            if (one.id != "u/c") continue;
            ++rooms;
            area += one.area.exact.value();
            marginal += one.marginal.exact.value();
            weighted += one.picture.value().mean_density.exact.value() * one.area.exact.value();
            farthest = std::max(farthest, one.picture->farthest.value());
        }
    EXPECT_EQ(rooms, 2U) << "it sees the floor below";
    EXPECT_NEAR(camera->area.exact.value(), area, 1e-9);
    EXPECT_NEAR(camera->marginal.exact.value(), marginal, 1e-9);
    EXPECT_NEAR(camera->picture.value().mean_density.exact.value(), weighted / area, 1e-9);
    EXPECT_NEAR(camera->picture->farthest.value(), farthest, 1e-9);
    ASSERT_TRUE(sum.redundancy_exact);
    double all = 0, seen = 0;
    for (std::size_t k = 0; k < sum.redundancy_exact->size(); ++k) {
        all += (*sum.redundancy_exact)[k];
        seen += k > 0 ? (*sum.redundancy_exact)[k] : 0;
    }
    EXPECT_NEAR(all, 1, 1e-6);
    EXPECT_NEAR(seen, sum.coverage.exact.value(), 1e-6);
    for (std::size_t i = 1; i < sum.unseen.size(); ++i)
        EXPECT_LE(sum.unseen[i].area, sum.unseen[i - 1].area);
    EXPECT_TRUE(std::all_of(sum.unseen.begin(), sum.unseen.end(), [](const UncoveredSpot& spot) {
        return spot.room == "g" || spot.room == "u";
    }));
}

TEST(StoreyPeople, AreSpreadByFreeFloor) {
    SiteCoverage coverage;
    coverage.storeys.resize(3);
    coverage.storeys[0].report.free_area = 50;
    coverage.storeys[1].report.free_area = 25;
    coverage.storeys[2].report.free_area = 25;
    coverage.free_area = 100;
    EXPECT_EQ(spreadOverStoreys(coverage, 8), (std::vector<std::size_t>{4, 2, 2}));
    // Equal rests: the lowest first.
    EXPECT_EQ(spreadOverStoreys(coverage, 5), (std::vector<std::size_t>{3, 1, 1}));
    EXPECT_EQ(spreadOverStoreys(coverage, 0), (std::vector<std::size_t>{0, 0, 0}));
    const SiteScene building =
        sceneOf("- storey: {id: g, height: 3, records: " + kRoom +
                "}\n- storey: {id: u, z: 3, records: [{ispace: {size: 3 x 2}}, {cube: {at: [0.9, "
                "0.3], size: 1}}]}\n"
                "- shaft: {id: s, storeys: 'g,u', path: '-1,-0.5;0.5,-0.5;0.5,0.5;-1,0.5'}\n");
    EXPECT_EQ(spreadOverStoreys(building, 0, 30), spreadOverStoreys(measureSite(building, {}), 30));
}

}  // namespace site_sums_test
}  // namespace ispace
