// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/robot_sensors.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>

#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace robot_sensors_test {

using std::chrono::milliseconds;
using testing::scene;

constexpr const char* kRoom = "ispace size=8,6\n";

TEST(Sonar, MeasuresTheNearestInItsCone) {
    // Ahead, to the left, back; the walls are 4 and 3 m away.
    const Scene room = scene(kRoom, "robot id=r1 at=0,0 sonar=0.2,0,0;0,0.1,90;-0.2,0,180\n");
    World world(room, milliseconds(100));
    const std::vector<float> ranges = world.sonar(0);
    ASSERT_EQ(ranges.size(), 3U);
    EXPECT_NEAR(ranges[0], 3.8, 1e-5);
    EXPECT_NEAR(ranges[1], 2.9, 1e-5);
    EXPECT_NEAR(ranges[2], 3.8, 1e-5);
}

TEST(Sonar, FollowsItsRobotAndSeesOthers) {
    const Scene room = scene(kRoom,
                             "robot id=r1 at=0,0 sonar=0,0,0;0,0,90 sonar_fov=20\n"
                             "robot id=r2 at=2,0.2 radius=0.3\n"
                             "human id=h1 at=-1,2\n");
    World world(room, milliseconds(100));
    // A cylinder a little aside: between its front and its middle.
    EXPECT_GT(world.sonar(0)[0], 1.7F);
    EXPECT_LT(world.sonar(0)[0], 1.75F);
    EXPECT_NEAR(world.sonar(0)[1], 3, 1e-5);
    world.command(0, {Verb::Left, 116.565});
    for (int i = 0; i < 60; ++i) world.step();
    // Towards the person's legs.
    EXPECT_LT(world.sonar(0)[0], std::sqrt(5.0));
    EXPECT_GT(world.sonar(0)[0], std::sqrt(5.0) - 0.3);
}

TEST(Sonar, LimitsAndTheFloor) {
    const Scene room = scene(kRoom,
                             "robot id=r1 at=3.65,0 height=0.1 sonar=0.3,0,0;0,0,180 "
                             "sonar_range=0.2,6\n");
    World world(room, milliseconds(100));
    EXPECT_EQ(world.sonar(0)[0], 0.2F) << "nearer than the least";
    // 7.65 m to the wall behind; the cone meets the floor long before.
    EXPECT_TRUE(std::isinf(world.sonar(0)[1]));
}

TEST(Sonar, HearsGlass) {
    for (const char* glass : {"clear", "opaque"}) {
        const Scene room =
            scene(std::string(kRoom) + "wall id=w from=2,-3 to=2,3 height=2.5\n" +
                      "window wall=w offset=3 size=2,0.1,2 sill=0.05 glass=" + glass + "\n",
                  "robot id=r1 at=0,0 sonar=0,0,0\n");
        World world(room, milliseconds(100));
        EXPECT_NEAR(world.sonar(0)[0], 2, 0.06) << glass;
    }
}

/// Rays are cast only if they may meet the nearest surface or body. One robot begins under the rim
/// of a table.
TEST(Sonar, AllAtOnceReadAsOneByOne) {
    std::string lines =
        "cube at=3,2 size=0.5,0.8,0.1\ncube at=-3,-2 heading=30 size=1,0.1,2\n"
        "table at=-1,2\ntable at=-5.9,-5.4 size=2,2,0.72\ndesk at=2,-3 heading=20\npillar at=5,5 "
        "kind=round size=0.4,0.4,3\n"
        "wall from=-6,3 to=-4,5 height=0.3\nchair at=0,-4 heading=70\n";
    const std::string ring =
        " sonar=0.1,0.1,90;0.2,0.1,50;0.2,0,10;0.2,0,-10;0.2,-0.1,-50;-0.1,-0.1,-90;-0.2,0,-150;"
        "-0.2,0,180";
    for (int i = 0; i < 12; ++i) {
        const std::string at = std::to_string(i % 4 * 3 - 5) + "," + std::to_string(i / 4 * 4 - 5);
        lines += "robot id=r" + std::to_string(i) + " at=" + at +
                 ".4 walk=wander heading=" + std::to_string(i * 77) + ring +
                 (i % 3 == 0 ? " sonar_fov=60" : "") +
                 (i % 5 == 0 ? " height=0.6 sonar_range=0.2,9\n" : "\n");
    }
    lines += "human id=h1 at=0.5,0.2 walk=wander\nhuman id=h2 at=-5,-3 walk=wander\n";
    const Scene room = scene("ispace size=16,16\n" + lines);
    World world(room, milliseconds(100));
    std::size_t echoes = 0, silent = 0;
    for (int step = 0; step < 300; ++step) {
        const std::vector<std::vector<float>> all = world.sonars();
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_EQ(all[i], world.sonar(i)) << world.robots()[i].id << " in step " << step;
            for (const float range : all[i]) ++(std::isinf(range) ? silent : echoes);
        }
        world.step();
    }
    EXPECT_GT(echoes, 1000U);
    EXPECT_GT(silent, 1000U);
}

/// Front, left, back and right, a quarter each.
constexpr const char* kBumpers = " bumpers=-45,45;45,135;135,225;225,315\n";

std::vector<bool> pressedAfter(const std::string& robot, Verb verb, double value,
                               const std::string& others = "") {
    const Scene room = scene(kRoom, "robot id=r1 " + robot + kBumpers + others);
    World world(room, milliseconds(10));
    EXPECT_EQ(world.bumper(0), std::vector<bool>(4));
    world.command(0, {verb, value});
    for (int i = 0; i < 2000 && !world.status(0).stall; ++i) world.step();
    EXPECT_TRUE(world.status(0).stall);
    return world.bumper(0);
}

TEST(Bumper, TellsWhereItTouches) {
    const std::vector<bool> front{true, false, false, false}, back{false, false, true, false};
    EXPECT_EQ(pressedAfter("at=2,0", Verb::Forward, 5), front);
    EXPECT_EQ(pressedAfter("at=2,0 heading=90", Verb::Forward, 5), front);
    EXPECT_EQ(pressedAfter("at=-2,0", Verb::Backward, 5), back);
    // Along a wall it does not feel it.
    EXPECT_EQ(pressedAfter("at=2,2.69", Verb::Forward, 5), front);
    // A glancing wall, met with the left of the front; a robot; a person.
    EXPECT_EQ(pressedAfter("at=0,2 heading=30", Verb::Forward, 5),
              (std::vector<bool>{false, true, false, false}));
    EXPECT_EQ(pressedAfter("at=-2,0", Verb::Forward, 5, "robot id=r2 at=0,0\n"), front);
    EXPECT_EQ(pressedAfter("at=-2,0", Verb::Forward, 5, "human id=h1 at=0,-0.2\n"),
              (std::vector<bool>{true, false, false, false}));
}

TEST(Bumper, IsReleasedByTheNextMotion) {
    const Scene room = scene(kRoom, std::string("robot id=r1 at=3,0") + kBumpers);
    World world(room, milliseconds(10));
    world.command(0, {Verb::Forward, 2});
    for (int i = 0; i < 1000 && !world.status(0).stall; ++i) world.step();
    EXPECT_TRUE(world.bumper(0)[0]);
    world.command(0, {Verb::Backward, 0.5});
    EXPECT_FALSE(world.bumper(0)[0]);
}

TEST(Bumper, IsReleasedWhenTheOtherGoes) {
    const Scene room =
        scene(kRoom, std::string("robot id=r1 at=-2,0") + kBumpers + "robot id=r2 at=0,0\n");
    World world(room, milliseconds(10));
    world.command(0, {Verb::Forward, 5});
    for (int i = 0; i < 1000 && !world.isStalled(0); ++i) world.step();
    const std::vector<bool> front{true, false, false, false};
    EXPECT_EQ(world.bumper(0), front);
    world.step();
    EXPECT_EQ(world.bumper(0), front) << "as before";
    world.command(1, {Verb::Forward, 1});
    for (int i = 0; i < 200; ++i) world.step();
    EXPECT_EQ(world.bumper(0), std::vector<bool>(4));
    EXPECT_TRUE(world.isStalled(0));
}

TEST(RobotRecord, PartsOfTheRimAndRangesAreChecked) {
    EXPECT_EQ(testing::findings([] { scene(kRoom, "robot bumpers=30,20\n"); }),
              "room.3dm:2:15: error: `bumpers`: 30,20 is no part of a turn, wanted FROM,TO "
              "counter-clockwise\n");
    EXPECT_EQ(testing::findings([] { scene(kRoom, "robot sonar_range=2,1\n"); }),
              "room.3dm:2:19: error: the greatest range of sonars, 1 m, must be above the least, "
              "2 m\n");
}

}  // namespace robot_sensors_test
}  // namespace ispace
