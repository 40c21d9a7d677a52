// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_orders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "sense/formats/ros_messages.h"
#include "server/ros/ros_topics.h"
#include "support/test_world.h"

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
