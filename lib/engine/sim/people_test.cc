// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/mover.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/bodies.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace people_test {

using std::chrono::milliseconds;
using testing::scene;

constexpr const char* kRoom = "ispace size=8,6\n";

void run(World& world, SimTime until) {
    while (world.time() < until) world.step();
}

TEST(People, AreMoversBehindTheRobots) {
    const Scene room = scene(
        kRoom, "human id=ann at=1,0 heading=90 speed=1.5\nrobot id=r1\nhuman id=bob at=2,0\n");
    World world(room, milliseconds(5));
    ASSERT_EQ(world.movers().size(), 3U);
    EXPECT_EQ(world.movers()[0].id, "r1");
    EXPECT_FALSE(world.movers()[0].is_person);
    EXPECT_EQ(world.personNamed("ann"), 1U);
    EXPECT_EQ(world.personNamed("r1"), std::nullopt);
    EXPECT_EQ(world.robotNamed("ann"), std::nullopt);
    EXPECT_EQ(world.moverNamed("bob"), 2U);
    EXPECT_EQ(world.people()[0].speed, 1.5);
    EXPECT_EQ(world.status(1).pose.heading, Angle::degrees(90));
    EXPECT_EQ(world.movers()[1].model.radius, humanRadius(1.7));
}

TEST(People, ObeyCommandsAsRobotsDo) {
    const Scene room = scene(kRoom, "human id=ann at=-2,0\n");
    World world(room, milliseconds(5));
    EXPECT_EQ(world.command(0, {Verb::Forward, 2}), 1);
    run(world, std::chrono::seconds(4));
    EXPECT_NEAR(world.status(0).pose.position.x, 0, 1e-9);
    EXPECT_EQ(world.refusal(0, {Verb::Speed, 2}), "ann goes at most 1.56 m/s");
    world.command(0, {Verb::Sidespeed, 0.6});
    run(world, std::chrono::seconds(5));
    EXPECT_NEAR(world.status(0).sidespeed, 0.6, 1e-12);
    // Up to speed at 2.4 m/s^2 within a quarter of a second.
    EXPECT_NEAR(world.status(0).pose.position.y, 0.6 * (1 - 0.125), 1e-9);
}

TEST(People, StopBeforeThingsRobotsAndEachOther) {
    const Scene room = scene(kRoom, "human id=ann\nrobot id=r1 at=2,0\nhuman id=bob at=-2,0\n");
    World world(room, milliseconds(5));
    const std::size_t ann = *world.personNamed("ann");
    world.command(ann, {Verb::Forward, 5});
    run(world, std::chrono::seconds(3));
    EXPECT_TRUE(world.status(ann).stall);
    EXPECT_LE(world.status(ann).pose.position.x, 2 - 0.3 - 0.255 + 1e-9);
    world.command(ann, {Verb::Backward, 5});
    run(world, std::chrono::seconds(7));
    EXPECT_GE(world.status(ann).pose.position.x, -2 + 2 * 0.255 - 1e-9);
    world.command(ann, {Verb::Left, 90});
    run(world, std::chrono::seconds(9));
    world.command(ann, {Verb::Forward, 9});
    run(world, std::chrono::seconds(14));
    EXPECT_TRUE(world.status(ann).stall);
    EXPECT_LE(world.status(ann).pose.position.y, 3 - 0.255 + 1e-9);
}

TEST(Gait, LimbsSwingByFifteenDegreesOnceAStride) {
    Gait gait;
    double most = 0;
    const double stride = strideOf(1.7);
    EXPECT_NEAR(stride, 4 * 0.48 * 1.7 * std::tan(Angle::degrees(15).radians()), 1e-12);
    for (int i = 0; i < 1000; ++i) {
        gait.walk(1.7, stride / 1000, 1.2);
        most = std::max(most, gait.swing(1.2).degrees());
        EXPECT_GE(gait.phase, 0);
        EXPECT_LT(gait.phase, 1);
    }
    EXPECT_NEAR(most, 15, 1e-9);
    EXPECT_NEAR(std::min(gait.phase, 1 - gait.phase), 0, 1e-9);
    // A slower person takes shorter steps; one at rest has the legs together.
    gait.phase = 0.25;
    EXPECT_NEAR(gait.swing(0.25).degrees(), 7.5, 1e-9);
    EXPECT_EQ(gait.swing(0), Angle());
    // Backwards the phase runs backwards.
    gait.walk(1.7, -stride / 2, 1);
    EXPECT_NEAR(gait.phase, 0.75, 1e-9);
}

TEST(Gait, ALaserSeesTheLegsSwing) {
    // From the side, at scanning height: one leg ahead of the other.
    const Scene room =
        scene(kRoom, "human id=ann at=-2,0\nlaser id=l1 at=-2,-2 heading=90 fov=180 step=0.5\n");
    World world(room, milliseconds(100));
    world.command(0, {Verb::Speed, 1.0});
    double widest = 0;
    for (int i = 0; i < 30; ++i) {
        world.step();
        const Scan& scan = world.reading(0).scan();
        double first = 1e9, last = -1e9;
        for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
            const double bearing = (-90 + 0.5 * static_cast<double>(k)) / 180 * M_PI;
            const double x = -scan.ranges[k] * std::sin(bearing),
                         y = scan.ranges[k] * std::cos(bearing);
            if (y > 2.3 || x < -1 || scan.ranges[k] > 4) continue;  // the room
            first = std::min(first, x);
            last = std::max(last, x);
        }
        widest = std::max(widest, last - first);
    }
    // Joint 0.816 m high, cut at 0.15: each foot 0.178 m from the middle, legs 0.119 m thick.
    EXPECT_GT(widest, 0.36);
    EXPECT_LT(widest, 0.49);
}

}  // namespace people_test
}  // namespace ispace
