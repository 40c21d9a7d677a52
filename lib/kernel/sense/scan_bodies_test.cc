// SPDX-License-Identifier: GPL-3.0-or-later
// Scans with robots in the way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sense/selection.h"
#include "support/test_layout.h"
#include "support/test_readings.h"

namespace ispace {
namespace scan_bodies_test {

const std::string kRoom = "ispace at=4,3 size=8,6,2.5\n";

/// What the sensors of a scene read with its robots at their start.
std::vector<Scan> scansOf(const Scene& scene) { return testing::scans(scene); }

std::vector<Scan> scansOf(const std::string& layout) {
    return scansOf(testing::scene(kRoom, layout));
}

TEST(RobotBody, IsABoxAboutItsMiddleOrACylinder) {
    RobotModel model;
    model.length = 0.44;
    model.width = 0.38;
    model.center = -0.04;
    model.height = 0.22;
    const MovingBody box = robotBody(model, {{1, 2}, Angle::degrees(90)}, 3);
    EXPECT_EQ(box.pose, (Pose2{{1, 1.96}, Angle::degrees(90)}));
    EXPECT_EQ(box.half_length, 0.22);
    EXPECT_EQ(box.half_width, 0.19);
    EXPECT_EQ(box.radius, 0);
    EXPECT_EQ(box.bottom, 0);
    EXPECT_EQ(box.top, 0.22);
    EXPECT_EQ(box.owner, 3U);
    const MovingBody round = robotBody(RobotModel(), {{1, 2}, {}}, 0);
    EXPECT_EQ(round.radius, 0.3);
    EXPECT_EQ(round.half_length, 0);
}

TEST(ScanOfRobots, ALevelLaserSeesTheFaceOfTheBody) {
    const auto scans = scansOf(
        "laser at=1,3 heading=0\n"
        "laser at=1,3,0.22\n"
        "laser at=1,3,0.23\n"
        "robot model=pioneer-2dx at=4,3\n"
        "robot at=1,5 radius=0.25\n");
    // Its back is at 4 - 0.04 - 0.22, the round one lies to the left.
    EXPECT_FLOAT_EQ(scans[0].ranges[90], 2.74F);
    EXPECT_FLOAT_EQ(scans[0].ranges[180], 1.75F);
    EXPECT_EQ(scans[0].ranges[0], 3);
    // At its top it is seen, above it the wall behind is out of range.
    EXPECT_FLOAT_EQ(scans[1].ranges[90], 2.74F);
    EXPECT_TRUE(std::isinf(scans[2].ranges[90]));
}

TEST(ScanOfRobots, ATiltedLaserSeesThemFromAbove) {
    const auto scans = scansOf("laser at=4,3,1.22 tilt=-90\nrobot at=4,3 height=0.22 radius=0.3\n");
    EXPECT_FLOAT_EQ(scans[0].ranges[90], 1);
}

TEST(ScanOfRobots, OnesOwnRobotIsNotSeen) {
    const auto scans = scansOf(
        "robot id=r1 at=2,3\n"
        "robot id=r2 at=5,3 heading=180\n"
        "laser on=r1 at=0.1,0\n"
        "laser on=r2\n"
        "laser at=2.1,3\n");
    EXPECT_FLOAT_EQ(scans[0].ranges[90], 2.6F);  // r2
    EXPECT_FLOAT_EQ(scans[1].ranges[90], 2.7F);  // r1
    EXPECT_FLOAT_EQ(scans[2].ranges[90], 0.2F);  // from within r1
}

TEST(ScanOfRobots, TheBlindZoneIsAppliedLast) {
    // A hidden body still hides the bodies behind it.
    const auto scans =
        scansOf("laser at=1,3 range=1,8\nlaser at=1,3 range=0.5,8\nrobot at=2,3 radius=0.5\n");
    EXPECT_TRUE(std::isinf(scans[0].ranges[90]));
    EXPECT_EQ(scans[1].ranges[90], 0.5F);
    EXPECT_EQ(scans[0].ranges[0], 3);
}

TEST(ScanOfRobots, WithoutBodiesNothingChanges) {
    const Scene scene = testing::scene(kRoom + "desk at=3,3\n", "laser at=1,3\nrobot at=2,3\n");
    const std::vector<float> plain = testing::scan(scene, scene.sensors[0]).ranges;
    EXPECT_EQ(plain,
              testing::scans(testing::scene(kRoom + "desk at=3,3\n", "laser at=1,3\n"))[0].ranges);
    EXPECT_NE(plain, scansOf(scene)[0].ranges);
}

TEST(ScanOfPeople, LegsTrunkAndHeadAreMet) {
    const auto scans = scansOf(
        "human at=4,3 heading=0\n"
        "laser at=2,3,0.15 range=8\n"
        "laser at=2,3,1.2 range=8\n"
        "laser at=2,3,1.65 range=8\n"
        "laser at=2,3,1.75 range=8\n"
        "laser at=4,3,2.4 tilt=-90 range=8\n");
    // Between the legs, 0.187 m apart from middle to middle, runs the middle beam; beside it they
    // are met.
    EXPECT_EQ(scans[0].ranges[90], 6);
    EXPECT_NEAR(*std::min_element(scans[0].ranges.begin(), scans[0].ranges.end()),
                std::hypot(2, 0.0935) - 0.0595, 2e-3);
    EXPECT_NEAR(scans[1].ranges[90], 2 - 0.102, 1e-6);
    EXPECT_NEAR(scans[2].ranges[90], 2 - std::sqrt(0.1105 * 0.1105 - 0.0605 * 0.0605), 1e-6);
    EXPECT_EQ(scans[3].ranges[90], 6);
    EXPECT_NEAR(scans[4].ranges[90], 0.7, 1e-6) << "onto the head";
}

TEST(ScanOfPeople, OnesOwnBodyIsNotSeen) {
    const auto scans = scansOf(
        "human id=a at=2,3\nhuman id=b at=5,3\n"
        "laser on=a at=0,0,1.2 range=8\nlaser at=2,3,1.2 range=8\n");
    EXPECT_NEAR(scans[0].ranges[90], 3 - 0.102, 1e-6);
    EXPECT_LT(scans[1].ranges[90], 0.2F);
}

/// Largest distance of the directions of a sensor's beams to those of Pose3::beam.
double worstDirection(Beams& beams, const Sensor& sensor) {
    double worst = 0;
    const Directions& directions = beams.at(sensor.pose);
    for (int k = 0; k < sensor.as<Laser>().beams; ++k) {
        const Vec3 wanted = sensor.pose.beam(sensor.as<Laser>().bearing(k));
        const Vec3 found = directions[static_cast<std::size_t>(k)];
        worst = std::max({worst, std::abs(wanted.x - found.x), std::abs(wanted.y - found.y),
                          std::abs(wanted.z - found.z)});
    }
    return worst;
}

TEST(Beams, FollowThePose) {
    for (const double tilt : {0.0, 20.0}) {
        for (const bool rides : {false, true}) {
            Sensor sensor;
            sensor.pose = {{1, 2, 0.5}, {}, Angle::degrees(tilt), {}};
            Beams beams(sensor.as<Laser>(), rides);
            for (const double heading : {0.0, 33.0, 33.0, -170.5, 90.0}) {
                sensor.pose.heading = Angle::degrees(heading);
                EXPECT_LT(worstDirection(beams, sensor), 1e-15) << tilt << rides << heading;
            }
        }
    }
}

TEST(Beams, DegreesOfASensorThatStandsAddUpExactly) {
    Sensor sensor;
    sensor.pose.heading = Angle::degrees(30);
    Beams beams(sensor.as<Laser>(), false);
    EXPECT_EQ(beams.at(sensor.pose)[150], (Vec3{0, 1, 0}));  // bearing 60
}

}  // namespace scan_bodies_test
}  // namespace ispace
