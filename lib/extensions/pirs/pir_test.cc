// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/pirs/pir.h"

#include <gtest/gtest.h>

#include "extensions/pirs/pirs_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/motion_sense.h"
#include "support/test_sensors.h"

namespace ispace::pirs {
namespace pir_test {

using testing::findings;
using testing::sensorRecord;

Pir pir(const std::string& keys) {
    const Record record = sensorRecord("pir " + keys);
    return parametersOf<Pir>(record, testing::deviceFor(record));
}

TEST(Pir, ReadsItsKeys) {
    EXPECT_EQ(pir("at=0,0"), Pir());
    const Pir read =
        pir("range=0.3,12 fov=100,40 rate=20 hold=5min min_speed=0.2 dropout=10% false_alarms=3");
    EXPECT_EQ(read.min_range, 0.3);
    EXPECT_EQ(read.max_range, 12);
    EXPECT_EQ(read.fov_x, Angle::degrees(100));
    EXPECT_EQ(read.fov_y, Angle::degrees(40));
    EXPECT_EQ(read.rate, 20);
    EXPECT_EQ(read.hold, 300);
    EXPECT_EQ(read.min_speed, 0.2);
    EXPECT_EQ(read.dropout, 0.1);
    EXPECT_EQ(read.false_alarms, 3);
    EXPECT_EQ(pir("fov=90").fov_y, Pir().fov_y);
    EXPECT_FALSE(Pir().isNoisy());
    EXPECT_TRUE(read.isNoisy());
}

TEST(Pir, SensesMotionInAnyDirection) {
    const SensorModel model = modelOf(pir("min_speed=0.5"));
    ASSERT_TRUE(detectsMotion(model));
    for (const Vec2 velocity : {Vec2{0.6, 0}, Vec2{0, -0.6}})
        EXPECT_TRUE(detects(model, velocity, {1, 0, 0}));
    EXPECT_FALSE(detects(model, {0.3, 0.3}, {1, 0, 0}));
}

TEST(Pir, RejectsContradictions) {
    EXPECT_NE(findings([] { return pir("fov=120,200"); }).find("180 degrees upright"),
              std::string::npos);
    EXPECT_NE(findings([] { return pir("hold=-1"); }).find("hold"), std::string::npos);
    EXPECT_NE(findings([] { return pir("range=5,2"); }).find("least"), std::string::npos);
}

TEST(Pir, DevicesHoldTheirOutput) {
    const Pir device = pir("model=hc-sr501");
    EXPECT_EQ(device.max_range, 7);
    EXPECT_EQ(device.hold, 3);
    EXPECT_TRUE(device.isNoisy());
    EXPECT_EQ(pir("model=hc-sr501 hold=60").hold, 60);
}

}  // namespace pir_test
}  // namespace ispace::pirs
