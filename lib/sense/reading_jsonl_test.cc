// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/reading_jsonl.h"

#include <gtest/gtest.h>

#include <limits>

#include "sense/sample_readings.h"

namespace ispace {

namespace {

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
    appendScanLine(out, sensor, scan);
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
    appendScanLine(out, sensor, scan);
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
    appendDepthLine(out, sensor, frame);
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
    appendDepthLine(out, sensor, frame);
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
    appendBurstLine(out, tag, burst, receivers);
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
    burst.fix = Fix{{1, 2, 0.75}, 0.001, 1.5, 1.25, 0.75};
    EXPECT_EQ(burstLine(burst), begin + heard +
                                    "],\"position\":[1,2,0.75],\"residual\":0.001,\"pdop\":1.5,"
                                    "\"hdop\":1.25,\"vdop\":0.75}\n");
}

TEST(ScanJsonl, NoBeamsIsAnEmptyList) {
    std::string out;
    appendScanLine(out, {}, {});
    EXPECT_TRUE(out.ends_with("\"ranges\":[]}\n")) << out;
}

}  // namespace

}  // namespace ispace
