// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/views.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ispace {

namespace {

/// Patches are bent at least this finely.
constexpr double kBend = 5;  // degrees

int piecesOf(Angle span) {
    return std::clamp(static_cast<int>(std::ceil(std::fabs(span.degrees()) / kBend)), 1, 72);
}

Vec3 directionOf(Angle bearing, Angle elevation) {
    const auto [cb, sb] = cosSin(bearing);
    const auto [ce, se] = cosSin(elevation);
    return {cb * ce, sb * ce, se};
}

/// A surface over steps u and v of a sheet, place(u, v) in 0..columns, 0..rows.
template <typename Place>
void addSheet(Mesh& mesh, int columns, int rows, Place place) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int v = 0; v <= rows; ++v)
        for (int u = 0; u <= columns; ++u)
            mesh.vertices.push_back(
                Point3{} + place(static_cast<double>(u) / columns, static_cast<double>(v) / rows));
    const auto stride = static_cast<std::uint32_t>(columns) + 1;
    for (std::uint32_t v = 0; v < static_cast<std::uint32_t>(rows); ++v)
        for (std::uint32_t u = 0; u + 1 < stride; ++u) {
            const std::uint32_t a = first + v * stride + u, b = a + stride;
            mesh.triangles.push_back({a, a + 1, b + 1});
            mesh.triangles.push_back({a, b + 1, b});
        }
}

struct Limits {
    double near, far;
};

Mesh fanOf(const Laser& laser, Limits limits) {
    Mesh mesh{Material::View, {}, {}, true};
    const Angle span = laser.span();
    addSheet(mesh, piecesOf(span), 1, [&](double u, double v) {
        return (limits.near + v * (limits.far - limits.near)) *
               directionOf(laser.first + u * span, {});
    });
    return mesh;
}

/// The ends of all beams of a sweep, in the frame of its first scan.
Mesh sweptOf(const PlacedLaser& sensor, Limits limits) {
    const Laser& laser = sensor.laser;
    Mesh mesh{Material::View, {}, {}, true};
    const Angle span = laser.span();
    const Frame3 frame(sensor.pose);
    addSheet(mesh, piecesOf(span), piecesOf(laser.sweep_span), [&](double u, double v) {
        const double scans = v * (laser.sweep_span.degrees() / laser.sweep_step.degrees());
        const Pose3 pose = sweptPose(laser, sensor.pose, scans);
        return limits.far * frame.toLocal(frame.origin + pose.beam(laser.first + u * span));
    });
    return mesh;
}

/// A ray of a ranger through the edge of its picture: -1..1 across and upright.
Vec3 edgeRay(const Ranger& ranger, double across, double upright) {
    if (ranger.projection == Projection::Spherical)
        return directionOf(-0.5 * across * ranger.fov_x, 0.5 * upright * ranger.fov_y);
    return {1, -across * tan(0.5 * ranger.fov_x), upright * tan(0.5 * ranger.fov_y)};
}

Mesh frustumOf(const Ranger& ranger, Limits limits) {
    Mesh mesh{Material::View, {}, {}, true};
    const bool is_bent = ranger.projection == Projection::Spherical || !ranger.measures_depth;
    const auto at = [&](double across, double upright, double range) {
        const Vec3 ray = edgeRay(ranger, across, upright);
        return (is_bent ? range / length(ray) : range) * ray;
    };
    const int columns = piecesOf(ranger.fov_x), rows = piecesOf(ranger.fov_y);
    const double deep = limits.far - limits.near;
    addSheet(mesh, columns, rows,
             [&](double u, double v) { return at(2 * u - 1, 2 * v - 1, limits.far); });
    for (const double side : {-1.0, 1.0}) {
        addSheet(mesh, columns, 1,
                 [&](double u, double v) { return at(2 * u - 1, side, limits.near + v * deep); });
        const bool closed =
            ranger.projection == Projection::Spherical && ranger.fov_x >= Angle::degrees(360);
        if (closed) continue;
        addSheet(mesh, rows, 1,
                 [&](double u, double v) { return at(side, 2 * u - 1, limits.near + v * deep); });
    }
    return mesh;
}

Mesh coneOf(const Receiver& receiver, Limits limits) {
    Mesh mesh{Material::View, {}, {}, true};
    const Angle half = 0.5 * receiver.fov, turn = Angle::degrees(360);
    const auto at = [&](Angle off, Angle around, double range) {
        const auto [c, s] = cosSin(off);
        const auto [ca, sa] = cosSin(around);
        return range * Vec3{c, s * ca, s * sa};
    };
    const int around = piecesOf(turn);
    if (half < Angle::degrees(180))
        addSheet(mesh, around, 1, [&](double u, double v) {
            return at(half, u * turn, limits.near + v * (limits.far - limits.near));
        });
    addSheet(mesh, around, piecesOf(half),
             [&](double u, double v) { return at(v * half, u * turn, limits.far); });
    return mesh;
}

}  // namespace

std::optional<Mesh> viewOf(const Scene& scene, const Placed& placed) {
    const Box2 plan = scene.environment.limits();
    const double widest = plan.empty() ? 1 : std::max(plan.width(), plan.depth());
    const auto limits = [widest](double least, double greatest) {
        return Limits{std::min(least, widest), std::min(greatest, widest)};
    };
    const std::string& keyword = scene.records[placed.record].keyword();
    if (keyword == "laser") {
        const PlacedLaser& sensor = scene.lasers[placed.index];
        const Limits range = limits(sensor.laser.min_range, sensor.laser.max_range);
        return sensor.laser.sweep == SweepAxis::None ? fanOf(sensor.laser, range)
                                                     : sweptOf(sensor, range);
    }
    if (keyword == "ranger") {
        const Ranger& ranger = scene.rangers[placed.index].ranger;
        return frustumOf(ranger, limits(ranger.min_range, ranger.max_range));
    }
    if (keyword == "ultrasound") {
        const Receiver& receiver = scene.receivers[placed.index].receiver;
        return coneOf(receiver, limits(receiver.min_range, receiver.max_range));
    }
    return std::nullopt;
}

}  // namespace ispace
