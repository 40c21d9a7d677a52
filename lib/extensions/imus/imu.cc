// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/imus/imu.h"

#include "base/number.h"
#include "extensions/imus/inertia.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace::imus {

Imu withParameters(Imu base, const Record& record) {
    if (record.has("gyro_bias")) base.gyro.bias = record.number("gyro_bias");
    if (record.has("gyro_noise")) base.gyro.density = record.number("gyro_noise");
    if (record.has("accel_bias")) base.accel.bias = record.number("accel_bias");
    if (record.has("accel_noise")) base.accel.density = record.number("accel_noise");
    if (record.has("rate")) base.rate = record.number("rate");
    return base;
}

namespace {

void addImuKeys(std::vector<KeySpec>& keys) {
    constexpr double kMaxError = 1e4;
    const auto error = [&keys](std::string name, std::string help) {
        keys.push_back({.name = std::move(name),
                        .type = KeyType::Number,
                        .help = std::move(help),
                        .lower = 0,
                        .upper = kMaxError});
    };
    error("gyro_bias", "spread of the constant error of a rate, degrees a second, with --noise");
    error("gyro_noise", "density of its white noise, degrees a second and square root of Hz");
    error("accel_bias", "the same of an acceleration, metres a second a second");
    error("accel_noise", "the same, metres a second a second and square root of Hz");
    keys.push_back(positiveKey("rate", Unit::Frequency, "readings a second", kMaxRate));
}

std::vector<Mesh> imuBody() {
    Mesh box{Material::Sensor, {}, {}};
    addBox(box, {-0.02, -0.015, -0.005}, {0.02, 0.015, 0.005});
    return {std::move(box)};
}

}  // namespace

const SensorKind Imu::kKind = {
    .keyword = "imu",
    .noun = "IMU",
    .help =
        "inertial measurement unit, which reports the rates of turning and the accelerations of "
        "its carrier; bare: rate=100, without noise",
    .heading_help = "direction of its x axis, from +x",
    .device_help = "an inertial measurement unit one can buy",
    .sign = SensorSign::Square,
    .add_keys = addImuKeys,
    .body = imuBody,
    .read = readModel<Imu>,
    .summary = [](const SensorModel& model) -> DeviceSummary {
        return {"-", "-", "-", formatDouble(tryModel<Imu>(model)->rate)};
    },
    .bearings = [](const SensorModel& /*model*/) { return BearingSpan{}; },
    .perceives = false,
    .is_read = true,
    .integrates = true,
    .measure = measureBy<Imu>,
    .reading = &Inertia::kKind};

void addImus() { addSensorKind(Imu::kKind); }

}  // namespace ispace::imus
