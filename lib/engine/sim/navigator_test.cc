// SPDX-License-Identifier: GPL-3.0-or-later
// Autonomous robots and people: along paths, past each other, about.
#include "sim/navigator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace navigator_test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::scene;

constexpr const char* kRoom = "ispace size=12,8\n";
/// 1.4 m wide along x, closed at its ends.
constexpr const char* kCorridor = "ispace size=12,1.4\n";
constexpr SimTime kStep = milliseconds(5);

/// Steps until `done` holds; the time, or nothing if that takes longer than `most`.
template <typename Done>
std::optional<SimTime> timeUntil(World& world, SimTime most, Done done) {
    while (world.time() < most) {
        world.step();
        if (done()) return world.time();
    }
    return std::nullopt;
}

bool isAt(const World& world, std::size_t mover, Point2 place, double within) {
    return distance(world.status(mover).pose.position, place) <= within;
}

TEST(Navigator, ARobotComesToRestExactlyAtTheEnd) {
    const Scene room = scene(kRoom, "robot id=r1 at=-3,0 path=0,0;0,2;-1,3\n");
    World world(room, kStep);
    bool corner = false;
    ASSERT_TRUE(timeUntil(world, seconds(60), [&] {
        corner = corner || isAt(world, 0, {0, 0}, Navigator::kArrive);
        return isAt(world, 0, {-1, 3}, 1e-3) && world.status(0).speed == 0;
    }));
    EXPECT_TRUE(corner);
    EXPECT_FALSE(world.status(0).stall);
    const Pose2 pose = world.status(0).pose;
    EXPECT_NEAR(distance(pose.position, Point2{-1, 3}), 0, 1e-6);
    timeUntil(world, world.time() + seconds(2), [] { return false; });
    EXPECT_EQ(world.status(0).pose, pose) << "and stays";
}

TEST(Navigator, APersonKeepsHerSpeedPastPlaces) {
    const Scene room = scene(kRoom, "human id=ann at=-4,-2 speed=1 path=4,-2;4,2;-4,2\n");
    World world(room, kStep);
    const auto time = timeUntil(world, seconds(40), [&] { return isAt(world, 0, {-4, 2}, 0.011); });
    ASSERT_TRUE(time);
    // 20 m at a metre a second, with two corners.
    EXPECT_GT(*time, milliseconds(19500));
    EXPECT_LT(*time, milliseconds(23500));
}

TEST(Navigator, LoopsAndPauses) {
    const Scene room =
        scene(kRoom, "human id=ann at=0,0 speed=1 path=2,0;0,0 loop=yes pause=1.5\n");
    World world(room, milliseconds(20));
    int visits = 0;
    SimTime rest{};
    bool was_there = false;
    for (int i = 0; i < 50 * 40; ++i) {
        world.step();
        const bool there = isAt(world, 0, {2, 0}, 0.02);
        visits += there && !was_there ? 1 : 0;
        was_there = there;
        if (there && world.status(0).speed == 0) rest += world.stepLength();
    }
    // A round of 4 m with two pauses and turns takes some 9 s.
    EXPECT_GE(visits, 4);
    EXPECT_LE(visits, 6);
    EXPECT_GT(rest, visits * milliseconds(1400));
    EXPECT_LT(rest, visits * milliseconds(2600));
}

TEST(Navigator, ACommandedPathIsDone) {
    const Scene room = scene(kRoom, "robot id=r1\nhuman id=ann at=0,2\n");
    World world(room, kStep);
    for (const std::size_t mover : {std::size_t{0}, std::size_t{1}}) {
        const auto parsed = parseCommand("PATH 2,-1;3,1 speed=0.4");
        ASSERT_TRUE(parsed.command);
        EXPECT_EQ(parsed.command->speed, 0.4);
        EXPECT_EQ(world.refusal(mover, *parsed.command), "");
        EXPECT_EQ(world.command(mover, *parsed.command), 1);
    }
    std::vector<CommandEnd> ends;
    timeUntil(world, seconds(60), [&] {
        ends.insert(ends.end(), world.ends().begin(), world.ends().end());
        return false;
    });
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_EQ(ends[0].outcome, Outcome::Done);
    EXPECT_EQ(ends[1].outcome, Outcome::Unreached) << "where the other one stands nobody gets";
    EXPECT_TRUE(isAt(world, ends[0].robot, {3, 1}, 0.01));
}

TEST(Navigator, APathThroughAWallFails) {
    const Scene room = scene(std::string(kRoom) + "wall from=1,-4 to=1,4\n", "robot id=r1\n");
    World world(room, kStep);
    world.command(0, pathCommand({.path = {{3, 0}}}));
    std::vector<CommandEnd> ends;
    const auto time = timeUntil(world, seconds(60), [&] {
        ends.assign(world.ends().begin(), world.ends().end());
        return !ends.empty();
    });
    ASSERT_TRUE(time);
    EXPECT_EQ(ends[0].outcome, Outcome::Unreached);
    EXPECT_LE(world.status(0).pose.position.x, 0.7 + 1e-9);
}

TEST(Navigator, AStopEndsAPath) {
    const Scene room = scene(kRoom, "robot id=r1\n");
    World world(room, kStep);
    const int id = world.command(0, pathCommand({.path = {{3, 0}}}));
    timeUntil(world, seconds(2), [] { return false; });
    world.command(0, {Verb::Stop, 0});
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends()[0].id, id);
    EXPECT_EQ(world.ends()[0].outcome, Outcome::Stopped);
    timeUntil(world, seconds(6), [] { return false; });
    EXPECT_LT(world.status(0).pose.position.x, 1.5);
    EXPECT_EQ(world.status(0).speed, 0);
}

TEST(Navigator, DegeneratePathsHarmNobody) {
    // To where it stands, twice the same place, into a wall, out of the room, round and round on
    // the spot.
    const Scene room = scene(kRoom,
                             "robot id=r1 at=-3,0 path=-3,0\n"
                             "robot id=r2 at=-3,2 path=-2,2;-2,2;-2,2;-1,2\n"
                             "human id=h1 at=0,0 path=6,0;0,1\n"
                             "human id=h2 at=0,2 path=50,50\n"
                             "human id=h3 at=3,-2 path=3,-2 loop=yes\n");
    World world(room, kStep);
    timeUntil(world, seconds(60), [] { return false; });
    EXPECT_TRUE(isAt(world, 0, {-3, 0}, 1e-9));
    EXPECT_TRUE(isAt(world, 1, {-1, 2}, 0.01));
    EXPECT_TRUE(isAt(world, *world.personNamed("h1"), {0, 1}, 0.02)) << "gave up the wall";
    EXPECT_TRUE(isAt(world, *world.personNamed("h3"), {3, -2}, 1e-9));
    for (std::size_t i = 0; i < world.movers().size(); ++i) {
        const Point2 p = world.status(i).pose.position;
        EXPECT_LE(std::abs(p.x), 6 - 0.25);
        EXPECT_LE(std::abs(p.y), 4 - 0.25);
    }
}

TEST(Navigator, WhoStartsInAThingMayLeaveIt) {
    // She sits half on a table's edge.
    const Scene room =
        scene(std::string(kRoom) + "wall from=0,-1 to=0,1\n", "human id=ann at=0.2,0 path=3,0\n");
    World world(room, kStep);
    EXPECT_TRUE(timeUntil(world, seconds(20), [&] { return isAt(world, 0, {3, 0}, 0.02); }));
}

TEST(Navigator, TwoWhoMeetInACorridorPass) {
    const Scene room =
        scene(kCorridor, "human id=ann at=-5,0 path=5,0\nhuman id=bob at=5,0 path=-5,0\n");
    World world(room, kStep);
    EXPECT_TRUE(timeUntil(world, seconds(30), [&] {
        return isAt(world, 0, {5, 0}, 0.02) && isAt(world, 1, {-5, 0}, 0.02);
    }));
}

TEST(Navigator, APersonStepsRoundARobot) {
    const Scene room = scene(kRoom, "robot id=r1\nhuman id=ann at=-4,0 path=4,0\n");
    World world(room, kStep);
    const auto time = timeUntil(world, seconds(30), [&] { return isAt(world, 1, {4, 0}, 0.02); });
    ASSERT_TRUE(time);
    EXPECT_LT(*time, seconds(10)) << "8 m at 1.2 m/s, and a little round it";
    EXPECT_FALSE(world.status(1).stall);
}

TEST(Navigator, SomebodyInACornerGetsOut) {
    const Scene room = scene(kRoom, "human id=ann at=-5.7,-3.7 heading=225 walk=wander\n");
    World world(room, kStep);
    EXPECT_TRUE(timeUntil(world, seconds(20), [&] { return !isAt(world, 0, {-5.7, -3.7}, 2); }));
}

TEST(Navigator, FastWanderersSlowDownToWhatTheRoomAllows) {
    for (const char* who : {"robot id=a speed=5 max_speed=5 accel=5", "human id=a speed=5",
                            "robot id=a speed=20 max_speed=20 accel=5", "human id=a speed=20"}) {
        const Scene cell = scene("ispace size=8,8\n", std::string(who) + " walk=wander\n");
        World world(cell, milliseconds(10));
        double path = 0;
        int stood = 0;
        while (world.time() < seconds(60)) {
            const Point2 before = world.status(0).pose.position;
            world.step();
            const double way = distance(before, world.status(0).pose.position);
            path += way;
            stood += way == 0 ? 1 : 0;
        }
        EXPECT_GT(path, 90) << who;
        EXPECT_LT(stood, 600) << who;
    }
}

/// Two barriers of the thesis' room.
constexpr const char* kBarriers = "barrier at=0.5,0.3\nbarrier at=1.2,0.95 heading=90\n";

TEST(Navigator, WhoTouchesAThingTurnsAwayInPlace) {
    const Scene room =
        scene(std::string(kRoom) + kBarriers,
              "robot id=r1 model=pioneer-2dx at=1.475,1.263 heading=-93.327 walk=wander\n");
    World world(room, kStep);
    EXPECT_TRUE(timeUntil(world, seconds(5), [&] { return !isAt(world, 0, {1.475, 1.263}, 1); }));
}

TEST(Navigator, APathLeadsAwayFromAThing) {
    for (const Point2 target : {Point2{0.5, -2}, Point2{1.475, -1}, Point2{3, 1.3}, Point2{2, 3}}) {
        const Scene room = scene(std::string(kRoom) + kBarriers,
                                 "robot id=r1 model=pioneer-2dx at=1.475,1.263 heading=-93.327\n");
        World world(room, kStep);
        world.command(0, pathCommand({.path = {target}}));
        std::vector<CommandEnd> ends;
        timeUntil(world, seconds(60), [&] {
            ends.assign(world.ends().begin(), world.ends().end());
            return !ends.empty();
        });
        ASSERT_EQ(ends.size(), 1U);
        EXPECT_EQ(ends[0].outcome, Outcome::Done) << target.x << ',' << target.y;
    }
}

TEST(Navigator, APersonThatGrazesAWallTurnsAwayInPlace) {
    const Scene room = scene(kRoom, "human id=h at=2.72006,-3.74358 path=2.75,-3.65;-1.4,-3.65\n");
    World world(room, milliseconds(50));
    EXPECT_TRUE(timeUntil(world, seconds(20), [&] { return isAt(world, 0, {-1.4, -3.65}, 0.02); }));
}

TEST(Navigator, ReachesPointsNearerToAWallThanItPasses) {
    for (const char* const mover : {"robot radius=0.3", "human"}) {
        const Scene room =
            scene(kRoom, mover + std::string(" id=m at=-3,0 path=2.07,3.69;2.5,1\n"));
        World world(room, milliseconds(50));
        EXPECT_TRUE(timeUntil(world, seconds(60), [&] { return isAt(world, 0, {2.5, 1}, 0.02); }));
    }
    const Scene room = scene(kRoom, "robot radius=0.3 id=m at=-3,0 path=2.07,3.69\n");
    World world(room, milliseconds(50));
    EXPECT_TRUE(timeUntil(world, seconds(60), [&] { return isAt(world, 0, {2.07, 3.69}, 0.02); }));
}

TEST(Navigator, WanderersKeepMoving) {
    std::string layout;
    for (int i = 0; i < 6; ++i) {
        const std::string x = std::to_string(i - 3);
        layout += "robot id=r" + x + " at=" + x + ",-1 radius=0.2 walk=wander\n";
        layout += "human id=h" + x + " at=" + x + ",1 walk=wander\n";
    }
    const Scene room = scene(kRoom, layout);
    World world(room, milliseconds(10));
    std::vector<double> path(world.movers().size());
    std::vector<Point2> last(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) last[i] = world.movers()[i].pose.position;
    while (world.time() < seconds(120)) {
        world.step();
        for (std::size_t i = 0; i < path.size(); ++i) {
            const Point2 p = world.status(i).pose.position;
            path[i] += distance(last[i], p);
            last[i] = p;
        }
    }
    for (std::size_t i = 0; i < path.size(); ++i)
        EXPECT_GT(path[i], 0.3 * 120 * world.movers()[i].model.speed) << world.movers()[i].id;
}

TEST(Navigator, TheSeedDecidesHowTheyWander) {
    const Scene room = scene(kRoom, "human id=ann walk=wander\nrobot id=r1 at=2,2 walk=wander\n");
    const auto ends = [&](std::uint64_t seed) {
        World world(room, kStep, {.seed = seed});
        timeUntil(world, seconds(30), [] { return false; });
        return std::pair(world.status(0).pose, world.status(1).pose);
    };
    EXPECT_EQ(ends(1), ends(1));
    EXPECT_NE(ends(1), ends(2));
}

TEST(Navigator, LongStepsDoNoHarm) {
    const Scene room =
        scene(kRoom, "human id=ann at=-4,0 path=4,0;4,2\nrobot id=r1 at=0,3 walk=wander\n");
    World world(room, seconds(1));
    EXPECT_TRUE(timeUntil(world, seconds(60), [&] { return isAt(world, 1, {4, 2}, 0.02); }));
}

}  // namespace navigator_test
}  // namespace ispace
