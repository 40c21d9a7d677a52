// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/friction.h"

#include <gtest/gtest.h>

#include "layout/test_layout.h"

namespace ispace {
namespace {

using testing::scene;

TEST(FrictionMap, LastFloorHolds) {
    const Scene room = scene(
        "ispace size=20,20\n"
        "floor size=20,20 kind=checker\n"
        "floor at=2,0 size=4,2 friction=0.5\n"
        "floor at=2,0 size=1,1 heading=45 friction=0.25\n"
        "floor at=3.5,0 size=0.2,0.2\n");
    const FrictionMap friction(room.environment);
    EXPECT_FALSE(friction.empty());
    EXPECT_EQ(friction.at({0.5, 0.5}), 0.5);
    EXPECT_EQ(friction.at({2, 0}), 0.25);
    EXPECT_EQ(friction.at({2, 0.7}), 0.25);  // a corner of the turned square
    EXPECT_EQ(friction.at({2.45, 0.45}), 0.5);
    EXPECT_EQ(friction.at({3.5, 0}), 0);  // a smooth plate on the rough floor
    EXPECT_EQ(friction.at({0, 1}), 0.5);  // the edge belongs to it
    EXPECT_EQ(friction.at({-0.001, 0}), 0);
}

TEST(FrictionMap, NoFloorHasNone) {
    const Scene room = scene("ispace size=20,20\nfloor size=4,4\n");
    const FrictionMap friction(room.environment);
    EXPECT_TRUE(friction.empty());
    EXPECT_EQ(friction.at({0, 0}), 0);
}

}  // namespace
}  // namespace ispace
