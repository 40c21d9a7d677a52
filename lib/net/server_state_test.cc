// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/server_state.h"

#include <gtest/gtest.h>

#include "net/test_world.h"

namespace ispace {

namespace {

TEST(StepQueue, TakesThemInTheOrderOfAsking) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(3), second = queue.ask(2);
    EXPECT_EQ(room.simulation.owed(), 5);
    for (int i = 0; i < 4; ++i) room.world.step();
    queue.settle();
    EXPECT_TRUE(first->over);
    EXPECT_EQ(second->left, 1);
    EXPECT_FALSE(second->over);
    room.world.step();
    queue.settle();
    EXPECT_TRUE(second->over);
}

TEST(StepQueue, ForgetsWhoIsGone) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(100), second = queue.ask(2);
    queue.drop(first);
    queue.drop(first);
    queue.drop(nullptr);
    EXPECT_EQ(room.simulation.owed(), 2);
    room.simulation.run(WallTime{}, std::chrono::hours(1));
    queue.settle();
    EXPECT_TRUE(second->over);
    EXPECT_EQ(second->left, 0);
    EXPECT_EQ(room.world.steps(), 2);
}

TEST(StepQueue, CutsShort) {
    testing::TestWorld room({Clock::Kind::Step, 1});
    StepQueue queue(room.simulation);
    const auto first = queue.ask(3), second = queue.ask(2);
    room.world.step();
    queue.cut();
    room.simulation.pause(WallTime{});
    EXPECT_TRUE(first->over);
    EXPECT_EQ(first->left, 2);
    EXPECT_TRUE(second->over);
    EXPECT_EQ(second->left, 2);
    // What is asked for afterwards has nothing to do with them.
    const auto third = queue.ask(1);
    room.world.step();
    queue.settle();
    EXPECT_EQ(first->left, 2);
    EXPECT_TRUE(third->over);
}

}  // namespace

}  // namespace ispace
