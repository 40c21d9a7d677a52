// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/illuminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "trace/render/lights.h"

namespace ispace {

namespace {

constexpr int kAcross = 4;  // points of a panel along a side

/// Computes the illuminance by a lamp at a height.
double lightOf(const Lux::Light& light, double height, const Moment& now) {
    const Point3 spot = now.pose.position;
    const Vec3 facing = Frame3(now.pose).forward;
    std::array<Point3, std::size_t{kAcross} * kAcross> points;
    std::array<std::uint8_t, points.size()> is_free{};
    const double half = static_cast<double>(Lamps::kHalf);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const auto along = [half](std::size_t i) {
            return half * (2 * (static_cast<double>(i) + 0.5) / kAcross - 1);
        };
        points[k] = {light.at.x + along(k % kAcross), light.at.y + along(k / kAcross), height};
    }
    if (spot.z >= height) return 0;
    now.mesh().query(spot, points, is_free);
    double lux = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec3 way = points[k] - spot;
        const double distance = length(way);
        const double cosines = dot(way, facing) * way.z / (distance * distance);
        if (cosines <= 0 || is_free[k] == 0 ||
            now.bodies.between(spot, points[k], carrierOf(now.sensor)))
            continue;
        lux += cosines / (distance * distance);
    }
    return light.lumens / std::numbers::pi * lux / static_cast<double>(points.size());
}

/// Computes the illuminance by a projector, of a white picture.
double lightOf(const ProjectorBeam& beam, const Moment& now) {
    const Point3 spot = now.pose.position, lens = beam.lens.origin;
    const auto light = beam.spotAt(spot, Frame3(now.pose).forward);
    if (!light) return 0;
    std::uint8_t is_free = 0;
    now.mesh().query(spot, std::span(&lens, 1), std::span(&is_free, 1));
    const bool is_lit = is_free != 0 && !now.bodies.between(spot, lens, carrierOf(now.sensor));
    return is_lit ? light->lux : 0;
}

}  // namespace

Illuminance readingOf(const Lux& lux, const Moment& now) {
    Illuminance reading{now.time, now.frame, now.pose, 0};
    const double height = Lamps::heightIn(now.worlds.environment());
    for (const Lux::Light& light : lux.lights) reading.lux += lightOf(light, height, now);
    for (const ProjectorBeam& beam : lux.beams) reading.lux += lightOf(beam, now);
    if (now.options.noise_seed) {
        std::array<float, 1> normal{};
        RandomKey constant = now.noiseKey();
        constant.frame = 0;
        draw(constant, 0, {.normal = normal});
        reading.lux *= std::max(0.0, 1 + lux.error * static_cast<double>(normal[0]));
        if (lux.resolution > 0)
            reading.lux = lux.resolution * std::round(reading.lux / lux.resolution);
    }
    reading.lux = std::min(reading.lux, lux.max);
    return reading;
}

}  // namespace ispace
