// SPDX-License-Identifier: GPL-3.0-or-later
// ARIA's classes over a running simrun: units, rounding, and the effect of each call on the robot.
// The world advances by steps, that is while the program sleeps.
#include <Sim_Aria.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "support/test_paths.h"
#include "test_server.h"

namespace {

std::string data(const std::string& file) {
    return ispace::testing::sourcePath("tests/data/") + file;
}

class SimAria : public ::testing::Test {
  protected:
    void serve(const std::string& clock) {
        server.reset(
            new TestServer({data("square.env"), data("session.3dm"), "--clock", clock, "-q"}));
        setenv("ISPACE_SIMRUN", server->address().c_str(), 1);
        unsetenv("ISPACE_ROBOT");
        Aria::init(Aria::SIGHANDLE_NONE);
    }
    /// r1 stands at (-1, 0) and faces the wall at x = 2.
    void connect() {
        serve("step");
        ASSERT_EQ(connection.open(), 0);
        robot.setDeviceConnection(&connection);
        ASSERT_TRUE(robot.blockingConnect());
        robot.comInt(ArCommands::ENABLE, 1);
        robot.runAsync(true);
    }
    void TearDown() override {
        robot.stopRunning();
        Aria::shutdown();
    }
    std::unique_ptr<TestServer> server;
    ArSerialConnection connection;
    ArRobot robot;
};

TEST_F(SimAria, TheThesisSkeletonDrives) {
    serve("step");
    ArSonarDevice sonar;
    ArSignalHandler::unhandle(ArSignalHandler::SigINT);
    ASSERT_EQ(connection.open(ArUtil::COM1), 0);
    EXPECT_EQ(connection.open(), ArSerialConnection::OPEN_ALREADY_OPEN);
    robot.setDeviceConnection(&connection);
    ASSERT_TRUE(robot.blockingConnect());
    robot.addRangeDevice(&sonar);
    robot.comInt(ArCommands::ENABLE, 1);
    robot.comInt(ArCommands::SONAR, 1);
    robot.runAsync(true);
    EXPECT_TRUE(robot.isRunning());
    robot.lock();
    robot.setVel(250);
    robot.setRotVel(0);
    robot.unlock();
    ArUtil::sleep(2000);
    robot.lock();
    EXPECT_EQ(robot.getVel(), 250);
    EXPECT_EQ(robot.getRotVel(), 0);
    EXPECT_FALSE(robot.isLeftMotorStalled() || robot.isRightMotorStalled());
    // 0.1 s until the command is sent, then v^2 / 2a and the rest.
    EXPECT_NEAR(robot.getX(), 250 * 250 / 600. + 250 * (1.9 - 250 / 300.), 2);
    EXPECT_NEAR(robot.getY(), 0, 1);
    robot.unlock();
    robot.stopRunning();
    EXPECT_FALSE(robot.isConnected());
    EXPECT_TRUE(robot.disconnect());
    Aria::shutdown();
    EXPECT_FALSE(Aria::getRunning());
}

TEST_F(SimAria, SpeedsAreWholeAndClamped) {
    connect();
    robot.setVel(123.6);
    robot.setRotVel(-20.4);
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getVel(), 124);
    EXPECT_EQ(robot.getRotVel(), -20);
    EXPECT_EQ(robot.getTransVelMax(), 750);
    EXPECT_EQ(robot.getRotVelMax(), 100);
    EXPECT_EQ(robot.getTransAccel(), 300);
    EXPECT_EQ(robot.getRotAccel(), 100);
    robot.setTransVelMax(80);
    robot.setVel(500);
    robot.setRotVelMax(10);
    robot.setRotVel(100);
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 80);
    EXPECT_EQ(robot.getRotVel(), 10);
    // The wheels of a Pioneer: 2 / 0.0056 mm apart as far as speeds go.
    EXPECT_NEAR(robot.getRightVel() - robot.getLeftVel(), 10 * M_PI / 180 * 2 / 0.0056, 0.1);
    robot.setRotVelMax(100);
    robot.setVel2(0, 100);
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getVel(), 50);
    EXPECT_EQ(robot.getRotVel(), std::round(0.0056 * 50 * 180 / M_PI));
    robot.stop();
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_EQ(robot.getRotVel(), 0);
}

TEST_F(SimAria, MaximaAreAtMostTheRobots) {
    connect();
    const double top = robot.getAbsoluteMaxTransVel(), turn = robot.getAbsoluteMaxRotVel();
    EXPECT_GT(top, 750);
    EXPECT_FALSE(robot.setTransVelMax(top + 400));
    EXPECT_FALSE(robot.setRotVelMax(turn + 400));
    EXPECT_EQ(robot.getTransVelMax(), top);
    EXPECT_EQ(robot.getRotVelMax(), turn);
    robot.setVel(-2 * top);
    robot.setRotVel(2 * turn);
    ArUtil::sleep(500);
    EXPECT_TRUE(robot.isConnected());
    EXPECT_LT(robot.getVel(), 0);
    EXPECT_TRUE(robot.setAbsoluteMaxTransVel(300));
    EXPECT_EQ(robot.getTransVelMax(), 300) << "it follows";
    EXPECT_FALSE(robot.setTransVelMax(400));
    EXPECT_FALSE(robot.setAbsoluteMaxTransVel(top + 1));
    EXPECT_EQ(robot.getAbsoluteMaxTransVel(), top);
    EXPECT_FALSE(robot.setTransVelMax(0));
    EXPECT_TRUE(robot.setTransDecel(200));
    EXPECT_EQ(robot.getTransDecel(), 200);
    EXPECT_EQ(robot.getTransAccel(), 300) << "another figure";
}

TEST_F(SimAria, NothingMovesBeforeMotorsAreEnabled) {
    connect();
    robot.disableMotors();
    EXPECT_FALSE(robot.areMotorsEnabled());
    robot.setVel(200);
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getX(), 0);
    robot.enableMotors();
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getVel(), 200);
    EXPECT_EQ(robot.getFlags() & ArUtil::BIT0, 1);
    robot.disableMotors();
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getVel(), 0);
}

TEST_F(SimAria, DistancesAndHeadingsAreHeld) {
    connect();
    robot.move(600);
    EXPECT_FALSE(robot.isMoveDone());
    ArUtil::sleep(8000);
    EXPECT_TRUE(robot.isMoveDone());
    EXPECT_NEAR(robot.getX(), 600, 3);
    robot.move(-400);
    ArUtil::sleep(8000);
    EXPECT_NEAR(robot.getX(), 200, 3);
    robot.setHeading(170);
    EXPECT_FALSE(robot.isHeadingDone());
    ArUtil::sleep(6000);
    EXPECT_TRUE(robot.isHeadingDone());
    EXPECT_NEAR(robot.getTh(), 170, 1);
    robot.setDeltaHeading(40);
    ArUtil::sleep(4000);
    EXPECT_NEAR(robot.getTh(), -150, 1);
    // A speed and a heading at once.
    robot.setVel(100);
    robot.setHeading(180);
    ArUtil::sleep(4000);
    EXPECT_EQ(robot.getVel(), 100);
    EXPECT_NEAR(ArMath::subAngle(robot.getTh(), 180), 0, 1.1);
}

TEST_F(SimAria, AWallStallsBothMotorsAndBackIsFree) {
    connect();
    robot.setVel(400);
    ArUtil::sleep(9000);
    EXPECT_TRUE(robot.isLeftMotorStalled() && robot.isRightMotorStalled());
    EXPECT_EQ(robot.getStallValue(), ArUtil::BIT0 | ArUtil::BIT8 | ArUtil::BIT11);
    EXPECT_EQ(robot.getVel(), 0);
    // The wall is 3 m away, the robot a circle of 0.25 m.
    EXPECT_NEAR(robot.getX(), 2750, 5);
    robot.setVel(-200);
    ArUtil::sleep(1500);
    EXPECT_FALSE(robot.isLeftMotorStalled());
    EXPECT_EQ(robot.getVel(), -200);
}

TEST_F(SimAria, SonarsAreInMillimetres) {
    connect();
    ispace::client::World world(server->address());
    world.add("robot id=r5 at=1.5,-1.2 sonar=0.2,0,0;0,-0.2,-90");
    setenv("ISPACE_ROBOT", "r5", 1);
    ArSonarDevice sonar;
    ArRobot ringed;
    ringed.setDeviceConnection(&connection);
    ASSERT_TRUE(ringed.blockingConnect());
    ringed.addRangeDevice(&sonar);
    ringed.runAsync(true);
    ArUtil::sleep(300);
    ringed.lock();
    ASSERT_EQ(ringed.getNumSonar(), 2);
    EXPECT_NEAR(ringed.getSonarRange(0), 300, 5);
    EXPECT_NEAR(ringed.getSonarRange(1), 600, 5);
    EXPECT_EQ(ringed.getSonarRange(2), -1);
    EXPECT_EQ(ringed.getSonarReading(1)->getSensorTh(), -90);
    EXPECT_TRUE(ringed.getSonarReading(1)->isNew(ringed.getCounter()));
    EXPECT_NEAR(ringed.getClosestSonarRange(-10, 10), 300, 5);
    EXPECT_NEAR(sonar.currentReadingPolar(-20, 20), 500, 5);
    EXPECT_NEAR(sonar.currentReadingPolar(-120, -60), 800, 5);
    EXPECT_EQ(sonar.currentReadingPolar(150, 210), 5000);
    ringed.unlock();
}

TEST_F(SimAria, BumpersAreBitsClockwise) {
    connect();
    EXPECT_TRUE(robot.hasFrontBumpers() && robot.hasRearBumpers());
    EXPECT_EQ(robot.getNumFrontBumpers(), 5U);
    EXPECT_EQ(robot.getNumRearBumpers(), 5U);
    EXPECT_EQ(robot.getNumSonar(), 16);
    ArBumpers bumpers;
    robot.lock();
    robot.addRangeDevice(&bumpers);
    robot.setVel(400);
    robot.unlock();
    ArUtil::sleep(9000);
    robot.lock();
    // The third of those in front faces the wall, and so does the point of it.
    EXPECT_EQ(robot.getStallValue(), ArUtil::BIT0 | ArUtil::BIT8 | ArUtil::BIT11);
    EXPECT_NEAR(bumpers.currentReadingPolar(-5, 5), 250, 1);
    EXPECT_EQ(bumpers.currentReadingPolar(10, -10), 5000);
    robot.setVel(-400);
    robot.unlock();
    ArUtil::sleep(12000);
    robot.lock();
    EXPECT_EQ(robot.getStallValue(), ArUtil::BIT0 | ArUtil::BIT8 | ArUtil::BIT3);
    EXPECT_NEAR(bumpers.currentReadingPolar(175, -175), 250, 1);
    robot.unlock();
}

TEST_F(SimAria, ThePoseIsWhatTheProgramSays) {
    connect();
    robot.moveTo(ArPose(1000, 2000, 90));
    EXPECT_EQ(robot.getY(), 2000);
    robot.setVel(200);
    ArUtil::sleep(3000);
    EXPECT_NEAR(robot.getX(), 1000, 1);
    EXPECT_GT(robot.getY(), 2400);
    EXPECT_NEAR(robot.getTh(), 90, 0.1);
    ArTime before;
    before.addMSec(-1000);
    ArPose pose, wheels;
    EXPECT_EQ(robot.getPoseInterpPosition(before, &pose), 1);
    EXPECT_EQ(robot.getEncoderPoseInterpPosition(before, &wheels), 1);
    EXPECT_NEAR(robot.getPose().findDistanceTo(pose), 200, 30);
    EXPECT_NEAR(robot.getEncoderPose().findDistanceTo(wheels), 200, 30);
}

TEST_F(SimAria, CommandsOfTheFirmwareMoveIt) {
    connect();
    EXPECT_TRUE(robot.comInt(ArCommands::VEL, 150));
    EXPECT_TRUE(robot.comInt(ArCommands::RVEL, 10));
    EXPECT_TRUE(robot.com(ArCommands::PULSE));
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 150);
    EXPECT_EQ(robot.getRotVel(), 10);
    robot.com2Bytes(ArCommands::VEL2, 5, 5);
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getVel(), 100);
    // The high byte is the left wheel's: it turns to the left, then to the right.
    robot.com2Bytes(ArCommands::VEL2, -1, 1);
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_GT(robot.getRotVel(), 0);
    robot.com2Bytes(ArCommands::VEL2, 2, static_cast<char>(-2));
    ArUtil::sleep(1500);
    EXPECT_LT(robot.getRotVel(), 0);
    robot.com(ArCommands::STOP);
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 0);
    robot.com(ArCommands::SETO);
    EXPECT_EQ(robot.getX(), 0);
    robot.stopRunning();
    EXPECT_FALSE(robot.comInt(ArCommands::VEL, 150));
}

TEST_F(SimAria, EachRobotOfAProgramIsAnother) {
    connect();
    ArTcpConnection second;
    ASSERT_EQ(second.open("localhost", 1), 0);
    ArRobot other("other");
    other.setDeviceConnection(&second);
    ASSERT_TRUE(other.blockingConnect());
    EXPECT_STREQ(robot.getRobotName(), "r1");
    EXPECT_STREQ(robot.getRobotSubType(), "p2dx");
    EXPECT_STREQ(other.getRobotName(), "r2");
    EXPECT_STREQ(other.getRobotSubType(), "p3dx");
    EXPECT_STREQ(other.getName(), "other");
    EXPECT_EQ(other.getRobotRadius(), 250);
    ArRobot third;
    third.setDeviceConnection(&second);
    EXPECT_FALSE(third.blockingConnect());
    // Its second program gets it when the first has gone.
    EXPECT_TRUE(robot.disconnect());
    setenv("ISPACE_ROBOT", "r2,r1", 1);
    EXPECT_TRUE(third.blockingConnect());
    EXPECT_STREQ(third.getRobotName(), "r1");
}

TEST_F(SimAria, WithoutAServerNothingOpens) {
    setenv("ISPACE_SIMRUN", "127.0.0.1:1", 1);
    EXPECT_EQ(connection.open(), ArSerialConnection::OPEN_COULD_NOT_OPEN_PORT);
    EXPECT_EQ(connection.getStatus(), ArDeviceConnection::STATUS_OPEN_FAILED);
    ArTcpConnection tcp;
    EXPECT_EQ(tcp.open("127.0.0.1", 1), ArTcpConnection::OPEN_CON_REFUSED);
    robot.setDeviceConnection(&connection);
    EXPECT_FALSE(robot.blockingConnect());
    EXPECT_TRUE(robot.disconnect());
}

TEST_F(SimAria, TheCycleEndsWithTheServer) {
    connect();
    server.reset();
    ArUtil::sleep(300);
    EXPECT_FALSE(robot.isConnected());
    EXPECT_FALSE(robot.isRunning());
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_EQ(connection.getStatus(), ArDeviceConnection::STATUS_CLOSED_ERROR);
}

struct Counted {
    ArRobot* robot;
    int cycles = 0;
    void count() {
        if (++cycles == 30) robot->stopRunning();
    }
};

TEST_F(SimAria, RunBlocksUntilItIsStopped) {
    for (const char* const clock : {"step", "real:20", "fast"}) {
        serve(clock);
        ArSimpleConnector connector(nullptr, nullptr);
        ArRobot blocking;
        ASSERT_TRUE(connector.connectRobot(&blocking)) << clock;
        Counted counted;
        counted.robot = &blocking;
        ArFunctorC<Counted> task(counted, &Counted::count);
        blocking.addUserTask("count", 50, &task);
        const ArTime begun;
        blocking.run(true);
        EXPECT_EQ(counted.cycles, 30) << clock;
        EXPECT_GE(begun.mSecSince(), 2890) << clock;
        EXPECT_FALSE(blocking.isRunning());
    }
}

TEST_F(SimAria, ACycleInItsOwnThreadGoesAtTheRateOfTheWorld) {
    serve("real:20");
    ASSERT_TRUE(connection.openSimple());
    robot.setDeviceConnection(&connection);
    ASSERT_TRUE(robot.blockingConnect());
    robot.comInt(ArCommands::ENABLE, 1);
    robot.runAsync(true);
    const auto wall = std::chrono::steady_clock::now();
    robot.lock();
    robot.setVel(200);
    robot.unlock();
    ArUtil::sleep(6000);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
    EXPECT_GE(seconds, 0.29);
    robot.lock();
    EXPECT_EQ(robot.getVel(), 200);
    EXPECT_GT(robot.getX(), 500);
    EXPECT_GT(robot.getCounter(), 10U);
    // A program may stop it while it holds the lock.
    robot.stopRunning();
    robot.unlock();
}

TEST(SimAriaProcess, ASignalStopsTheRobotAndEndsTheProcess) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(
        {
            Aria::init();
            Aria::addExitCallback(new ArGlobalFunctor([] { std::fputs("in order\n", stderr); }));
            raise(SIGTERM);
            ArUtil::sleep(60000);
        },
        testing::ExitedWithCode(1), "in order");
    EXPECT_EXIT(
        {
            Aria::init();
            ArSignalHandler::unhandle(ArSignalHandler::SigTERM);
            raise(SIGTERM);
        },
        testing::KilledBySignal(SIGTERM), "");
    EXPECT_EXIT(Aria::exit(4), testing::ExitedWithCode(4), "");
}

}  // namespace
