// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/wire/p2os_session.h"

#include <gtest/gtest.h>

#include <cmath>

#include "extensions/wire/tests/test_pioneer.h"

namespace ispace::wire {

namespace p2os_drive_test {

using testing::Pioneer;
using testing::TestHost;

constexpr const char* kRobot = "robot id=r1 model=pioneer-3dx at=-2,0\n";

TEST(P2osDrive, IgnoresMotionWithoutMotors) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.connect().command(11, 300);
    robot.run(1);
    EXPECT_EQ(robot.x(), 0);
    EXPECT_EQ(robot.flags(), 0x1E);
    robot.command(4, 1);
    robot.run(0.5);
    EXPECT_EQ(robot.x(), 0) << "a command from before";
    EXPECT_EQ(robot.flags(), 0x1F);
}

TEST(P2osDrive, KeepsSpeeds) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 300);
    robot.run(3);
    EXPECT_EQ(robot.left(), 300);
    EXPECT_EQ(robot.right(), 300);
    EXPECT_EQ(robot.x(), 750);  // 1 s of 300 mm/s^2, then 2 s of 300 mm/s
    EXPECT_EQ(robot.y(), 0);
    EXPECT_NEAR(host.world().status(0).pose.position.x, -2 + 0.75, 1e-9);
    robot.command(21, 50);  // does not cancel the speed
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), 500);
    EXPECT_EQ(robot.right() - robot.left(), 2 * 156);  // 50 deg/s over 0.0056
    EXPECT_EQ(robot.right() + robot.left(), 600);
    robot.command(29);
    robot.run(2);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.rotspeed(), 0);
}

TEST(P2osDrive, GoesBackAndTurnsTheOtherWay) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, -300);
    robot.run(3);
    EXPECT_EQ(robot.x(), -750);
    robot.command(11, 0);
    robot.command(9, -50);
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), -500);
}

TEST(P2osDrive, GoesADistanceAndTurnsToAHeading) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 1500);
    robot.run(6);
    EXPECT_EQ(robot.x(), 1500);
    EXPECT_EQ(robot.left(), 0);
    robot.command(12, 90);
    robot.run(4);
    EXPECT_EQ(robot.heading(), 1024);
    robot.command(13, -135);
    robot.run(4);
    EXPECT_EQ(robot.heading(), -512);
    robot.command(12, -180);  // the shorter way
    robot.run(1);
    EXPECT_LT(robot.rotspeed(), 0);
    robot.run(3);
    EXPECT_EQ(robot.heading(), 2048);
    EXPECT_NEAR(host.world().status(0).pose.position.x, -0.5, 1e-9);
}

TEST(P2osDrive, TurnsWhileItGoes) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(8, 1000);
    robot.command(12, 45);
    robot.run(6);
    EXPECT_EQ(robot.heading(), 512);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_GT(robot.y(), 300);
    EXPECT_LT(std::hypot(robot.x(), robot.y()), 1000);
}

TEST(P2osDrive, KeepsItsLimits) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(6, 200);  // SETV
    robot.command(5, 100);          // SETA, up
    robot.command(5, -400);         // down
    robot.command(11, 900);
    robot.run(1);
    EXPECT_EQ(robot.left(), 100);
    robot.run(2);
    EXPECT_EQ(robot.left(), 200);
    robot.command(11, 0);
    robot.run(0.3);
    EXPECT_EQ(robot.left(), 80);
    robot.run(0.3);
    EXPECT_EQ(robot.left(), 0);
    robot.command(10, 20);  // SETRV
    robot.command(23, 200);
    robot.command(21, 90);
    robot.run(1);
    EXPECT_EQ(robot.rotspeed(), 200);
    robot.command(6, 30'000);  // no more than the robot can
    robot.command(11, 30'000);
    robot.run(0.1);
    EXPECT_DOUBLE_EQ(host.world().status(0).accel, 0.1);
}

TEST(P2osDrive, DrivesByWheels) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(32, 10 << 8 | 20);  // left 200, right 400
    robot.run(3);
    EXPECT_EQ(robot.left(), 200);
    EXPECT_EQ(robot.right(), 400);
    const int backward = static_cast<std::uint16_t>(static_cast<std::uint8_t>(-10) << 8U | 10);
    robot.command(32, -(0x10000 - backward));  // left -200, right 200
    robot.run(3);
    EXPECT_EQ(robot.left(), -200);
    EXPECT_EQ(robot.right(), 200);
}

TEST(P2osDrive, StopsHard) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 500);
    robot.run(3);
    robot.command(55);
    robot.command(11, 500);  // ignored until it stands
    robot.run(0.1);
    EXPECT_EQ(robot.left(), 300);
    EXPECT_EQ(robot.flags() & 0x20, 0x20);
    robot.run(0.4);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.flags() & 0x20, 0);
    robot.command(11, 500);
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 150);
    robot.command(4, 0);
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 0);
    EXPECT_EQ(robot.flags() & 1, 0);
}

TEST(P2osDrive, StallsAtAWall) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(12, 180);
    robot.run(4);
    EXPECT_EQ(robot.stall(), 0);
    robot.command(11, 300);
    robot.run(9);
    // The wall is 2 m away, the radius 0.25; three of the bumpers in front feel it at most.
    EXPECT_EQ(robot.stall() & 0x0101, 0x0101);
    EXPECT_NE(robot.stall() & 0x3E00, 0);
    EXPECT_EQ(robot.stall() & 0x00FE, 0);
    EXPECT_NEAR(robot.x(), -1750, 5);
    for (int i = 0; i < 25; ++i) {
        robot.run(0.1);
        EXPECT_EQ(robot.stall() & 0x0101, 0x0101) << "while it pushes";
    }
    robot.command(21, 30);  // it can turn
    robot.run(0.3);
    EXPECT_GT(robot.rotspeed(), 0);
    robot.command(11, -200);
    robot.run(1);
    EXPECT_EQ(robot.stall(), 0);
    EXPECT_EQ(robot.left() + robot.right(), -400);
}

TEST(P2osDrive, StaysStalledWhereverItsStepsEnd) {
    for (int k = 0; k < 12; ++k) {
        TestHost host("robot id=r1 model=pioneer-3dx at=" + std::to_string(2 + 0.00037 * k) +
                      ",0\n");
        Pioneer robot(host);
        robot.drive().command(11, 400);
        while (host.world().collisions().empty()) robot.run(0.01);
        for (int i = 0; i < 20; ++i) {
            robot.run(0.1);
            ASSERT_EQ(robot.stall() & 0x0101, 0x0101) << k;
            ASSERT_NE(robot.stall() & 0x3E00, 0) << k;
        }
        robot.command(11, 0);
        robot.run(0.2);
        EXPECT_EQ(robot.stall() & 0x0101, 0) << k;
    }
}

TEST(P2osDrive, TurnsOnAfterItRanIntoSomething) {
    TestHost host(kRobot);
    Pioneer robot(host);
    robot.drive().command(11, 700);
    robot.run(10);
    EXPECT_EQ(robot.stall() & 0x0101, 0x0101);
    robot.command(12, 90);
    robot.run(1.2);
    EXPECT_GT(robot.rotspeed(), 0);
    robot.command(29);
    robot.command(12, 90);
    robot.run(4);
    EXPECT_EQ(robot.heading(), 1024);
    EXPECT_EQ(robot.stall(), 0);
}

TEST(P2osDrive, StandsWhileTheClientIsSilent) {
    TestHost host("robot id=r1 model=pioneer-3dx at=-2,0\n", "ispace size=40,6\n");
    Pioneer robot(host);
    robot.drive().command(11, 300);
    robot.run(5);
    EXPECT_EQ(robot.left(), 300) << "no wall time has passed: the world is fast";
    robot.wait(std::chrono::milliseconds(1999));
    robot.run(0.5);
    EXPECT_EQ(robot.left(), 300);
    robot.wait(std::chrono::milliseconds(1));
    robot.run(2);
    EXPECT_EQ(robot.left(), 0);
    robot.command(0);  // PULSE
    robot.run(2);
    EXPECT_EQ(robot.left(), 300);
}

TEST(P2osDrive, GetsTheDefaultsOfTheWheelsBack) {
    TestHost host(kRobot);
    {
        Pioneer robot(host);
        robot.drive().command(5, 50);
        robot.command(11, 50);
        robot.run(2);
    }
    host.world().command(0, {Verb::Forward, 1});
    for (int i = 0; i < 1000; ++i) host.world().step();
    EXPECT_DOUBLE_EQ(host.world().status(0).speed, 0);
    host.world().command(0, {Verb::Speed, 0.5});
    for (int i = 0; i < 50; ++i) host.world().step();
    EXPECT_DOUBLE_EQ(host.world().status(0).accel, 0.3);
}

}  // namespace p2os_drive_test

}  // namespace ispace::wire
