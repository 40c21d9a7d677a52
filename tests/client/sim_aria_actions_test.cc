// SPDX-License-Identifier: GPL-3.0-or-later
// ARIA's actions, tasks and lasers over a running simrun, which advances while the program sleeps.
#include <Sim_Aria.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "support/test_folder.h"
#include "support/test_paths.h"
#include "test_server.h"

namespace {

std::string data(const std::string& file) {
    return ispace::testing::sourcePath("tests/data/") + file;
}

class SimAriaActions : public ::testing::Test {
  protected:
    /// r1 stands at (-1, 0) and faces the wall at x = 2; its pose is its odometry from there.
    void SetUp() override {
        server.reset(
            new TestServer({data("square.env"), data("session.3dm"), "--clock", "step", "-q"}));
        setenv("ISPACE_SIMRUN", server->address().c_str(), 1);
        setenv("ISPACE_ROBOT", "r1", 1);
        Aria::init(Aria::SIGHANDLE_NONE);
        robot.setDeviceConnection(&connection);
        ASSERT_TRUE(robot.blockingConnect());
        robot.addRangeDevice(&sonar);
        robot.enableMotors();
        robot.runAsync(true);
    }
    void TearDown() override {
        robot.stopRunning();
        Aria::shutdown();
    }

    std::unique_ptr<TestServer> server;
    ArTcpConnection connection;
    ArRobot robot;
    ArSonarDevice sonar;
};

TEST_F(SimAriaActions, AConstantVelocityHoldsUntilDirectMotionSuspendsIt) {
    ArActionConstantVelocity drive("drive", 200);
    robot.addAction(&drive, 50);
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 200);
    robot.setVel(-100);
    EXPECT_TRUE(robot.isDirectMotion());
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), -100);
    robot.clearDirectMotion();
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 200);
    robot.setDirectMotionPrecedenceTime(500);
    robot.stop();
    ArUtil::sleep(2500);
    EXPECT_EQ(robot.getVel(), 200);
    // Without an action with a wish it keeps its speed; a stop of lower priority ends it.
    EXPECT_EQ(robot.findAction("drive"), &drive);
    drive.deactivate();
    ArUtil::sleep(300);
    EXPECT_EQ(robot.getVel(), 200);
    ArActionStop stop;
    robot.addAction(&stop, 10);
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_TRUE(robot.remAction("drive"));
    EXPECT_FALSE(robot.remAction(&drive));
}

TEST_F(SimAriaActions, ALimiterStopsBeforeTheWall) {
    ArActionLimiterForwards limiter("limiter", 300, 1100, 400);
    ArActionConstantVelocity drive("drive", 400);
    robot.addAction(&limiter, 90);
    robot.addAction(&drive, 50);
    ArUtil::sleep(30000);
    // The wall is 3 m ahead of the centre of a robot of 0.25 m.
    EXPECT_GT(robot.getX(), 2300);
    EXPECT_LT(robot.getX(), 2500);
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_FALSE(robot.isLeftMotorStalled());
    EXPECT_NEAR(robot.checkRangeDevicesCurrentPolar(-10, 10), 3000 - robot.getX(), 15);
    // Backward, its counterpart.
    ArActionLimiterBackwards behind;
    ArActionConstantVelocity back("back", -400);
    robot.remAction(&drive);
    robot.addAction(&behind, 80);
    robot.addAction(&back, 50);
    ArUtil::sleep(1500);
    EXPECT_NEAR(robot.getVel(), -250, 1);
    ArUtil::sleep(30000);
    EXPECT_LT(robot.getX(), -400);
    EXPECT_GT(robot.getX(), -520);
    EXPECT_FALSE(robot.isLeftMotorStalled());
}

/// Adds the actions of a wandering robot and returns its pose at the end.
ArPose wander(ArRobot* robot, unsigned int ms) {
    ArActionStallRecover recover;
    ArActionBumpers bumpers;
    ArActionAvoidFront near("Avoid Front Near", 225, 0), far;
    ArActionConstantVelocity drive("Constant Velocity", 400);
    robot->addAction(&recover, 100);
    robot->addAction(&bumpers, 75);
    robot->addAction(&near, 50);
    robot->addAction(&far, 49);
    robot->addAction(&drive, 25);
    ArUtil::sleep(ms);
    return robot->getPose();
}

TEST_F(SimAriaActions, AWandererAvoidsTheWallsTheSameWayEachTime) {
    const ArPose first = wander(&robot, 60000);
    EXPECT_GT(robot.getOdometerDistance(), 5000);
    // In the square, from (-1, 0): none of its walls was passed.
    EXPECT_LT(std::fabs(first.getX() - 1000), 1751);
    EXPECT_LT(std::fabs(first.getY()), 1751);
    TearDown();
    robot.resetOdometer();
    SetUp();
    const ArPose second = wander(&robot, 60000);
    EXPECT_EQ(first.getX(), second.getX());
    EXPECT_EQ(first.getY(), second.getY());
    EXPECT_EQ(first.getTh(), second.getTh());
}

TEST_F(SimAriaActions, AStalledRobotIsFreed) {
    ArActionStallRecover recover;
    ArActionConstantVelocity drive("drive", 400);
    robot.addAction(&drive, 25);
    ArUtil::sleep(12000);
    ASSERT_TRUE(robot.isLeftMotorStalled());
    const ArPose wall = robot.getPose();
    robot.addAction(&recover, 100);
    ArUtil::sleep(7000);
    EXPECT_GT(robot.getPose().findDistanceTo(wall), 300);
    ArUtil::sleep(3000);
    EXPECT_GT(std::fabs(ArMath::subAngle(robot.getTh(), wall.getTh())), 30);
}

TEST_F(SimAriaActions, BumpersMakeItBackOff) {
    ArActionBumpers bumpers("bumpers", 100, 3000, 1000);
    ArActionConstantVelocity drive("drive", 400);
    robot.addAction(&drive, 25);
    ArUtil::sleep(12000);
    ASSERT_NE(robot.getStallValue() & 0xfe00, 0);
    const double wall = robot.getX();
    robot.addAction(&bumpers, 75);
    ArUtil::sleep(2500);
    EXPECT_LT(robot.getX(), wall - 150);
}

TEST_F(SimAriaActions, GoalsAreReached) {
    ArActionGotoStraight straight("straight", 400);
    ArActionGoto curved("curved", ArPose(0, 0), 50, 300);
    curved.cancelGoal();
    ArActionStop stop;
    robot.addAction(&straight, 50);
    robot.addAction(&curved, 50);
    robot.addAction(&stop, 40);
    for (const ArPose& goal : {ArPose(1500, 0), ArPose(1500, -1000), ArPose(0, -1000)}) {
        straight.setGoal(goal);
        for (int i = 0; i < 300 && !straight.haveAchievedGoal(); ++i) ArUtil::sleep(100);
        ASSERT_TRUE(straight.haveAchievedGoal());
        EXPECT_LT(robot.getPose().findDistanceTo(goal), 130) << goal.getX() << ',' << goal.getY();
    }
    curved.setGoal(ArPose(1200, 300));
    for (int i = 0; i < 300 && !curved.haveAchievedGoal(); ++i) ArUtil::sleep(100);
    EXPECT_TRUE(curved.haveAchievedGoal());
    EXPECT_LT(robot.getPose().findDistanceTo(ArPose(1200, 300)), 60);
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 0);
    // Back, without a turn.
    const ArPose at = robot.getPose();
    straight.setGoalRel(500, 180, true);
    ArUtil::sleep(6000);
    EXPECT_NEAR(robot.getPose().findDistanceTo(at), 450, 60);
    EXPECT_NEAR(ArMath::subAngle(robot.getTh(), at.getTh()), 0, 5);
    ArActionDriveDistance distance;
    robot.addAction(&distance, 60);
    distance.setDistance(400);
    const ArPose from = robot.getPose();
    ArUtil::sleep(6000);
    EXPECT_TRUE(distance.haveAchievedDistance());
    EXPECT_NEAR(robot.getPose().findDistanceTo(from), 400, 20);
}

TEST_F(SimAriaActions, GroupsExcludeEachOther) {
    ArActionGroupStop stop(&robot);
    ArActionGroupInput input(&robot);
    ArActionGroupWander wander(&robot);
    input.activateExclusive();
    input.setVel(150);
    input.setRotVel(20);
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 150);
    EXPECT_EQ(robot.getRotVel(), 20);
    stop.activateExclusive();
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 0);
    EXPECT_EQ(robot.getRotVel(), 0);
    wander.activateExclusive();
    ArUtil::sleep(3000);
    EXPECT_GT(robot.getVel(), 100);
}

TEST_F(SimAriaActions, KeysDriveIt) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    std::FILE* const input = fdopen(ends[0], "r");
    {
        ArKeyHandler keys(false, false, input);
        Aria::setKeyHandler(&keys);
        robot.attachKeyHandler(&keys);
        ArActionKeydrive drive;
        robot.addAction(&drive, 50);
        const std::string ups = "\033[A\033[A\033[A\033[A";
        ASSERT_EQ(write(ends[1], ups.data(), ups.size()), static_cast<ssize_t>(ups.size()));
        ArUtil::sleep(1500);
        EXPECT_EQ(robot.getVel(), 100);
        ASSERT_EQ(write(ends[1], "\033[D\033[D", 6), 6);
        ArUtil::sleep(1500);
        EXPECT_NEAR(robot.getTh(), 16, 1.5);
        ASSERT_EQ(write(ends[1], " ", 1), 1);
        ArUtil::sleep(1500);
        EXPECT_EQ(robot.getVel(), 0);
        // A deactivated action leaves its keys to others.
        ArActionGroupRatioDriveUnsafe ratio(&robot);
        ratio.activateExclusive();
        ASSERT_EQ(write(ends[1], ups.data(), ups.size()), static_cast<ssize_t>(ups.size()));
        ArUtil::sleep(1500);
        EXPECT_EQ(robot.getVel(), 140);
    }
    EXPECT_EQ(robot.getKeyHandler(), nullptr);
    EXPECT_EQ(Aria::getKeyHandler(), nullptr);
    std::fclose(input);
    close(ends[1]);
}

/// Counts calls, in order.
struct Calls {
    std::string order;
    void sense() { order += 's'; }
    void use() { order += 'u'; }
    void first() { order += 'f'; }
    void connected() { order += 'c'; }
    void disconnected() { order += 'd'; }
    bool packet(ArRobotPacket* packet) {
        good = packet->verifyCheckSum();
        id = packet->getID();
        x = packet->bufToByte2();
        return false;
    }
    bool good = false;
    int id = 0, x = 0;
};

TEST_F(SimAriaActions, TasksRunInTheOrderOfACycle) {
    Calls calls;
    ArFunctorC<Calls> sense(calls, &Calls::sense), use(calls, &Calls::use);
    ArFunctorC<Calls> first(calls, &Calls::first);
    ArRetFunctor1C<bool, Calls, ArRobotPacket*> packet(calls, &Calls::packet);
    robot.addUserTask("use", 50, &use);
    robot.addSensorInterpTask("sense", 50, &sense);
    robot.addUserTask("first", 60, &first);
    robot.addPacketHandler(&packet);
    robot.setVel(200);
    ArUtil::sleep(200);
    EXPECT_EQ(calls.order, "sfusfu");
    ArUtil::sleep(2000);
    EXPECT_TRUE(calls.good);
    EXPECT_EQ(calls.id, 0x33);
    EXPECT_EQ(calls.x, std::lround(robot.getEncoderPose().getX()));
    EXPECT_EQ(robot.getMotorPacCount(), 10);
    EXPECT_NEAR(static_cast<double>(robot.getLeftEncoder()), 128 * robot.getX(), 130);
    robot.remUserTask("use");
    robot.remSensorInterpTask(&sense);
    calls.order.clear();
    ArUtil::sleep(100);
    EXPECT_EQ(calls.order, "f");
    robot.remUserTask(&first);
    robot.remPacketHandler(&packet);
    ArFunctorC<Calls> connected(calls, &Calls::connected);
    ArFunctorC<Calls> disconnected(calls, &Calls::disconnected);
    calls.order.clear();
    robot.addDisconnectNormallyCB(&disconnected);
    robot.addConnectCB(&connected);
    robot.stopRunning();
    EXPECT_EQ(calls.order, "d");
    robot.runAsync(false);
    EXPECT_TRUE(robot.asyncConnect());
    ArUtil::sleep(300);
    EXPECT_TRUE(robot.isConnected());
    EXPECT_EQ(calls.order, "dc");
    robot.remConnectCB(&connected);
    robot.remDisconnectNormallyCB(&disconnected);
}

TEST_F(SimAriaActions, LasersOnTheRobotConnect) {
    ispace::client::World(server->address()).remove("r2");
    int count = 1;
    char program[] = "a";
    char* words[] = {program, nullptr};
    ArArgumentParser parser(&count, words);
    ArRobotConnector connector(&parser, &robot);
    ArLaserConnector lasers(&parser, &robot, &connector);
    EXPECT_TRUE(Aria::parseArgs());
    ASSERT_TRUE(lasers.connectLasers());
    // l2, of three beams over a half turn; the others stand in the room.
    ASSERT_EQ(robot.getNumLasers(), 1);
    ArLaser* const laser = robot.findLaser(1);
    EXPECT_STREQ(laser->getSimId(), "l2");
    EXPECT_TRUE(laser->isConnected());
    EXPECT_EQ(laser->getStartDegrees(), -90);
    EXPECT_EQ(laser->getEndDegrees(), 90);
    ArUtil::sleep(500);
    ASSERT_EQ(laser->getRawReadings()->size(), 3U);
    EXPECT_NEAR(laser->currentReadingPolar(-10, 10), 3000, 2);
    EXPECT_NEAR(laser->currentReadingPolar(80, 100), 2000, 2);
    // The points stand still while it drives and turns.
    robot.setVel(200);
    robot.setRotVel(15);
    for (int i = 0; i < 20; ++i) {
        ArUtil::sleep(100);
        for (const ArPoseWithTime* point : *laser->getCurrentBuffer()) {
            const double x = point->getX() - 1000, y = point->getY();
            EXPECT_NEAR(std::max(std::fabs(x), std::fabs(y)), 2000, 12) << i;
        }
    }
    const int scans = laser->getReadingCount();
    EXPECT_GE(scans, 20);
    EXPECT_TRUE(laser->disconnect());
    EXPECT_EQ(robot.getNumLasers(), 0);
}

TEST_F(SimAriaActions, ALaserBesideTheCentreSeesTheSameWalls) {
    ispace::client::World world(server->address());
    world.remove("r2");
    world.remove("l2");
    world.add("laser id=l9 on=r1 at=0.2,0.1,0.2 heading=90 fov=180 step=15 range=8");
    ArLaserConnector lasers(nullptr, &robot);
    ASSERT_TRUE(lasers.connectLasers());
    ArLaser* const laser = robot.findLaser(1);
    EXPECT_NEAR(laser->getSensorPosition().getX(), 200, 1e-9);
    EXPECT_NEAR(laser->getSensorPosition().getY(), 100, 1e-9);
    EXPECT_NEAR(laser->getSensorPosition().getTh(), 90, 1e-9);
    ArUtil::sleep(300);
    ASSERT_EQ(laser->getCurrentBuffer()->size(), 13U);
    for (const ArPoseWithTime* point : *laser->getCurrentBuffer())
        EXPECT_NEAR(std::max(std::fabs(point->getX() - 1000), std::fabs(point->getY())), 2000, 2);
}

TEST_F(SimAriaActions, ALaserOfAProgramIsTheRobotsOfThatNumber) {
    ArSick sick;
    EXPECT_STREQ(sick.getName(), "sick_1");
    EXPECT_FALSE(sick.blockingConnect()) << "it is on no robot";
    robot.addRangeDevice(&sick);
    ArSimpleConnector connector(static_cast<ArArgumentParser*>(nullptr));
    EXPECT_TRUE(connector.setupLaser(&sick));
    sick.runAsync();
    ASSERT_TRUE(sick.blockingConnect());
    ArUtil::sleep(300);
    EXPECT_GT(sick.getReadingCount(), 1);
    EXPECT_LT(sick.currentReadingPolar(-90, 90), sick.getMaxRange());
    ArUrg second(2);
    second.setRobot(&robot);
    EXPECT_FALSE(second.blockingConnect()) << "the robot has one";
}

TEST_F(SimAriaActions, LinesAndACornerAreFoundInAScan) {
    ispace::client::World world(server->address());
    // A corner of 135 degrees that points to the robot, 2 m ahead of it.
    world.add("fence id=f path=1.383,-0.924;1,0;1.383,0.924 height=1");
    world.add("laser id=l9 on=r1 fov=180 step=0.5 range=8");
    world.remove("l2");
    ArLaserConnector lasers(nullptr, &robot);
    ASSERT_TRUE(lasers.connectLasers());
    ArLineFinder finder(robot.findLaser(1));
    ArUtil::sleep(300);
    int of_corner = 0;
    for (const auto& line : *finder.getLines()) {
        const ArLine straight = line.second->getLine();
        if (straight.getPerpDist(ArPose(2000, 0)) < 20) ++of_corner;
    }
    EXPECT_EQ(of_corner, 2);
    ArActionTriangleDriveTo approach("triangle", 500, 1000, 200);
    ArActionStop stop;
    robot.addAction(&approach, 60);
    robot.addAction(&stop, 50);
    approach.activate();
    ArUtil::sleep(25000);
    EXPECT_EQ(approach.getState(), ArActionTriangleDriveTo::STATE_SUCCEEDED);
    EXPECT_NEAR(robot.getX(), 1500, 30);
    EXPECT_NEAR(robot.getY(), 0, 30);
    EXPECT_NEAR(robot.getTh(), 0, 3);
}

int twice = 0;
int two() { return twice += 2; }

TEST_F(SimAriaActions, LogsHaveARowEachInterval) {
    const ispace::testing::TestFolder folder;
    const std::string log = folder.file("data.log"), scans = folder.file("scans.2d");
    twice = 0;
    {
        ArDataLogger logger(&robot, log.c_str());
        ArGlobalRetFunctor<int> value(&two);
        logger.addData<int>("two", &value, "%d");
        logger.setLogInterval(1);
        logger.startLogging();
        ArLaserConnector lasers(nullptr, &robot);
        ASSERT_TRUE(lasers.connectLasers());
        ArLaserLogger logs(&robot, robot.findLaser(1), 300, 25, scans.c_str());
        ASSERT_TRUE(logs.wasFileOpened());
        robot.setVel(200);
        ArUtil::sleep(5050);
    }
    std::ifstream rows(log);
    std::string line, last;
    int count = 0;
    for (; std::getline(rows, line); ++count) last = line;
    EXPECT_EQ(count, 6);  // the names, and one for each second
    EXPECT_EQ(last.substr(last.rfind('\t') + 1), "10");
    std::stringstream text;
    text << std::ifstream(scans).rdbuf();
    int readings = 0;
    for (std::size_t at = text.str().find("scan1:"); at != std::string::npos;
         at = text.str().find("scan1:", at + 1))
        ++readings;
    // The first, and one for each 300 mm of some 900.
    EXPECT_EQ(readings, 3);
}

}  // namespace
