// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/luxes/illuminance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "trace/render/lights.h"

namespace ispace::luxes {

namespace {

constexpr int kAcross = 4;  // points of a panel along a side, for shadows

/// Returns the part of a polygon on the front side of the plane through the origin with this
/// normal.
std::vector<Vec3> inFront(std::span<const Vec3> polygon, Vec3 normal) {
    std::vector<Vec3> part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double before = dot(a, normal), after = dot(b, normal);
        if (before >= 0) part.push_back(a);
        if ((before < 0) == (after < 0)) continue;
        const double share = before / (before - after);
        part.push_back(
            {std::lerp(a.x, b.x, share), std::lerp(a.y, b.y, share), std::lerp(a.z, b.z, share)});
    }
    return part;
}

/// Integrates the cosine to a normal over the directions of a polygon that is in front of the
/// origin, by its contour: J. H. Lambert, Photometria, 1760; D. R. Baum et al., Improving Radiosity
/// Solutions Through the Use of Analytically Determined Form-Factors, 1989. Corners run either way.
double projectedSolidAngle(std::span<const Vec3> polygon, Vec3 normal) {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const Vec3 across = cross(a, b);
        const double sine = length(across);
        if (sine > 0) sum += std::atan2(sine, dot(a, b)) / sine * dot(across, normal);
    }
    return std::abs(sum) / 2;
}

/// Returns a point of a panel: from its centre along its sides, -1 to 1 each.
Point2 pointOf(const Lux::Light& light, double along, double across) {
    const double half = static_cast<double>(Lamps::kHalf);
    return light.at + half * (along * light.along + across * perpendicular(light.along));
}

/// Computes the share of the light of a panel that no body holds back.
double visibleShare(const Lux::Light& light, double height, const Moment& now) {
    const Point3 spot = now.pose.position;
    const Vec3 facing = Frame3(now.pose).forward;
    std::array<Point3, std::size_t{kAcross} * kAcross> points;
    std::array<std::uint8_t, points.size()> is_free{};
    const auto share = [](std::size_t i) {
        return 2 * (static_cast<double>(i) + 0.5) / kAcross - 1;
    };
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Point2 at = pointOf(light, share(k % kAcross), share(k / kAcross));
        points[k] = {at.x, at.y, height};
    }
    now.mesh().query(spot, points, is_free);
    double seen = 0, all = 0, free = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec3 way = points[k] - spot;
        const double square = dot(way, way);
        const double light_of_part = std::max(0.0, dot(way, facing)) * way.z / (square * square);
        const bool is_seen =
            is_free[k] != 0 && !now.bodies.between(spot, points[k], carrierOf(now.sensor));
        all += light_of_part;
        if (!is_seen) continue;
        seen += light_of_part;
        free += 1;
    }
    // Only an edge of the panel may be in front of the spot.
    return all > 0 ? seen / all : free / static_cast<double>(points.size());
}

/// Computes the illuminance by a lamp at a height.
double lightOf(const Lux::Light& light, double height, const Moment& now) {
    const Point3 spot = now.pose.position;
    if (spot.z >= height) return 0;
    const auto corner = [&](double along, double across) {
        const Point2 at = pointOf(light, along, across);
        return Point3{at.x, at.y, height} - spot;
    };
    const std::array<Vec3, 4> corners = {corner(-1, -1), corner(1, -1), corner(1, 1),
                                         corner(-1, 1)};
    const Vec3 facing = Frame3(now.pose).forward;
    const double angle = projectedSolidAngle(inFront(corners, facing), facing);
    if (angle == 0) return 0;
    const double side = 2 * static_cast<double>(Lamps::kHalf);
    const double radiance = light.lumens / (std::numbers::pi * side * side);
    return radiance * angle * visibleShare(light, height, now);
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
    Illuminance reading;
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

}  // namespace ispace::luxes
