// SPDX-License-Identifier: GPL-3.0-or-later
// The C++ client against a running simrun, by steps: every role and every call.
#include <gtest/gtest.h>
#include <ispace_client.h>

#include <cmath>
#include <string>

#include "support/test_paths.h"
#include "test_server.h"

namespace ispace {
namespace client {
namespace {

std::string data(const std::string& file) {
    return ispace::testing::sourcePath("tests/data/") + file;
}

/// square.env, 4 m by 4 m, with session.3dm, which waits for steps of 5 ms.
class Roles : public ::testing::Test {
  protected:
    TestServer server{{data("square.env"), data("session.3dm"), "--clock", "step", "-q"}};
    World world{server.address()};
    void simulate(double seconds) { world.step(std::lround(seconds / world.dt())); }
};

TEST_F(Roles, ARobotDrivesAndSaysSo) {
    Robot robot(server.address(), "r1");
    EXPECT_EQ(robot.info().text("model"), "pioneer-2dx");
    EXPECT_EQ(robot.limits().speed, 0.5);
    EXPECT_EQ(robot.limits().rotspeed, 100);
    EXPECT_EQ(robot.limits().max_speed, 1.6);
    EXPECT_EQ(robot.limits().max_rotspeed, 300);
    EXPECT_EQ(robot.limits().max_sidespeed, 0);
    EXPECT_EQ(robot.limits().accel, 0.3);
    EXPECT_EQ(robot.limits().rotaccel, 100);
    const Motion ahead = robot.forward(0.5);
    simulate(0.5);
    EXPECT_FALSE(robot.ended(ahead));
    EXPECT_THROW(robot.wait(ahead, 0.01), Timeout);
    simulate(5);
    EXPECT_TRUE(robot.ended(ahead));
    const End end = robot.wait(ahead);
    EXPECT_TRUE(end.done);
    EXPECT_NEAR(robot.status().pose.x, -0.5, 1e-3);
    const Motion turn = robot.left(90), other = robot.right(45);
    simulate(5);
    EXPECT_EQ(robot.wait(turn).reason, "replaced");
    EXPECT_TRUE(robot.wait(other).done);
    EXPECT_NEAR(robot.status().pose.heading, -45, 1e-3);
}

TEST_F(Roles, SpeedsAreKeptUntilTheyChange) {
    Robot robot(server.address(), "r1");
    robot.speed(0.25);
    robot.rotspeed(-20);
    simulate(2);
    Status status = robot.status();
    EXPECT_EQ(status.speed, 0.25);
    EXPECT_EQ(status.rotspeed, -20);
    EXPECT_EQ(status.time, 2);
    robot.stop();
    simulate(2);
    status = robot.status();
    EXPECT_EQ(status.speed, 0);
    EXPECT_EQ(status.rotspeed, 0);
}

TEST_F(Roles, AWallStallsARobot) {
    Robot robot(server.address(), "r2");
    const Motion motion = robot.backward(3);
    simulate(10);
    const End end = robot.wait(motion);
    EXPECT_FALSE(end.done);
    EXPECT_EQ(end.reason, "stall");
    EXPECT_TRUE(robot.status().stall);
}

TEST_F(Roles, RefusalsHaveTheServersText) {
    Robot robot(server.address(), "r1");
    try {
        Robot again(server.address(), "r1");
        FAIL() << "two clients drive r1";
    } catch (const Refused& refused) {
        EXPECT_EQ(refused.code(), 409);
        EXPECT_STREQ(refused.what(), "robot r1 is held by another client");
    }
    EXPECT_THROW(Robot(server.address(), "r9"), Refused);
    EXPECT_THROW(robot.speed(50), Refused);
    EXPECT_THROW(robot.forward(-1), Refused);
    EXPECT_THROW(robot.connection().ask("STATUS\nSTATUS"), Error);
    // The connection is as good as before.
    EXPECT_EQ(robot.status().time, 0);
}

TEST_F(Roles, WhoLeavesFreesTheRobot) {
    {
        Robot robot(server.address(), "r1");
        robot.connection().quit();
        EXPECT_THROW(robot.status(), ConnectionError);
        Robot at_once(server.address(), "r1");
    }
    // The server learns of it a moment later.
    for (int i = 0;; ++i) {
        try {
            Robot robot(server.address(), "r1");
            break;
        } catch (const Refused& refused) {
            ASSERT_EQ(refused.code(), 409);
            ASSERT_LT(i, 1000);
            usleep(10000);
        }
    }
}

TEST_F(Roles, ALaserReadsTheSameAsTextAndBytes) {
    LaserSensor laser(server.address(), "l1");
    EXPECT_EQ(laser.rate(), 10);
    const Scan bytes = laser.scan();
    laser.binary(false);
    const Scan text = laser.scan();
    ASSERT_EQ(text.ranges.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(text.ranges[i], bytes.ranges[i], 5.1e-4);
    EXPECT_NEAR(text.ranges[1], 3.5, 1e-3);
    EXPECT_EQ(text.angle(1), 0);
    Robot robot(server.address(), "r1");
    EXPECT_EQ(robot.scan("l2").ranges.size(), 3U);
    EXPECT_THROW(robot.scan("l1"), Refused);
}

TEST_F(Roles, AStreamHasEveryScan) {
    for (const bool binary : {true, false}) {
        LaserSensor laser(server.address(), "l1");
        laser.binary(binary);
        laser.stream(2);
        const long before = world.steps() / 20;
        for (long i = 0; i < 5; ++i) {
            simulate(0.2);
            const Scan scan = laser.next();
            EXPECT_EQ(scan.seq, before + 2 * i + 2);
            EXPECT_NEAR(scan.time, static_cast<double>(scan.seq) / 10, 1e-9);
            // An answer between scans.
            EXPECT_EQ(laser.scan().seq, scan.seq);
        }
        laser.stop();
        EXPECT_THROW(laser.next(0.02), Timeout);
    }
}

TEST_F(Roles, TheWorldHasAListAndAClock) {
    EXPECT_EQ(world.clock(), "step");
    EXPECT_EQ(world.dt(), 0.005);
    EXPECT_EQ(world.rate(), 1);
    EXPECT_EQ(world.list()["robots"], std::vector<std::string>({"r1", "r2"}));
    EXPECT_EQ(world.step(300), 300);
    EXPECT_EQ(world.time(), 1.5);
    EXPECT_EQ(world.steps(), 300);
    EXPECT_EQ(world.poses()["r2"].heading, 180);
    EXPECT_THROW(world.resume(), Refused);
}

TEST_F(Roles, AnAnswerThatComesTooLateIsNotTakenForTheNext) {
    EXPECT_THROW(world.step(100000, 0.001), Timeout);
    // The answer to STEP comes first, and is dropped.
    EXPECT_EQ(world.connection().ask("TIME", 60).fields.integer("steps"), 100000);
}

TEST_F(Roles, AWorldCanBeEnded) {
    world.shutdown();
    EXPECT_EQ(server.wait(), 0);
    EXPECT_THROW(
        {
            for (int i = 0; i < 10; ++i) world.time();
        },
        ConnectionError);
    EXPECT_THROW(World other(server.address()), ConnectionError);
}

TEST(RolesConnecting, SomebodyElsesServerIsNoSimrun) {
    // A silent port: the timeout holds.
    const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in at = {};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&at), size), 0);
    ASSERT_EQ(::listen(listener, 1), 0);
    ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&at), &size), 0);
    Options options;
    options.timeout = 0.1;
    EXPECT_THROW(World(Address("127.0.0.1", ntohs(at.sin_port)), options), Timeout);
    ::close(listener);
}

}  // namespace
}  // namespace client
}  // namespace ispace
