// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/robot.h"

#include <gtest/gtest.h>

#include "support/test_layout.h"

namespace ispace {

using testing::devices;
using testing::findings;

namespace robot_test {

Record record(const std::string& line) { return readRecord(line, "line", sceneSchemas()); }

RobotModel robot(const std::string& keys) { return robotOf(record("robot " + keys), devices()); }

std::string robotFindings(const std::string& keys) {
    return findings([&] { return robot(keys); });
}

TEST(RobotOf, DevicesHaveTheSonarsAndBumpersOfTheReal) {
    for (const char* model : {"pioneer-2dx", "pioneer-3dx", "pioneer-2at", "pioneer-3at"}) {
        const RobotModel pioneer = robot(std::string("model=") + model);
        ASSERT_EQ(pioneer.sonar.places.size(), 16U) << model;
        EXPECT_EQ(pioneer.bumpers.size(), 10U) << model;
        // The ring is the same on both sides; the last sits a hair outside of the circle.
        for (std::size_t i = 0; i < 16; ++i) {
            const Pose2 here = pioneer.sonar.places[i];
            const Pose2 there = pioneer.sonar.places[i < 8 ? 7 - i : 23 - i];
            EXPECT_EQ(here.position.x, there.position.x) << model << ' ' << i;
            EXPECT_EQ(here.position.y, -there.position.y) << model << ' ' << i;
            EXPECT_NEAR(wrapped(here.heading + there.heading).degrees(), 0, 1e-9) << model;
            EXPECT_LT(distance(here.position, Point2()), pioneer.radius + 0.01)
                << model << ' ' << i;
        }
    }
    for (const char* model : {"create3", "turtlebot4"}) {
        EXPECT_EQ(robot(std::string("model=") + model).bumpers.size(), 5U) << model;
        EXPECT_TRUE(robot(std::string("model=") + model).sonar.places.empty()) << model;
    }
    for (const char* model : {"turtlebot3-burger", "turtlebot3-waffle-pi"}) {
        EXPECT_TRUE(robot(std::string("model=") + model).bumpers.empty()) << model;
        EXPECT_TRUE(robot(std::string("model=") + model).sonar.places.empty()) << model;
    }
}

TEST(RobotOf, BareRobotIsACylinderOfThirtyCentimetres) {
    const RobotModel bare = robot("");
    EXPECT_EQ(bare, RobotModel());
    EXPECT_EQ(bare.model, "");
    EXPECT_EQ(bare.radius, 0.3);
    EXPECT_EQ(bare.length, 0);
    EXPECT_LE(bare.speed, bare.max_speed);
    EXPECT_LE(bare.rotspeed, bare.max_rotspeed);
}

TEST(RobotOf, WheelsAreThoseOfTheModelElseOfTheBody) {
    EXPECT_EQ(wheelsOf(robot("model=pioneer-3dx")), (Wheels{0.0975, 0.33}));
    EXPECT_EQ(wheelsOf(robot("model=pioneer-3dx wheels=0.1,0.3")), (Wheels{0.1, 0.3}));
    const Wheels bare = wheelsOf(robot(""));
    EXPECT_NEAR(bare.track, 0.48, 1e-12);
    EXPECT_NEAR(bare.radius, 0.11, 1e-12);
    const Wheels tall = wheelsOf(robot("size=0.5,0.4,1.2"));
    EXPECT_NEAR(tall.track, 0.32, 1e-12);
    EXPECT_NEAR(tall.radius, 0.08, 1e-12) << "within the body";
    EXPECT_THROW(robot("wheels=0,0.3"), FormatError);
}

TEST(RobotOf, ModelGivesTheParametersAndExplicitKeysWin) {
    const RobotModel pioneer = robot("model=pioneer-2dx");
    EXPECT_EQ(pioneer.model, "pioneer-2dx");
    EXPECT_EQ(pioneer.radius, 0.25);
    EXPECT_EQ(pioneer.length, 0.44);
    EXPECT_EQ(pioneer.width, 0.38);
    EXPECT_EQ(pioneer.height, 0.22);
    EXPECT_EQ(pioneer.center, -0.04);
    EXPECT_EQ(pioneer.max_speed, 1.6);
    EXPECT_EQ(pioneer.max_rotspeed.degrees(), 300);
    const RobotModel other =
        robot("model=pioneer-2dx center=0 accel=1 rotaccel=30 rotspeed=1rad speed=30cm height=1");
    EXPECT_EQ(other.center, 0);
    EXPECT_EQ(other.accel, 1);
    EXPECT_EQ(other.rotaccel.degrees(), 30);
    EXPECT_DOUBLE_EQ(other.rotspeed.radians(), 1);
    EXPECT_EQ(other.speed, 0.3);
    EXPECT_EQ(other.height, 1);
    EXPECT_EQ(other.radius, 0.25);
    EXPECT_EQ(robot("model=pioneer-3dx").max_speed, 1.2);
}

TEST(RobotOf, SizeMakesABoxAndRadiusAloneACylinder) {
    const RobotModel round = robot("radius=0.4");
    EXPECT_EQ(round.radius, 0.4);
    EXPECT_EQ(round.length, 0);
    const RobotModel box = robot("size=0.6,0.5,0.4");
    EXPECT_EQ(box.length, 0.6);
    EXPECT_EQ(box.width, 0.5);
    EXPECT_EQ(box.height, 0.4);
    EXPECT_EQ(box.radius, 0.3);
    // The third number of size wins over height, as everywhere.
    EXPECT_EQ(robot("size=0.6,0.5 height=0.9").height, 0.9);
    EXPECT_EQ(robot("size=0.6,0.5,0.4 height=0.9").height, 0.4);
    EXPECT_EQ(robot("size=0.6,0.5").height, RobotModel().height);
    EXPECT_EQ(robot("model=pioneer-2dx radius=0.3").length, 0.44);
}

TEST(RobotOf, SpeedsFitTheirMaximum) {
    EXPECT_EQ(robotFindings("speed=2"),
              "line:1:13: error: speed 2 m/s is above max_speed 1.6 m/s\n");
    EXPECT_EQ(robotFindings("model=pioneer-3dx speed=1.3"),
              "line:1:31: error: speed 1.3 m/s is above max_speed 1.2 m/s\n");
    EXPECT_EQ(robotFindings("rotspeed=400"),
              "line:1:16: error: rotspeed 400 deg/s is above max_rotspeed 300 deg/s\n");
    const std::string both = robotFindings("speed=1 max_speed=0.9 rotspeed=9 max_rotspeed=8");
    EXPECT_EQ(std::count(both.begin(), both.end(), '\n'), 2) << both;
    EXPECT_EQ(robot("speed=2 max_speed=2").speed, 2);
    // A lower maximum lowers what the model drives at.
    EXPECT_EQ(robot("model=pioneer-2dx max_speed=0.4").speed, 0.4);
    EXPECT_EQ(robot("max_rotspeed=50").rotspeed.degrees(), 50);
    EXPECT_EQ(robot("max_speed=3").speed, 0.5);
}

TEST(RobotOf, ParametersHaveBounds) {
    for (const char* keys : {"radius=0",   "radius=-1",
                             "radius=101", "size=0,1",
                             "size=1",     "size=1,1,0",
                             "size=1,101", "center=101",
                             "height=0",   "speed=0",
                             "speed=-1",   "max_speed=1001",
                             "rotspeed=0", "max_rotspeed=100001",
                             "accel=0",    "accel=1001",
                             "rotaccel=0", "rotaccel=1e6",
                             "at=1,2,3",   "radius=nan",
                             "accel=inf"})
        EXPECT_NE(robotFindings(keys), "") << keys;
}

TEST(RobotOf, UnknownAndForeignModels) {
    const std::string unknown = robotFindings("model=pioneer-2xd");
    EXPECT_EQ(unknown,
              "line:1:13: error: unknown model `pioneer-2xd`, did you mean `pioneer-2dx`? (known: "
              "create3, turtlebot4, pioneer-2dx, pioneer-3dx, pioneer-3at, pioneer-2at, "
              "turtlebot3-burger, turtlebot3-waffle-pi)\n");
    EXPECT_EQ(robotFindings("model=urg-04lx"),
              "line:1:13: error: model `urg-04lx` is a laser, not a robot\n");
    EXPECT_NE(findings([] {
                  return robotOf(record("robot model=x"), DeviceCatalogue());
              }).find("the device catalogue has no robot"),
              std::string::npos);
}

TEST(FloorPoseOf, IsTheOriginIfNotGiven) {
    EXPECT_EQ(floorPoseOf(record("robot")), Pose2());
    EXPECT_EQ(floorPoseOf(record("robot at=1,2 heading=-90")),
              (Pose2{{1, 2}, Angle::degrees(-90)}));
    EXPECT_EQ(floorPoseOf(record("desk at=1,2,0.5 heading=30")),
              (Pose2{{1, 2}, Angle::degrees(30)}));
}

}  // namespace robot_test

}  // namespace ispace
