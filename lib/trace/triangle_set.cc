// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Triangles thinner than this are none, in metres.
constexpr double kThinnest = 1e-9;

/// Rounding of corners, origins and directions to float32 and of Embree's products, relative to the
/// extent of the scene.
constexpr double kFloatError = 0x1p-21;

/// Of the bounding box.
double diagonalOf(const std::vector<Point3>& vertices) {
    if (vertices.empty()) return 0;
    Point3 low = vertices.front(), high = low;
    for (const Point3& p : vertices) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return length(high - low);
}

Vec3 unit(Vec3 v) { return (1 / length(v)) * v; }

}  // namespace

TriangleSet::TriangleSet(const TriangleSoup& soup)
    : rounds_(soup.rounds), tolerance_(kFloatError * diagonalOf(soup.vertices)) {
    const std::size_t count = soup.triangles.size();
    corners_.reserve(count);
    planes_.reserve(count);
    margins_.reserve(count);
    round_of_.reserve(count);
    sources_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto& [first, second, third] = soup.triangles[i];
        const Point3 a = soup.vertices[first], b = soup.vertices[second], c = soup.vertices[third];
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        const Vec3 across = cross(b - a, c - a);
        const double twice = length(across), thin = twice / longest;
        if (!(thin > kThinnest)) continue;
        const Vec3 normal = (1 / twice) * across;
        const std::uint32_t round =
            i < soup.round_of.size() ? soup.round_of[i] : TriangleSoup::kFlat;
        corners_.push_back({a, b, c});
        planes_.push_back({normal, normal.x * a.x + normal.y * a.y + normal.z * a.z});
        margins_.push_back(round == TriangleSoup::kFlat ? 2.5 * tolerance_ / thin : kInfinity);
        round_of_.push_back(round);
        sources_.push_back(static_cast<std::uint32_t>(i));
    }
}

std::array<std::array<float, 3>, 3> TriangleSet::enlarged(std::size_t triangle) const {
    // Sharper corners would move far away.
    constexpr double kMinSine = 1.0 / 16;
    const std::array<Point3, 3>& corners = corners_[triangle];
    std::array<std::array<float, 3>, 3> moved{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 p = corners[i];
        const Vec3 left = unit(corners[(i + 1) % 3] - p);
        const Vec3 right = unit(corners[(i + 2) % 3] - p);
        // The tolerance over the sine of half the angle, along the line that halves it.
        const double sine = length({left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
        const Vec3 between{left.x + right.x, left.y + right.y, left.z + right.z};
        const Point3 q = p + (-tolerance_ / std::max(sine, kMinSine)) * unit(between);
        moved[i] = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
    }
    return moved;
}

RayHit TriangleSet::meet(std::size_t triangle, const Ray& ray, double ray_epsilon) const {
    return isRound(triangle) ? meetRound(triangle, ray, ray_epsilon) : meetFlat(triangle, ray);
}

RayHit TriangleSet::meetFlat(std::size_t triangle, const Ray& ray) const {
    const Vec3 d = ray.direction;
    double near = kInfinity, far = -kInfinity;
    for (const Point3& corner : corners_[triangle]) {
        const double along = dot(corner - ray.origin, d) / dot(d, d);
        near = std::min(near, along);
        far = std::max(far, along);
    }
    const Plane& plane = planes_[triangle];
    const double slope = dot(plane.normal, d);
    // No number where the ray runs in the plane: the near end.
    const double unlimited = plane.heightOver(ray.origin) / slope;
    const double multiple = unlimited > near ? std::min(unlimited, far) : near;
    if (!(multiple >= 0 && multiple <= ray.reach)) return {};
    return {multiple, std::fabs(slope)};
}

RayHit TriangleSet::meetRound(std::size_t triangle, const Ray& ray, double ray_epsilon) const {
    const auto& [curve, bottom, top] = rounds_[round_of_[triangle]];
    const Vec2 q = curve.toUnit(ray.origin.onFloor() - curve.center);
    const Vec2 d = curve.toUnit({ray.direction.x, ray.direction.y});
    const double a = dot(d, d), b = dot(q, d), c = dot(q, q) - 1;
    // The stretch of the ray within the side, and between both ends.
    double from = -kInfinity, to = kInfinity;
    if (a > 0) {
        const double square = a - cross(q, d) * cross(q, d);
        if (square < 0) return {};
        // Written so that neither root cancels.
        const double far = b > 0 ? -b - std::sqrt(square) : std::sqrt(square) - b;
        from = b > 0 ? far / a : c / far;
        to = b > 0 ? c / far : far / a;
    } else if (c > 0) {
        return {};
    }
    double low = -kInfinity, high = kInfinity;
    const double z = ray.origin.z, rise = ray.direction.z;
    if (rise != 0) {
        low = std::min((bottom - z) / rise, (top - z) / rise);
        high = std::max((bottom - z) / rise, (top - z) / rise);
    } else if (z < bottom || z > top) {
        return {};
    }
    const double enter = std::max(from, low), leave = std::min(to, high);
    if (!(enter <= leave && leave >= 0)) return {};
    const double height = curve.heightOf(ray.origin.onFloor());
    const double outside = std::max({height, z - top, bottom - z});
    const bool touches = std::fabs(outside) <= ray_epsilon;
    if (touches) {
        const bool goes_out = (std::fabs(height) <= ray_epsilon && b >= 0) ||
                              (std::fabs(z - top) <= ray_epsilon && rise > 0) ||
                              (std::fabs(bottom - z) <= ray_epsilon && rise < 0);
        if (goes_out || leave * length(ray.direction) <= ray_epsilon) return {};
    }
    const bool enters = enter >= 0 && !touches;
    const double multiple = enters ? enter : leave;
    if (!(multiple <= ray.reach)) return {};
    if (multiple == (enters ? low : high)) return {multiple, std::fabs(rise)};
    const Point2 place = (ray.origin + multiple * ray.direction).onFloor();
    const Vec2 normal = curve.normalAt(place);
    const Vec2 flat{ray.direction.x, ray.direction.y};
    return {multiple, std::fabs(dot(normal, flat)) / length(normal)};
}

double TriangleSet::distance(std::size_t triangle, Point3 p) const {
    const Plane& plane = planes_[triangle];
    const auto& corners = corners_[triangle];
    bool is_over = true;
    double nearest = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 from = corners[i];
        const Vec3 side = corners[(i + 1) % 3] - from, way = p - from;
        if (dot(cross(plane.normal, side), way) < 0) is_over = false;
        const double share = std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0);
        nearest = std::min(nearest, length(p - (from + share * side)));
    }
    return is_over ? std::fabs(plane.heightOver(p)) : nearest;
}

Mesh meshAround(Prism round) {
    // By a hair more, for rounding.
    const double growth = growthAround(round.footprint.size()) * (1 + 1e-9);
    for (Point2& p : round.footprint) p = round.curve->center + growth * (p - round.curve->center);
    Body body;
    body.prisms.push_back(std::move(round));
    return std::move(meshesOf(body, Surfaces::Solid).front());
}

}  // namespace ispace
