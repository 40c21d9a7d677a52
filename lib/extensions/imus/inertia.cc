// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/imus/inertia.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ispace::imus {

namespace {

constexpr double kGravity = 9.80665;

Vec3 sum(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

/// Expresses a vector of the room in the axes of a pose.
Vec3 inAxesOf(const Pose3& pose, Vec3 vector) {
    const Frame3 axes(pose);
    return {dot(vector, axes.forward), dot(vector, axes.left), dot(vector, axes.up)};
}

/// Draws the errors of three axes: `first` is the number of the first in a sequence.
Vec3 errorsOf(const InertialNoise& noise, double rate, std::uint32_t first, const Moment& now) {
    std::array<float, 3> bias{}, white{};
    RandomKey constant = now.noiseKey(1);
    constant.frame = 0;
    draw(constant, first, {.normal = bias});
    draw(now.noiseKey(2), first, {.normal = white});
    const double sigma = noise.density * std::sqrt(rate / 2);
    const auto error = [&](std::size_t k) {
        return noise.bias * static_cast<double>(bias[k]) + sigma * static_cast<double>(white[k]);
    };
    return {error(0), error(1), error(2)};
}

}  // namespace

Inertia readingOf(const Imu& imu, const Moment& now) {
    Inertia reading;
    const std::uint32_t carrier = carrierOf(now.sensor);
    if (carrier != MovingBodies::kNoOwner)
        reading.rates =
            inAxesOf(now.pose, {0, 0, now.mean ? 0 : now.options.velocities.of(carrier).turn});
    reading.accelerations = inAxesOf(now.pose, {0, 0, kGravity});
    if (now.options.noise_seed) {
        const double radian = Angle::degrees(1).radians();
        reading.rates = sum(reading.rates, radian * errorsOf(imu.gyro, imu.rate, 0, now));
        reading.accelerations = sum(reading.accelerations, errorsOf(imu.accel, imu.rate, 3, now));
    }
    if (!now.mean) return reading;
    const Vec2 gained = now.mean->acceleration;
    reading.rates = sum(reading.rates, inAxesOf(now.pose, {0, 0, now.mean->turn}));
    reading.accelerations = sum(reading.accelerations, inAxesOf(now.pose, {gained.x, gained.y, 0}));
    return reading;
}

}  // namespace ispace::imus
