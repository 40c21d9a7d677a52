// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world.h"

#include <gtest/gtest.h>

#include "support/test_layout.h"

namespace ispace {
namespace world_test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::findings;
using testing::scene;

constexpr SimTime kStep = milliseconds(5);
const char* const kRoom = "ispace id=room size=8,6\n";

void run(World& world, SimTime duration) {
    for (const SimTime end = world.time() + duration; world.time() < end;) world.step();
}

/// Steps until a robot stalls.
void runToStall(World& world, std::size_t robot) {
    for (int i = 0; i < 100000 && !world.status(robot).stall; ++i) world.step();
    ASSERT_TRUE(world.status(robot).stall);
}

TEST(World, BeginsAtTheScene) {
    const Scene room = scene(kRoom, "robot id=b at=1,1 heading=270\nrobot id=a at=-1,1\n");
    const World world(room, kStep);
    EXPECT_EQ(world.time(), SimTime(0));
    EXPECT_EQ(world.stepLength(), kStep);
    EXPECT_EQ(world.steps(), 0);
    ASSERT_EQ(world.robots().size(), 2U);
    EXPECT_EQ(world.robotNamed("a"), 1U);
    EXPECT_EQ(world.robotNamed("c"), std::nullopt);
    EXPECT_EQ(world.sensorNamed("a"), std::nullopt);
    EXPECT_EQ(world.status(0).pose.heading, Angle::degrees(-90));
    EXPECT_EQ(world.status(0).pose.position, (Point2{1, 1}));
    EXPECT_FALSE(world.status(0).stall);
}

TEST(World, RobotsMustStandFree) {
    const auto text = [](const std::string& robots) {
        return findings([&] {
            return World(scene(std::string(kRoom) + "cube id=box at=2,0 size=1\n", robots), kStep);
        });
    };
    // Touching is allowed.
    EXPECT_EQ(text("robot id=a at=3.7,0\nrobot id=b at=0,0\nrobot id=c at=0.6,0\n"), "");
    // Their distance comes out as 0.5999999999999999.
    EXPECT_EQ(text("robot id=a at=1.1,-2\nrobot id=b at=1.7,-2\n"), "");
    EXPECT_EQ(
        text("robot id=a at=2,0.1\n"
             "robot id=b at=0,0\n"
             "robot id=c at=3.8,0\n"
             "robot id=d at=0.5,0\n"),
        "room.3dm:2:1: error: robot a stands in cube box near (2.0, 0.5); move it, e.g. by "
        "0.70 m\n"
        "room.3dm:3:1: error: robot b overlaps robot d near (0.25, 0.0); move one, e.g. by "
        "0.10 m\n"
        "room.3dm:4:1: error: robot c stands in ispace room near (4.0, 0.0); move it, e.g. by "
        "0.10 m\n");
    // Over the robot's head.
    EXPECT_EQ(text("robot id=a at=0,2 height=0.5\n"), "");
    std::string heap;
    for (int i = 0; i < 3000; ++i) heap += "robot at=0,0\n";
    const std::string many = text(heap);
    EXPECT_GE(std::count(many.begin(), many.end(), '\n'), 20);
    EXPECT_LE(std::count(many.begin(), many.end(), '\n'), 21);
}

TEST(World, ACommandEndsWithTheStepInWhichItArrives) {
    const Scene room = scene(kRoom, "robot id=r1 at=-2,0\n");
    World world(room, kStep);
    EXPECT_EQ(world.command(0, {Verb::Forward, 2}), 1);
    // 2 / 0.5 + 0.5 / 0.3 s.
    run(world, milliseconds(5665));
    EXPECT_TRUE(world.ends().empty());
    EXPECT_GT(world.status(0).speed, 0);
    world.step();
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends()[0].robot, 0U);
    EXPECT_EQ(world.ends()[0].id, 1);
    EXPECT_EQ(world.ends()[0].outcome, Outcome::Done);
    EXPECT_EQ(world.ends()[0].time, milliseconds(5670));
    EXPECT_EQ(world.status(0).speed, 0);
    EXPECT_EQ(world.status(0).accel, 0);
    EXPECT_NEAR(world.status(0).pose.position.x, 0, 1e-11);
    world.step();
    EXPECT_TRUE(world.ends().empty());
    EXPECT_EQ(world.command(0, {Verb::Left, 90}), 2);
    run(world, seconds(3));
    EXPECT_EQ(world.status(0).pose.heading, Angle::degrees(90));
    // Nothing to do takes a step.
    EXPECT_EQ(world.command(0, {Verb::Forward, 0}), 3);
    EXPECT_TRUE(world.ends().empty());
    world.step();
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends()[0].outcome, Outcome::Done);
}

TEST(World, StepsOfAnyLengthComeToTheSameEnd) {
    const Scene room = scene(kRoom, "robot id=r1 at=-2,0 heading=30\n");
    for (const SimTime step : {milliseconds(5), milliseconds(100), milliseconds(1000)}) {
        World world(room, step);
        world.command(0, {Verb::Forward, 1.3});
        run(world, seconds(7));
        world.command(0, {Verb::Right, 75});
        run(world, seconds(4));
        world.command(0, {Verb::Backward, 0.4});
        run(world, seconds(4));
        const Pose2 pose = world.status(0).pose;
        const Point2 expected = Point2{-2, 0} + 1.3 * unitVector(Angle::degrees(30)) -
                                0.4 * unitVector(Angle::degrees(-45));
        EXPECT_NEAR(distance(pose.position, expected), 0, 1e-9);
        EXPECT_EQ(pose.heading, Angle::degrees(-45));
    }
}

TEST(World, WheelsRollAsFarAsTheRobotGoes) {
    const Scene room = scene(kRoom, "robot id=r1 at=-2,0 heading=30\nrobot id=r2 at=3,0\n");
    for (const SimTime step : {milliseconds(5), milliseconds(1000)}) {
        World world(room, step);
        world.command(0, {Verb::Forward, 1.3});
        run(world, seconds(7));
        world.command(0, {Verb::Left, 500});
        run(world, seconds(12));
        world.command(0, {Verb::Backward, 0.4});
        run(world, seconds(4));
        const WheelTravel& travel = world.wheelTravel(0);
        EXPECT_NEAR(travel.driven, 0.9, 1e-12);
        EXPECT_NEAR(travel.turned.degrees(), 500, 1e-9) << "more than a turn";
        const Wheels wheels{.radius = 0.1, .track = 0.4};
        const double arc = 0.2 * Angle::degrees(500).radians();
        EXPECT_NEAR(travel.of(wheels, 1).radians(), (0.9 - arc) / 0.1, 1e-9);
        EXPECT_NEAR(travel.of(wheels, -1).radians(), (0.9 + arc) / 0.1, 1e-9);
        EXPECT_EQ(world.wheelTravel(1).driven, 0);
        world.change(Scene(world.scene()));
        EXPECT_NEAR(world.wheelTravel(0).driven, 0.9, 1e-12) << "kept";
        world.rewind();
        EXPECT_EQ(world.wheelTravel(0).driven, 0);
    }
}

TEST(World, WheelsRollAlongCurves) {
    const Scene room = scene(kRoom,
                             "robot id=r1 at=-1,0 accel=5 rotaccel=5000 max_rotspeed=900\n"
                             "robot id=r2 at=2,0 accel=0.3 rotaccel=40\n");
    for (const SimTime step : {milliseconds(5), milliseconds(20), milliseconds(1000)}) {
        World world(room, step);
        world.command(0, {Verb::Speed, 0.5});
        world.command(0, {Verb::Rotspeed, 400});
        world.command(1, {Verb::Speed, 0.3});
        world.command(1, {Verb::Rotspeed, 60});
        run(world, seconds(20));
        ASSERT_FALSE(world.isStalled(0) || world.isStalled(1));
        // Until the speeds are reached, it goes half as far.
        const bool is_short = step < seconds(1);
        EXPECT_NEAR(world.wheelTravel(1).driven, 0.3 * (20 - 0.5), is_short ? 1e-6 : 0.02);
        EXPECT_NEAR(world.wheelTravel(1).turned.degrees(), 60 * (20 - 0.75), 1e-6);
        if (!is_short) continue;  // the other one turns by more than half a turn as it starts
        EXPECT_NEAR(world.wheelTravel(0).driven, 0.5 * (20 - 0.05), 1e-3);
        EXPECT_NEAR(world.wheelTravel(0).turned.degrees(), 400 * (20 - 0.04), 1e-6);
    }
}

TEST(World, WheelsStandWhenAWallStopsThem) {
    const Scene room = scene(kRoom, "robot id=r1\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 0.5});
    run(world, seconds(30));
    ASSERT_TRUE(world.isStalled(0));
    EXPECT_NEAR(world.wheelTravel(0).driven, world.status(0).pose.position.x, 1e-9);
}

TEST(World, NewCommandsEndOldOnes) {
    const Scene room = scene(kRoom, "robot id=r1\nrobot id=r2 at=2,0\n");
    World world(room, kStep);
    EXPECT_EQ(world.command(0, {Verb::Forward, 2}), 1);
    EXPECT_EQ(world.command(1, {Verb::Left, 20}), 1);
    world.step();
    EXPECT_EQ(world.command(0, {Verb::Left, 20}), 2);
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().back().id, 1);
    EXPECT_EQ(world.ends().back().outcome, Outcome::Replaced);
    EXPECT_EQ(world.ends().back().time, kStep);
    EXPECT_EQ(world.command(0, {Verb::Stop, 0}), 0);
    ASSERT_EQ(world.ends().size(), 2U);
    EXPECT_EQ(world.ends().back().id, 2);
    EXPECT_EQ(world.ends().back().outcome, Outcome::Stopped);
    // A motion that does not end reports no end.
    EXPECT_EQ(world.command(0, {Verb::Speed, 0.2}), 0);
    EXPECT_EQ(world.command(0, {Verb::Rotspeed, 20}), 0);
    EXPECT_EQ(world.ends().size(), 2U);
    world.step();
    EXPECT_TRUE(world.ends().empty());
    EXPECT_EQ(world.command(0, {Verb::Forward, 1}), 3);
}

TEST(World, EndsDoNotFillTheMemory) {
    const Scene room = scene(kRoom, "robot id=r1\n");
    World world(room, kStep);
    for (int i = 0; i < 20000; ++i) world.command(0, {Verb::Forward, 1});
    EXPECT_LE(world.ends().size(), 5000U);
    EXPECT_GE(world.ends().size(), 1000U);
    EXPECT_EQ(world.ends().back().id, 19999);
}

TEST(World, RefusesWhatARobotCannotDo) {
    const Scene room = scene(kRoom, "robot id=r1 max_speed=1.2\n");
    const World world(room, kStep);
    EXPECT_EQ(world.refusal(0, {Verb::Speed, 1.2}), "");
    EXPECT_EQ(world.refusal(0, {Verb::Speed, -1.25}), "r1 goes at most 1.2 m/s");
    EXPECT_EQ(world.refusal(0, {Verb::Rotspeed, 300.5}), "r1 turns at most 300 deg/s");
    EXPECT_EQ(world.refusal(0, {Verb::Forward, 100}), "");
    EXPECT_EQ(world.refusal(0, {Verb::Left, -1}), "LEFT takes no negative value");
    EXPECT_EQ(world.refusal(0, {Verb::Stop, 0}), "");
}

TEST(World, AWallCancelsTheStep) {
    const Scene room = scene(kRoom, "robot id=r1\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 1});
    run(world, seconds(3));
    ASSERT_FALSE(world.status(0).stall);
    const int id = world.command(0, {Verb::Forward, 9});
    runToStall(world, 0);
    const RobotStatus status = world.status(0);
    EXPECT_LE(status.pose.position.x, 3.7 + 1e-9);
    EXPECT_GT(status.pose.position.x, 3.7 - 1.0 * 0.005);
    EXPECT_EQ(status.speed, 0);
    EXPECT_EQ(status.accel, 0);
    ASSERT_EQ(world.collisions().size(), 1U);
    EXPECT_EQ(world.collisions()[0].robot, 0U);
    EXPECT_EQ(world.collisions()[0].other, std::nullopt);
    EXPECT_EQ(world.collisions()[0].into, "room");
    EXPECT_EQ(world.collisions()[0].time, world.time());
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends()[0].id, id);
    EXPECT_EQ(world.ends()[0].outcome, Outcome::Stall);
    // It stays so, and tells it once.
    run(world, seconds(1));
    EXPECT_TRUE(world.status(0).stall);
    EXPECT_TRUE(world.collisions().empty());
    EXPECT_EQ(world.status(0).pose, status.pose);
    // Any motion command clears the flag; turning and leaving are free.
    world.command(0, {Verb::Stop, 0});
    EXPECT_FALSE(world.status(0).stall);
    world.command(0, {Verb::Right, 90});
    run(world, seconds(3));
    EXPECT_FALSE(world.status(0).stall);
    world.command(0, {Verb::Forward, 1});
    run(world, seconds(5));
    EXPECT_NEAR(world.status(0).pose.position.y, -1, 1e-9);
}

TEST(World, LongStepsDoNotGoThroughWalls) {
    const Scene room = scene(std::string(kRoom) + "wall from=1,-3 to=1,3\n", "robot id=r1\n");
    World world(room, seconds(1));
    world.command(0, {Verb::Speed, 1.6});
    runToStall(world, 0);
    EXPECT_LE(world.status(0).pose.position.x, 0.7);
}

TEST(World, PeopleStallRobotsAsThingsDo) {
    // 0.15 of her height about her: the robot comes as near as 0.6 m.
    const Scene room = scene(kRoom, "robot id=r1 at=-2,0\nhuman id=ann at=1,0 height=2\n");
    for (const SimTime step : {kStep, SimTime(seconds(1))}) {
        World world(room, step);
        const int id = world.command(0, {Verb::Forward, 5});
        runToStall(world, 0);
        EXPECT_LE(world.status(0).pose.position.x, 0.4 + 1e-9);
        EXPECT_GT(world.status(0).pose.position.x, 0.4 - 0.5 * ispace::seconds(step) - 1e-9);
        EXPECT_EQ(world.status(0).speed, 0);
        ASSERT_EQ(world.collisions().size(), 1U);
        EXPECT_EQ(world.collisions()[0].other, world.personNamed("ann"));
        EXPECT_EQ(world.collisions()[0].into, "ann");
        ASSERT_EQ(world.ends().size(), 1U);
        EXPECT_EQ(world.ends()[0].id, id);
        EXPECT_EQ(world.ends()[0].outcome, Outcome::Stall);
        // It may leave, and pass beside her.
        world.command(0, {Verb::Left, 90});
        run(world, seconds(4));
        world.command(0, {Verb::Forward, 1});
        run(world, seconds(6));
        world.command(0, {Verb::Right, 90});
        run(world, seconds(4));
        world.command(0, {Verb::Forward, 2});
        run(world, seconds(8));
        EXPECT_FALSE(world.status(0).stall);
        EXPECT_GT(world.status(0).pose.position.x, 1.3);
    }
}

TEST(World, RobotsMustNotStandInPeople) {
    const auto text = [](const std::string& layout) {
        return findings([&] { return World(scene(kRoom, layout), kStep); });
    };
    // Touching is allowed.
    EXPECT_EQ(text("human height=1 at=0.45,0\nhuman height=1 at=0.45,0.4\nrobot id=a\n"), "");
    EXPECT_EQ(text("human id=h at=0.5,0\nrobot id=a\n"),
              "room.3dm:2:1: error: human h overlaps robot a near (0.25, 0.0); move one, e.g. by "
              "0.06 m\n");
}

TEST(World, RobotsMeetHeadOn) {
    const Scene room = scene(kRoom, "robot id=r2 at=-1,0\nrobot id=r10 at=1,0 heading=180\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 0.5});
    world.command(1, {Verb::Speed, 0.5});
    while (world.collisions().empty() && world.time() < seconds(9)) world.step();
    // r10 comes before r2: it is tried where r2 stands, and r2 may go on until it touches.
    ASSERT_EQ(world.collisions().size(), 1U);
    const std::size_t first = world.collisions()[0].robot;
    EXPECT_EQ(world.collisions()[0].other, 1 - first);
    EXPECT_EQ(world.collisions()[0].into, world.robots()[1 - first].id);
    const auto gap = [&] {
        return distance(world.status(0).pose.position, world.status(1).pose.position) - 0.6;
    };
    EXPECT_GE(gap(), -1e-9);
    EXPECT_LE(gap(), 2 * 0.5 * 0.005);
    run(world, seconds(1));
    EXPECT_TRUE(world.status(0).stall);
    EXPECT_TRUE(world.status(1).stall);
    EXPECT_GE(gap(), -1e-9);
    EXPECT_LE(gap(), 0.5 * 0.005);
}

TEST(World, MovesAreSettledInTheOrderOfIds) {
    // Touching in a row, all to the right. The first mover to be settled must find its way free.
    const auto stalls = [](const std::string& left, const std::string& middle,
                           const std::string& right) {
        const Scene room = scene(kRoom, "robot id=" + left + " at=-0.6,0\nrobot id=" + middle +
                                            "\nrobot id=" + right + " at=0.6,0\n");
        World world(room, kStep);
        for (std::size_t i = 0; i < 3; ++i) world.command(i, {Verb::Speed, 0.4});
        run(world, seconds(2));
        std::string stalled;
        for (std::size_t i = 0; i < 3; ++i) stalled += world.status(i).stall ? 'x' : '-';
        return stalled;
    };
    EXPECT_EQ(stalls("c", "b", "a"), "---");
    EXPECT_EQ(stalls("a", "b", "c"), "xx-");
    EXPECT_EQ(stalls("r9", "r10", "r1"), "---");
}

TEST(World, AConvoyFollowsItsLeader) {
    std::string robots;
    for (int i = 0; i < 8; ++i) {
        robots += "robot id=r" + std::to_string(i) +
                  " radius=0.1 at=" + std::to_string(2 - 0.25 * i) + ",0\n";
    }
    const Scene room = scene("ispace size=40,6\ninside at=0,0\n", robots);
    World world(room, milliseconds(50));
    for (std::size_t i = 0; i < 8; ++i) world.command(i, {Verb::Forward, 6});
    run(world, seconds(20));
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_NEAR(world.status(i).pose.position.x, 8 - 0.25 * static_cast<double>(i), 1e-9);
    // The leader stops; the next ones run into those before them, one after another.
    for (std::size_t i = 1; i < 8; ++i) world.command(i, {Verb::Forward, 6});
    run(world, seconds(20));
    for (std::size_t i = 1; i < 8; ++i) {
        EXPECT_TRUE(world.status(i).stall);
        EXPECT_GE(distance(world.status(i).pose.position, world.status(i - 1).pose.position),
                  0.2 - 1e-9);
    }
}

TEST(World, TurningOnTheSpotHitsNothing) {
    const Scene room = scene(kRoom, "robot id=r1 at=3.7,0\nrobot id=r2 at=3.1,0\n");
    World world(room, kStep);
    world.command(0, {Verb::Rotspeed, 100});
    world.command(1, {Verb::Left, 500});
    run(world, seconds(8));
    EXPECT_FALSE(world.status(0).stall);
    EXPECT_FALSE(world.status(1).stall);
    EXPECT_EQ(world.status(1).pose.heading, Angle::degrees(140));
    EXPECT_NEAR(world.status(0).rotspeed.degrees(), 100, 1e-12);
}

TEST(World, FloorsSlowDown) {
    const Scene room = scene(
        "ispace size=40,6\ninside at=0,0\n"
        "floor at=3,0 size=4,6 friction=0.5\nfloor at=12,0 size=2,2 friction=1\n",
        "robot id=r1 at=0,0\n");
    World world(room, kStep);
    world.command(0, {Verb::Speed, 1.5});
    run(world, milliseconds(2000));
    EXPECT_NEAR(world.status(0).accel, 0.3, 1e-12);
    run(world, seconds(3));  // beyond x = 1, too fast for that floor
    EXPECT_NEAR(world.status(0).speed, 0.8, 1e-12);
    run(world, seconds(5));
    EXPECT_GT(world.status(0).speed, 0.81);  // the goal is what it was
    run(world, seconds(10));
    // It stands where friction is 1, and cannot leave.
    EXPECT_NEAR(world.status(0).pose.position.x, 11, 1.5 * 0.005);
    EXPECT_GE(world.status(0).pose.position.x, 11);
    EXPECT_EQ(world.status(0).speed, 0);
    EXPECT_FALSE(world.status(0).stall);
    world.command(0, {Verb::Backward, 1});
    run(world, seconds(2));
    EXPECT_TRUE(world.ends().empty());
    EXPECT_EQ(world.status(0).speed, 0);
}

}  // namespace world_test
}  // namespace ispace
