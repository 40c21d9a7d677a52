// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan_jsonl.h"

#include <gtest/gtest.h>

#include <limits>

namespace ispace {

namespace {

TEST(ScanJsonl, HeaderLine) {
    EXPECT_EQ(scanHeaderLine({}, 0), "{\"schema\":\"ispace-scan/1\",\"history\":[],\"seed\":0}\n");
    EXPECT_EQ(scanHeaderLine({"arrange room.glb", "scan - \"x\""}, 18446744073709551615ULL),
              "{\"schema\":\"ispace-scan/1\",\"history\":[\"arrange room.glb\","
              "\"scan - \\\"x\\\"\"],\"seed\":18446744073709551615}\n");
}

TEST(ScanJsonl, ScanLine) {
    PlacedLaser sensor;
    sensor.id = "l\"1";
    sensor.laser.min_range = 0.06;
    sensor.laser.max_range = 4.095;
    sensor.laser.beams = 3;
    sensor.pose = {{1, -2.5, 0.15}, Angle::degrees(180), {}, {}};
    Scan scan;
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

TEST(ScanJsonl, NoBeamsIsAnEmptyList) {
    std::string out;
    appendScanLine(out, {}, {});
    EXPECT_TRUE(out.ends_with("\"ranges\":[]}\n")) << out;
}

}  // namespace

}  // namespace ispace
