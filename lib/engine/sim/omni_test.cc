// SPDX-License-Identifier: GPL-3.0-or-later
// Motion of omnidirectional robots.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/motion.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace omni_test {

using std::chrono::milliseconds;
using testing::scene;

constexpr const char* kOmni = "robot id=r1 drive=omni max_sidespeed=0.8 accel=0.5 rotaccel=90\n";

RobotModel omni() { return scene("ispace size=8,6\n", kOmni).robots[0].model; }

TEST(Omni, ConstantSpeedsGoRoundAPoint) {
    // Ahead at 0.6, to the left at 0.4 m/s, turning by 50 deg/s: a circle about the point to the
    // left of the velocity.
    Motion motion;
    motion.drive = {{AxisGoal::Kind::Speed, 0.6}, 0.6, 0};
    motion.side = {{AxisGoal::Kind::Speed, 0.4}, 0.4, 0};
    motion.turn = {{AxisGoal::Kind::Speed, 50}, 50, 0};
    const double rate = Angle::degrees(50).radians();
    const MotionLimits limits = limitsOf(omni(), 0);
    for (const double time : {0.005, 0.7, 3.0}) {
        const double angle = rate * time;
        const Vec2 end{(0.6 * std::sin(angle) - 0.4 * (1 - std::cos(angle))) / rate,
                       (0.6 * (1 - std::cos(angle)) + 0.4 * std::sin(angle)) / rate};
        const Motion after = advance(motion, limits, time).motion;
        EXPECT_NEAR(after.pose.position.x, end.x, 1e-12);
        EXPECT_NEAR(after.pose.position.y, end.y, 1e-12);
        EXPECT_NEAR(after.pose.heading.degrees(), wrapped(Angle::degrees(50 * time)).degrees(),
                    1e-9);
    }
}

TEST(Omni, SpeedsUpToTheSideInClosedForm) {
    const Scene room = scene("ispace size=8,6\n", kOmni);
    World world(room, milliseconds(5));
    world.command(0, {Verb::Sidespeed, -0.5});
    world.command(0, {Verb::Speed, 0.25});
    while (world.time() < std::chrono::seconds(3)) world.step();
    // One second at -0.5 m/s^2 to -0.5, half a second to 0.25.
    EXPECT_NEAR(world.status(0).pose.position.y, -0.25 - 0.5 * 2, 1e-9);
    EXPECT_NEAR(world.status(0).pose.position.x, 0.0625 + 0.25 * 2.5, 1e-9);
    EXPECT_EQ(world.status(0).pose.heading, Angle());
    EXPECT_NEAR(world.status(0).sidespeed, -0.5, 1e-12);
    world.command(0, {Verb::Stop, 0});
    while (world.time() < std::chrono::seconds(5)) world.step();
    EXPECT_NEAR(world.status(0).pose.position.y, -1.25 - 0.25, 1e-9);
    EXPECT_EQ(world.status(0).sidespeed, 0);
}

TEST(Omni, StepsOfAnyLengthComeToTheSameEndAndBoundsHold) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> share(-1, 1);
    const MotionLimits limits = limitsOf(omni(), 0);
    for (int i = 0; i < 300; ++i) {
        Motion motion;
        motion.drive = {{AxisGoal::Kind::Speed, 1.5 * share(random)}, 1.5 * share(random), 0};
        motion.side = {{AxisGoal::Kind::Speed, 0.8 * share(random)}, 0.8 * share(random), 0};
        motion.turn = {{AxisGoal::Kind::Speed, 200 * share(random)}, 200 * share(random), 0};
        const Advance whole = advance(motion, limits, 1);
        const Vec2 chord = whole.motion.pose.position - Point2{};
        Motion steps = motion;
        for (int k = 1; k <= 100; ++k) {
            steps = advance(steps, limits, 0.01).motion;
            const Vec2 way = steps.pose.position - Point2{};
            EXPECT_LE(length(way - (k / 100.0) * chord), whole.lag + 1e-9);
        }
        EXPECT_NEAR(distance(steps.pose.position, whole.motion.pose.position), 0, 1e-9);
        EXPECT_GE(whole.path, length(chord) - 1e-12);
    }
}

TEST(Omni, OthersDoNotGoSideways) {
    const Scene room = scene("ispace size=8,6\n",
                             "robot id=r1\nrobot id=r2 at=2,0 drive=omni max_sidespeed=0.8\n");
    const World world(room, milliseconds(5));
    EXPECT_EQ(world.refusal(0, {Verb::Sidespeed, 0.1}),
              "r1 does not go sideways: its drive is not omni");
    EXPECT_EQ(world.refusal(1, {Verb::Sidespeed, 0.9}), "r2 goes at most 0.8 m/s sideways");
    EXPECT_EQ(world.refusal(1, {Verb::Sidespeed, -0.8}), "");
    EXPECT_EQ(
        testing::findings([] { return scene("ispace size=8,6\n", "robot max_sidespeed=1\n"); }),
        "room.3dm:2:21: error: only drive=omni goes sideways: say so, or leave it out\n");
}

}  // namespace omni_test
}  // namespace ispace
