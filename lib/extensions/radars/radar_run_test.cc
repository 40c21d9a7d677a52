// SPDX-License-Identifier: GPL-3.0-or-later
// Radars of a running world.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "extensions/radars/radar_frame.h"
#include "extensions/radars/radars_test.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace::radars {
namespace radar_run_test {

using std::chrono::milliseconds;

/// r1 is round, 0.3 m in radius, and drives along y = 0.
constexpr const char* kRobot = "robot id=r1 at=-2,0 radius=0.3 accel=1\n";
constexpr const char* kRadar = "radar id=w1 at=3,0,0.11 heading=180 min_speed=0.05\n";

const AddedReading& reading(const World& world) {
    return std::get<AddedReading>(world.reading(0).value);
}
const RadarFrame& frame(const World& world) { return reading(world).as<RadarFrame>(); }

TEST(RadarRun, MeasuresTheSpeedsOfRobots) {
    const Scene room = testing::scene("ispace size=10,6\n", std::string(kRobot) + kRadar);
    World world(room, milliseconds(20));
    EXPECT_TRUE(frame(world).detections.empty());
    world.command(0, {Verb::Speed, 0.4});
    int seen = 0;
    for (int i = 0; i < 200; ++i) {
        world.step();
        if (world.latestReadings().empty()) continue;
        const RadarFrame& now = frame(world);
        EXPECT_EQ(reading(world).frame, i / 5 + 1);
        EXPECT_NEAR(reading(world).time, ispace::seconds(world.time()), 1e-12);
        const RobotStatus status = world.status(0);
        if (status.speed < 0.05) continue;
        ASSERT_EQ(now.detections.size(), 1U) << i;
        EXPECT_NEAR(now.detections[0].range, 3 - 0.3 - status.pose.position.x, 1e-9);
        EXPECT_NEAR(now.detections[0].speed, -status.speed, 1e-9);
        ++seen;
    }
    EXPECT_GT(seen, 30);
}

TEST(RadarRun, AStalledRobotIsNoMover) {
    const Scene room = testing::scene("ispace size=10,6\nwall from=1,-1 to=1,1 height=0.05\n",
                                      std::string(kRobot) + "radar id=w1 at=4,0,1 heading=180\n");
    World world(room, milliseconds(100));
    world.command(0, {Verb::Speed, 0.5});
    for (int i = 0; i < 30; ++i) world.step();
    EXPECT_EQ(frame(world).detections.size(), 1U);
    for (int i = 0; i < 60; ++i) world.step();
    ASSERT_TRUE(world.status(0).stall);
    EXPECT_TRUE(frame(world).detections.empty());
}

TEST(RadarRun, ARadarOnARobotCompensatesItsMotion) {
    const Scene room = testing::scene("ispace size=10,6\n",
                                      std::string(kRobot) +
                                          "human id=h1 at=2.5,0 heading=180\n"
                                          "robot id=r2 at=2,1.5 radius=0.2\n"
                                          "radar id=w1 on=r1 at=0.2,0,0.11 min_speed=0.05\n");
    World world(room, milliseconds(100));
    world.command(0, {Verb::Speed, 0.3});
    for (int i = 0; i < 30; ++i) world.step();
    EXPECT_TRUE(frame(world).detections.empty()) << "all others stand";
    world.command(1, {Verb::Speed, 0.2});
    for (int i = 0; i < 10; ++i) world.step();
    ASSERT_EQ(frame(world).detections.size(), 1U);
    const RobotStatus radar = world.status(0), other = world.status(1);
    const Vec2 way = other.pose.position - (radar.pose * Point2{0.2, 0});
    EXPECT_NEAR(frame(world).detections[0].speed, other.speed * way.x / length(way), 1e-9);
    EXPECT_NEAR(frame(world).detections[0].bearing.radians(), std::atan2(way.y, way.x), 1e-9);
}

}  // namespace radar_run_test
}  // namespace ispace::radars
