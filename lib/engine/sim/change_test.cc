// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace change_test {

using std::chrono::milliseconds;
using testing::findings;
using testing::scene;

constexpr SimTime kStep = milliseconds(100);
const std::string kRoom = "ispace id=room size=8,6\n";
const std::string kRobot = "robot id=r1 model=pioneer-2dx at=0,0\n";
const std::string kLaser = "laser id=l1 at=-3,-2 fov=4 step=2 range=0.1,7.002 rate=2\n";

std::shared_ptr<const Scene> shared(Scene scene) {
    return std::make_shared<const Scene>(std::move(scene));
}

void run(World& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step();
}

TEST(Change, WhatStaysGoesOn) {
    const Scene start = scene(kRoom, kRobot + kLaser);
    World changed(start, kStep), same(start, kStep);
    for (World* world : {&changed, &same}) {
        world->command(0, {Verb::Forward, 2});
        run(*world, 13);
    }
    const std::int64_t seq = changed.reading(0).seq;
    const SimTime read = changed.reading(0).time;
    changed.change(
        scene(kRoom + "cube id=box at=-2,2 size=0.5\n", "robot id=r0 at=2,2\n" + kLaser + kRobot));
    EXPECT_EQ(changed.changes(), 1);
    EXPECT_EQ(changed.time(), same.time());
    EXPECT_EQ(changed.steps(), 13);
    ASSERT_EQ(changed.robotNamed("r1"), 1U);
    EXPECT_EQ(changed.reading(0).seq, seq);
    EXPECT_EQ(changed.reading(0).time, read);
    EXPECT_TRUE(changed.ends().empty());
    run(changed, 100);
    run(same, 100);
    EXPECT_EQ(changed.status(1).pose, same.status(0).pose);
    EXPECT_NEAR(changed.status(1).pose.position.x, 2, 1e-12);
    EXPECT_EQ(changed.reading(0).scan().ranges, same.reading(0).scan().ranges);
    EXPECT_EQ(changed.reading(0).seq, same.reading(0).seq);
    // Ids of commands go on as well.
    EXPECT_EQ(changed.command(1, {Verb::Left, 90}), 2);
}

TEST(Change, KeepsTheCommandsThatEndedInTheLastStep) {
    World world(scene(kRoom, kRobot + "robot id=r2 at=2,2\n"), kStep);
    world.command(1, {Verb::Forward, 0.1});
    while (world.ends().empty()) world.step();
    world.change(scene(kRoom, "robot id=r2 at=2,2\n" + kRobot + kLaser));
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().front().robot, world.robotNamed("r2"));
    EXPECT_EQ(world.ends().front().id, 1);
    EXPECT_EQ(world.ends().front().outcome, Outcome::Done);
    // Those of movers that are gone are not.
    world.change(scene(kRoom, kRobot));
    EXPECT_TRUE(world.ends().empty());
}

TEST(Change, ARobotWithAnotherStartIsPutThere) {
    World world(shared(scene(kRoom, kRobot + "laser id=l1 on=r1 rate=10\n")), kStep);
    world.command(0, {Verb::Forward, 2});
    run(world, 20);
    world.change(scene(kRoom,
                       "robot id=r1 model=pioneer-2dx at=1,-1 heading=90\n"
                       "laser id=l1 on=r1 rate=10\n"));
    EXPECT_EQ(world.status(0).pose.position, (Point2{1, -1}));
    EXPECT_EQ(world.status(0).speed, 0);
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().front().id, 1);
    EXPECT_EQ(world.ends().front().outcome, Outcome::Stopped);
    run(world, 10);
    EXPECT_EQ(world.status(0).pose.position, (Point2{1, -1}));
    EXPECT_EQ(world.reading(0).pose.position.x, 1);
    EXPECT_EQ(world.command(0, {Verb::Forward, 1}), 2);
}

TEST(Change, ANewSensorReadsAtOnce) {
    World world(shared(scene(kRoom, kRobot)), kStep);
    run(world, 7);
    world.change(scene(kRoom, kRobot + kLaser));
    EXPECT_EQ(world.reading(0).time, milliseconds(700));
    EXPECT_EQ(world.reading(0).seq, 1);
    EXPECT_EQ(world.reading(0).scan().ranges.size(), 3U);
    ASSERT_EQ(world.latestReadings().size(), 1U);
    run(world, 1);
    EXPECT_TRUE(world.latestReadings().empty());
    run(world, 2);
    EXPECT_EQ(world.reading(0).seq, 2);
    EXPECT_EQ(world.reading(0).time, milliseconds(1000));
}

TEST(Change, ASensorOnARobotIsWhereThatIs) {
    World world(shared(scene(kRoom, kRobot)), kStep);
    world.command(0, {Verb::Forward, 2});
    run(world, 100);
    world.change(scene(kRoom, "robot id=r0 at=-2,-2\n" + kRobot + "laser id=l1 on=r1\n"));
    EXPECT_NEAR(world.reading(0).pose.position.x, 2, 1e-12);
}

TEST(Change, AFailedOneLeavesTheWorldAsItWas) {
    World world(shared(scene(kRoom, kRobot + kLaser)), kStep);
    world.command(0, {Verb::Forward, 2});
    run(world, 100);
    const auto in_the_way = [&](const char* place) {
        return findings([&] {
            world.change(scene(kRoom + "cube id=box size=0.6 at=" + place + "\n", kRobot + kLaser));
        });
    };
    EXPECT_EQ(in_the_way("2,0"),
              "room.3dm:2:1: error: robot r1 stands in cube box near (1.7, 0.0); move it, e.g. by "
              "0.55 m\n");
    EXPECT_EQ(world.changes(), 0);
    EXPECT_NEAR(world.status(0).pose.position.x, 2, 1e-12);
    EXPECT_EQ(world.scene().records.size(), 3U);
    // Where it began is free again.
    EXPECT_EQ(in_the_way("0,0"), "");
    EXPECT_NEAR(world.status(0).pose.position.x, 2, 1e-12);
}

TEST(Change, RobotsThatAreGoneAreGone) {
    World world(shared(scene(kRoom, kRobot + "robot id=r2 at=2,2\n")), kStep);
    world.command(0, {Verb::Forward, 2});
    world.command(1, {Verb::Forward, 1});
    run(world, 3);
    world.change(scene(kRoom, "robot id=r2 at=2,2\n"));
    EXPECT_EQ(world.robotNamed("r1"), std::nullopt);
    EXPECT_EQ(world.robotNamed("r2"), 0U);
    EXPECT_TRUE(world.ends().empty());
    run(world, 100);
    EXPECT_NEAR(world.status(0).pose.position.x, 3, 1e-12);
}

TEST(Change, ARestartBeginsAnewAtThisTime) {
    World world(shared(scene(kRoom, kRobot + kLaser)), kStep);
    world.command(0, {Verb::Forward, 2});
    run(world, 20);
    world.restart(scene(kRoom, kRobot + kLaser));
    EXPECT_EQ(world.time(), milliseconds(2000));
    EXPECT_EQ(world.steps(), 20);
    EXPECT_EQ(world.status(0).pose.position, (Point2{0, 0}));
    EXPECT_EQ(world.status(0).speed, 0);
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().front().outcome, Outcome::Stopped);
    EXPECT_EQ(world.reading(0).seq, 4);
    EXPECT_EQ(world.command(0, {Verb::Forward, 1}), 2);
    run(world, 100);
    EXPECT_NEAR(world.status(0).pose.position.x, 1, 1e-12);
}

TEST(Change, ASensorOnAPersonGoesAlong) {
    const std::string carried = "human id=h1 at=1,1 heading=90\nlaser id=l1 on=h1 at=0.2,0,1\n";
    World world(shared(scene(kRoom, carried)), kStep);
    const Pose3 before = world.reading(0).pose;
    world.change(scene(kRoom, carried + kRobot));
    EXPECT_NEAR(world.reading(0).pose.position.x, before.position.x, 1e-12);
    EXPECT_NEAR(world.reading(0).pose.position.y, before.position.y, 1e-12);
    EXPECT_NEAR(world.reading(0).pose.heading.degrees(), before.heading.degrees(), 1e-12);
}

}  // namespace change_test
}  // namespace ispace
