// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_orders.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

}  // namespace
}  // namespace ispace
