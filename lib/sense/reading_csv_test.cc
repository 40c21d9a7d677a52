// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_csv.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sense/sample_readings.h"

namespace ispace {
namespace {

std::string fieldOf(std::string_view text) {
    std::string out;
    appendCsvField(out, text);
    return out;
}

TEST(ReadingCsv, FieldsAreQuotedIfNeeded) {
    EXPECT_EQ(fieldOf("l1"), "l1");
    EXPECT_EQ(fieldOf(""), "");
    EXPECT_EQ(fieldOf("a b=1"), "a b=1");
    EXPECT_EQ(fieldOf("a,b"), "\"a,b\"");
    EXPECT_EQ(fieldOf("a\"b"), "\"a\"\"b\"");
    EXPECT_EQ(fieldOf("a\nb"), "\"a\nb\"");
}

TEST(ReadingCsv, LaserRows) {
    EXPECT_EQ(laserCsvHeader(), "sensor,frame,scan,t,beam,bearing_deg,range,x,y,z\n");
    Sensor sensor = threeBeams();
    sensor.id = "a,b";
    Scan scan = scanOf({{1, 2, 0.15}, Angle::degrees(90), {}, {}}, {0.1F, kNone, 2.5F});
    scan.frame = 3;
    scan.number = 1;
    scan.time = 0.1 + 0.2;
    std::string out = "before\n";
    appendLaserRows(out, sensor, std::span(&scan, 1), Coordinates::World);
    EXPECT_EQ(out,
              "before\n"
              "\"a,b\",3,1,0.3,0,-90,0.1,1.1,2,0.15\n"
              "\"a,b\",3,1,0.3,1,0,,,,\n"
              "\"a,b\",3,1,0.3,2,90,2.5,-1.5,2,0.15\n");
    out.clear();
    appendLaserRows(out, sensor, std::span(&scan, 1), Coordinates::Sensor);
    EXPECT_TRUE(out.starts_with("\"a,b\",3,1,0.3,0,-90,0.1,0,-0.1,0\n")) << out;
}

TEST(ReadingCsv, BeamsOfATurningLaserHaveTheirOwnTimes) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().spin = 10;
    Scan scan = scanOf({}, {1, 1, kNone});
    scan.time = 0.3;
    std::string out;
    appendLaserRows(out, sensor, std::span(&scan, 1), Coordinates::Sensor);
    EXPECT_EQ(out, "l1,0,0,0.3,0,-90,1,0,-1,0\nl1,0,0,0.325,1,0,1,1,0,0\nl1,0,0,0.35,2,90,,,,\n");
}

TEST(ReadingCsv, LongIdsFit) {
    Sensor sensor;
    sensor.id = std::string(1000, 'x');
    sensor.as<Laser>().spin = 7;
    sensor.as<Laser>().step = Angle::degrees(1.0 / 3);
    sensor.as<Laser>().beams = 500;
    std::mt19937 random(8);
    Scan scan = scanOf(randomPose(random), randomRanges(random, 500));
    scan.time = 123456.789;
    std::string out;
    appendLaserRows(out, sensor, std::span(&scan, 1), Coordinates::World);
    EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 500);
    EXPECT_EQ(std::count(out.begin(), out.end(), ','), 500 * 9);
}

TEST(ReadingCsv, RangerRows) {
    EXPECT_EQ(rangerCsvHeader(), "sensor,frame,t,column,row,depth,x,y,z\n");
    Sensor sensor = smallRanger(Projection::Pinhole, 3, 1);
    sensor.as<Ranger>().fov_x = sensor.as<Ranger>().fov_y = Angle::degrees(90);
    DepthFrame frame;
    frame.time = 0.5;
    frame.frame = 2;
    frame.pose = {{0, 0, 1}, Angle::degrees(180), {}, {}};
    frame.depths = {kNone, 3.25F, 1.5F};
    std::string out;
    appendRangerRows(out, sensor, frame, Coordinates::World);
    EXPECT_EQ(out,
              "r1,2,0.5,0,0,,,,\n"
              "r1,2,0.5,1,0,3.25,-3.25,0,1\n"
              "r1,2,0.5,2,0,1.5,-1.5,1,1\n");
}

std::vector<Sensor> fourReceivers() {
    std::vector<Sensor> receivers(4, {"", Receiver(), {}});
    for (std::size_t i = 0; i < 4; ++i) receivers[i].id = "u" + std::to_string(i + 1);
    return receivers;
}

std::string rowOf(const Burst& burst) {
    const Sensor tag{"t1", Tag(), {}};
    std::string out;
    appendBurstRow(out, tag, burst, fourReceivers());
    return out;
}

TEST(ReadingCsv, BurstRows) {
    EXPECT_EQ(ultrasoundCsvHeader(), "sensor,frame,t,x,y,z,residual,pdop,hdop,vdop,heard,times\n");
    Burst burst;
    burst.time = 0.1;
    burst.frame = 1;
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,,,,,,,,0,\n");
    burst.heard = {{0, 0.0125, 4.3}, {3, 0.01, 3.4}};
    burst.simple = Point2{1.5, -2};
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,1.5,-2,,,,,,2,u1=0.0125 u4=0.01\n");
    burst.simple.reset();
    burst.fix = Fix{{1, 2, 0.5}, 0.001, 1.5, 1.25, 0.75};
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,1,2,0.5,0.001,1.5,1.25,0.75,2,u1=0.0125 u4=0.01\n");
}

}  // namespace
}  // namespace ispace
