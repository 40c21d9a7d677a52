// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/inertia.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace ispace {

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
    Inertia reading{now.time, now.frame, now.pose, {}, {}, {}};
    const std::uint32_t carrier = carrierOf(now.sensor);
    if (carrier != MovingBodies::kNoOwner) {
        const MoverVelocity motion = now.options.velocities.of(carrier);
        reading.velocity = motion.at(now.pose.position.onFloor());
        reading.rates = inAxesOf(now.pose, {0, 0, motion.turn});
    }
    reading.accelerations = inAxesOf(now.pose, {0, 0, kGravity});
    if (!now.options.noise_seed) return reading;
    const double radian = Angle::degrees(1).radians();
    reading.rates = sum(reading.rates, radian * errorsOf(imu.gyro, imu.rate, 0, now));
    reading.accelerations = sum(reading.accelerations, errorsOf(imu.accel, imu.rate, 3, now));
    return reading;
}

void follow(const Inertia& before, Inertia& now) {
    const double passed = now.time - before.time;
    if (passed <= 0) return;
    const Vec2 mean = (1 / passed) * (now.velocity - before.velocity);
    now.accelerations = sum(now.accelerations, inAxesOf(now.pose, {mean.x, mean.y, 0}));
}

}  // namespace ispace
