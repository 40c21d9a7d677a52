// SPDX-License-Identifier: GPL-3.0-or-later
// The C++ client changes a running world, reads its events, and drives people and paths.
#include <gtest/gtest.h>
#include <ispace_client.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/test_folder.h"
#include "support/test_paths.h"
#include "test_server.h"

namespace ispace {
namespace client {
namespace {

std::string data(const std::string& file) {
    return ispace::testing::sourcePath("tests/data/") + file;
}

TEST(Building, LeadsRobotsByLifts) {
    TestServer server{{data("tower.yaml"), data("tower.3dm"), "--clock", "step", "-q"}};
    World world(server.address());
    Robot robot(server.address(), "ground/r1");
    const Motion trip = robot.goTo("upper", {9, 6});
    world.step(std::lround(70 / world.dt()));
    EXPECT_TRUE(robot.wait(trip).done);
    EXPECT_EQ(robot.status().storey, "upper");
    EXPECT_EQ(robot.status().passage, "");
    world.call("l1", "ground");
    const std::vector<Lift> lifts = world.lifts();
    ASSERT_EQ(lifts.size(), 1U);
    EXPECT_EQ(lifts[0].id, "l1");
    EXPECT_EQ(lifts[0].height, 3);
    EXPECT_EQ(lifts[0].calls, std::vector<std::string>{"ground"});
    EXPECT_THROW(robot.ride("l2", "ground"), Refused);
}

TEST(Building, ChangesThingsOfItsRooms) {
    TestServer server{{data("tower.yaml"), data("tower.3dm"), "--clock", "step", "-q"}};
    World world(server.address());
    EXPECT_EQ(world.add("lamp id=upper/lamp1 at=8,4"), "upper/lamp1");
    EXPECT_EQ(world.states("upper/lamp1")["upper/lamp1.on"], "0");
    world.act("upper/lamp1", "on", "1");
    EXPECT_EQ(world.states()["upper/lamp1.on"], "1");
    EXPECT_EQ(world.add("desk id=ground/d1 at=9,2"), "ground/d1");
    world.set("ground/d1", "at", "9,3");
    world.remove("ground/d1");
    EXPECT_THROW(world.remove("ground/d1"), Refused);
    // Movers go on trips with all that they carry.
    for (const char* record : {"robot id=ground/r9 at=1,1", "laser id=ground/l9 on=ground/r1",
                               "laser id=ground/l9 on=\"ground/r1\"", "desk at=9,2", "desk id=d9",
                               "lamp id=ground/ at=1,1", "lamp id=upper/ground/r1 at=1,7",
                               "laser id=ground/eye at=1,1", "lamp id=upper/upper/fixed at=1,1"})
        EXPECT_THROW(world.add(record), Refused) << record;
    EXPECT_THROW(world.set("ground/r1", "mass", "3"), Refused);
    EXPECT_THROW(world.set("upper/fixed", "on", "ground/r1"), Refused);
    EXPECT_THROW(world.set("upper/lamp1", "id", "ground/r1"), Refused);
    EXPECT_THROW(world.remove("ground/"), Refused);
    EXPECT_THROW(world.remove("ground/r1"), Refused);
    EXPECT_THROW(world.remove("ground/eye"), Refused);
    // A robot still goes to the changed storey.
    Robot robot(server.address(), "ground/r1");
    const Motion trip = robot.goTo("upper", {9, 6});
    world.step(std::lround(70 / world.dt()));
    EXPECT_TRUE(robot.wait(trip).done);
    EXPECT_EQ(world.states("upper/lamp1")["upper/lamp1.on"], "1");
    world.set("ground/r1", "at", "ground/1,1");
    world.reset();
    EXPECT_EQ(world.states().count("upper/lamp1.on"), 0U);
}

/// A client's order to a robot aboard a lift is refused; a robot whose client leaves it there goes
/// on to the storey, and stands off the landing.
TEST(Building, ARobotLeftAloneInALiftStopsBehindIt) {
    TestServer server{{data("tower.yaml"), data("tower.3dm"), "--clock", "step", "-q"}};
    World world(server.address());
    const auto simulate = [&](double seconds) { world.step(std::lround(seconds / world.dt())); };
    {
        Robot robot(server.address(), "ground/r1");
        robot.goTo("upper", {9, 6});
        for (int i = 0; i < 120 && robot.status().passage != "l1"; ++i) simulate(0.5);
        ASSERT_EQ(robot.status().passage, "l1");
        EXPECT_EQ(robot.status().storey, "ground");
        EXPECT_THROW(robot.forward(1), Refused);
        EXPECT_THROW(robot.goTo("ground", {9, 6}), Refused);
    }
    simulate(60);
    Robot robot(server.address(), "ground/r1");
    const Status status = robot.status();
    EXPECT_EQ(status.fields.text("storey"), "upper");
    EXPECT_FALSE(status.fields.has("in"));
    EXPECT_EQ(status.speed, 0);
    const double from_door = std::hypot(status.pose.x - 2.1, status.pose.y - 4);
    EXPECT_GT(from_door, 0.9);
    EXPECT_LT(from_door, 5) << "it does not go on to the goal";
    const Motion motion = robot.forward(0.1);
    simulate(5);
    EXPECT_TRUE(robot.wait(motion).done);
}

/// square.env with sensing.3dm: r1 at (-1, 0) faces h1 at (0.9, 0.5).
class LivingWorld : public ::testing::Test {
  protected:
    TestServer server{{data("square.env"), data("sensing.3dm"), "--clock", "step", "-q"}};
    World world{server.address()};
    void simulate(double seconds) { world.step(std::lround(seconds / world.dt())); }
    /// The events that have come, which are of these kinds alone.
    std::vector<Event> events() {
        std::vector<Event> events;
        Event event;
        while (world.nextEvent(event, 0.05)) events.push_back(event);
        return events;
    }
};

TEST_F(LivingWorld, APersonIsDrivenAsARobotIs) {
    Person person(server.address(), "h1");
    EXPECT_EQ(person.info().number("height"), 1.7);
    EXPECT_THROW(Person(server.address(), "h1"), Refused);
    EXPECT_THROW(Person(server.address(), "r1"), Refused);
    const Motion ahead = person.forward(0.4);
    simulate(5);
    EXPECT_TRUE(person.wait(ahead).done);
    EXPECT_NEAR(person.status().pose.x, 0.5, 2e-3);
    EXPECT_NEAR(world.poses()["h1"].x, 0.5, 2e-3);
    person.sidespeed(0.2);
    simulate(2);
    EXPECT_LT(person.status().pose.y, 0.4);
    person.stop();
}

TEST_F(LivingWorld, PathsAreFollowed) {
    Robot robot(server.address(), "r1");
    PathOptions options;
    options.speed = 0.4;
    options.pause = 0.5;
    const Motion path = robot.path({Point(-1, 0), Point(-1, 1), Point(0, 1)}, options);
    EXPECT_NEAR(path.length, 2, 1e-6);
    simulate(30);
    const End end = robot.wait(path);
    EXPECT_TRUE(end.done) << end.reason;
    EXPECT_NEAR(robot.status().pose.x, 0, 0.01);
    EXPECT_NEAR(robot.status().pose.y, 1, 0.01);
    options.loop = true;
    const Motion round = robot.path({Point(-1, 1), Point(-1, 0)}, options);
    simulate(30);
    EXPECT_FALSE(robot.ended(round));
    Person person(server.address(), "h1");
    const Motion walk = person.path({Point(0.9, -1)});
    simulate(10);
    EXPECT_TRUE(person.wait(walk).done);
}

TEST_F(LivingWorld, ThingsComeAndGo) {
    Robot robot(server.address(), "r1");
    EXPECT_EQ(world.add("cube id=box at=0,0 size=0.5,0.5,1"), "box");
    const Motion blocked = robot.forward(1.5);
    simulate(10);
    EXPECT_EQ(robot.wait(blocked).reason, "stall");
    world.remove("box");
    EXPECT_THROW(world.remove("box"), Refused);
    world.set("r1", "speed", "0.1");
    const Motion slow = robot.forward(0.5);
    simulate(4);
    EXPECT_FALSE(robot.ended(slow));
    EXPECT_EQ(robot.status().speed, 0.1);
    simulate(4);
    EXPECT_TRUE(robot.wait(slow).done);
    EXPECT_THROW(world.set("r1", "speed", "fast"), Refused);
    EXPECT_THROW(world.add("cube size=much"), Refused);
    EXPECT_EQ(world.add("human id=far at=50,50"), "far");
    EXPECT_EQ(world.warning(), "human far stands outside the room at (50.0, 50.0)");
    world.set("far", "at", "1.5,-1.5");
    EXPECT_EQ(world.warning(), "");
}

TEST_F(LivingWorld, SensorsAndRobotsComeToo) {
    EXPECT_EQ(world.add("laser id=l9 at=-1.9,0,0.1 fov=0"), "l9");
    EXPECT_EQ(world.list()["lasers"], std::vector<std::string>({"l1", "l9"}));
    simulate(0.1);
    LaserSensor laser(server.address(), "l9");
    EXPECT_NEAR(laser.scan().ranges.at(0), 0.64, 1e-3);  // the back of r1
    world.add("robot id=r9 at=1,-1");
    Robot robot(server.address(), "r9");
    robot.speed(0.2);
    simulate(1);
    EXPECT_GT(world.poses()["r9"].x, 1.05);
    EXPECT_EQ(world.list()["people"], std::vector<std::string>({"h1"}));
}

TEST_F(LivingWorld, ResetTakesThemBackAndLoadAway) {
    Robot robot(server.address(), "r1");
    robot.speed(0.3);
    simulate(3);
    EXPECT_GT(robot.status().pose.x, -0.9);
    world.reset();
    EXPECT_EQ(robot.status().pose.x, -1);
    EXPECT_EQ(world.time(), 3);
    world.load(data("square.env"), data("session.3dm"));
    EXPECT_EQ(world.list()["robots"], std::vector<std::string>({"r1", "r2"}));
    EXPECT_THROW(world.load(data("missing.env")), Refused);
}

TEST_F(LivingWorld, EventsAreToldAsTheyHappen) {
    Robot robot(server.address(), "r1");
    world.events({"collision", "mat", "gate", "mark"});
    EXPECT_THROW(world.events({"collission"}), Refused);
    world.mark("the robot = off");
    robot.forward(5);
    simulate(10);
    std::vector<std::string> kinds;
    for (const Event& event : events()) {
        kinds.push_back(event.kind);
        if (event.kind == "mark") {
            EXPECT_EQ(event.fields.text("text"), "the robot = off");
        }
        if (event.kind == "gate" && event.fields.text("who") == "r1") {
            EXPECT_EQ(event.fields.text("way"), "in");
        }
        if (event.kind == "collision") {
            EXPECT_EQ(event.fields.text("into"), "h1");
            EXPECT_NEAR(event.fields.number("x"), world.poses()["r1"].x, 0.02);
            EXPECT_GT(event.time, 1);
        }
    }
    for (const char* kind : {"mark", "mat", "gate", "collision"})
        EXPECT_EQ(std::count(kinds.begin(), kinds.end(), std::string(kind)) > 0, true) << kind;
    EXPECT_EQ(kinds.front(), "mark");
    world.eventsOff();
    world.mark("nobody hears this");
    EXPECT_TRUE(events().empty());
    world.events();
    world.mark("all");
    EXPECT_EQ(events().back().kind, "mark");
}

TEST(LivingWorldReplay, IsTakenToATime) {
    const ispace::testing::TestFolder temporary;
    const std::string folder = temporary.file("run");
    std::ofstream(folder + ".txt") << "0 r1 SPEED 0.3\n";
    EXPECT_EQ(TestServer({data("square.env"), data("sensing.3dm"), "--clock", "fast", "--until",
                          "2", "--script", folder + ".txt", "--record", folder, "-q"})
                  .wait(),
              0);
    TestServer server({"--replay", folder, "--hold", "--clock", "step"});
    World world(server.address());
    Robot robot(server.address(), "r1");
    EXPECT_EQ(world.end(), 2);
    EXPECT_EQ(world.seek(1.503), 1.5);
    const double there = robot.status().pose.x;
    EXPECT_GT(there, -1);
    EXPECT_EQ(world.seek(0), 0);
    EXPECT_EQ(robot.status().pose.x, -1);
    world.step(300);
    EXPECT_EQ(robot.status().pose.x, there);
    EXPECT_EQ(world.seek(99), 2);
    EXPECT_THROW(world.seek(-1), Refused);
}

TEST(LivingWorldToken, ChangesNeedItWhereItIsAskedFor) {
    const ispace::testing::TestFolder folder;
    const std::string file = folder.file("token");
    std::ofstream(file) << "a-secret-of-this-test\n";
    ::chmod(file.c_str(), 0600);
    TestServer server(
        {data("square.env"), data("sensing.3dm"), "--clock", "step", "-q", "--token-file", file});
    World stranger(server.address());
    EXPECT_EQ(stranger.time(), 0);
    try {
        stranger.reset();
        FAIL() << "changed without the token";
    } catch (const Refused& refused) {
        EXPECT_EQ(refused.code(), 401);
    }
    Options options;
    options.token = "wrong";
    EXPECT_THROW(World(server.address(), options), Refused);
    options.token = "a-secret-of-this-test";
    World friendly(server.address(), options);
    friendly.reset();
    friendly.shutdown();
    EXPECT_EQ(server.wait(), 0);
}

}  // namespace
}  // namespace client
}  // namespace ispace
