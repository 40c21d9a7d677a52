// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pages/cables.h"

#include <gtest/gtest.h>

#include <string>

#include "support/test_scenes.h"

namespace ispace::pages {
namespace cables_test {

constexpr const char* kRoom =
    "#env 1\n"
    "wall id=south from=0,0 to=6,0 height=2.5\n"
    "wall id=east from=6,0 to=6,4 height=2.5\n"
    "wall id=north from=6,4 to=0,4 height=2.5\n"
    "wall id=west from=0,4 to=0,0 height=2.5\n"
    "inside at=1,1\n";

std::vector<Cable> cablesIn(const std::string& more) { return cablesOf(sceneOf(kRoom + more)); }

TEST(Cables, RunAlongWallsAndUpToTheSensor) {
    const std::vector<Cable> cables = cablesIn(
        "panel id=p at=1,0 height=1.5 cost=2\n"
        "laser id=same at=4,0,1.5\n"     // on the panel's wall
        "laser id=corner at=6,1,2.5\n"   // 5 to the corner, 1 along the next wall, 1 up
        "laser id=over at=3,4,1.5\n"     // the shorter way round, over the west wall
        "laser id=middle at=2,1.25,1\n"  // 1.25 from the wall
        "robot id=r at=3,3\nlaser id=rider on=r\n");
    ASSERT_EQ(cables.size(), 4U);
    EXPECT_NEAR(cables[0].length, 3, 1e-12);
    EXPECT_NEAR(cables[1].length, 7, 1e-12);
    EXPECT_NEAR(cables[2].length, 1 + 4 + 3, 1e-12);
    EXPECT_NEAR(cables[3].length, 1 + 1.25 + 0.5, 1e-12);
    EXPECT_NEAR(cables[1].cost, 14, 1e-12);
    for (const Cable& cable : cables) EXPECT_EQ(cable.panel, "p");
}

TEST(Cables, TakeInnerWallsAndTheNearestPanel) {
    const std::vector<Cable> cables = cablesIn(
        "wall id=inner from=3,0 to=3,4 height=2.5\n"
        "panel id=p at=1,0 height=1\npanel id=q at=5,4 height=1\n"
        "laser id=l at=3,3,1\n"    // q: 2 along the north wall, 1 down the inner one; p: 2 + 3
        "laser id=m at=3,1,1\n");  // p: 2 + 1
    ASSERT_EQ(cables.size(), 2U);
    EXPECT_EQ(cables[0].panel, "q");
    EXPECT_NEAR(cables[0].length, 3, 1e-12);
    EXPECT_EQ(cables[1].panel, "p");
    EXPECT_NEAR(cables[1].length, 3, 1e-12);
}

TEST(Cables, TakeTheShorterWayFromACorner) {
    // As far from the west wall as from the south wall, along which the panel is.
    const std::vector<Cable> cables = cablesIn(
        "panel id=p at=1,0.1 height=1.5\nlaser id=low at=0.2,0.2,2.3\nlaser id=right "
        "at=5.8,0.2,1.5\n"
        // This panel is in a corner, too.
        "panel id=q at=0.3,3.7 height=1.5\nlaser id=high at=0.3,3,1.5\n");
    ASSERT_EQ(cables.size(), 3U);
    EXPECT_NEAR(cables[0].length, 0.1 + 0.8 + 0.2 + 0.8, 1e-9);
    EXPECT_NEAR(cables[1].length, 0.1 + 4.8 + 0.2, 1e-9);
    EXPECT_NEAR(cables[2].length, 0.3 + 0.7 + 0.3, 1e-9) << "along the panel's second wall";
}

TEST(Cables, AreNoneWithoutAPanel) { EXPECT_TRUE(cablesIn("laser at=1,1\n").empty()); }

}  // namespace cables_test
}  // namespace ispace::pages
