// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include "record/text.h"
#include "support/test_layout.h"

namespace ispace {

using testing::devices;
using testing::findings;
using testing::layoutDocument;
using testing::roomDocument;
using testing::scene;

namespace scene_test {

const std::string kRoom =
    "ispace id=room at=4,3 size=8,6\n"
    "desk at=2,2\n"
    "desk id=d at=5,4\n";

std::string sceneFindings(const std::string& room, const std::string& layout) {
    return findings([&] { return scene(room, layout); });
}

TEST(MakeScene, EnvironmentAlone) {
    const Scene made = scene(kRoom);
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d"}));
    EXPECT_EQ(made.environment.elements().size(), 3U);
    EXPECT_TRUE(made.sensors.empty());
    EXPECT_TRUE(made.pending.empty());
    EXPECT_EQ(made.digest(), environmentDigest(roomDocument(kRoom).records));
}

TEST(MakeScene, OfChangedRecordsSharesTheRoom) {
    const Scene before = scene(kRoom, "laser id=l1 at=1,2\n");
    const auto changed = [&](const std::string& room, const std::string& layout) {
        return makeScene(scene(room, layout).records, before, devices());
    };
    const auto shares = [&](const Scene& made) {
        return &made.environment.elements() == &before.environment.elements();
    };
    const Scene moved = changed(kRoom, "laser id=l1 at=3,2\nrobot id=r1 at=1,1\n");
    EXPECT_TRUE(shares(moved));
    EXPECT_EQ(moved.sensors[0].pose.position.x, 3);
    EXPECT_EQ(moved.robots.size(), 1U);
    EXPECT_EQ(moved.digest(), before.digest());
    EXPECT_TRUE(shares(changed(kRoom, "")));
    EXPECT_FALSE(shares(changed(kRoom + "desk id=e at=7,4\n", "")));
    EXPECT_FALSE(shares(changed("ispace id=room at=4,3 size=8,6\ndesk at=2,2\n", "")));
    EXPECT_FALSE(
        shares(changed("ispace id=room at=4,3 size=8,6\ndesk at=2,2.1\ndesk id=d at=5,4\n", "")));
    EXPECT_FALSE(
        shares(changed("ispace id=room at=4,3 size=8,6\ndesk at=2,2\ndesk id=f at=5,4\n", "")));
    EXPECT_EQ(findings([&] {
                  const Document bad = layoutDocument("laser id=l1 on=nobody\n");
                  makeScene(joinRecords(before.records, bad.records), before, devices());
              }),
              "room.3dm:2:16: error: `on`: nothing has the id `nobody`\n");
}

TEST(MakeScene, PicturesDoNotCountInTheDigest) {
    const auto digest = [](const std::string& cube) {
        return scene("ispace size=4,4\ncube " + cube + "\n").digest();
    };
    EXPECT_EQ(digest("size=1 texture=a.png"), digest("size=1"));
    EXPECT_NE(digest("size=2"), digest("size=1"));
}

TEST(MakeScene, SensorsOfLayoutFollowPlacedAndPending) {
    const Scene made = scene(kRoom,
                             "environment file=room.glb digest=sha256:0\n"
                             "laser id=a model=urg-04lx at=1,2,0.3 heading=-90\n"
                             "laser range=4\n"
                             "laser at=3,3\n"
                             "result coverage=97.4% area=12 bound=0.99 strategy=grid\n");
    EXPECT_EQ(made.records.size(), 6U);
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d", "a", "laser1", "laser2"}));
    ASSERT_EQ(made.sensors.size(), 2U);
    EXPECT_EQ(made.sensors[0].id, "a");
    EXPECT_EQ(made.sensors[0].as<Laser>().model, "urg-04lx");
    EXPECT_EQ(made.sensors[0].pose.position, (Point3{1, 2, 0.3}));
    EXPECT_EQ(made.sensors[0].pose.heading.degrees(), -90);
    EXPECT_EQ(made.sensors[1].id, "laser2");
    EXPECT_EQ(made.sensors[1].pose.position.z, kScanHeight);
    ASSERT_EQ(made.pending.size(), 1U);
    EXPECT_EQ(made.pending[0].id, "laser1");
    EXPECT_EQ(std::get<Laser>(made.pending[0].model).max_range, 4);
    EXPECT_EQ(made.pending[0].record, made.records[4]);
}

TEST(MakeScene, LayoutReplacesWrittenIdsInTheirPlace) {
    const Scene made = scene(kRoom, "chair at=1,1\ndesk id=d at=6,5\nlaser id=room2 at=1,1\n");
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d", "chair1", "room2"}));
    EXPECT_EQ(made.records[2].tuple("at"), (Tuple{6, 5}));
    EXPECT_EQ(made.environment.elements().size(), 4U);
}

TEST(MakeScene, AutomaticIdsAreNeverReplacedAndSkipWrittenOnes) {
    // ENV's first desk was desk1; the layout's written desk1 is another desk.
    const Scene made = scene(kRoom, "desk id=desk1 at=6,1\n");
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk2", "d", "desk1"}));
}

TEST(MakeScene, DigestIsOfTheEnvironmentBeforeTheLayout) {
    const std::string plain = scene(kRoom).digest();
    EXPECT_EQ(scene(kRoom, "desk id=d at=6,5\nlaser at=1,1\n").digest(), plain);
    EXPECT_EQ(scene(kRoom + "laser at=1,1\n").digest(), plain);
    EXPECT_NE(scene(kRoom + "chair at=1,1\n").digest(), plain);
}

TEST(MakeScene, SensorsOfTheEnvironmentCanBeMovedByTheLayout) {
    const Scene made =
        scene(kRoom + "laser id=l at=1,1\nlaser id=m at=2,1\n", "laser id=l at=3,3\n");
    ASSERT_EQ(made.sensors.size(), 2U);
    EXPECT_EQ(made.sensors[0].pose.position.x, 3);
    EXPECT_EQ(made.sensors[1].pose.position.x, 2);
}

TEST(MakeScene, DoubledIdWithinOneFileIsAnError) {
    // Readers refuse it; so does a scene of records that a program has made.
    Document room = roomDocument(kRoom);
    room.records.push_back(room.records.back());
    EXPECT_NE(findings([&] { return makeScene(room, nullptr, devices()); }), "");
    const Document good = roomDocument(kRoom);
    Document layout = layoutDocument("laser id=l at=1,1\n");
    layout.records.push_back(layout.records.back());
    EXPECT_NE(findings([&] { return makeScene(good, &layout, devices()); }), "");
}

TEST(MakeScene, RobotsInOrder) {
    const Scene made =
        scene(kRoom + "robot at=1,1\n", "robot id=b model=pioneer-2dx at=2,4 heading=-90\nrobot\n");
    EXPECT_EQ(made.ids, (std::vector<std::string>{"room", "desk1", "d", "robot1", "b", "robot2"}));
    ASSERT_EQ(made.robots.size(), 3U);
    EXPECT_EQ(made.robots[0].id, "robot1");
    EXPECT_EQ(made.robots[0].model, RobotModel());
    EXPECT_EQ(made.robots[0].pose, (Pose2{{1, 1}, {}}));
    EXPECT_EQ(made.robots[1].id, "b");
    EXPECT_EQ(made.robots[1].model.model, "pioneer-2dx");
    EXPECT_EQ(made.robots[1].pose, (Pose2{{2, 4}, Angle::degrees(-90)}));
    EXPECT_EQ(made.robots[1].place.line, 2);
    EXPECT_EQ(made.robots[2].id, "robot2");
    EXPECT_EQ(made.robots[2].pose, Pose2());
    EXPECT_EQ(made.digest(), scene(kRoom).digest()) << "robots belong to the layout";
    EXPECT_TRUE(made.sensors.empty());
}

TEST(MakeScene, SensorsOnRobotsInAnyOrder) {
    const Scene made = scene(kRoom,
                             "laser id=a on=r2 at=0.2,0.1 heading=10 tilt=-5\n"
                             "robot at=1,1\n"
                             "robot id=r2 at=2,4 heading=90\n"
                             "laser id=b on=robot1\n"
                             "laser id=c on=r2 at=0,0,0.5\n");
    ASSERT_EQ(made.sensors.size(), 3U);
    EXPECT_TRUE(made.pending.empty());
    const Sensor& a = made.sensors[0];
    ASSERT_TRUE(a.mount);
    EXPECT_EQ(a.mount->robot, 1U);
    EXPECT_EQ(a.mount->robot_from_sensor,
              (Pose3{{0.2, 0.1, kScanHeight}, Angle::degrees(10), Angle::degrees(-5), {}}));
    EXPECT_EQ(a.pose, mountedPose(made.robots[1].pose, a.mount->robot_from_sensor));
    EXPECT_DOUBLE_EQ(a.pose.position.x, 1.9);
    EXPECT_DOUBLE_EQ(a.pose.position.y, 4.2);
    EXPECT_EQ(a.pose.heading.degrees(), 100);
    const Sensor& b = made.sensors[1];
    ASSERT_TRUE(b.mount);
    EXPECT_EQ(b.mount->robot, 0U);
    EXPECT_EQ(b.pose.position, (Point3{1, 1, kScanHeight}));
    EXPECT_EQ(made.sensors[2].pose.position, (Point3{2, 4, 0.5}));
}

TEST(MakeScene, SensorsOnObjectsStandOnTheirTop) {
    const Scene made =
        scene(kRoom + "cube id=c at=3,3,0.5 size=1,1,0.4 heading=90\npillar id=p at=7,1 height=2\n",
              "laser on=d\nlaser on=c at=0.25,0,0.1 heading=-90\nlaser on=p at=0,0,-0.5\n");
    ASSERT_EQ(made.sensors.size(), 3U);
    for (const Sensor& laser : made.sensors) EXPECT_FALSE(laser.mount);
    EXPECT_EQ(made.sensors[0].pose.position.onFloor(), (Point2{5, 4}));
    EXPECT_DOUBLE_EQ(made.sensors[0].pose.position.z, 0.7 + kScanHeight);
    EXPECT_EQ(made.sensors[1].pose.position.onFloor(), (Point2{3, 3.25}));
    EXPECT_DOUBLE_EQ(made.sensors[1].pose.position.z, 1);
    EXPECT_EQ(made.sensors[1].pose.heading.degrees(), 0);
    EXPECT_DOUBLE_EQ(made.sensors[2].pose.position.z, 1.5);
}

TEST(MakeScene, EverythingWithAPlaceIsPlaced) {
    const Scene made = scene(kRoom,
                             "human at=3,3 heading=90\n"
                             "laser id=a at=1,2\n"
                             "camera id=wait\n"
                             "ranger id=k on=r at=0.1,0,0.4 heading=10 tilt=-5\n"
                             "ultrasound id=u at=2,2,2.4 tilt=-90\n"
                             "laser id=later\n"
                             "robot id=r at=2,4 heading=90\n"
                             "tag id=t on=r at=0,0,0.3\n"
                             "camera id=c on=d at=0,0,0.1 roll=5\n"
                             "mat at=1,1\nrobot id=s at=6,2\n"
                             "gate at=5,1 heading=-90\n"
                             "laser id=b on=s\n");
    std::vector<std::string> ids;
    for (const PlacedRecord& placed : made.placed) ids.push_back(made.ids[placed.record]);
    EXPECT_EQ(ids, (std::vector<std::string>{"human1", "a", "k", "u", "r", "t", "c", "mat1", "s",
                                             "gate1", "b"}));
    const auto& placed = made.placed;
    EXPECT_EQ(placed[0].pose, (Pose3{{3, 3, 0}, Angle::degrees(90), {}, {}}));
    EXPECT_EQ(placed[1].pose, made.sensors[0].pose);
    EXPECT_EQ(placed[1].index, 0U);
    EXPECT_FALSE(placed[1].mount);
    // In the frame of the robot at 2,4 that faces +y.
    EXPECT_NEAR(placed[2].pose.position.x, 2, 1e-12);
    EXPECT_NEAR(placed[2].pose.position.y, 4.1, 1e-12);
    EXPECT_EQ(placed[2].pose.position.z, 0.4);
    EXPECT_EQ(placed[2].pose.heading.degrees(), 100);
    EXPECT_EQ(placed[2].pose.tilt.degrees(), -5);
    ASSERT_TRUE(placed[2].mount);
    EXPECT_EQ(placed[2].mount->robot, 0U);
    EXPECT_EQ(placed[3].pose.position, (Point3{2, 2, 2.4}));
    EXPECT_EQ(placed[4].pose, (Pose3{{2, 4, 0}, Angle::degrees(90), {}, {}}));
    EXPECT_EQ(placed[4].index, 0U);
    EXPECT_TRUE(placed[5].mount);
    // On the desk of 0.7 m.
    EXPECT_DOUBLE_EQ(placed[6].pose.position.z, 0.8);
    EXPECT_EQ(placed[6].pose.roll.degrees(), 5);
    EXPECT_FALSE(placed[6].mount);
    EXPECT_EQ(placed[7].pose.position, (Point3{1, 1, 0}));
    EXPECT_EQ(placed[8].index, 1U);
    EXPECT_EQ(placed[9].pose.heading.degrees(), -90);
    EXPECT_EQ(placed[10].index, 5U);
    EXPECT_EQ(placed[10].pose, made.sensors[5].pose);
    EXPECT_EQ(placed[10].mount->robot, 1U);
    EXPECT_EQ(made.pending.size(), 2U);
}

TEST(MakeScene, CarriersOfAllSensors) {
    for (const char* keyword : {"ranger", "camera", "ultrasound", "tag"}) {
        const std::string line(keyword);
        EXPECT_EQ(sceneFindings(kRoom, "robot id=rover\n" + line + " on=rovre at=0,0\n"),
                  "room.3dm:3:" + std::to_string(line.size() + 5) +
                      ": error: `on`: nothing has the id `rovre`, did you mean `rover`?\n");
        EXPECT_NE(sceneFindings(kRoom, line + " on=room\n").find("is a `ispace`"),
                  std::string::npos);
        EXPECT_EQ(sceneFindings(kRoom, line + " on=d\n"), "");
    }
    const std::string model = sceneFindings(kRoom, "camera model=eye at=1,1\n");
    EXPECT_EQ(model.find("room.3dm:2:14: error: unknown model `eye`"), 0U) << model;
    EXPECT_NE(sceneFindings(kRoom, "ranger range=3,2 at=1,1\n").find("least range 3 m"),
              std::string::npos);
    EXPECT_NE(sceneFindings(kRoom, "camera range=0\n"), "") << "also where not yet placed";
    EXPECT_EQ(sceneFindings(kRoom, "ranger range=0.5,4\nultrasound range=8\n"), "");
}

TEST(MakeScene, SensorsStandOnTheTopOfAnyObject) {
    const Scene made = scene(kRoom + "boxes id=x at=1,1 height=1.5\ninfra id=f height=2\n",
                             "laser on=x\nultrasound on=f at=1,0,-0.1 tilt=-90\n");
    EXPECT_DOUBLE_EQ(made.placed[0].pose.position.z, 1.65);
    EXPECT_NEAR(made.placed[1].pose.position.z, 1.95, 1e-12);
}

TEST(MakeScene, PeopleCarrySensorsAtTheirEyes) {
    const Scene made = scene(kRoom,
                             "camera on=h2\ncamera on=h1 at=0.1,0,1.2 heading=10\n"
                             "human id=h1 at=1,1 heading=90\nhuman id=h2 at=3,2 height=1.5\n"
                             "camera on=h1 at=0.5,0\n");
    ASSERT_EQ(made.sensors.size(), 3U);
    EXPECT_EQ(made.sensors[0].pose.position, (Point3{3, 2, 0.94 * 1.5}));
    EXPECT_EQ(made.sensors[0].person, 1U);
    EXPECT_FALSE(made.sensors[0].mount);
    EXPECT_NEAR(made.sensors[1].pose.position.y, 1.1, 1e-12);
    EXPECT_EQ(made.sensors[1].pose.position.z, 1.2);
    EXPECT_EQ(made.sensors[1].pose.heading.degrees(), 100);
    EXPECT_EQ(made.sensors[1].person, 0U);
    EXPECT_NEAR(made.sensors[2].pose.position.z, 1.598, 1e-12);
}

TEST(MakeScene, OnMustNameACarrier) {
    const std::string unknown = sceneFindings(kRoom, "robot id=rover\nlaser on=rovre at=0,0\n");
    EXPECT_EQ(unknown,
              "room.3dm:3:10: error: `on`: nothing has the id `rovre`, did you mean `rover`?\n");
    const std::string chain = sceneFindings(kRoom, "laser id=a on=d\nlaser on=a\n");
    EXPECT_EQ(chain.find("room.3dm:3:10: error: `on`: `a` is a `laser`"), 0U) << chain;
    EXPECT_NE(sceneFindings(kRoom, "laser id=a on=a\n"), "");
    EXPECT_NE(sceneFindings(kRoom, "laser on=room\n").find("is a `ispace`"), std::string::npos);
    EXPECT_NE(sceneFindings(kRoom + "wall id=w from=0,1 to=1,1\n", "laser on=w\n"), "");
    // A robot with a finding of its own is there all the same.
    const std::string one = sceneFindings(kRoom, "robot id=r model=pionee\nlaser on=r\n");
    EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1) << one;
}

TEST(MakeScene, FindingsOfSensorsAndRoomComeTogether) {
    const std::string text = sceneFindings(
        "wall from=0,0 to=4,0\n", "laser model=urg at=1,1\nlaser range=3,2\nlaser at=1,1 on=r1\n");
    EXPECT_NE(text.find("room.3dm:2:13: error: unknown model"), std::string::npos) << text;
    EXPECT_NE(text.find("room.3dm:3:13:"), std::string::npos) << text;
    EXPECT_NE(text.find("room.3dm:4:17:"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
}

TEST(EnvironmentReference, TellsFileAndDigest) {
    const auto reference = environmentReference(
        layoutDocument("environment file=\"my room.glb\" digest=sha256:12\nlaser\n"));
    ASSERT_TRUE(reference);
    EXPECT_EQ(reference->file, "my room.glb");
    EXPECT_EQ(reference->digest, "sha256:12");
    EXPECT_EQ(reference->record.keyword(), "environment");
    const auto bare = environmentReference(layoutDocument("environment\n"));
    ASSERT_TRUE(bare);
    EXPECT_EQ(bare->file, "");
    EXPECT_EQ(bare->digest, "");
    EXPECT_FALSE(environmentReference(layoutDocument("laser\n")));
}

TEST(EnvironmentReference, OneLayoutHasOneEnvironment) {
    const std::string one = "environment file=a.glb\n";
    EXPECT_TRUE(environmentReference(layoutDocument(one + one)));
    EXPECT_NE(findings([&] {
                  return environmentReference(layoutDocument(one + "environment file=b.glb\n"));
              }),
              "");
}

TEST(SceneSchemas, EveryKeywordOnceAndIdFirst) {
    std::vector<std::string> seen;
    for (const Schema& schema : sceneSchemas().all()) {
        EXPECT_EQ(std::count(seen.begin(), seen.end(), schema.keyword), 0) << schema.keyword;
        seen.push_back(schema.keyword);
        ASSERT_FALSE(schema.keys.empty());
        EXPECT_EQ(schema.keys.front().name, "id") << schema.keyword;
    }
    for (const char* keyword : {"ispace", "desk", "laser", "robot", "environment", "result"})
        EXPECT_NE(sceneSchemas().find(keyword), nullptr) << keyword;
    EXPECT_EQ(&sceneSchemas(), &sceneSchemas());
}

TEST(SceneSchemas, CanonicalFormOfTheDesignsExample) {
    const std::string lines =
        "environment file=room.glb digest=sha256:00\n"
        "laser id=l1 model=urg-04lx at=-0.67,1.45,0.15 heading=-90\n"
        "laser at=0.2,0 rate=20 on=r1\n"
        "robot id=r1 model=pioneer-2dx at=0.5,2 heading=-90 size=0.4,0.3 center=0 speed=0.3\n"
        "result coverage=97.4% area=12.5 bound=99% strategy=wall complete=no\n";
    EXPECT_EQ(writeRecordText(layoutDocument(lines)), "#3dm 1\n" + lines);
    // Defaults are left out.
    EXPECT_EQ(
        writeRecordText(layoutDocument("laser tilt=0 roll=0 heading=0\nresult complete=yes\n")),
        "#3dm 1\nlaser\nresult\n");
    EXPECT_EQ(writeRecordText(layoutDocument("robot at=0,0 heading=0deg radius=25cm\n")),
              "#3dm 1\nrobot radius=0.25\n");
}

TEST(JoinRecords, ARecordTakesThePlaceOfOneOfItsKindOnly) {
    EXPECT_EQ(scene("ispace id=b\ndesk id=d at=1,1\n", "desk id=d at=2,1\n").records.size(), 2U);
    EXPECT_EQ(testing::findings([] { return scene("ispace id=b\n", "ranger id=b at=0,0\n"); }),
              "room.3dm:2:11: error: `b` is the id of the environment's ispace, and a record takes "
              "the place of one of its kind; give it another\n");
}

TEST(SceneSchemas, WhatSeesOrHearsIsASensorAndRobotsAreNot) {
    std::vector<std::string> sensors;
    for (const SensorKind* kind : sensorKinds())
        if (kind->perceives) sensors.emplace_back(kind->keyword);
    for (const char* const seer : {"laser", "ranger", "ultrasound", "camera"})
        EXPECT_NE(std::find(sensors.begin(), sensors.end(), seer), sensors.end()) << seer;
    for (const char* const other : {"tag", "mat", "gate"})
        EXPECT_EQ(std::find(sensors.begin(), sensors.end(), other), sensors.end()) << other;
    for (const std::string& keyword : sensors) EXPECT_NE(sceneSchemas().find(keyword), nullptr);
    EXPECT_EQ(sensorKind("robot"), nullptr);
}

constexpr std::string_view kUnread[] = {"camera", "mat"};

TEST(LeftOut, NamesAFewOfEachKind) {
    const Scene scene = testing::scene("ispace size=8,6\n",
                                       "camera id=a\nlaser id=l at=0,0\ncamera id=b at=1,1\n"
                                       "camera id=c\nmat id=m\ncamera id=d\ncamera id=e\n");
    EXPECT_EQ(
        leftOut(scene, kUnread, "measured"),
        (std::vector<std::string>{"`camera` is not measured yet, left out: a, b, c and 2 more",
                                  "`mat` is not measured yet, left out: m"}));
    const auto is_placed = [&](std::size_t i) { return scene.records[i].has("at"); };
    EXPECT_EQ(leftOut(scene, kUnread, "read", is_placed),
              std::vector<std::string>{"`camera` is not read yet, left out: b"});
}

TEST(LeftOut, SaysNothingOfNothing) {
    const Scene scene = testing::scene("ispace size=8,6\n", "laser at=0,0\n");
    EXPECT_TRUE(leftOut(scene, kUnread, "measured").empty());
}

}  // namespace scene_test

}  // namespace ispace
