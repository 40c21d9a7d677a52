// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/radars/radar.h"

#include <gtest/gtest.h>

#include "extensions/radars/radars_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "support/test_sensors.h"

namespace ispace::radars {
namespace radar_test {

using testing::findings;
using testing::sensorRecord;

Radar radar(const std::string& keys) {
    const Record record = sensorRecord("radar " + keys);
    return parametersOf<Radar>(record, testing::deviceFor(record));
}

TEST(Radar, ReadsItsKeys) {
    EXPECT_EQ(radar("at=0,0"), Radar());
    const Radar read = radar(
        "range=0.3,12 fov=100,40 rate=20 detections=8 min_speed=0.2 max_speed=4 "
        "angle_resolution=15 speed_resolution=0.1 speed_sigma=0.05 sigma=0.02 resolution=0.04");
    EXPECT_EQ(read.min_range, 0.3);
    EXPECT_EQ(read.max_range, 12);
    EXPECT_EQ(read.fov_x, Angle::degrees(100));
    EXPECT_EQ(read.fov_y, Angle::degrees(40));
    EXPECT_EQ(read.rate, 20);
    EXPECT_EQ(read.detections, 8);
    EXPECT_EQ(read.min_speed, 0.2);
    EXPECT_EQ(read.max_speed, 4);
    EXPECT_EQ(read.angle_resolution, Angle::degrees(15));
    EXPECT_EQ(read.speed_resolution, 0.1);
    EXPECT_EQ(read.speed_sigma, 0.05);
    EXPECT_EQ(read.noise.sigma[0], 0.02);
    EXPECT_EQ(radar("fov=90").fov_y, Radar().fov_y);
    EXPECT_FALSE(Radar().isNoisy());
    EXPECT_TRUE(read.isNoisy());
}

TEST(Radar, RejectsContradictions) {
    EXPECT_NE(findings([] { return radar("fov=120,200"); }).find("180 degrees upright"),
              std::string::npos);
    EXPECT_NE(findings([] { return radar("min_speed=2 max_speed=1"); }).find("least speed 2"),
              std::string::npos);
    EXPECT_NE(findings([] { return radar("detections=1.5"); }).find("whole"), std::string::npos);
    EXPECT_NE(findings([] { return radar("range=5,2"); }).find("least"), std::string::npos);
}

TEST(Radar, SeesAWindowOfBearingsAndElevations) {
    const Sensor sensor{
        "w", modelOf(radar("range=9 fov=120,60")), {{1, 2, 1}, Angle::degrees(90), {}, {}}};
    const FieldOfView view = fieldOfView(sensor).value();
    const auto at = [&](double bearing, double elevation, double range) {
        return Point3{1, 2, 1} +
               range * directionOf(Angle::degrees(90 + bearing), Angle::degrees(elevation));
    };
    EXPECT_TRUE(view.holds(at(60, 0, 9)));
    EXPECT_TRUE(view.holds(at(-59, 29, 8)));
    EXPECT_FALSE(view.holds(at(60.1, 0, 5)));
    EXPECT_FALSE(view.holds(at(0, -30.1, 5)));
    EXPECT_FALSE(view.holds(at(0, 0, 9.01)));
}

TEST(Radar, ReadingsHaveTopicsOfPointsAndOfReturns) {
    const auto topics = readingKind(modelOf(Radar())).topics;
    ASSERT_EQ(topics.size(), 2U);
    EXPECT_EQ(topics[0].name, "points");
    EXPECT_EQ(topics[0].type, RosType::PointCloud2);
    EXPECT_EQ(topics[1].name, "returns");
    EXPECT_EQ(topics[1].type, RosType::RadarScan);
}

TEST(Radar, DevicesAreModulesAtSixtyGigahertz) {
    const Radar device = radar("model=iwr6843isk");
    EXPECT_EQ(device.model, "iwr6843isk");
    EXPECT_EQ(device.fov_x, Angle::degrees(120));
    EXPECT_TRUE(device.isNoisy());
    EXPECT_EQ(radar("model=iwr6843isk range=5").max_range, 5);
}

}  // namespace radar_test
}  // namespace ispace::radars
