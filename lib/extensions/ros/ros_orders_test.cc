// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "extensions/ros/ros_text.h"
#include "extensions/ros/ros_topics.h"
#include "sense/formats/ros_messages.h"
#include "support/test_world.h"

namespace ispace::ros {
namespace ros_orders_test {

TEST(RosOrders, TellsWhyARequestNeedsAToken) {
    testing::TestWorld room({Clock::Kind::Real, 1});
    ServerLimits limits;
    limits.token = "secret";
    limits.token_first = true;
    ServerState state(room.simulation, limits);
    RosOrders orders(state, [](const std::string&) {});
    std::vector<std::string> answers;
    const auto pause = [&] {
        orders.request("PAUSE", [&answers](bool is_done, std::string_view text) {
            answers.push_back((is_done ? "done: " : "failed: ") + std::string(text));
        });
    };
    pause();
    pause();
    ASSERT_EQ(answers.size(), 2U);
    EXPECT_NE(answers[1].find("token"), std::string::npos) << answers[1];
    EXPECT_TRUE(answers[1].starts_with("failed: "));
    EXPECT_EQ(orders.present("secret"), 0U);
    pause();
    ASSERT_EQ(answers.size(), 3U);
    EXPECT_TRUE(answers[2].starts_with("done: ")) << answers[2];
    EXPECT_TRUE(room.simulation.paused());
}

TEST(RosOrders, MarkersOfATrackerAreTracks) {
    testing::TestWorld room({Clock::Kind::Real, 1});
    ServerState state(room.simulation);
    std::vector<std::string> told;
    RosOrders orders(state, [&told](const std::string& error) { told.push_back(error); });
    std::vector<RosRoom> rooms(1);
    rooms[0].simulation = &room.simulation;
    nameFrames(rooms);
    const std::vector<RosChannel> channels = rosChannels(rooms);
    const auto tracks = std::find_if(
        channels.begin(), channels.end(),
        [](const RosChannel& channel) { return channel.topic == "/tracks" && channel.isInput(); });
    ASSERT_NE(tracks, channels.end());
    std::vector<RosPerson> people = {{"ann", {{1, -2}, {}}, 0.25, 1.7}};
    orders.obey(*tracks, peopleMessage({2'500'000'000, "map"}, people));
    const auto present = room.simulation.tracks().present(room.world.time());
    ASSERT_EQ(present.size(), 1U);
    EXPECT_EQ(present[0]->track, "ispace/0");
    EXPECT_EQ(present[0]->time, 2.5);
    EXPECT_EQ(present[0]->place, (Point2{1, -2}));
    people[0].pose.position.x = std::nan("");
    orders.obey(*tracks, peopleMessage({3, "map"}, people));
    EXPECT_EQ(told.size(), 1U);
    EXPECT_THROW(orders.obey(*tracks, std::string_view("\0\1\0\0\2\0\0\0", 8)), FormatError);
}

/// A room with one robot ordered by topics.
struct Ordered {
    Ordered() {
        rooms[0].simulation = &room.simulation;
        nameFrames(rooms);
        channels = rosChannels(rooms);
    }

    void send(const std::string& topic, RosType type, const nlohmann::json& message) {
        const auto channel = std::ranges::find_if(channels, [&](const RosChannel& each) {
            return each.topic == topic && each.type == type;
        });
        ASSERT_NE(channel, channels.end()) << topic;
        orders.obey(*channel, rosMessage(type, message));
    }
    void goTo(double x, double y, const std::string& frame = "map") {
        send("/r2/goal_pose", RosType::PoseStamped,
             {{"header", {{"frame_id", frame}}},
              {"pose",
               {{"position", {{"x", x}, {"y", y}}}, {"orientation", {{"z", 1.0}, {"w", 0.0}}}}}});
    }
    void drive(double speed) { send("/r2/cmd_vel", RosType::Twist, {{"linear", {{"x", speed}}}}); }
    /// Steps while the client drives robots, at most so often. \returns the number of steps
    int steps(int most) {
        int count = 0;
        for (; count < most && orders.isDriving(); ++count) {
            room.simulation.allow(1);
            room.simulation.run({}, std::chrono::nanoseconds(0));
            state.collect();
            orders.stepped();
        }
        return count;
    }
    [[nodiscard]] Pose2 pose() const { return room.world.status(1).pose; }

    testing::TestWorld room;
    ServerState state{room.simulation};
    std::vector<std::string> told;
    RosOrders orders{state, [this](const std::string& error) { told.push_back(error); }};
    std::vector<RosRoom> rooms{1};
    std::vector<RosChannel> channels;
};

TEST(RosOrders, RobotsGoToGoals) {
    Ordered ordered;
    ordered.goTo(-2, -1);
    EXPECT_TRUE(ordered.orders.isDriving());
    EXPECT_FALSE(ordered.state.hold("r2")) << "another client has it";
    const int count = ordered.steps(400);
    EXPECT_GT(count, 50);
    EXPECT_LT(count, 400);
    EXPECT_EQ(ordered.told, std::vector<std::string>());
    EXPECT_NEAR(distance(ordered.pose().position, Point2{-2, -1}), 0, 0.05);
    EXPECT_NEAR(std::abs(ordered.pose().heading.degrees()), 180, 1);
    EXPECT_TRUE(ordered.state.hold("r2")) << "it is free";
}

TEST(RosOrders, RobotsGoToClickedPoints) {
    Ordered ordered;
    ordered.send("/r2/clicked_point", RosType::PointStamped,
                 {{"header", {{"frame_id", "map"}}}, {"point", {{"x", -2.0}, {"y", -1.0}}}});
    EXPECT_LT(ordered.steps(400), 400);
    EXPECT_EQ(ordered.told, std::vector<std::string>());
    EXPECT_NEAR(distance(ordered.pose().position, Point2{-2, -1}), 0, 0.05);
    EXPECT_GT(std::abs(ordered.pose().heading.degrees()), 10) << "it does not turn to any heading";
}

TEST(RosOrders, GoalsReplaceGoalsAndSpeedsReplaceBoth) {
    Ordered ordered;
    ordered.goTo(-2, -1);
    EXPECT_EQ(ordered.steps(10), 10);
    ordered.goTo(3, 1);
    EXPECT_LT(ordered.steps(400), 400);
    EXPECT_NEAR(distance(ordered.pose().position, Point2{3, 1}), 0, 0.05);
    ordered.goTo(-3, 1);
    EXPECT_EQ(ordered.steps(10), 10);
    ordered.drive(0);
    EXPECT_LT(ordered.steps(100), 30) << "freed after a silence";
    const Point2 stopped = ordered.pose().position;
    EXPECT_GT(distance(stopped, Point2{-3, 1}), 1);
    // A goal takes a robot from its own speeds.
    ordered.drive(0.1);
    ordered.goTo(3, 1);
    EXPECT_LT(ordered.steps(400), 400);
    EXPECT_NEAR(distance(ordered.pose().position, Point2{3, 1}), 0, 0.05);
    EXPECT_EQ(ordered.told, std::vector<std::string>());
}

TEST(RosOrders, ARefusedGoalLeavesTheEarlierOne) {
    Ordered ordered;
    ordered.goTo(-2, -1);
    EXPECT_EQ(ordered.steps(10), 10);
    ordered.goTo(40, 0);
    EXPECT_EQ(ordered.told.size(), 1U);
    EXPECT_LT(ordered.steps(400), 400);
    EXPECT_NEAR(distance(ordered.pose().position, Point2{-2, -1}), 0, 0.05);
}

TEST(RosOrders, TellsWhyAGoalIsNone) {
    Ordered ordered;
    ordered.goTo(40, 0);
    ASSERT_EQ(ordered.told.size(), 1U);
    EXPECT_TRUE(ordered.told[0].starts_with("goal of r2: ")) << ordered.told[0];
    EXPECT_FALSE(ordered.orders.isDriving());
    EXPECT_TRUE(ordered.state.hold("r2"));
    ordered.goTo(0, 1);
    ASSERT_EQ(ordered.told.size(), 2U);
    EXPECT_NE(ordered.told[1].find("r2"), std::string::npos) << "held by another";
    ordered.goTo(0, 1, "base_link");
    ASSERT_EQ(ordered.told.size(), 3U);
    EXPECT_NE(ordered.told[2].find("in the frame map"), std::string::npos);
    ordered.send("/r2/move_base_simple/goal", RosType::PoseStamped,
                 {{"pose", {{"position", {{"x", nullptr}}}}}});
    EXPECT_EQ(ordered.told.size(), 4U);
}

}  // namespace ros_orders_test
}  // namespace ispace::ros
