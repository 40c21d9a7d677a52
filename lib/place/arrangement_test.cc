// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arrangement.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "base/error.h"
#include "layout/schemas.h"
#include "layout/sensor_spec.h"
#include "record/digest.h"
#include "record/text.h"

namespace ispace {
namespace {

const std::string kRoom =
    "#env 1\n"
    "ispace id=room size=8,6,2.5\n"
    "desk id=d1 at=2,1\n"
    "pillar id=p1 at=-2,-1\n";

Document environmentDocument(const std::string& text = kRoom) {
    return readRecordText(text, "room.env", sceneSchemas());
}

Document layoutFrom(const std::string& records) {
    return readRecordText("#3dm 1\n# before\n" + records, "layout.3dm", sceneSchemas());
}

std::vector<Record> specs(const std::string& text) {
    return readSensorSpec(text, kArrangedKinds, sceneSchemas(), DeviceCatalogue());
}

LayoutParts parts(const Scene& scene) {
    return {{"arrange room.glb"}, "room.glb", scene.digest, "grid"};
}

TEST(Arrangement, ResultIsWhatCoverageMeasures) {
    const Document environment = environmentDocument();
    const Scene scene = makeScene(environment, nullptr, DeviceCatalogue());
    const auto sensors = sensorsToPlace(scene, specs("laser,range=4:3"), DeviceCatalogue());
    ASSERT_EQ(sensors.size(), 3U);
    SilentProgress progress;
    ArrangeOptions options;
    options.x = 5;
    options.y = 5;
    const Arrangement arrangement = arrangeOnGrid(scene, sensors, options, progress);
    EXPECT_GE(arrangement.bound, arrangement.coverage);
    EXPECT_LE(arrangement.bound, 1);

    // Through text and back, as the tools do it.
    const std::string text =
        writeRecordText(layoutDocument(parts(scene), nullptr, sensors, arrangement));
    const Document layout = readRecordText(text, "best.3dm", sceneSchemas());
    const Scene again = makeScene(environment, &layout, DeviceCatalogue());
    ASSERT_EQ(again.lasers.size(), 3U);
    Worlds worlds(again.environment);
    const CoverageReport report = measureCoverage(again, worlds, {}).report;
    EXPECT_EQ(report.coverage.grid, arrangement.coverage);
    EXPECT_EQ(report.total_effective_area.grid, arrangement.area);
    const Record& result = layout.records.back();
    EXPECT_EQ(result.keyword(), "result");
    EXPECT_EQ(result.number("coverage"), arrangement.coverage);
    EXPECT_EQ(layout.records.front().text("digest"), environmentDigest(environment.records));
}

TEST(Arrangement, SameForAnyNumberOfThreads) {
    const Scene scene = makeScene(environmentDocument(), nullptr, DeviceCatalogue());
    const auto sensors = sensorsToPlace(scene, specs("laser:4"), DeviceCatalogue());
    SilentProgress progress;
    std::string texts[2];
    for (const std::size_t threads : {1U, 2U}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Arrangement arrangement = arrangeOnGrid(scene, sensors, {}, progress);
        texts[threads - 1] =
            writeRecordText(layoutDocument(parts(scene), nullptr, sensors, arrangement));
    }
    EXPECT_EQ(texts[0], texts[1]);
}

TEST(Arrangement, KeepsALayoutAndPlacesItsPendingSensors) {
    const Document layout = layoutFrom(
        "laser id=fixed at=0,0 heading=90\n"
        "laser id=todo range=3\n"
        "chair at=3,-2\n"
        "result coverage=1%\n");
    const Scene scene = makeScene(environmentDocument(), &layout, DeviceCatalogue());
    ASSERT_EQ(scene.pending.size(), 1U);
    const auto sensors = sensorsToPlace(scene, specs("laser"), DeviceCatalogue());
    ASSERT_EQ(sensors.size(), 2U);
    EXPECT_EQ(sensors[0].id, "todo");
    EXPECT_EQ(sensors[1].id, "laser1");
    SilentProgress progress;
    const Arrangement arrangement = arrangeOnGrid(scene, sensors, {}, progress);
    const Document written = layoutDocument(parts(scene), &layout, sensors, arrangement);
    std::vector<std::string> keywords, ids;
    for (const Record& record : written.records) {
        keywords.push_back(record.keyword());
        ids.push_back(record.writtenId());
    }
    EXPECT_EQ(keywords, (std::vector<std::string>{"environment", "laser", "laser", "chair", "laser",
                                                  "result"}));
    EXPECT_EQ(ids, (std::vector<std::string>{"", "fixed", "todo", "", "laser1", ""}));
    EXPECT_EQ(written.records[2].tuple("range"), (Tuple{3}));
    EXPECT_TRUE(written.records[2].has("at"));
}

TEST(Arrangement, SensorsAlreadyPlacedCount) {
    const Scene empty = makeScene(environmentDocument(), nullptr, DeviceCatalogue());
    SilentProgress progress;
    ArrangeOptions options;
    options.x = options.y = 5;
    const auto two = sensorsToPlace(empty, specs("laser,range=4:2"), DeviceCatalogue());
    const Arrangement both = arrangeOnGrid(empty, two, options, progress);
    // The first of the two given as fixed, the second is placed as before.
    const auto one = sensorsToPlace(empty, specs("laser,range=4"), DeviceCatalogue());
    const Arrangement first = arrangeOnGrid(empty, one, options, progress);
    const Document layout = layoutDocument(parts(empty), nullptr, one, first);
    const Scene begun = makeScene(environmentDocument(), &layout, DeviceCatalogue());
    const auto second = sensorsToPlace(begun, specs("laser,range=4"), DeviceCatalogue());
    EXPECT_EQ(second[0].id, "laser2");
    const Arrangement rest = arrangeOnGrid(begun, second, options, progress);
    EXPECT_EQ(rest.coverage, both.coverage);
    EXPECT_EQ(rest.placed[0].pose, both.placed[1].pose);
}

TEST(Arrangement, RobotsAndWhatTheyCarryPassThrough) {
    const std::string kept =
        "robot id=r1 at=2,2 heading=-90 max_speed=1\n"
        "laser id=own at=0.1,0 range=2 on=r1\n"
        "laser id=top range=2 on=d1\n";
    const Document layout = layoutFrom(kept + "laser id=todo range=3\n");
    const Scene scene = makeScene(environmentDocument(), &layout, DeviceCatalogue());
    ASSERT_EQ(scene.pending.size(), 1U);
    const auto sensors = sensorsToPlace(scene, {}, DeviceCatalogue());
    SilentProgress progress;
    ArrangeOptions options;
    options.x = options.y = 3;
    const Arrangement arrangement = arrangeOnGrid(scene, sensors, options, progress);
    const std::string text =
        writeRecordText(layoutDocument(parts(scene), &layout, sensors, arrangement));
    EXPECT_NE(text.find(kept), std::string::npos) << text;

    // What they see counts, and the result is what coverage measures.
    const Document written = readRecordText(text, "best.3dm", sceneSchemas());
    const Scene again = makeScene(environmentDocument(), &written, DeviceCatalogue());
    Worlds worlds(again.environment);
    EXPECT_EQ(measureCoverage(again, worlds, {}).report.coverage.grid, arrangement.coverage);
    ASSERT_EQ(again.lasers.size(), 3U);
    EXPECT_EQ(again.robots.size(), 1U);
}

TEST(Arrangement, TiltedSensorsArePlacedToo) {
    const Scene scene = makeScene(environmentDocument(), nullptr, DeviceCatalogue());
    const auto sensors = sensorsToPlace(scene, specs("laser,tilt=10,range=4"), DeviceCatalogue());
    SilentProgress progress;
    ArrangeOptions options;
    options.x = options.y = 2;
    options.columns = options.rows = 40;
    const Arrangement arrangement = arrangeOnGrid(scene, sensors, options, progress);
    EXPECT_EQ(arrangement.placed[0].pose.tilt, Angle::degrees(10));
    EXPECT_GT(arrangement.coverage, 0);
}

TEST(Arrangement, NoValidPlaceIsSaid) {
    const Scene scene = makeScene(
        environmentDocument("#env 1\nispace size=4,4\ncube size=3,3,1\ninside at=1.8,1.8\n"),
        nullptr, DeviceCatalogue());
    const auto sensors = sensorsToPlace(scene, specs("laser"), DeviceCatalogue());
    SilentProgress progress;
    ArrangeOptions options;
    options.x = options.y = 1;
    EXPECT_THROW(arrangeOnGrid(scene, sensors, options, progress), UnmetError);
}

TEST(Arrangement, RefusesIdsThatAreTakenAndPlacesThatAreGiven) {
    const Scene scene = makeScene(environmentDocument(), nullptr, DeviceCatalogue());
    EXPECT_THROW(sensorsToPlace(scene, specs("laser,id=d1"), DeviceCatalogue()), UsageError);
    EXPECT_THROW(sensorsToPlace(scene, specs("laser,at=1,1"), DeviceCatalogue()), UsageError);
    EXPECT_THROW(sensorsToPlace(scene, specs("laser,heading=30"), DeviceCatalogue()), UsageError);
    EXPECT_THROW(sensorsToPlace(scene, specs("laser,on=d1"), DeviceCatalogue()), UsageError);
    std::vector<Record> twice = specs("laser,id=a");
    twice.push_back(twice.front());
    EXPECT_THROW(sensorsToPlace(scene, twice, DeviceCatalogue()), UsageError);
}

}  // namespace
}  // namespace ispace
