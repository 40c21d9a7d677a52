// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/imus/inertia.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "extensions/imus/imus_test.h"
#include "scene/sensor/sensor_keys.h"
#include "sense/formats/reading_fields.h"
#include "support/test_readings.h"

namespace ispace::imus {
namespace inertia_test {

constexpr double kGravity = 9.80665;

/// Reads an IMU on a robot that moves.
Inertia inertiaOf(const std::string& keys, const MoverVelocity& motion, TakerOptions options = {},
                  int frame = 0) {
    const Scene scene = testing::scene("ispace size=12,12\n",
                                       "imu " + keys + " on=r1\nrobot id=r1 at=1,2 heading=90\n");
    options.velocities.robots = {motion};
    return std::get<AddedReading>(testing::readings(scene, options, frame).front()).as<Inertia>();
}

void expectNear(Vec3 a, Vec3 b) {
    EXPECT_NEAR(a.x, b.x, 1e-12);
    EXPECT_NEAR(a.y, b.y, 1e-12);
    EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(Inertia, AtRestIsGravityAlone) {
    const Inertia level = inertiaOf("at=0,0", {});
    EXPECT_EQ(level.rates, Vec3());
    expectNear(level.accelerations, {0, 0, kGravity});
    expectNear(inertiaOf("at=0,0 tilt=90", {}).accelerations, {kGravity, 0, 0});
    expectNear(inertiaOf("at=0,0 tilt=30", {}).accelerations,
               {kGravity / 2, 0, kGravity * std::sqrt(0.75)});
}

TEST(Inertia, TellsRatesInItsOwnAxes) {
    const MoverVelocity turning{{1, 2}, {}, 0.5};
    expectNear(inertiaOf("at=0,0", turning).rates, {0, 0, 0.5});
    expectNear(inertiaOf("at=0,0 tilt=90", turning).rates, {0.5, 0, 0});
}

TEST(Inertia, HasATopic) {
    const auto topics = readingKind(modelOf(Imu())).topics;
    ASSERT_EQ(topics.size(), 1U);
    EXPECT_EQ(topics[0].name, "imu");
    EXPECT_EQ(topics[0].type, RosType::Imu);
}

TEST(Inertia, HasConstantErrorsAndWhiteNoise) {
    const auto noisy = [](const std::string& keys, std::uint64_t seed, int frame) {
        return inertiaOf("at=0,0 rate=50 " + keys, {}, {.noise_seed = seed}, frame);
    };
    const Inertia first = noisy("gyro_bias=2 accel_bias=0.3", 4, 0);
    EXPECT_EQ(first.rates, noisy("gyro_bias=2 accel_bias=0.3", 4, 9).rates);
    EXPECT_EQ(first.accelerations, noisy("gyro_bias=2 accel_bias=0.3", 4, 9).accelerations);
    EXPECT_NE(first.rates.x, first.rates.y);
    EXPECT_NE(first.rates, noisy("gyro_bias=2 accel_bias=0.3", 5, 0).rates);
    double squares = 0, biases = 0;
    constexpr int kFrames = 400;
    for (int frame = 0; frame < kFrames; ++frame) {
        const double rate = noisy("gyro_noise=0.1", 4, frame).rates.z;
        squares += std::pow(Angle::radians(rate).degrees(), 2);
        const auto seed = static_cast<std::uint64_t>(frame);
        biases += std::pow(noisy("accel_bias=0.3", seed, 0).accelerations.x, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / kFrames), 0.1 * std::sqrt(25.0), 5 * 0.018);
    EXPECT_NEAR(std::sqrt(biases / kFrames), 0.3, 5 * 0.011);
}

TEST(Imu, ReadsItsKeys) {
    const auto read = [](const std::string& keys) {
        const Record record = testing::sensorRecord("imu " + keys);
        return parametersOf<Imu>(record, testing::deviceFor(record));
    };
    EXPECT_EQ(read(""), Imu());
    EXPECT_FALSE(Imu().isNoisy());
    const Imu imu = read("gyro_bias=1 gyro_noise=0.01 accel_bias=0.2 accel_noise=0.002 rate=200");
    EXPECT_EQ(imu.gyro, (InertialNoise{1, 0.01}));
    EXPECT_EQ(imu.accel, (InertialNoise{0.2, 0.002}));
    EXPECT_EQ(imu.rate, 200);
    EXPECT_EQ(read("model=mpu-6050").gyro.density, 0.005);
}

}  // namespace inertia_test
}  // namespace ispace::imus
