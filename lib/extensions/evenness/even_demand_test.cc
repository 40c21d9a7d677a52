// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/evenness/even_demand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "support/test_arrange.h"

namespace ispace::evenness {
namespace even_demand_test {

/// Two halves, which a narrow gap joins.
constexpr const char* kTwoRooms = "#env 1\nispace size=8,6,2.5\nwall from=0,-3 to=0,2.5\n";

std::shared_ptr<const EvenDemand> demandOf(const Scene& scene, EvenRule rule = {},
                                           const FloorWeights& floor = {},
                                           CellChoice cells = CellCount{16, 12}) {
    const Target target = makeTarget(scene.environment, cells, kScanHeight);
    return std::make_shared<EvenDemand>(std::make_shared<const Scene>(scene), target,
                                        weightsOfCells(target, floor), rule);
}

/// Returns a sensor, with its angles in degrees.
Sensor placed(const Scene& scene, const std::string& spec, Point3 place, double heading,
              double tilt = 0) {
    return {"s",
            groupsOf(scene, {spec.c_str()}).front().model,
            {.position = place,
             .heading = Angle::degrees(heading),
             .tilt = Angle::degrees(tilt),
             .roll = {}}};
}

CellSet servedIn(const Scene& scene, const Sensor& sensor, const EvenDemand& demand) {
    RayScenes worlds(scene.environment);
    worlds.prepare(sensor.pose);
    worlds.prepareMesh(kindOf(sensor.model).stopped_by);
    return demand.servedBy(sensor, worlds);
}

/// Returns the value of a set of views, by counting the sensors of each cell.
double valueOf(const EvenDemand& demand, const EvenRule& rule, const std::vector<CellSet>& views) {
    const std::size_t cells = demand.weights().size() / static_cast<std::size_t>(rule.depth);
    double value = 0, all = 0;
    for (std::size_t i = 0; i < cells; ++i) {
        const auto sensors = static_cast<int>(std::count_if(
            views.begin(), views.end(), [i](const CellSet& view) { return view.test(i); }));
        value += demand.weights()[i] * rule.valueOf(sensors);
        all += demand.weights()[i] * rule.valueOf(rule.depth);
    }
    return value / all;
}

TEST(EvenRule, FurtherSensorsAddLess) {
    const EvenRule rule{.depth = 3, .share = 0.5};
    const std::vector<double> values = {0, 1, 1.5, 1.75, 1.75};
    for (int k = 0; k < 5; ++k)
        EXPECT_DOUBLE_EQ(rule.valueOf(k), values[static_cast<std::size_t>(k)]);
}

TEST(EvenDemand, WeighsTheFloorOnceForEachSensor) {
    const Scene scene = roomScene("#env 1\nispace size=8,6,2.5\nzone id=a at=2,0 size=4,6\n");
    const auto plain = demandOf(scene, {.depth = 2, .share = 0.25});
    ASSERT_EQ(plain->weights().size(), 2U * 16 * 12);
    EXPECT_NEAR(plain->area(), 48, 1e-9);
    EXPECT_DOUBLE_EQ(plain->weights()[16 * 12], 0.25 * plain->weights()[0]);
    EXPECT_EQ(plain->needs().front(), 1);
    EXPECT_EQ(plain->needs().back(), 2);
    const FloorWeights only{.targets = {readZone("a", scene.environment)}, .weights = {}};
    EXPECT_NEAR(demandOf(scene, {.depth = 2}, only)->area(), 24, 1e-9);
}

/// Sensors see the cells that coverage() counts for them.
TEST(EvenDemand, SensorsSeeTheCellsOfCoverage) {
    const Scene scene = roomScene(std::string(kTwoRooms) + "desk id=d at=2,1\n");
    const auto demand = demandOf(scene, {.depth = 2}, {}, CellSize{0.1});
    const Target target = makeTarget(scene.environment, CellSize{0.1}, kScanHeight);
    RayScenes worlds(scene.environment);
    const VisibleArea sight(scene.environment, 0, &worlds);
    for (const Sensor& sensor : {placed(scene, "laser,range=4,fov=240", {-2, 0.3, 0.15}, 20),
                                 placed(scene, "laser,range=20,fov=360", {1, -1, 0.15}, 0),
                                 placed(scene, "camera,range=9,fov=90", {3, -2, 2.4}, 130, -40),
                                 placed(scene, "ranger,range=9,fov=120,60,projection=spherical",
                                        {-3.5, 2, 2.3}, -30, -30)}) {
        sight.prepare(sensor);
        const CellSet expected = sight.cellsOf(target.grid, sensor);
        const CellSet served = servedIn(scene, sensor, *demand);
        EXPECT_GT(expected.count(), 100U);
        EXPECT_EQ(served.count(), 2 * expected.count());
        for (std::size_t i = 0; i < expected.size(); ++i)
            ASSERT_EQ(served.test(i), expected.test(i)) << kindOf(sensor.model).keyword << i;
    }
}

/// All pairs and single poses of few candidates.
TEST(ArrangeEvenly, FindsTheBestOfAllSets) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse();
    options.density = {2, 2, 4};
    options.wants_trace = true;
    for (const EvenRule& rule : {EvenRule{.depth = 2, .share = 0.5}, EvenRule{.depth = 3},
                                 EvenRule{.depth = 3, .share = 1}}) {
        const auto demand = demandOf(scene, rule);
        options.demand = demand;
        for (const int count : {1, 2, 3}) {
            const std::string spec = "laser,range=4,fov=120:" + std::to_string(count);
            const auto groups = groupsOf(scene, {spec.c_str()});
            options.search.optimizer = Optimizer::Greedy;
            const Arrangement fast = arranged(scene, groups, options);
            options.search.optimizer = Optimizer::Exact;
            const Arrangement best = arranged(scene, groups, options);
            std::vector<CellSet> views;
            for (const TriedPose& tried : best.tried)
                views.push_back(servedIn(scene, {"", groups.front().model, tried.pose}, *demand));
            double most = 0;
            const std::size_t n = views.size();
            for (std::size_t a = 0; a < n; ++a)
                for (std::size_t b = a; b < (count > 1 ? n : a + 1); ++b)
                    for (std::size_t c = b; c < (count > 2 ? n : b + 1); ++c) {
                        std::vector<CellSet> chosen = {views[a]};
                        if (b > a) chosen.push_back(views[b]);
                        if (c > b) chosen.push_back(views[c]);
                        most = std::max(most, valueOf(*demand, rule, chosen));
                    }
            EXPECT_NEAR(*best.value, most, 1e-6) << count;
            EXPECT_NEAR(best.bound, most, 1e-6) << count;
            EXPECT_GE(fast.bound, most - 1e-6);
            EXPECT_LE(*fast.value, most + 1e-6);
            // Fisher, Nemhauser and Wolsey 1978
            EXPECT_GE(*fast.value, (1 - 1 / 2.718281828) * most);
        }
    }
}

TEST(ArrangeEvenly, SpreadsSensorsOverBothHalves) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = demandOf(scene);
    const Arrangement found = arranged(scene, groupsOf(scene, {"laser,fov=360:2"}), options);
    ASSERT_EQ(found.sensors.size(), 2U);
    EXPECT_LT(found.sensors[0].pose.position.x * found.sensors[1].pose.position.x, 0);
}

TEST(ArrangeEvenly, CountsSensorsThatStand) {
    const Document layout =
        layoutFrom("laser id=l1 at=-3.9,0,0.15 fov=360\nlaser id=l2 at=-3.9,1,0.15 fov=360\n");
    const Scene scene = roomScene(kTwoRooms, &layout);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = demandOf(scene);
    const Arrangement found = arranged(scene, groupsOf(scene, {"laser,fov=360"}), options);
    EXPECT_GT(found.sensors.at(0).pose.position.x, 0);
}

TEST(ArrangeEvenly, ReachesATarget) {
    const Scene scene = roomScene(kTwoRooms);
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.demand = demandOf(scene, {.depth = 2});
    options.target = 1;
    const Arrangement found = arranged(scene, groupsOf(scene, {"laser,fov=360:9"}, true), options);
    EXPECT_TRUE(found.is_reached);
    EXPECT_EQ(found.sensors.size(), 4U) << "two in each half";
}

TEST(EvenDemand, FindingCountsTheFloorOfAllRooms) {
    const Scene scene = roomScene("#env 1\nispace size=8,6,2.5\n");
    const auto demand = demandOf(scene, {.depth = 2});
    const std::size_t cells = demand->weights().size() / 2;
    CellSet served(demand->weights().size());
    for (std::size_t i = 0; i < cells; ++i) {
        if (i < cells / 2) served.set(i);
        if (i < cells / 4) served.set(cells + i);
    }
    EXPECT_EQ(demand->finding(std::vector<ServedDemand>{{demand.get(), served}}, 1),
              "of the floor 50.0 % is seen by no sensor, 25.0 % is seen by 1 sensor, 25.0 % is "
              "seen by 2 or more sensors");
    EXPECT_EQ(demand->finding(std::vector<ServedDemand>{{demand.get(), served},
                                                        {demand.get(), CellSet(2 * cells)}},
                              1),
              "of the floor 75.0 % is seen by no sensor, 12.5 % is seen by 1 sensor, 12.5 % is "
              "seen by 2 or more sensors");
}

}  // namespace even_demand_test
}  // namespace ispace::evenness
