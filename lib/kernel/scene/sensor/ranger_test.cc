// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/ranger.h"
#include "scene/sensor/sensor_keys.h"

#include <gtest/gtest.h>

#include <array>

#include "scene/sensor/ultrasound.h"
#include "support/test_sensors.h"

namespace ispace {

namespace ranger_test {

/// Reads the parameters of a record with these keys.
template <typename Parameters>
Parameters parameters(const std::string& line) {
    const Record record = testing::sensorRecord(line);
    return parametersOf<Parameters>(record, testing::deviceFor(record));
}

Ranger ranger(const std::string& keys) { return parameters<Ranger>("ranger " + keys); }

std::string rangerFindings(const std::string& keys) {
    return testing::findings([&] { return ranger(keys); });
}

TEST(RangerOf, ExplicitKeysThenTheModelThenTheBareRanger) {
    EXPECT_EQ(ranger(""), Ranger());
    const Ranger kinect = ranger("model=kinect-v1 range=6 rate=15");
    EXPECT_EQ(kinect.model, "kinect-v1");
    EXPECT_EQ(kinect.min_range, 0.8);
    EXPECT_EQ(kinect.max_range, 6);
    EXPECT_EQ(kinect.rate, 15);
    EXPECT_EQ(kinect.columns, 640);
    EXPECT_TRUE(kinect.measures_depth);
    EXPECT_EQ(ranger("model=sr-3000").ambiguity, 7.5);
    EXPECT_EQ(ranger("model=sr-3000 ambiguity=0").ambiguity, 0);
    EXPECT_EQ(ranger("sigma=0.01,0.02").noise.sigma, (std::array<double, 3>{0.01, 0.02, 0}));
    EXPECT_EQ(ranger("dropout=5%").noise.dropout, 0.05);
    EXPECT_TRUE(ranger("incidence=60,80").noise.dropsByIncidence());
}

TEST(RangerOf, OneFieldOfViewGivesSquarePixels) {
    const Ranger lens = ranger("fov=90 pixels=200,100");
    EXPECT_NEAR(lens.fx(), 100, 1e-12);
    EXPECT_NEAR(lens.fy(), 100, 1e-12);
    EXPECT_NEAR(ranger("projection=spherical fov=360 pixels=720,64").fov_y.degrees(), 32, 1e-12);
    // As the SR-3000's data agree: 200 pixels both ways.
    EXPECT_NEAR(ranger("model=sr-3000").fx(), 200, 0.1);
    EXPECT_NEAR(ranger("model=sr-3000").fy(), 200, 0.1);
}

TEST(RangerOf, ParametersThatDoNotFit) {
    EXPECT_NE(rangerFindings("range=5,4").find("least range 5 m is above"), std::string::npos);
    EXPECT_NE(rangerFindings("fov=180").find("a pinhole sees less than 180"), std::string::npos);
    EXPECT_EQ(rangerFindings("fov=180 projection=spherical"), "");
    EXPECT_NE(rangerFindings("fov=90,181 projection=spherical").find("upright"), std::string::npos);
    EXPECT_NE(rangerFindings("pixels=16384,16384").find("pixels, at most"), std::string::npos);
    EXPECT_NE(rangerFindings("range=2,5 ambiguity=2").find("not below the ambiguity"),
              std::string::npos);
    EXPECT_EQ(rangerFindings("range=1.9,5 ambiguity=2"), "");
    EXPECT_NE(rangerFindings("projection=spherical measures=depth"), "");
    EXPECT_NE(rangerFindings("sigma=-0.1").find("below 0"), std::string::npos);
    EXPECT_EQ(rangerFindings("sigma=0.1,-0.1"), "");
    EXPECT_NE(rangerFindings("incidence=80,60"), "");
}

TEST(Ranger, PixelsLookWhereTheHeaderSays) {
    const Ranger lens = ranger("fov=90 pixels=3,3");
    EXPECT_EQ(lens.ray(1, 1), (Vec3{1, 0, 0}));
    EXPECT_GT(lens.ray(0, 1).y, 0) << "the first column is on the left";
    EXPECT_GT(lens.ray(1, 0).z, 0) << "the first row is at the top";
    EXPECT_NEAR(lens.ray(-0.5, 1).y, 1, 1e-12) << "the edge of the picture";
    const Ranger ball = ranger("model=vlp-16");
    EXPECT_NEAR(ball.elevation(0).degrees(), 15, 1e-12);
    EXPECT_NEAR(ball.elevation(15).degrees(), -15, 1e-12);
    EXPECT_NEAR(ball.bearing(0).degrees(), 179.9, 1e-12);
    EXPECT_NEAR(length(ball.ray(123, 4)), 1, 1e-12);
}

TEST(UltrasoundOf, ReceiversAndTags) {
    const auto receiver = [](const std::string& keys) {
        return parameters<Receiver>("ultrasound " + keys);
    };
    EXPECT_EQ(receiver(""), Receiver());
    EXPECT_EQ(receiver("model=zps-3d").rate, 20);
    EXPECT_EQ(receiver("range=0.2,4").min_range, 0.2);
    EXPECT_NE(testing::findings([&] { return receiver("range=4,1"); }), "");
    const auto tag = [](const std::string& keys) { return parameters<Tag>("tag " + keys); };
    EXPECT_EQ(tag(""), Tag());
    EXPECT_FALSE(tag("model=zps-3d-tag").is_simple);
    EXPECT_TRUE(tag("locate=simple sigma=0.2").is_simple);
    EXPECT_EQ(tag("locate=simple sigma=0.2").simple_sigma, 0.2);
    EXPECT_EQ(tag("").simple_sigma, 0.1) << "as the thesis has it";
}

}  // namespace ranger_test

}  // namespace ispace
