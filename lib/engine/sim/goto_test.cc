// SPDX-License-Identifier: GPL-3.0-or-later
// Goto: a mover of a room finds its way to a point.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sim/simulation.h"
#include "sim/world.h"
#include "support/test_layout.h"

namespace ispace {
namespace goto_test {

using testing::scene;

constexpr SimTime kStep = std::chrono::milliseconds(20);
/// Two rooms with an opening of 0.9 m at the top of the wall between them.
const std::string kRooms =
    "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\nfence id=a path=4,0;4,3.1\ninside at=1,1\n";

Command goTo(Point2 goal, std::optional<Angle> heading = {}) {
    Command command{Verb::Goto, 0, {.path = {goal}}};
    command.heading = heading;
    return command;
}

/// Gives a Goto, of which there must be a way. \returns its id
int send(World& world, std::size_t mover, Command command) {
    EXPECT_EQ(world.findPath(mover, command), "");
    return world.command(mover, command);
}

/// Steps until the mover's command ends, for at most so many seconds; Stopped if it does not.
Outcome await(World& world, std::size_t mover, int seconds) {
    for (const SimTime end = world.time() + std::chrono::seconds(seconds); world.time() < end;) {
        world.step();
        for (const CommandEnd& ended : world.ends())
            if (ended.robot == mover) return ended.outcome;
    }
    return Outcome::Stopped;
}

TEST(Goto, LeadsRoundAWallAndTurns) {
    const Scene rooms = scene(kRooms.c_str(), "robot id=r at=1,1\n");
    World world(rooms, kStep);
    Command command = goTo({7, 1}, Angle::degrees(90));
    ASSERT_EQ(world.findPath(0, command), "");
    EXPECT_GT(command.value, 2 * std::hypot(3, 2));
    EXPECT_LT(command.value, 9);
    EXPECT_EQ(world.command(0, command), 1);
    EXPECT_EQ(await(world, 0, 60), Outcome::Done);
    EXPECT_NEAR(distance(world.status(0).pose.position, Point2{7, 1}), 0, 0.02);
    EXPECT_NEAR(world.status(0).pose.heading.degrees(), 90, 1e-6);
    EXPECT_FALSE(world.status(0).stall);
    EXPECT_EQ(world.running(0), 0);
}

TEST(Goto, ComesBackToAGoalThatItPassed) {
    // It bends round the desk towards a goal near the corner, too fast to stop there.
    const Scene room = scene(
        "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\ncube id=desk at=6,1 size=1,1,0.7\n"
        "inside at=1,1\n",
        "robot id=r at=4.5,3.4 heading=-30\n");
    World world(room, kStep);
    for (const Point2 goal : {Point2{7.6, 0.5}, Point2{7.5, 3.5}, Point2{0.5, 0.5}}) {
        Command command = goTo(goal, Angle::degrees(180));
        command.speed = 0.8;
        send(world, 0, command);
        EXPECT_EQ(await(world, 0, 60), Outcome::Done);
        EXPECT_NEAR(distance(world.status(0).pose.position, goal), 0, 0.02);
        EXPECT_NEAR(std::abs(world.status(0).pose.heading.degrees()), 180, 1e-6);
        EXPECT_FALSE(world.status(0).stall);
    }
}

TEST(Goto, GoesAsFastAsItIsTold) {
    const Scene rooms = scene("ispace size=20,6\n", "robot id=r at=-9,0\n");
    World world(rooms, kStep);
    Command command = goTo({9, 0});
    command.speed = 1;
    EXPECT_EQ(world.refusal(0, command), "");
    send(world, 0, command);
    EXPECT_EQ(await(world, 0, 60), Outcome::Done);
    EXPECT_GT(world.time(), std::chrono::seconds(18));
    EXPECT_LT(world.time(), std::chrono::seconds(27));
    command.speed = 9;
    EXPECT_EQ(world.refusal(0, command), "r goes at most 1.6 m/s");
}

TEST(Goto, SaysWhyThereIsNoWay) {
    const std::string narrow =
        "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\nfence id=a path=4,0;4,3.5\n"
        "cube id=desk1 at=6,2 size=1,1,0.7\ninside at=1,1\n";
    const Scene rooms = scene(
        narrow.c_str(), "robot id=wide at=1,1 radius=0.25\nrobot id=slim at=1,3 radius=0.15\n");
    World world(rooms, kStep);
    Command command = goTo({7, 1});
    EXPECT_EQ(world.findPath(0, command), "no way for wide to 7,1: walls or bodies are between");
    EXPECT_EQ(command.course.path, std::vector<Point2>{(Point2{7, 1})});
    EXPECT_EQ(world.findPath(1, command), "");
    command = goTo({6, 2.4});
    EXPECT_EQ(
        world.findPath(1, command),
        "slim has no room at 6,2.4: desk1 stands there; the nearest point with room is 6,2.7");
    EXPECT_EQ(world.findPath(0, command), "wide has no room at 6,2.4: desk1 stands there")
        << "it comes nowhere near";
    command = goTo({20, 1});
    EXPECT_EQ(world.findPath(1, command), "no way for slim to 20,1: it is outside of the room");
}

TEST(Goto, NamesTheShutDoorsInTheWay) {
    const std::string flat =
        "fence id=f path=0,0;12,0;12,4;0,4 closed=yes\nfence id=a path=4,0;4,4\n"
        "fence id=b path=8,0;8,4\ndoor id=da wall=a at=4,2\ndoor id=db wall=b at=8,2 open=yes\n"
        "door id=dout wall=f at=6,0\ninside at=1,1\ninside at=5,1\n";
    const Scene rooms = scene(flat.c_str(), "robot id=r at=1,1 radius=0.25\n");
    World world(rooms, kStep);
    Command command = goTo({11, 1});
    EXPECT_EQ(world.findPath(0, command), "no way for r to 11,1: da is shut");
    command = goTo({20, 1});
    EXPECT_EQ(world.findPath(0, command), "no way for r to 20,1: it is outside of the room")
        << "no door leads there";
}

TEST(Goto, IsNotMisledToTheOtherSideOfAThinWall) {
    // The corridor behind the wall leaves the robot 3 cm at each side, less than ways keep.
    const Scene rooms = scene(
        "fence id=f path=0,0;8,0;8,4;0,4 closed=yes\nfence id=a path=0,3.44;8,3.44\n"
        "inside at=1,1\n",
        "robot id=r at=1,1 radius=0.25\n");
    World world(rooms, kStep);
    Command command = goTo({6, 3.72});
    EXPECT_EQ(
        world.findPath(0, command),
        "no way for r to 6,3.72: it is outside of the room; the nearest point with a way is 6,3.1");
}

TEST(Goto, TakesAnotherWayRoundRobotsThatStand) {
    // Two openings; the robot stands in the nearer one.
    const std::string two =
        "fence id=f path=0,0;8,0;8,6;0,6 closed=yes\nfence id=a path=4,1;4,4.8\ninside at=1,1\n";
    const Scene rooms = scene(two.c_str(), "robot id=r at=1,1\nrobot id=stands at=4,0.5\n");
    World world(rooms, kStep);
    send(world, 0, goTo({7, 1}));
    EXPECT_EQ(await(world, 0, 90), Outcome::Done);
    EXPECT_NEAR(distance(world.status(0).pose.position, Point2{7, 1}), 0, 0.02);
}

TEST(Goto, GivesUpAWayThatStaysOccupied) {
    const Scene rooms = scene(kRooms.c_str(), "robot id=r at=1,1\nrobot id=stands at=4,3.55\n");
    World world(rooms, kStep);
    send(world, 0, goTo({7, 1}));
    std::vector<Point2> given_up;
    EXPECT_EQ(await(world, 0, 120), Outcome::Unreached);
    for (const UnreachedPoint& point : world.unreached()) given_up.push_back(point.at);
    EXPECT_EQ(given_up, std::vector<Point2>{(Point2{7, 1})});
    EXPECT_GT(world.time(), 3 * std::chrono::seconds(10));
}

TEST(Goto, GoesRoundWhatIsPutInItsWay) {
    const std::string hall = "ispace id=room size=12,6\n";
    const Scene empty = scene(hall.c_str(), "robot id=r at=-5,0\n");
    World world(empty, kStep);
    const int id = send(world, 0, goTo({5, 0}));
    for (int i = 0; i < 100; ++i) world.step();
    const std::string desks = hall + "cube id=desk at=1,0.5 size=0.5,4.5,1\n";
    world.change(scene(desks.c_str(), "robot id=r at=-5,0\n"));
    EXPECT_EQ(world.running(0), id);
    const SimTime changed = world.time();
    EXPECT_EQ(await(world, 0, 60), Outcome::Done);
    EXPECT_FALSE(world.status(0).stall);
    EXPECT_NEAR(distance(world.status(0).pose.position, Point2{5, 0}), 0, 0.02);
    // At once, not after a while of standing before it.
    EXPECT_LT(world.time() - changed, std::chrono::seconds(28));
}

TEST(Goto, EndsByAnyOtherCommand) {
    const Scene rooms = scene(kRooms.c_str(), "robot id=r at=1,1\n");
    World world(rooms, kStep);
    const int first = send(world, 0, goTo({7, 1}));
    for (int i = 0; i < 50; ++i) world.step();
    const int second = send(world, 0, goTo({1, 3}));
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().front().id, first);
    EXPECT_EQ(world.ends().front().outcome, Outcome::Replaced);
    for (int i = 0; i < 50; ++i) world.step();
    world.command(0, {Verb::Stop, 0});
    ASSERT_EQ(world.ends().size(), 1U);
    EXPECT_EQ(world.ends().front().id, second);
    EXPECT_EQ(world.ends().front().outcome, Outcome::Stopped);
    for (int i = 0; i < 200; ++i) world.step();
    EXPECT_EQ(world.status(0).speed, 0);
}

TEST(Goto, OfAScriptWithoutAWayIsAnEvent) {
    const Scene rooms = scene(kRooms.c_str(), "robot id=r at=1,1\n");
    World world(rooms, kStep);
    const auto script = readScript("0 r GOTO 20,1\n0.1 r GOTO 2,2,-90\n", "s.txt", world);
    Simulation simulation(world, script, {Clock::Kind::Fast, 1}, std::chrono::seconds(20));
    simulation.events().want({EventKind::Unreached, EventKind::Mark});
    while (!simulation.finished())
        simulation.run(WallTime(std::chrono::hours(1)), std::chrono::hours(1));
    const EventLog& events = simulation.events();
    ASSERT_EQ(events.next(), 2);
    EXPECT_EQ(events.at(0).text, "script: no way for r to 20,1: it is outside of the room");
    EXPECT_EQ(events.at(1).kind, EventKind::Unreached);
    EXPECT_EQ(events.at(1).id, "r");
    EXPECT_EQ(events.at(1).time, SimTime(0));
    EXPECT_EQ(events.at(1).place, (Point2{20, 1}));
    EXPECT_NEAR(distance(world.status(0).pose.position, Point2{2, 2}), 0, 0.02);
    EXPECT_NEAR(world.status(0).pose.heading.degrees(), -90, 1e-6);
}

TEST(ParseGoto, TakesAPointAHeadingAndASpeed) {
    const ParsedCommand parsed = parseCommand("GOTO 1.5,-2,90 speed=0.3");
    ASSERT_TRUE(parsed.command);
    EXPECT_EQ(parsed.command->course.path, std::vector<Point2>{(Point2{1.5, -2})});
    EXPECT_EQ(parsed.command->heading, Angle::degrees(90));
    EXPECT_EQ(parsed.command->speed, 0.3);
    EXPECT_EQ(parseCommand("GOTO 1,2").command->heading, std::nullopt);
    for (const auto& [text, message] : {
             std::pair("GOTO", "GOTO wants a point x,y or x,y,heading in metres"),
             std::pair("GOTO 1",
                       "GOTO wants a point x,y or x,y,heading in metres and degrees, "
                       "found `1`"),
             std::pair("GOTO 1,2,3,4",
                       "GOTO wants a point x,y or x,y,heading in metres and "
                       "degrees, found `1,2,3,4`"),
             std::pair("GOTO upper/1,2",
                       "this run is of one room, without the storey of "
                       "`upper/1,2`: GOTO takes x,y"),
             std::pair("GOTO 1,2 pause=3",
                       "GOTO takes speed= in metres a second above 0 behind "
                       "its point, found `pause=3`"),
             std::pair("GOTO 1,2 speed=0",
                       "GOTO takes speed= in metres a second above 0 behind "
                       "its point, found `speed=0`"),
         })
        EXPECT_EQ(parseCommand(text).error.message,
                  std::string(message) + ", like GOTO 1,2 speed=0.3");
    EXPECT_EQ(parseCommand("GOTO 1e9,2").error.kind, CommandError::Kind::Range);
}

}  // namespace goto_test
}  // namespace ispace
