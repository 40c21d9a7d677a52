// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/p2os_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "extensions/wire/tests/test_pioneer.h"

namespace ispace::wire {

namespace p2os_session_test {

using testing::Pioneer;
using testing::TestHost;

constexpr const char* kRobot = "robot id=r1 model=pioneer-3dx at=-2,0\n";

TEST(P2osSession, Introduces) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.run(0.5);
    robot.command(11, 300);  // before its time
    EXPECT_TRUE(robot.packets.empty());
    for (const int id : {0, 1, 0, 1, 2}) {
        robot.command(id);
        EXPECT_EQ(robot.packets.back().id, id);
    }
    EXPECT_EQ(robot.packets.size(), 5U);
    EXPECT_EQ(robot.packets.back().data, std::string("r1\0Pioneer\0p3dx-sh\0", 19));
    robot.run(0.5);
    EXPECT_EQ(robot.packets.size(), 5U) << "status before OPEN";
    robot.command(1);  // OPEN without an argument
    robot.run(1);
    EXPECT_EQ(robot.packets.size(), 5U + 1 + 10);
    EXPECT_EQ(robot.packets.back().id, 0x32);
    EXPECT_EQ(robot.last(0x32).size() + 3, 86U);
    EXPECT_FALSE(robot.session().closing());
    robot.command(2);
    EXPECT_TRUE(robot.session().closing());
}

TEST(P2osSession, HearsAgainAfterADamagedHead) {
    TestHost host(kRobot);
    Pioneer robot(host);
    for (int round = 0; round < 2; ++round) {
        robot.send("\xFA\xFB\xC8");
        robot.command(0);
        EXPECT_TRUE(robot.packets.empty()) << "the rest may come";
        robot.wait(P2osSession::kPacketTime);
        round == 0 ? robot.command(0) : robot.run(0.01);
        EXPECT_EQ(robot.packets.size(), round == 0 ? 2U : 1U);
        robot.packets.clear();
    }
    robot.connect();
}

TEST(P2osSession, HoldsTheRobotAlone) {
    TestHost host(kRobot);
    {
        Pioneer robot(host);
        EXPECT_TRUE(host.isHeld());
        Pioneer other(host);
        EXPECT_TRUE(other.session().closing());
        EXPECT_TRUE(host.isHeld());
        robot.drive().command(11, 300);
        robot.run(2);
        EXPECT_GT(host.world().status(0).speed, 0.2);
    }
    EXPECT_FALSE(host.isHeld());
    for (int i = 0; i < 200; ++i) host.world().step();
    EXPECT_EQ(host.world().status(0).speed, 0);
}

TEST(P2osSession, TellsWhatItIs) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(18, 1);
    const std::string config = robot.last(0x20);
    EXPECT_TRUE(config.starts_with(std::string("Pioneer\0p3dx-sh\0SIM\0", 20)));
    EXPECT_EQ(p2osInteger(config, 21, 2), 300);   // top rotspeed
    EXPECT_EQ(p2osInteger(config, 23, 2), 1200);  // top speed
    // name, cycle, bauds, gripper, sonars, battery, counter, watchdog, stall, joystick
    const std::size_t behind_name = 31 + 3;
    EXPECT_EQ(config[behind_name], 100);
    EXPECT_EQ(p2osInteger(config, behind_name + 12, 2), 2000);
    const std::size_t limits = behind_name + 3 + 2 + 2 + 1 + 2 + 2 + 2 + 1 + 2 + 2 + 2 + 2;
    EXPECT_EQ(p2osInteger(config, limits, 2), 100);
    EXPECT_EQ(p2osInteger(config, limits + 2, 2), 750);
    EXPECT_EQ(p2osInteger(config, limits + 4, 2), 100);
    EXPECT_EQ(p2osInteger(config, limits + 14, 2), 300);
    EXPECT_EQ(config[limits + 24], 5);  // bumpers in front
    EXPECT_EQ(config[limits + 25], 5);
}

TEST(P2osSession, HearsWalls) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().run(0.1);
    ASSERT_EQ(robot.sonars(), 16);
    const std::vector<float> ranges = host.world().sonar(0);
    for (std::size_t k = 0; k < 16; ++k) {
        EXPECT_EQ(robot.field(19 + 3 * k, 1), static_cast<int>(k));
        EXPECT_EQ(robot.sonar(k), std::isinf(ranges[k]) ? 5000 : std::lround(ranges[k] * 1000));
    }
    EXPECT_LT(robot.sonar(0), 3000);
    robot.command(28, 0);
    robot.run(0.1);
    EXPECT_EQ(robot.sonars(), 0);
    EXPECT_EQ(robot.flags(), 0);
    robot.command(28, 1);
    robot.run(0.1);
    EXPECT_EQ(robot.sonars(), 16);
}

TEST(P2osSession, ConvertsAsItsTypeDoes) {
    for (const P2osType& type : p2osTypes()) {
        TestHost host("robot id=r1 model=pioneer-3dx at=-2,0 p2os=" + std::string(type.name) +
                      "\n");
        Pioneer robot(host);
        for (const int id : {0, 1, 2}) robot.command(id);
        EXPECT_NE(robot.last(2).find(std::string(type.name) + '\0'), std::string::npos);
        robot.packets.clear();
        robot.command(1, 1);
        robot.command(4, 1);
        robot.command(8, 1000);
        robot.run(6);
        EXPECT_NEAR(robot.x() * type.distance, 1000, type.distance) << type.name;
        const std::vector<float> ranges = host.world().sonar(0);
        EXPECT_NEAR(robot.sonar(0) * type.range, 1000 * ranges[0], 1) << type.name;
        robot.command(32, 250 << 8 | 6);  // both 120 mm/s, the left one backward
        robot.run(4);
        EXPECT_EQ(robot.right(), 120) << type.name;
        EXPECT_EQ(robot.left(), -120) << type.name;
        EXPECT_NEAR(robot.rotspeed(), 10 * Angle::radians(120 * type.turn).degrees(), 1);
    }
    const Scene scene = testing::scene(
        "ispace size=8,6\n",
        "robot id=a\nrobot id=b model=pioneer-2dx at=1,1\nrobot id=c model=pioneer-3at at=2,2\n");
    EXPECT_EQ(p2osTypeOf(scene, "a").name, "p3dx-sh");
    EXPECT_EQ(p2osTypeOf(scene, "b").name, "p2dx");
    EXPECT_EQ(p2osTypeOf(scene, "c").name, "p3at-sh");
    EXPECT_EQ(p2osTypeNamed("p3dx")->distance, 0.485);
    EXPECT_EQ(p2osTypeNamed("pioneer"), nullptr);
}

TEST(P2osSession, SetsTheOriginOfOdometry) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 600);
    robot.command(12, 90);
    robot.run(5);
    robot.send(p2osBytes(7, "\x3b"));  // the type byte alone
    robot.run(0.1);
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.y(), 0);
    EXPECT_EQ(robot.heading(), 0);
    robot.command(8, 500);
    robot.run(5);
    EXPECT_EQ(robot.x(), 500);
    P2osWriter out;
    robot.send(out.u8(0x3b).u16(1000).u16(-2000).u16(90).packet(7));
    robot.command(8, -100);
    robot.run(3);
    EXPECT_EQ(robot.x(), 1000);
    EXPECT_EQ(robot.y(), -2100);
    EXPECT_EQ(robot.heading(), 1024);
}

TEST(P2osSession, IsPutElsewhere) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 600);
    robot.run(4);
    P2osWriter place;
    robot.send(place.u8(0).u32(1000).u32(-500).u32(-90).packet(224));
    EXPECT_EQ(host.world().status(0).pose.position, (Point2{1, -0.5}));
    EXPECT_DOUBLE_EQ(host.world().status(0).pose.heading.degrees(), -90);
    robot.run(0.2);
    EXPECT_EQ(robot.x(), 600) << "odometry knows nothing of it";
    robot.command(237);
    const std::string sim = robot.last(0x62);
    EXPECT_EQ(p2osInteger(sim, 12, 4), 1000);
    EXPECT_EQ(p2osInteger(sim, 16, 4), -500);
    EXPECT_EQ(p2osInteger(sim, 24, 4), -90);
    robot.command(8, 400);
    robot.run(4);
    EXPECT_EQ(robot.x(), 1000);
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    // Into a wall: refused. Others' changes come first.
    P2osWriter wall;
    robot.send(wall.u8(0x3b).u32(4000).u32(0).u32(0).packet(224));
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    host.changes_later = 3;
    robot.command(225);
    EXPECT_NEAR(host.world().status(0).pose.position.y, -0.9, 1e-9);
    robot.run(0.1);
    EXPECT_EQ(host.world().status(0).pose.position, (Point2{-2, 0}));
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.heading(), 0);
}

TEST(P2osSession, ChangesTheWorldBetweenItsStepsToo) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive();
    robot.command(8, 400);
    robot.run(4);
    host.changes_later = 2;
    robot.command(225);  // SIM_RESET
    const SimTime time = host.world().time();
    EXPECT_TRUE(robot.session().waitsToChange());
    robot.session().proceed();
    EXPECT_TRUE(robot.session().waitsToChange());
    EXPECT_NE(host.world().status(0).pose.position, (Point2{-2, 0}));
    robot.session().proceed();
    EXPECT_FALSE(robot.session().waitsToChange());
    EXPECT_EQ(host.world().status(0).pose.position, (Point2{-2, 0}));
    EXPECT_EQ(host.world().time(), time);
}

TEST(P2osSession, TellsItsStateAfterGoingBack) {
    TestHost host(kRobot);
    host.is_replay = true;
    Pioneer robot(host);
    robot.connect().run(5);
    robot.packets.clear();
    host.world().rewind();
    robot.run(1);
    EXPECT_NEAR(static_cast<double>(robot.packets.size()), 10, 1);
}

TEST(P2osSession, CountsReplaysOfShortSteps) {
    TestHost host(kRobot, "ispace size=8,6\n", std::chrono::milliseconds(1));
    host.is_replay = true;
    Pioneer robot(host);
    robot.connect();
    host.world().command(0, {Verb::Speed, 0.7});
    robot.run(4);
    EXPECT_NEAR(robot.x(), 1000 * (host.world().status(0).pose.position.x + 2), 1);
}

TEST(P2osSession, GoesOnWhereOthersPutIt) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 200);
    robot.run(2);
    const std::vector<std::string> elsewhere = {"r1.at=-3,1"};
    ASSERT_EQ(host.change(elsewhere), WireHost::Change::Done);
    robot.command(11, 200);
    robot.run(2);
    EXPECT_EQ(robot.left(), 200);
    host.world().restart(testing::scene("ispace size=8,6\n", kRobot));
    for (int i = 0; i < 4; ++i) {
        robot.command(11, 200);
        robot.run(0.5);
    }
    EXPECT_EQ(robot.left(), 200);
    // A change that leaves it alone leaves its distance.
    robot.command(11, 0);
    robot.run(2);
    const int before = robot.x();
    robot.command(8, 500);
    ASSERT_EQ(host.change(std::vector<std::string>{"r1.speed=1"}), WireHost::Change::Done);
    robot.run(4);
    EXPECT_NEAR(robot.x() - before, 500, 1);
}

TEST(P2osSession, TellsOfTheSimulation) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(237, 2);
    EXPECT_TRUE(robot.packets.empty());
    robot.run(0.2);
    ASSERT_EQ(robot.packets.size(), 4U);
    EXPECT_EQ(robot.packets[0].id, 0x62);
    EXPECT_EQ(robot.packets[1].id, 0x32);
    robot.command(237, 0);
    robot.packets.clear();
    robot.run(0.2);
    EXPECT_EQ(robot.packets.size(), 2U);
}

TEST(P2osSession, ScansInPieces) {
    TestHost host(std::string(kRobot) + "laser id=l1 on=r1 at=0.1,0,0.3 range=0.02,3\n");
    for (const auto& [base, mode] : {std::pair(35, 1), std::pair(230, 2)}) {
        Pioneer robot(host);
        robot.connect();
        robot.command(base + 1, -90);
        robot.command(base + 2, 90);
        robot.command(base + 3, 50);
        robot.command(base, mode);
        robot.run(0.1);
        std::vector<int> ranges;
        const std::size_t head = mode == 1 ? 6 : 0, step = mode == 1 ? 2 : 5;
        for (const P2osPacket& packet : robot.packets) {
            if (packet.id == 0x32) continue;
            ASSERT_EQ(packet.id, mode == 1 ? 0x60 : 0x61);
            ASSERT_EQ(p2osInteger(packet.data, head, 2), 361);
            ASSERT_EQ(p2osInteger(packet.data, head + 2, 2), static_cast<int>(ranges.size()));
            const int here = p2osInteger(packet.data, head + 4, 1);
            ASSERT_LE(here, 32);
            for (int k = 0; k < here; ++k)
                ranges.push_back(
                    p2osInteger(packet.data, head + 5 + static_cast<std::size_t>(k) * step, 2));
        }
        ASSERT_EQ(ranges.size(), 361U);
        EXPECT_EQ(ranges[0], 3000);    // to the right: the wall is 3 m away, no return
        EXPECT_EQ(ranges[180], 3000);  // ahead: beyond its range
        // 60 degrees to the left the wall at y = 3 is farther than 3 m, at 89.5 it is not.
        EXPECT_EQ(ranges[359], 3000);
        robot.command(base, 0);
        robot.packets.clear();
        robot.run(0.2);
        EXPECT_EQ(robot.packets.size(), 2U);
    }
}

TEST(P2osSession, HasALaserWithoutADevice) {
    TestHost host(std::string(kRobot) + "robot id=r2 at=0,0\n");
    Pioneer robot(host);
    robot.connect().command(35, 1);
    robot.run(0.1);
    // 181 readings by default: 6 packets, ahead the other robot, its circle 1.7 m off.
    ASSERT_EQ(robot.packets.size(), 7U);
    const std::string& third = robot.packets[3].data;
    EXPECT_EQ(p2osInteger(third, 8, 2), 64);
    EXPECT_EQ(p2osInteger(third, 11 + 2 * (90 - 64), 2), 1700 - 21);
    // One with more readings than any device has is none.
    robot.command(38, 1);
    robot.command(36, -180);
    robot.packets.clear();
    robot.run(0.1);
    EXPECT_EQ(robot.packets.size(), 1U);
}

TEST(P2osSession, LeavesOutWhatNobodyReads) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect();
    for (int i = 0; i < 100; ++i) {
        host.world().step();
        robot.session().stepped(std::size_t{1} << 20);
    }
    EXPECT_EQ(robot.session().take(), "");
    robot.run(0.1);
    EXPECT_EQ(robot.packets.size(), 1U);
}

TEST(P2osSession, SurvivesAnything) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive();
    // Every id with no data, a type byte alone, a number, a long text.
    for (int id = 0; id < 256; ++id) {
        if (id == 2) continue;
        const auto command = static_cast<std::uint8_t>(id);
        for (const std::string& data :
             {std::string(), std::string("\x3b"), std::string("\x1b\xff\xff"),
              std::string("\x3b\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x7f"),
              "\x2b\xc0" + std::string(192, 'x')}) {
            robot.send(p2osBytes(command, data));
            robot.run(0.01);
        }
    }
    EXPECT_FALSE(robot.session().closing());
}

}  // namespace p2os_session_test

}  // namespace ispace::wire
