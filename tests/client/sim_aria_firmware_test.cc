// SPDX-License-Identifier: GPL-3.0-or-later
// ARIA's classes over a running simrun: figures of the firmware, flags and devices of later robots,
// commands past the cycle.
#include <Sim_Aria.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "support/test_paths.h"
#include "test_server.h"

namespace {

class SimAriaFirmware : public ::testing::Test {
  protected:
    /// r1 stands at (-1, 0) and faces the wall at x = 2.
    void SetUp() override {
        const std::string data = ispace::testing::sourcePath("tests/data/");
        server.reset(
            new TestServer({data + "square.env", data + "session.3dm", "--clock", "step", "-q"}));
        setenv("ISPACE_SIMRUN", server->address().c_str(), 1);
        unsetenv("ISPACE_ROBOT");
        Aria::init(Aria::SIGHANDLE_NONE);
        ASSERT_EQ(connection.open(), 0);
        robot.setDeviceConnection(&connection);
    }
    void connect() {
        ASSERT_TRUE(robot.blockingConnect());
        robot.enableMotors();
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

struct Arrivals {
    int count = 0;
    void add() { ++count; }
};

TEST_F(SimAriaFirmware, ConfigurationArrivesInTheNextCycle) {
    Arrivals arrivals;
    ArFunctorC<Arrivals> arrived(&arrivals, &Arrivals::add);
    ArRobotConfigPacketReader reader(&robot, true, &arrived);
    EXPECT_FALSE(reader.requestPacket());  // not connected
    connect();
    EXPECT_FALSE(reader.hasPacketBeenRequested());
    EXPECT_TRUE(reader.requestPacket());
    EXPECT_TRUE(reader.hasPacketBeenRequested());
    EXPECT_FALSE(reader.hasPacketArrived());
    EXPECT_FALSE(reader.requestPacket());  // once only
    ArUtil::sleep(500);
    EXPECT_TRUE(reader.hasPacketArrived());
    EXPECT_EQ(arrivals.count, 1);
    const ArRobotConfigPacketReader& own = *robot.getOrigRobotConfig();
    EXPECT_STREQ(reader.getName(), "r1");
    EXPECT_STREQ(reader.getSubType(), own.getSubType());
    EXPECT_EQ(reader.getTransVelTop(), own.getTransVelTop());
    EXPECT_GT(reader.getTransVelTop(), 0);
    EXPECT_EQ(reader.getRotAccel(), own.getRotAccel());
    EXPECT_EQ(reader.getFrontSonar(), robot.getNumSonar() > 0);
    EXPECT_EQ(reader.getNumFrontBumpers(), static_cast<int>(robot.getNumFrontBumpers()));
    EXPECT_FALSE(own.getHasGripper());
    EXPECT_EQ(own.getConfigFlags(), 0);

    ArRobotConfigPacketReader again(&robot, false, &arrived);
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(again.requestPacket());
        ArUtil::sleep(300);
    }
    EXPECT_EQ(arrivals.count, 3);
    {
        ArRobotConfigPacketReader gone(&robot, false, &arrived);
        EXPECT_TRUE(gone.requestPacket());
    }
    ArUtil::sleep(300);
    EXPECT_EQ(arrivals.count, 3);
}

// The thread sanitizer sees unguarded figures.
TEST_F(SimAriaFirmware, ConfigurationArrivesBesideTheProgram) {
    connect();
    ArRobotConfigPacketReader reader(&robot);
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(reader.requestPacket());
        const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (!reader.hasPacketArrived() && std::chrono::steady_clock::now() < patience)
            ArUtil::sleep(20);
        ASSERT_TRUE(reader.hasPacketArrived()) << "request " << i;
        EXPECT_STREQ(reader.getName(), "r1");
    }
}

TEST_F(SimAriaFirmware, AStoppedStateReflectionSendsNoMotion) {
    connect();
    ArActionConstantVelocity drive("drive", 200);
    robot.addAction(&drive, 50);
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 200);
    robot.stop();
    robot.stopStateReflection();
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 0);
    const double x = robot.getX();
    ArUtil::sleep(1000);
    EXPECT_EQ(robot.getX(), x);
    robot.setVel(100);
    ArUtil::sleep(2000);
    EXPECT_EQ(robot.getVel(), 100);
    robot.stop();
    robot.stopStateReflection();
    ArUtil::sleep(1000);
    robot.clearDirectMotion();
    ArUtil::sleep(1500);
    EXPECT_EQ(robot.getVel(), 200);
}

TEST_F(SimAriaFirmware, PointsFromTheRobot) {
    connect();
    robot.moveTo(ArPose(1000, 2000, 170));
    const ArPose point(1000, 1000);
    EXPECT_NEAR(robot.findDistanceTo(point), 1000, 1e-9);
    EXPECT_NEAR(robot.findAngleTo(point), -90, 1e-9);
    EXPECT_NEAR(robot.findDeltaHeadingTo(point), 100, 1e-9);
    EXPECT_NEAR(robot.findDeltaHeadingTo(ArPose(-1000, 2000)), 10, 1e-9);
    const ArPose local = robot.getToLocalTransform().doTransform(point);
    EXPECT_NEAR(local.getX(), 1000 * ArMath::cos(100), 1e-6);
    EXPECT_NEAR(local.getY(), 1000 * ArMath::sin(100), 1e-6);
    const ArPose back = robot.getToGlobalTransform().doTransform(local);
    EXPECT_NEAR(back.findDistanceTo(point), 0, 1e-6);
}

TEST_F(SimAriaFirmware, AClosedConnectionEndsInTheNextCycle) {
    Arrivals connected, normal, lost;
    ArFunctorC<Arrivals> on_connect(&connected, &Arrivals::add), on_end(&normal, &Arrivals::add),
        on_loss(&lost, &Arrivals::add);
    robot.addConnectCB(&on_connect);
    robot.addDisconnectNormallyCB(&on_end);
    robot.addDisconnectOnErrorCB(&on_loss);
    ASSERT_TRUE(robot.blockingConnect());
    robot.loopOnce();
    connection.close();
    robot.loopOnce();
    EXPECT_FALSE(robot.isConnected());
    EXPECT_EQ(connection.getStatus(), ArDeviceConnection::STATUS_CLOSED_NORMALLY);
    EXPECT_EQ(lost.count, 1);
    ASSERT_EQ(connection.open(), 0);
    ASSERT_TRUE(robot.blockingConnect());
    robot.disconnect();
    EXPECT_EQ(connected.count, 2);
    EXPECT_EQ(normal.count, 1);
    EXPECT_EQ(lost.count, 1);
}

TEST_F(SimAriaFirmware, PointsMoveWithTheRobot) {
    ArSonarDevice sonar;
    robot.addRangeDevice(&sonar);
    setenv("ISPACE_ROBOT", "r2", 1);  // which has sonars
    connect();
    unsetenv("ISPACE_ROBOT");
    ArUtil::sleep(1000);
    const auto nearest = [&] { return sonar.currentReadingPolar(-180, 180); };
    const auto old = [&] { return sonar.cumulativeReadingPolar(-180, 180); };
    const double distance = nearest(), remembered = old();
    ASSERT_LT(distance, 4000);
    const ArPose echo = robot.getSonarReading(3)->getPose();
    const double from_robot = robot.findDistanceTo(echo), turn = robot.findDeltaHeadingTo(echo);
    robot.lock();
    robot.moveTo(ArPose(8000, -2000, 120));
    EXPECT_NEAR(nearest(), distance, 1e-6);
    EXPECT_NEAR(old(), remembered, 1e-6);
    const ArPose moved = robot.getSonarReading(3)->getPose();
    EXPECT_GT(moved.findDistanceTo(echo), 1000);
    EXPECT_NEAR(robot.findDistanceTo(moved), from_robot, 1e-6);
    EXPECT_NEAR(robot.findDeltaHeadingTo(moved), turn, 1e-6);
    robot.unlock();
    // Points of earlier cycles lie where new ones come.
    ArUtil::sleep(200);
    EXPECT_NEAR(nearest(), distance, 20);
    robot.moveTo(ArPose(0, 0, 0), false);
    EXPECT_NEAR(nearest(), distance, 20);
    EXPECT_GT(old(), 3000);
}

TEST_F(SimAriaFirmware, TheSimulatorKnowsAndSetsTheTruePose) {
    ArSimUtil simulator(&robot);
    EXPECT_FALSE(simulator.setSimTruePose(ArPose(0, 0, 0)));  // not connected
    EXPECT_EQ(simulator.getSimTruePose(), ArPose());
    connect();
    EXPECT_EQ(simulator.getSimTruePose(), ArPose(-1000, 0, 0));
    robot.move(500);
    ArUtil::sleep(5000);
    const double way = robot.getX();
    EXPECT_NEAR(way, 500, 20);
    EXPECT_NEAR(simulator.getSimTrueX(), -1000 + way, 2);
    EXPECT_TRUE(simulator.setSimTruePose(ArPose(-500, -1000, 90)));
    ArUtil::sleep(500);
    EXPECT_EQ(simulator.getSimTruePoseFunc()->invokeR(), ArPose(-500, -1000, 90));
    EXPECT_EQ(robot.getX(), way);                                // by its wheels it has not moved
    EXPECT_FALSE(simulator.setSimTruePose(ArPose(1950, 0, 0)));  // in the wall
    ArUtil::sleep(500);
    EXPECT_EQ(simulator.getSimTrueY(), -1000);
    robot.move(300);
    ArUtil::sleep(5000);
    EXPECT_NEAR(simulator.getSimTrueY(), -700, 20);
    EXPECT_NEAR(robot.getX(), way + 300, 20);
    robot.disconnect();
    EXPECT_NEAR(simulator.getSimTrueY(), -700, 20);  // the last one known
}

/// Counts packets and keeps the numbers of the last one that has this id.
struct PacketReader {
    int id = 0, count = 0;
    std::size_t skip = 0;
    long first = 0, second = 0;
    bool read(ArRobotPacket* packet) {
        if (packet->getID() != id) return false;
        ++count;
        for (std::size_t i = 0; i < skip; ++i) packet->bufToUByte2();
        first = packet->bufToByte4();
        second = packet->bufToByte4();
        return true;
    }
};

TEST_F(SimAriaFirmware, PacketsOfEncodersAndOfTheSimulatorComeOnRequest) {
    PacketReader encoders, simulator;
    encoders.id = 0x90;
    simulator.id = 0x62;
    simulator.skip = 6;
    ArRetFunctor1C<bool, PacketReader, ArRobotPacket*> read(encoders, &PacketReader::read),
        read_simulator(simulator, &PacketReader::read);
    robot.addPacketHandler(&read, ArListPos::FIRST);
    robot.addPacketHandler(&read_simulator);
    connect();
    ArUtil::sleep(1000);
    EXPECT_EQ(encoders.count + simulator.count, 0);
    robot.requestEncoderPackets();
    robot.comInt(ArCommands::SIM_STAT, 1);
    robot.setVel(200);
    ArUtil::sleep(2000);
    EXPECT_NEAR(encoders.count, 20, 1);
    EXPECT_GT(encoders.first, 10000);
    EXPECT_EQ(encoders.first, encoders.second);
    EXPECT_EQ(simulator.count, 1);
    robot.stopEncoderPackets();
    robot.comInt(ArCommands::SIM_STAT, 2);
    ArUtil::sleep(1000);
    EXPECT_NEAR(encoders.count, 20, 1);
    EXPECT_NEAR(simulator.count, 11, 1);
    EXPECT_NEAR(static_cast<double>(simulator.first), -1000 + robot.getX(), 2);
    EXPECT_EQ(simulator.second, 0);
    robot.remPacketHandler(&read);
    robot.remPacketHandler(&read_simulator);
}

struct HalfTurns {
    // NOLINTNEXTLINE(performance-unnecessary-value-param): ARIA passes it so
    double half(ArPoseWithTime change) { return change.getTh() / 2; }
};

TEST_F(SimAriaFirmware, ACorrectionChangesTheHeading) {
    HalfTurns turns;
    ArRetFunctor1C<double, HalfTurns, ArPoseWithTime> half(turns, &HalfTurns::half);
    robot.setEncoderCorrectionCallback(&half);
    EXPECT_EQ(robot.getEncoderCorrectionCallback(), &half);
    connect();
    robot.setRotVel(30);
    ArUtil::sleep(3000);
    robot.lock();
    EXPECT_GT(robot.getEncoderPose().getTh(), 50);
    EXPECT_NEAR(robot.getTh(), robot.getEncoderPose().getTh() / 2, 1e-6);
    robot.setEncoderCorrectionCallback(nullptr);
    const double corrected = robot.getTh(), wheels = robot.getEncoderPose().getTh();
    robot.unlock();
    ArUtil::sleep(1000);
    EXPECT_NEAR(robot.getTh() - corrected, robot.getEncoderPose().getTh() - wheels, 1e-6);
}

TEST_F(SimAriaFirmware, ADroppedConnectionIsALoss) {
    Arrivals lost;
    ArFunctorC<Arrivals> on_loss(&lost, &Arrivals::add);
    robot.addDisconnectOnErrorCB(&on_loss);
    EXPECT_EQ(robot.waitForConnectOrConnFail(), ArRobot::WAIT_RUN_EXIT);
    robot.runAsync(false);
    ASSERT_TRUE(robot.asyncConnect());
    EXPECT_EQ(robot.waitForConnectOrConnFail(), ArRobot::WAIT_CONNECTED);
    robot.dropConnection();
    EXPECT_FALSE(robot.isConnected());
    EXPECT_EQ(lost.count, 1);
    robot.dropConnection();
    EXPECT_EQ(lost.count, 1);
    setenv("ISPACE_ROBOT", "r9", 1);
    ASSERT_TRUE(robot.asyncConnect());
    EXPECT_EQ(robot.waitForConnectOrConnFail(), ArRobot::WAIT_FAILED_CONN);
    unsetenv("ISPACE_ROBOT");
}

TEST_F(SimAriaFirmware, ALaserIgnoresWhatIsNearerThanItsMinimum) {
    connect();
    ArLaser laser(1, "");
    robot.addLaser(&laser, 1);
    ASSERT_TRUE(laser.blockingConnect());
    ArUtil::sleep(500);
    // To the sides the walls are 2 m away, ahead 3 m.
    EXPECT_EQ(laser.getCurrentReadings().size(), 3U);
    laser.lock();
    laser.setMinRange(2500);
    laser.unlock();
    ArUtil::sleep(500);
    laser.lock();
    ASSERT_EQ(laser.getCurrentReadings().size(), 1U);
    EXPECT_NEAR(laser.getCurrentReadings().front().getX(), 3000, 2);
    EXPECT_EQ(laser.getRawReadings()->size(), 3U);
    EXPECT_TRUE(laser.getRawReadings()->front()->getIgnoreThisReading());
    laser.unlock();
    laser.disconnect();
}

TEST_F(SimAriaFirmware, DevicesThatAPioneerLacks) {
    connect();
    EXPECT_TRUE(robot.getBatteryMap()->empty());
    ArBatteryMTX battery(1);
    EXPECT_STREQ(battery.getName(), "MTXBattery1");
    EXPECT_FALSE(battery.isConnected());
    EXPECT_FALSE(battery.sendEmergencyPowerOff());
    EXPECT_EQ(robot.getPTZ(), nullptr);
    ArVCC4 camera(&robot);
    robot.setPTZ(&camera);
    EXPECT_EQ(robot.getPTZ(), &camera);
    EXPECT_FALSE(ArAnalogGyro(&robot).hasGyroOnlyMode());
    EXPECT_FALSE(robot.hasFaultFlags() || robot.hasFlags3());
    EXPECT_EQ(robot.getFaultFlags() | robot.getFlags3(), 0);
    EXPECT_TRUE(robot.hasSettableVelMaxes() && robot.hasSettableAccsDecs());
    EXPECT_TRUE(robot.getRobotParams()->hasMoveCommand());
    EXPECT_STREQ(robot.getChargeStateName(), "not");
    EXPECT_EQ(robot.getStateOfChargeShutdown(), 0);
    const ArTime last = robot.getIOPacketTime();
    ArUtil::sleep(500);
    EXPECT_EQ(last.mSecSince(robot.getIOPacketTime()), 0);
}

}  // namespace
