// SPDX-License-Identifier: GPL-3.0-or-later
// The C++ client reads a sensor of each kind of a running simrun.
#include <gtest/gtest.h>
#include <ispace_client.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/test_paths.h"
#include "test_server.h"

namespace ispace {
namespace client {
namespace {

std::string data(const std::string& file) {
    return ispace::testing::sourcePath("tests/data/") + file;
}

/// square.env with sensing.3dm: r1 drives past the sensors, h1 stands.
class Sensors : public ::testing::Test {
  protected:
    TestServer server{{data("square.env"), data("sensing.3dm"), "--clock", "step", "-q"}};
    World world{server.address()};
    void simulate(double seconds) { world.step(std::lround(seconds / world.dt())); }
};

TEST_F(Sensors, ACameraTakesPictures) {
    Camera camera(server.address(), "c1");
    EXPECT_EQ(camera.info().text("kind"), "camera");
    const Picture png = camera.scan();
    EXPECT_EQ(png.format, "png");
    EXPECT_EQ(png.width, 8);
    EXPECT_EQ(png.data.substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(png.pose().heading, 45);
    EXPECT_EQ(png.pose().z, 1.5);
    camera.binary(false);
    EXPECT_EQ(camera.scan().data, png.data);
    camera.format("rgb");
    EXPECT_EQ(camera.scan().data.size(), 8U * 6 * 3);
    camera.binary(true);
    camera.stream();
    for (long i = 1; i < 4; ++i) {
        simulate(0.2);
        const Picture picture = camera.next();
        EXPECT_EQ(picture.seq, i);
        EXPECT_EQ(picture.data.size(), 8U * 6 * 3);
    }
    EXPECT_THROW(camera.format("depth32"), Refused);
}

TEST_F(Sensors, ARangerReadsTheSameInEachFormat) {
    Ranger ranger(server.address(), "d1");
    const Depths metres = ranger.scan();
    ASSERT_EQ(metres.depths.size(), 12U);
    ranger.format("depth16");
    const Depths millimetres = ranger.scan();
    CloudSensor sensor(server.address(), "d1");
    const Cloud cloud = sensor.scan();
    ASSERT_EQ(cloud.points.size(), 12U);
    std::size_t i = 0;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column, ++i) {
            const float distance = metres.at(column, row);
            ASSERT_TRUE(std::isfinite(distance));
            EXPECT_NEAR(millimetres.at(column, row), distance, 5.1e-4);
            EXPECT_NEAR(cloud.points[i].x, distance, 1e-6);  // along the axis
        }
    }
}

TEST_F(Sensors, TagsAreHeardAndPlaced) {
    const Burst burst = Ultrasound(server.address(), "u1").scan();
    EXPECT_EQ(burst.tags, std::vector<std::string>({"t1", "t2"}));
    EXPECT_NEAR(burst.times_of_flight[0] * 340, std::hypot(std::hypot(2, 1), 1.7), 0.1);
    Tag tag(server.address(), "t1");
    EXPECT_TRUE(tag.scan().solved);
    EXPECT_NEAR(tag.scan().x, -1, 0.01);
    EXPECT_EQ(tag.scan().heard, 4);
}

TEST_F(Sensors, MatsAndGatesNoticeARobot) {
    Mat mat(server.address(), "m1");
    Gate gate(server.address(), "g1");
    EXPECT_TRUE(mat.scan().on.empty());
    EXPECT_EQ(gate.scan().last, "");
    Robot robot(server.address(), "r1");
    robot.forward(1.5);
    simulate(4);
    EXPECT_EQ(mat.scan().on, std::vector<std::string>({"r1"}));
    const Passages passages = gate.scan();
    EXPECT_EQ(passages.in, 1);
    EXPECT_EQ(passages.last, "r1");
    EXPECT_EQ(passages.way, "in");
    EXPECT_TRUE(passages.broken);
    EXPECT_EQ(robot.reading<Depths>("d2").depths.size(), 3U);
    EXPECT_THROW(robot.reading<Picture>("c1"), Refused);
}

TEST_F(Sensors, ARadarDetectsAMovingRobot) {
    world.add("radar id=w1 at=1.8,0,0.11 heading=180");
    Radar radar(server.address(), "w1");
    EXPECT_EQ(radar.info().text("kind"), "radar");
    EXPECT_EQ(radar.info().numbers("fov"), std::vector<double>({120, 60}));
    simulate(0.1);
    EXPECT_TRUE(radar.scan().movers.empty());
    Robot robot(server.address(), "r1");
    robot.speed(0.2);
    simulate(2);
    const Detections seen = radar.scan();
    ASSERT_EQ(seen.movers.size(), 1U);
    EXPECT_NEAR(seen.movers[0].speed, -0.2, 0.002);
    EXPECT_NEAR(seen.movers[0].bearing, 0, 0.01);
    radar.stream();
    simulate(0.5);
    EXPECT_LT(radar.next().movers.at(0).range, seen.movers[0].range);
}

TEST_F(Sensors, ASmartRoomReportsTagsLightSoundAndMotion) {
    world.add("imu id=i1 on=r1");
    world.add("cube id=k1 at=1.2,1.2 size=0.1,0.1,0.1 tag=key");
    world.add("rfid id=f1 at=1.2,0.7,0.12 heading=90 range=1 fov=90,90");
    world.add("lamp id=l9 at=0,0 on=yes lumens=3000");
    world.add("lux id=x1 at=0,0,0.5 tilt=90");
    world.add("speaker id=p9 at=1,0 height=1 on=yes volume=70");
    world.add("microphone id=o1 at=-1,0,1 floor=0");
    simulate(1);
    const Inertia rest = Imu(server.address(), "i1").scan();
    EXPECT_EQ(rest.rates, std::vector<double>({0, 0, 0}));
    EXPECT_NEAR(rest.accelerations[2], 9.81, 0.01);
    EXPECT_EQ(Rfid(server.address(), "f1").scan().tags, std::vector<std::string>({"key"}));
    EXPECT_GT(Lux(server.address(), "x1").scan().lux, 100);
    EXPECT_NEAR(Microphone(server.address(), "o1").scan().level, 70 - 20 * std::log10(2), 0.05);
}

TEST_F(Sensors, AMoteReportsLightAndNeighbours) {
    world.add("lamp id=l8 at=0,0 on=yes");
    world.add("mote id=n1 at=0,0,0.5 tilt=90 radio=2");
    world.add("mote id=n2 at=1,0,0.5");
    world.add("mote id=n3 at=-1.9,-1.9,0.5");
    simulate(1);
    const MoteReport report = Mote(server.address(), "n1").scan();
    EXPECT_GT(report.lux, 100);
    EXPECT_EQ(report.neighbours, std::vector<std::string>({"n2"}));
    EXPECT_NEAR(report.margins.at(0), 20 * std::log10(2.0), 0.06);
}

TEST_F(Sensors, AThermometerReportsItsZone) {
    world.add("zone id=z8 at=0,0 size=4,4 celsius=21.5 storage=1");
    world.add("thermometer id=t8 at=0,0,1.5 rate=10");
    world.add("heater id=h8 at=0,0 watts=32000 on=yes");
    simulate(1);
    // 2 K a second
    EXPECT_GT(Thermometer(server.address(), "t8").scan().celsius, 22);
}

TEST_F(Sensors, AnchorsMeasureRangesAndLocate) {
    world.add("cube id=k1 at=1.2,1.2 size=0.1,0.1,0.09 tag=key");
    for (const char* anchor : {"a0 at=1.9,1.9,1.8", "a1 at=-1.9,1.9,1.9", "a2 at=-1.9,-1.9,2"})
        world.add(std::string("uwb id=") + anchor);
    simulate(1);
    Uwb uwb(server.address(), "a0");
    EXPECT_EQ(uwb.info().number("loss"), 6);
    const TagRanges seen = uwb.scan();
    ASSERT_EQ(seen.tags.size(), 1U);
    EXPECT_EQ(seen.tags[0].tag, "key");
    EXPECT_NEAR(seen.tags[0].range, std::hypot(0.7, 0.7, 1.69), 0.02);
    EXPECT_FALSE(seen.tags[0].is_blocked);
    ASSERT_TRUE(seen.tags[0].is_located);
    EXPECT_NEAR(seen.tags[0].x, 1.2, 0.01);
    EXPECT_NEAR(seen.tags[0].y, 1.2, 0.01);
    world.remove("a2");
    simulate(1);
    EXPECT_FALSE(uwb.scan().tags.at(0).is_located);
}

TEST_F(Sensors, ARobotHasSonarsAndBumpers) {
    world.add("robot id=r5 at=1.5,-1.2 sonar=0.2,0,0;0,-0.2,-90 bumpers=-45,45;135,225");
    Robot robot(server.address(), "r5");
    const std::vector<Sonar> ring = robot.sonar();
    ASSERT_EQ(ring.size(), 2U);
    EXPECT_EQ(ring[0].place.x, 0.2);
    EXPECT_EQ(ring[1].place.heading, -90);
    EXPECT_NEAR(ring[0].range, 0.3, 0.005);
    EXPECT_NEAR(ring[1].range, 0.6, 0.005);
    EXPECT_EQ(robot.bumpers(), std::vector<bool>({false, false}));
    robot.speed(0.3);
    simulate(5);
    EXPECT_TRUE(robot.status().stall);
    EXPECT_EQ(robot.bumpers(), std::vector<bool>({true, false}));
}

TEST_F(Sensors, ARobotHasOdometry) {
    Robot robot(server.address(), "r1");
    robot.forward(0.5);
    simulate(5);
    const Odometry odometry = robot.odometry();
    EXPECT_NEAR(odometry.pose.x, 0.5, 2e-3);
    EXPECT_NEAR(odometry.pose.y, 0, 1e-3);
    EXPECT_EQ(odometry.pose.heading, 0);
    EXPECT_EQ(odometry.speed, 0);
}

TEST_F(Sensors, AnyKindIsAReading) {
    for (const char* id : {"l1", "c1", "d1", "u1", "t1", "m1", "g1"}) {
        Sensor sensor(server.address(), id);
        EXPECT_EQ(sensor.scan().sensor, id);
        EXPECT_EQ(sensor.scan().seq, 0);
    }
    EXPECT_EQ(SensorOf<Scan>(server.address(), "l1").scan().ranges.size(), 3U);
}

}  // namespace
}  // namespace client
}  // namespace ispace
