// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/arrange.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "arrange/strategy.h"
#include "base/error.h"
#include "support/test_arrange.h"
#include "support/test_problems.h"

namespace ispace {
namespace arrangement_test {

TEST(Arrangement, ResultIsWhatCoverageMeasures) {
    const Scene scene = roomScene();
    for (const char* sensor : {"laser,range=4:3", "ranger,tilt=-40:2", "laser,tilt=-10:2"}) {
        const auto groups = groupsOf(scene, {sensor});
        ArrangeOptions options = coarse();
        options.mount.heights = {1.2};
        const Arrangement arrangement = arranged(scene, groups, options);
        const CoverageReport report = reportOf(scene, groups, arrangement);
        EXPECT_EQ(report.coverage.grid, arrangement.coverage) << sensor;
        EXPECT_EQ(report.total_effective_area.grid, arrangement.area) << sensor;
        EXPECT_DOUBLE_EQ(arrangement.candidate_value, arrangement.coverage) << sensor;
        EXPECT_FALSE(arrangement.value);
        EXPECT_GE(arrangement.bound, arrangement.coverage) << sensor;
        EXPECT_GT(arrangement.coverage, 0) << sensor;
        EXPECT_TRUE(arrangement.is_complete);
    }
}

TEST(Arrangement, ALargeRoomIsSearchedOnFewerCellsAndMeasuredAsEver) {
    const Scene scene = roomScene("#env 1\nispace size=60,40\ncube at=3,2 size=7,5,2\n");
    const auto groups = groupsOf(scene, {"laser,range=9:2"});
    ArrangeOptions options = coarse();
    options.density = {5, 5, 8};
    const Arrangement large = arranged(scene, groups, options);
    EXPECT_LE(large.grid.size(), 40'000U);
    EXPECT_GT(large.grid.size(), 30'000U);
    const CoverageReport report = reportOf(scene, groups, large);
    EXPECT_GT(report.grid.size(), 150'000U);
    EXPECT_EQ(report.coverage.grid, large.coverage);
    ASSERT_TRUE(large.value);
    EXPECT_DOUBLE_EQ(*large.value, large.candidate_value);
    EXPECT_NEAR(*large.value, large.coverage, 0.005);
    EXPECT_GE(large.bound, *large.value);
}

TEST(SearchCells, AreTheThesisWithItsStrategies) {
    ArrangeOptions options;
    for (const StrategyRow& row : strategies()) {
        const Strategy strategy = row.strategy;
        options.strategy = strategy;
        options.cells.reset();
        EXPECT_EQ(std::holds_alternative<CellCount>(searchCells(options)), isOfThesis(strategy));
        options.cells = CellSize{0.5};
        EXPECT_TRUE(std::holds_alternative<CellSize>(searchCells(options)));
    }
    options.strategy = Strategy::Wall;
    options.cells.reset();
    const Box2 limits{{0, 0}, {7, 3}};
    EXPECT_EQ(gridOver(limits, searchCells(options)), (Grid{limits, 100, 100}));
}

TEST(Arrangement, SameForAnyNumberOfThreads) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser:2", "laser,range=3,fov=270:2"});
    for (const Strategy strategy : {Strategy::All, Strategy::Random, Strategy::Wall}) {
        std::string texts[2];
        for (const std::size_t threads : {1U, 2U}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
            ArrangeOptions options = coarse();
            options.strategy = strategy;
            options.refine = strategy == Strategy::Wall;
            const Arrangement arrangement = arranged(scene, groups, options);
            texts[threads - 1] =
                writeRecordText(layoutDocument(partsOf(scene), nullptr, groups, arrangement));
        }
        EXPECT_EQ(texts[0], texts[1]);
    }
}

TEST(Arrangement, RandomHasPlacesOfItsOwnForEachSensor) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=2:2", "laser,range=2,id=mine"});
    ArrangeOptions options;
    options.strategy = Strategy::Random;
    options.headings = 1;
    options.first_places = options.more_places = 1;
    options.wants_trace = true;
    options.search.optimizer = Optimizer::Greedy;
    const Arrangement found = arranged(scene, groups, options);
    EXPECT_EQ(found.candidates, 3U * 2);
    ASSERT_EQ(found.sensors.size(), 3U);
    std::set<std::string> kinds;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(found.sensors[i].group, i / 2) << "in the order asked for";
        for (const TriedPose& tried : found.tried)
            if (tried.pose == found.sensors[i].pose) {
                EXPECT_TRUE(tried.is_chosen);
                kinds.insert(tried.sensor);
            }
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"laser", "laser.2", "mine"}));
    // If the search finds the number, all sensors share the same sites.
    options.budget = 3;
    EXPECT_LE(arranged(scene, groupsOf(scene, {"laser,range=2:3"}), options).candidates, 3U * 2);
}

TEST(Arrangement, AMovedRoomHasTheSameArrangement) {
    const std::string there =
        "#env 1\nfence path=16,8;24,8;24,14;16,14 closed=yes\ndesk at=22,12 heading=30\n"
        "inside at=17,9\n";
    const std::string here =
        "#env 1\nfence path=0,0;8,0;8,6;0,6 closed=yes\ndesk at=6,4 heading=30\ninside at=1,1\n";
    const Scene scene = roomScene(here), moved = roomScene(there);
    const auto groups = groupsOf(scene, {"laser,range=4:3"});
    const ArrangeOptions options = coarse(Optimizer::Exact);
    const Arrangement a = arranged(scene, groups, options), b = arranged(moved, groups, options);
    ASSERT_EQ(a.sensors.size(), b.sensors.size());
    EXPECT_EQ(a.coverage, b.coverage);
    EXPECT_EQ(a.bound, b.bound);
    for (std::size_t i = 0; i < a.sensors.size(); ++i) {
        const Pose3 &p = a.sensors[i].pose, &q = b.sensors[i].pose;
        EXPECT_NEAR(p.position.x + 16, q.position.x, 1e-9);
        EXPECT_NEAR(p.position.y + 8, q.position.y, 1e-9);
        EXPECT_EQ(p.heading, q.heading);
    }
}

TEST(Arrangement, KeepsALayoutAndPlacesItsPendingSensors) {
    const Document layout = layoutFrom(
        "laser id=fixed at=0,0 heading=90\n"
        "laser id=later range=3\n"
        "chair at=3,-2\n"
        "ultrasound id=ear\n"
        "result coverage=1%\n");
    const Scene scene = roomScene(kTestRoom, &layout);
    ASSERT_EQ(scene.pending.size(), 2U);
    const auto groups = groupsOf(scene, {"laser"});
    ASSERT_EQ(groups.size(), 3U);
    EXPECT_EQ(groups[0].id, "later");
    const Arrangement arrangement = arranged(scene, groups, coarse());
    const Document written = layoutDocument(partsOf(scene), &layout, groups, arrangement);
    std::vector<std::string> keywords, ids;
    for (const Record& record : written.records) {
        keywords.push_back(record.keyword());
        ids.push_back(record.writtenId());
    }
    EXPECT_EQ(keywords, (std::vector<std::string>{"environment", "laser", "laser", "chair",
                                                  "ultrasound", "laser", "result"}));
    EXPECT_EQ(ids, (std::vector<std::string>{"", "fixed", "later", "", "ear", "laser1", ""}));
    EXPECT_EQ(written.records[2].tuple("range"), (Tuple{3}));
    EXPECT_TRUE(written.records[2].has("at"));
    EXPECT_TRUE(written.records[4].has("at"));
}

TEST(Arrangement, SensorsAlreadyPlacedCount) {
    const Scene empty = roomScene();
    ArrangeOptions options = coarse(Optimizer::Greedy);
    options.strategy = Strategy::Grid;
    options.x = options.y = 5;
    const auto two = groupsOf(empty, {"laser,range=4:2"});
    const Arrangement both = arranged(empty, two, options);
    // The first of the two given as fixed, the second is placed as before.
    const auto one = groupsOf(empty, {"laser,range=4"});
    const Arrangement first = arranged(empty, one, options);
    const Document layout = layoutDocument(partsOf(empty), nullptr, one, first);
    const Scene begun = roomScene(kTestRoom, &layout);
    const auto second = groupsOf(begun, {"laser,range=4"});
    const Arrangement rest = arranged(begun, second, options);
    EXPECT_EQ(rest.sensors[0].sensor, "laser2");
    EXPECT_EQ(rest.coverage, both.coverage);
    EXPECT_EQ(rest.sensors[0].pose, both.sensors[1].pose);
}

TEST(Arrangement, RobotsAndWhatTheyCarryPassThrough) {
    const std::string kept =
        "robot id=r1 at=2,2 heading=-90 max_speed=1\n"
        "laser id=own at=0.1,0 range=2 on=r1\n"
        "laser id=top range=2 on=d1\n";
    const Document layout = layoutFrom(kept + "laser id=later range=3\n");
    const Scene scene = roomScene(kTestRoom, &layout);
    ASSERT_EQ(scene.pending.size(), 1U);
    const auto groups = groupsOf(scene, {});
    const Arrangement arrangement = arranged(scene, groups, coarse());
    const std::string text =
        writeRecordText(layoutDocument(partsOf(scene), &layout, groups, arrangement));
    EXPECT_NE(text.find(kept), std::string::npos) << text;

    // Their coverage counts, and the result equals the measured coverage.
    const Document written = readRecordText(text, "best.3dm", sceneSchemas());
    const Scene again = roomScene(kTestRoom, &written);
    RayScenes worlds(again.environment);
    EXPECT_EQ(measureCoverage(again, worlds, {}).report.coverage.grid, arrangement.coverage);
    ASSERT_EQ(again.sensors.size(), 3U);
    EXPECT_EQ(again.robots.size(), 1U);
}

TEST(Arrangement, TiltsAndHeightsAreChosen) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"ranger,fov=60,60,range=4"});
    ArrangeOptions options = coarse(Optimizer::Exact);
    options.mount.heights = {0.15, 2.2};
    options.mount.tilts = {Angle::degrees(-60), Angle::degrees(0)};
    const Arrangement both = arranged(scene, groups, options);
    options.mount.heights = {0.15};
    options.mount.tilts = {Angle::degrees(0)};
    const Arrangement low = arranged(scene, groups, options);
    EXPECT_GT(both.coverage, low.coverage);
    EXPECT_EQ(both.sensors[0].pose.position.z, 2.2);
    const Record record = placedRecord(groups[0], both.sensors[0]);
    EXPECT_EQ(record.angle("tilt"), both.sensors[0].pose.tilt);
    // The sensor's parameters take precedence.
    options.mount.tilts = {Angle::degrees(0)};
    const auto tilted = groupsOf(scene, {"laser,tilt=10,range=4"});
    EXPECT_EQ(arranged(scene, tilted, options).sensors[0].pose.tilt, Angle::degrees(10));
}

TEST(Arrangement, FourReceiversUnderTheCeilingHearTogether) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"ultrasound:4"});
    ArrangeOptions options = coarse();
    options.density = {2, 2, 1};
    options.mount.on = MountOn::Ceiling;
    const Arrangement arrangement = arranged(scene, groups, options);
    ASSERT_EQ(arrangement.sensors.size(), 4U);
    EXPECT_EQ(arrangement.sensors[0].pose.tilt, Angle::degrees(-90));
    EXPECT_NEAR(arrangement.sensors[0].pose.position.z, 2.45, 1e-9);
    EXPECT_GT(arrangement.coverage, 0.4);
    EXPECT_EQ(reportOf(scene, groups, arrangement).coverage.grid, arrangement.coverage);
    const auto three = groupsOf(scene, {"ultrasound:3"});
    EXPECT_EQ(arranged(scene, three, options).coverage, 0) << "four are needed";
}

TEST(Arrangement, StopsWithTheBestSoFar) {
    const Scene scene = roomScene();
    const auto groups = groupsOf(scene, {"laser,range=4:3"});
    StopWhen progress(afterPhases(2));
    const Arrangement arrangement = arrange(scene, groups, coarse(Optimizer::Exact), progress);
    EXPECT_FALSE(arrangement.is_complete);
    EXPECT_EQ(arrangement.sensors.size(), 3U);
    EXPECT_GE(arrangement.bound, arrangement.coverage);
    const Document layout = layoutDocument(partsOf(scene), nullptr, groups, arrangement);
    EXPECT_FALSE(layout.records.back().flag("complete"));
}

TEST(Arrangement, ThereIsALayoutHoweverEarlyOneStops) {
    const Scene scene = roomScene();
    StopWhen progress(always);
    for (const Optimizer optimizer : {Optimizer::Greedy, Optimizer::Exact}) {
        ArrangeOptions options = coarse(optimizer);
        options.mount.heights = {1.2};
        const auto groups = groupsOf(scene, {"laser:2", "ranger,tilt=-30"});
        const Arrangement arrangement = arrange(scene, groups, options, progress);
        EXPECT_EQ(arrangement.sensors.size(), 3U);
        EXPECT_FALSE(arrangement.is_complete);
        EXPECT_EQ(arrangement.bound, 1);
    }
}

TEST(Arrangement, WhatCannotBeIsSaid) {
    const Scene full = roomScene("#env 1\nispace size=4,4\ncube size=3,3,1\ninside at=1.8,1.8\n");
    ArrangeOptions options = coarse();
    options.strategy = Strategy::Grid;
    options.x = options.y = 1;
    EXPECT_THROW(arranged(full, groupsOf(full, {"laser"}), options), UnmetError);

    const Scene scene = roomScene();
    options = coarse();
    options.budget = 0;
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}, true), options), UnmetError);
    options = coarse();
    options.max_bytes = 1000;
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}), options), UsageError);
    options = coarse();
    options.weights.targets = {readZone("rect:100,100,101,101", scene.environment)};
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}), options), UnmetError);
    options = coarse();
    options.mount.on = MountOn::Frame;
    EXPECT_THROW(arranged(scene, groupsOf(scene, {"laser"}), options), UnmetError);
}

}  // namespace arrangement_test
}  // namespace ispace
