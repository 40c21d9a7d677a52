// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/selection.h"

#include <gtest/gtest.h>

#include "support/test_layout.h"

namespace ispace {
namespace selection_test {

TEST(StartVelocities, FollowPathsAndWanderersAtTheirSpeeds) {
    const Scene scene = testing::scene(
        "ispace size=20,20\n"
        "human id=h1 at=1,1 path=1,1;1,4 speed=1.5\n"
        "human id=h2 at=3,3 heading=180 walk=wander\n"
        "human id=h3 at=5,5\n"
        "robot id=r1 at=-2,0 path=-5,-4\n");
    const MoverVelocities all = startVelocities(scene);
    EXPECT_EQ(all.of(kFirstPerson).at({1, 1}), (Vec2{0, 1.5}));
    EXPECT_NEAR(all.of(kFirstPerson + 1).linear.x, -1.2, 1e-12);
    EXPECT_EQ(all.of(kFirstPerson + 2).linear, Vec2());
    EXPECT_NEAR(all.of(0).linear.x, -0.3, 1e-12);
    EXPECT_NEAR(all.of(0).linear.y, -0.4, 1e-12);
    EXPECT_EQ(all.of(MovingBodies::kNoOwner).linear, Vec2());
}

}  // namespace selection_test
}  // namespace ispace
