// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/doorcounters/doorcounter.h"

#include <gtest/gtest.h>

#include <any>
#include <chrono>
#include <string>
#include <vector>

#include "base/error.h"
#include "extensions/doorcounters/doorcounters_test.h"
#include "record/text.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "sense/formats/reading_fields.h"
#include "sense/moment.h"
#include "sense/selection.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "support/test_folder.h"

namespace ispace::doorcounters {
namespace doorcounter_test {

using std::chrono::milliseconds;

/// Two rooms and a wide door in the wall between them; people enter the right one.
const std::string kRooms =
    "#env 1\nispace size=8,4,2.5\nwall id=w from=0,-2 to=0,2 thickness=0.1\n"
    "door id=d wall=w offset=2 size=1.6 open=yes\n";
const std::string kCounter = "doorcounter id=c door=d\n";

Scene sceneOf(const std::string& records, const std::string& room = kRooms) {
    testing::addDoorCountersOnce();
    return makeScene(readRecordText(room + records, "room.env", sceneSchemas()), nullptr,
                     DeviceCatalogue());
}

std::string refusal(const std::string& records) {
    try {
        sceneOf(records);
    } catch (const FormatError& error) {
        return error.diagnostics().front().text();
    }
    return "";
}

/// Returns what the counter reads with these robots and people at their starts.
DoorCount readIn(const Scene& scene) {
    RayScenes worlds(scene.environment);
    worlds.prepareMesh();
    const MovingBodies bodies(bodiesOf(scene));
    const Sensor& sensor = scene.sensors.at(0);
    return countAt({sensor, sensor.pose, 0, 0, worlds, bodies, {}, {}});
}

TEST(DoorCounter, HangsBesideTheWallAboveItsDoor) {
    const Scene scene = sceneOf(kCounter);
    ASSERT_EQ(scene.sensors.size(), 1U);
    const Pose3& pose = scene.sensors[0].pose;
    EXPECT_NEAR(pose.position.x, 0.11, 1e-9) << "half of the wall and 6 cm";
    EXPECT_NEAR(pose.position.y, 0, 1e-9);
    EXPECT_NEAR(pose.position.z, 2, 1e-9);
    EXPECT_NEAR(pose.heading.degrees(), 0, 1e-9);
    const Pose3 other = sceneOf("doorcounter id=c door=d heading=170\n").sensors[0].pose;
    EXPECT_NEAR(other.position.x, -0.11, 1e-9);
    EXPECT_NEAR(std::abs(other.heading.degrees()), 180, 1e-9);
    const Pose3 given = sceneOf("doorcounter id=c at=1,1,2.3 heading=90\n").sensors[0].pose;
    EXPECT_EQ(given.position, (Point3{1, 1, 2.3}));
    EXPECT_NE(refusal("doorcounter id=c door=dd\n").find("no door has the id"), std::string::npos);
    EXPECT_TRUE(sceneOf("doorcounter id=c\n").sensors.empty());
}

TEST(DoorCounter, ParametersAreThoseOfItsRecord) {
    const Scene scene = sceneOf("doorcounter id=c door=d fov=45,40 range=3 height=0.9 rate=20\n");
    const DoorCounter& counter = scene.sensors[0].as<DoorCounter>();
    EXPECT_EQ(counter.fov_across, Angle::degrees(45));
    EXPECT_EQ(counter.fov_along, Angle::degrees(40));
    EXPECT_EQ(counter.height, 0.9);
    EXPECT_EQ(readingRate(scene.sensors[0].model), 20);
    EXPECT_EQ(maxRange(scene.sensors[0].model), 3);
    EXPECT_FALSE(scene.sensors[0].is<Laser>());
    EXPECT_EQ(&kindOf(scene.sensors[0].model), &DoorCounter::kKind);
    EXPECT_EQ(scene.sensors[0].model, SensorModel(AddedSensor(counter)));
    DoorCounter changed = counter;
    changed.height = 1;
    EXPECT_FALSE(scene.sensors[0].model == SensorModel(AddedSensor(changed)));
}

TEST(DoorCounter, SeesPeopleAndTallRobotsOfBothZones) {
    EXPECT_EQ(readIn(sceneOf(kCounter + "human id=a at=0.3,0\n")).tracks,
              (std::vector<CountedTrack>{{kFirstPerson, 1, 1}}));
    EXPECT_EQ(readIn(sceneOf(kCounter + "human id=a at=-0.1,0\n")).tracks,
              (std::vector<CountedTrack>{{kFirstPerson, -1, -1}}));
    EXPECT_TRUE(readIn(sceneOf(kCounter + "human id=a at=2,0\n")).tracks.empty());
    EXPECT_EQ(
        readIn(sceneOf(kCounter + "human id=a at=0.3,0.3\nhuman id=b at=0.3,-0.3\n")).tracks.size(),
        2U);
    const std::string robot = "robot id=r at=0.2,0 height=";
    EXPECT_TRUE(readIn(sceneOf(kCounter + robot + "0.4\n")).tracks.empty());
    EXPECT_EQ(readIn(sceneOf(kCounter + robot + "1.3\n")).tracks.size(), 1U);
    EXPECT_EQ(
        readIn(sceneOf("doorcounter id=c door=d height=0.3\n" + robot + "0.4\n")).tracks.size(),
        1U);
}

/// One reading after another: where a mover is, or 9 for out of view.
DoorCount after(const std::vector<int>& zones) {
    DoorCount count;
    for (const int zone : zones) {
        DoorCount now;
        if (zone != 9) now.tracks.push_back({7, zone, zone});
        addPassages(count, now);
        count = now;
    }
    return count;
}

TEST(DoorCounter, CountsTheWayFromOneZoneToTheOther) {
    EXPECT_EQ(after({-1, -1, 1, 9}), (DoorCount{1, 0}));
    EXPECT_EQ(after({1, 0, -1, 9}), (DoorCount{0, 1}));
    EXPECT_EQ(after({0, -1, 0, 1, 9}), (DoorCount{1, 0}));
    EXPECT_EQ(after({-1, 1, -1, 9}), DoorCount()) << "turned back";
    EXPECT_EQ(after({-1, 1, 1, 1}).entered, 0) << "stands there";
    EXPECT_EQ(after({0, 9}), DoorCount());
    EXPECT_EQ(after({-1, 1, 9, 1, -1, 9, -1, 0, 9}), (DoorCount{1, 1}));
}

/// Lets people walk for some seconds, and returns the last reading.
DoorCount walked(const std::string& records, int seconds) {
    const Scene scene = sceneOf(kCounter + records);
    World world(scene, milliseconds(20));
    DoorCount last;
    for (int i = 0; i < 50 * seconds; ++i) {
        world.step();
        last = std::get<AddedReading>(world.reading(0).value).as<DoorCount>();
    }
    return last;
}

TEST(DoorCounter, CountsPeopleInARun) {
    EXPECT_EQ(walked("human id=a at=-2,0 path=2,0\n", 6), (DoorCount{1, 0}));
    EXPECT_EQ(walked("human id=a at=2,0.2 path=-2,0.2\n", 6), (DoorCount{0, 1}));
    EXPECT_EQ(walked("human id=a at=-2,0.3 path=2,0.3\nhuman id=b at=-2,-0.3 path=2,-0.3\n", 6),
              (DoorCount{2, 0}))
        << "side by side";
    const DoorCount standing = walked("human id=a at=-2,0 path=0.2,0\n", 6);
    EXPECT_EQ(standing.entered, 0);
    EXPECT_EQ(standing.tracks.size(), 1U);
}

DoorCount countIn(const World& world) {
    return std::get<AddedReading>(world.reading(0).value).as<DoorCount>();
}

/// Three enter and one leaves within 12 s.
const std::string kTraffic =
    "human id=a at=-2,0 path=2,0;-2,0\nhuman id=b at=-3,0.4 path=2,0.4\n"
    "human id=c2 at=-3.5,-0.4 path=2,-0.4\n";

TEST(DoorCounter, CountsAreThoseOfTheRunAfterSeek) {
    const Scene scene = sceneOf(kCounter + kTraffic);
    const testing::TestFolder folder;
    World world(scene, milliseconds(20));
    std::vector<DoorCount> counts = {countIn(world)};
    {
        Recorder recorder(folder.path(), world, {}, 0);
        for (int i = 0; i < 600; ++i) {
            world.step();
            recorder.record(world);
            counts.push_back(countIn(world));
        }
        recorder.flush(world);
    }
    EXPECT_EQ(counts.back().entered, 3);
    EXPECT_EQ(counts.back().left, 1);
    Replay replay(folder.path());
    World again(scene, milliseconds(20));
    for (const std::size_t step : {600U, 150U, 400U}) {
        replay.seek(again, static_cast<int>(step) * milliseconds(20));
        EXPECT_EQ(countIn(again), counts[step]) << step;
    }
}

TEST(DoorCounter, CountsBetweenTheRowsOfASparseRecord) {
    const Scene scene = sceneOf(kCounter + kTraffic);
    const testing::TestFolder folder;
    World world(scene, milliseconds(20));
    {
        Recorder recorder(folder.path(), world, {.form = {.every = milliseconds(1000)}}, 0);
        for (int i = 0; i < 600; ++i) {
            world.step();
            recorder.record(world);
        }
        recorder.flush(world);
    }
    Replay replay(folder.path());
    World again(scene, replay.stepLength());
    while (replay.step(again)) continue;
    EXPECT_EQ(again.time(), world.time());
    EXPECT_EQ(countIn(again).entered, 3);
    EXPECT_EQ(countIn(again).left, 1);
}

/// Returns the finding about the only counter; "" for none.
std::string findingOf(const std::string& records) {
    const std::vector<Finding> findings = checkScene(sceneOf(records));
    return findings.empty() ? "" : findings.front().text();
}

TEST(DoorCounter, CheckTellsOfOnesThatCanCountNoPassage) {
    EXPECT_EQ(findingOf(kCounter), "");
    EXPECT_EQ(findingOf("doorcounter id=c at=1,0,2.3 range=3 tilt=20\n"), "");
    for (const char* wrong :
         {"doorcounter id=c at=3,1,0.15\n", "doorcounter id=c at=1,0,2.2 range=0.02,0.3\n",
          "doorcounter id=c at=1,0,2.2 height=3\n"})
        EXPECT_NE(findingOf(wrong).find("no point of its view is at `height`"), std::string::npos)
            << wrong;
    EXPECT_NE(findingOf("doorcounter id=c door=d tilt=90\n").find("one side of its line"),
              std::string::npos);
    EXPECT_NE(findingOf("doorcounter id=c\n").find("give it `at`, `on` or `door`"),
              std::string::npos);
    EXPECT_EQ(findingOf("doorcounter id=c at=1,0,2.2 range=0.02,0.3\nhuman id=a at=3,1 height=2\n"),
              "");
}

TEST(DoorCounter, FieldsHaveItsCounts) {
    const Scene scene = sceneOf(kCounter + "human id=a at=0.3,0\n");
    const DoorCount count{3, 2, {{kFirstPerson, 1, 1}}};
    const AddedReading reading{.pose = {}, .kind = &DoorCounter::kKind, .value = count};
    const ReadingView view = viewOf(scene.sensors[0], reading);
    std::vector<std::string> names;
    for (const ReadingField& field : readingKind(scene.sensors[0].model).fields) {
        if ((field.uses & kInJson) == 0) continue;
        names.push_back(std::string(field.name) + "=" +
                        std::to_string(std::get<std::int64_t>(field.value(view))));
    }
    EXPECT_EQ(names, (std::vector<std::string>{"entered=3", "left=2", "present=1"}));
}

}  // namespace doorcounter_test
}  // namespace ispace::doorcounters
