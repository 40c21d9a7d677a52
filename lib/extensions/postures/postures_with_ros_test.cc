// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "cli/common_options.h"
#include "extensions/postures/postures_test.h"
#include "extensions/ros/ros_feed.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/server_state.h"
#include "sim/simulation.h"

namespace ispace::postures {
namespace postures_with_ros_test {

TEST(Postures, AreMarkersOfRos) {
    testing::addPosturesOnce();
    const auto marker = [](const std::string& keys) {
        const Document placed = readRecordText(
            "#3dm 1\nhuman id=ann at=1,2 heading=90 " + keys + "\n", "room.3dm", sceneSchemas());
        const Scene scene =
            makeScene(readRecordText("#env 1\nispace size=10,8\n"
                                     "cylinder id=cup at=3,3 size=0.1,0.1 height=0.2 carried=ann\n",
                                     "room.env", sceneSchemas()),
                      &placed, shippedDevices());
        World world(scene, std::chrono::milliseconds(100));
        Simulation simulation(world, {}, {Clock::Kind::Step, 1}, {});
        ServerState state(simulation);
        ros::RosFeed feed(state, {});
        const std::uint32_t number = feed.numbersOf("/people").front();
        feed.want(number);
        simulation.allow(1);
        simulation.run({}, std::chrono::nanoseconds(0));
        feed.stepped();
        const auto& message = feed.entries().at(number).newest;
        return message ? nlohmann::json::parse(*message->json())["markers"][1] : nlohmann::json();
    };
    const auto expect = [&](const std::string& keys, int type, Point3 at, Vec3 size) {
        const nlohmann::json body = marker(keys);
        EXPECT_EQ(body["type"], type) << keys;
        const auto number = [&](const char* of, const char* axis) -> double {
            return std::string_view(of) == "scale" ? body["scale"][axis]
                                                   : body["pose"]["position"][axis];
        };
        EXPECT_NEAR(number("position", "x"), at.x, 1e-9) << keys;
        EXPECT_NEAR(number("position", "y"), at.y, 1e-9) << keys;
        EXPECT_NEAR(number("position", "z"), at.z, 1e-9) << keys;
        EXPECT_NEAR(number("scale", "x"), size.x, 1e-9) << keys;
        EXPECT_NEAR(number("scale", "y"), size.y, 1e-9) << keys;
        EXPECT_NEAR(number("scale", "z"), size.z, 1e-9) << keys;
    };
    constexpr int kCube = 1, kCylinder = 3;
    constexpr double h = 1.7;
    expect("", kCylinder, {1, 2, h / 2}, {0.3 * h, 0.3 * h, h});
    // From the feet to the top of the head, or to the hand beside it.
    expect("posture=lie support=0.5", kCube, {1, 2 - 0.175 * h, 0.5 + 0.065 * h},
           {h, 0.3 * h, 0.13 * h});
    expect("posture=fallen", kCube, {1, 2 - 0.025 * h, 0.065 * h}, {1.3 * h, 0.3 * h, 0.13 * h});
}

}  // namespace postures_with_ros_test
}  // namespace ispace::postures
