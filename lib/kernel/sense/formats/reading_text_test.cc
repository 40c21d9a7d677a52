// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/reading_text.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <limits>
#include <numbers>
#include <sstream>

#include "support/test_readings.h"

namespace ispace {

namespace reading_text_test {

TEST(ScanJsonl, HeaderLine) {
    EXPECT_EQ(scanHeaderLine({}, 0), "{\"schema\":\"ispace-scan/1\",\"history\":[],\"seed\":0}\n");
    EXPECT_EQ(scanHeaderLine({"arrange room.glb", "scan - \"x\""}, 18446744073709551615ULL),
              "{\"schema\":\"ispace-scan/1\",\"history\":[\"arrange room.glb\","
              "\"scan - \\\"x\\\"\"],\"seed\":18446744073709551615}\n");
}

TEST(ScanJsonl, ScanLine) {
    Sensor sensor;
    sensor.id = "l\"1";
    sensor.as<Laser>().min_range = 0.06;
    sensor.as<Laser>().max_range = 4.095;
    sensor.as<Laser>().beams = 3;
    Scan scan;
    scan.pose = {{1, -2.5, 0.15}, Angle::degrees(180), {}, {}};
    scan.time = 0.25;
    scan.frame = 7;
    scan.ranges = {0.1F, std::numeric_limits<float>::infinity(), 4.095F};
    std::string out = "before\n";
    appendLine(out, viewOf(sensor, scan));
    EXPECT_EQ(out,
              "before\n{\"sensor\":\"l\\\"1\",\"t\":0.25,\"frame\":7,"
              "\"pose\":[1,-2.5,0.15,3.141592653589793,0,0],"
              "\"angle_min\":-1.5707963267948966,\"angle_max\":-1.53588974175501,"
              "\"angle_increment\":0.017453292519943295,"
              "\"range_min\":0.06,\"range_max\":4.095,\"ranges\":[0.1,null,4.095]}\n");
}

TEST(ScanJsonl, ScansOfASweepAreNumbered) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().sweep = SweepAxis::Tilt;
    Scan scan = scanOf({}, {kNone, -0.0F, 1});
    scan.frame = 2;
    scan.number = 5;
    std::string out;
    appendLine(out, viewOf(sensor, scan));
    EXPECT_NE(out.find("\"frame\":2,\"scan\":5,\"pose\""), std::string::npos) << out;
    EXPECT_TRUE(out.ends_with("\"ranges\":[null,0,1]}\n")) << out;
}

TEST(DepthJsonl, Pinhole) {
    Sensor sensor = smallRanger(Projection::Pinhole, 2, 1);
    sensor.as<Ranger>().fov_x = sensor.as<Ranger>().fov_y = Angle::degrees(90);
    sensor.as<Ranger>().min_range = 0.5;
    DepthFrame frame;
    frame.time = 0.04;
    frame.frame = 1;
    frame.depths = {1.25F, kNone};
    std::string out = "before\n";
    appendLine(out, viewOf(sensor, frame));
    EXPECT_EQ(out,
              "before\n{\"sensor\":\"r1\",\"t\":0.04,\"frame\":1,\"pose\":[0,0,0,0,0,0],"
              "\"width\":2,\"height\":1,\"projection\":\"pinhole\",\"fx\":1,\"fy\":0.5,"
              "\"cx\":0.5,\"cy\":0,\"measures\":\"distance\",\"range_min\":0.5,\"range_max\":5,"
              "\"depths\":[1.25,null]}\n");
}

TEST(DepthJsonl, Spherical) {
    Sensor sensor = smallRanger(Projection::Spherical, 1, 1);
    sensor.as<Ranger>().fov_x = Angle::degrees(360);
    sensor.as<Ranger>().fov_y = Angle::degrees(90);
    DepthFrame frame;
    frame.depths = {2};
    std::string out;
    appendLine(out, viewOf(sensor, frame));
    EXPECT_NE(out.find("\"projection\":\"spherical\",\"fov\":[6.283185307179586,"
                       "1.5707963267948966],\"measures\":\"distance\",\"range_min\":0,\"range_"
                       "max\":5,\"depths\":[2]}"),
              std::string::npos)
        << out;
}

std::string burstLine(const Burst& burst) {
    const Sensor tag{"t1", Tag(), {}};
    const std::vector<Sensor> receivers = {{"u1", Receiver(), {}}, {"u2", Receiver(), {}}};
    std::string out;
    appendLine(out, viewOf(tag, burst, receivers));
    return out;
}

TEST(BurstJsonl, WithAndWithoutAPlace) {
    Burst burst;
    burst.time = 0.1;
    burst.frame = 1;
    burst.pose.position = {1, 2, 0.5};
    const std::string begin =
        "{\"sensor\":\"t1\",\"t\":0.1,\"frame\":1,\"pose\":[1,2,0.5,0,0,0],\"heard\":[";
    EXPECT_EQ(burstLine(burst),
              begin +
                  "],\"position\":null,\"residual\":null,\"pdop\":null,\"hdop\":null,"
                  "\"vdop\":null}\n");
    burst.heard = {{1, 0.0125, 4.25}, {0, 0.01, 3.5}};
    const std::string heard =
        "{\"receiver\":\"u2\",\"time_of_flight\":0.0125,\"range\":4.25},"
        "{\"receiver\":\"u1\",\"time_of_flight\":0.01,\"range\":3.5}";
    burst.simple = Point2{1.25, 2};
    EXPECT_EQ(burstLine(burst), begin + heard +
                                    "],\"position\":[1.25,2],\"residual\":null,\"pdop\":null,"
                                    "\"hdop\":null,\"vdop\":null}\n");
    burst.simple.reset();
    burst.fix = PositionFix{{1, 2, 0.75}, 0.001, 1.5, 1.25, 0.75};
    EXPECT_EQ(burstLine(burst), begin + heard +
                                    "],\"position\":[1,2,0.75],\"residual\":0.001,\"pdop\":1.5,"
                                    "\"hdop\":1.25,\"vdop\":0.75}\n");
}

TEST(ScanJsonl, NoBeamsIsAnEmptyList) {
    std::string out;
    appendLine(out, viewOf(Sensor(), Scan()));
    EXPECT_TRUE(out.ends_with("\"ranges\":[]}\n")) << out;
}

}  // namespace reading_text_test

namespace reading_text_test {

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
    Sensor sensor = threeBeams();
    EXPECT_EQ(csvHeader(sensor), "sensor,frame,scan,t,beam,bearing_deg,range,x,y,z\n");
    sensor.id = "a,b";
    Scan scan = scanOf({{1, 2, 0.15}, Angle::degrees(90), {}, {}}, {0.1F, kNone, 2.5F});
    scan.frame = 3;
    scan.number = 1;
    scan.time = 0.1 + 0.2;
    std::string out = "before\n";
    appendRows(out, sensor, std::vector{scan}, Coordinates::World);
    EXPECT_EQ(out,
              "before\n"
              "\"a,b\",3,1,0.3,0,-90,0.1,1.1,2,0.15\n"
              "\"a,b\",3,1,0.3,1,0,,,,\n"
              "\"a,b\",3,1,0.3,2,90,2.5,-1.5,2,0.15\n");
    out.clear();
    appendRows(out, sensor, std::vector{scan}, Coordinates::Sensor);
    EXPECT_TRUE(out.starts_with("\"a,b\",3,1,0.3,0,-90,0.1,0,-0.1,0\n")) << out;
}

TEST(ReadingCsv, BeamsOfATurningLaserHaveTheirOwnTimes) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().spin = 10;
    Scan scan = scanOf({}, {1, 1, kNone});
    scan.time = 0.3;
    std::string out;
    appendRows(out, sensor, std::vector{scan}, Coordinates::Sensor);
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
    appendRows(out, sensor, std::vector{scan}, Coordinates::World);
    EXPECT_EQ(std::count(out.begin(), out.end(), '\n'), 500);
    EXPECT_EQ(std::count(out.begin(), out.end(), ','), 500 * 9);
}

TEST(ReadingCsv, RangerRows) {
    Sensor sensor = smallRanger(Projection::Pinhole, 3, 1);
    EXPECT_EQ(csvHeader(sensor), "sensor,frame,t,column,row,depth,x,y,z\n");
    sensor.as<Ranger>().fov_x = sensor.as<Ranger>().fov_y = Angle::degrees(90);
    DepthFrame frame;
    frame.time = 0.5;
    frame.frame = 2;
    frame.pose = {{0, 0, 1}, Angle::degrees(180), {}, {}};
    frame.depths = {kNone, 3.25F, 1.5F};
    std::string out;
    appendRows(out, sensor, frame, Coordinates::World);
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
    appendRows(out, tag, burst, Coordinates::World, fourReceivers());
    return out;
}

TEST(ReadingCsv, BurstRows) {
    EXPECT_EQ(csvHeader({"t1", Tag(), {}}),
              "sensor,frame,t,x,y,z,residual,pdop,hdop,vdop,heard,times\n");
    Burst burst;
    burst.time = 0.1;
    burst.frame = 1;
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,,,,,,,,0,\n");
    burst.heard = {{0, 0.0125, 4.3}, {3, 0.01, 3.4}};
    burst.simple = Point2{1.5, -2};
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,1.5,-2,,,,,,2,u1=0.0125 u4=0.01\n");
    burst.simple.reset();
    burst.fix = PositionFix{{1, 2, 0.5}, 0.001, 1.5, 1.25, 0.75};
    EXPECT_EQ(rowOf(burst), "t1,1,0.1,1,2,0.5,0.001,1.5,1.25,0.75,2,u1=0.0125 u4=0.01\n");
}

}  // namespace reading_text_test

namespace reading_text_test {

TEST(CarmenLog, HeaderIsComments) {
    std::istringstream lines(carmenHeader());
    int count = 0;
    for (std::string line; std::getline(lines, line); ++count)
        EXPECT_TRUE(line.starts_with("# ")) << line;
    EXPECT_GT(count, 2);
    EXPECT_TRUE(carmenHeader().ends_with('\n'));
}

TEST(CarmenLog, FieldsInOrder) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().noise.sigma[0] = 0.01;
    Scan scan = scanOf({{1, -2, 0.15}, Angle::degrees(180), {}, {}}, {0.1F, kNone, 3.999F});
    scan.time = 0.25;
    std::string out = "before\n";
    appendCarmenLine(out, 1, sensor, scan, {{0.5, -2}, Angle::degrees(-180)});
    EXPECT_EQ(out,
              "before\nROBOTLASER1 3 -1.5707963267948966 3.141592653589793 1.5707963267948966 4 "
              "0.01 0 3 0.1 4 3.999 0 1 -2 3.141592653589793 0.5 -2 3.141592653589793 "
              "0 0 0 0 0 0.25 sim 0.25\n");
}

/// What a reader makes of the line: where a beam points, if the scan begins at start_angle, and if
/// it is taken for one about the laser's heading.
struct Beam {
    double by_start, by_fov;
};
Beam beamOf(const Sensor& sensor, const Scan& scan, int beam) {
    std::string line;
    appendCarmenLine(line, 1, sensor, scan, {});
    std::istringstream words(line);
    std::string name;
    int type = 0, mode = 0;
    std::size_t count = 0, remissions = 1;
    double start = 0, fov = 0, step = 0, limit = 0, accuracy = 0, range = 0, x = 0, y = 0,
           theta = 0;
    words >> name >> type >> start >> fov >> step >> limit >> accuracy >> mode >> count;
    for (std::size_t i = 0; i < count; ++i) words >> range;
    words >> remissions >> x >> y >> theta;
    EXPECT_EQ(remissions, 0U);
    return {theta + start + beam * step,
            theta - fov / 2 + beam * fov / static_cast<double>(count - 1)};
}

TEST(CarmenLog, ReadersAgreeOnBeamsOfAFanThatIsNotSymmetric) {
    Sensor sensor;
    Laser& laser = sensor.as<Laser>();
    laser.step = Angle::degrees(360.0 / 1024);
    laser.first = (44.0 - 384) * laser.step;
    laser.beams = 682;
    const Scan scan = scanOf({{}, Angle::degrees(30), {}, {}}, std::vector<float>(682, 1));
    for (const int beam : {0, 340, 681}) {
        const double wanted = (Angle::degrees(30) + laser.bearing(beam)).radians();
        const Beam seen = beamOf(sensor, scan, beam);
        EXPECT_NEAR(seen.by_start, wanted, 1e-12);
        EXPECT_NEAR(seen.by_fov, wanted, 1e-12);
    }
    // All around from bearing 0.
    laser.first = {};
    laser.step = Angle::degrees(1);
    laser.beams = 360;
    const Scan around = scanOf({}, std::vector<float>(360, 1));
    EXPECT_NEAR(beamOf(sensor, around, 90).by_fov, std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(beamOf(sensor, around, 90).by_start, std::numbers::pi / 2, 1e-12);
}

}  // namespace reading_text_test

}  // namespace ispace
