// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "cli/common_options.h"
#include "extensions/heads/heads_test.h"
#include "extensions/ros/ros_feed.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "sim/simulation.h"

namespace ispace::heads {
namespace heads_with_ros_test {

TEST(Head, IsTwoJointsOfItsRobot) {
    testing::addHeadsOnce();
    const Scene scene = makeScene(
        readRecordText("#env 1\nispace size=8,6\nrobot id=r\nhead id=h-1 on=r pan=90 tilt=-30\n"
                       "laser id=l on=h-1\nhead id=f\n",
                       "room.env", sceneSchemas()),
        nullptr, shippedDevices());
    World world(scene, std::chrono::milliseconds(5));
    Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
    ServerState state(simulation);
    ros::RosFeed feed(state, {});
    const std::uint32_t number = feed.numbersOf("/joint_states").front();
    feed.want(number);
    const auto joints = nlohmann::json::parse(*feed.entries().at(number).newest->json());
    EXPECT_EQ(joints["name"],
              nlohmann::json({"r_left_wheel_joint", "r_right_wheel_joint", "h_1_pan", "h_1_tilt"}));
    EXPECT_NEAR(joints["position"][2].get<double>(), std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(joints["position"][3].get<double>(), -std::numbers::pi / 6, 1e-12);
    EXPECT_TRUE(joints["velocity"][2].is_null()) << "unknown";
}

}  // namespace heads_with_ros_test
}  // namespace ispace::heads
