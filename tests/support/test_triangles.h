// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of triangles: builds them, and computes the hits of rays by brute force.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "trace/embree_scene.h"

namespace ispace::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kTouching = 1e-4;
inline constexpr int kWidths[] = {16, 8, 4, 1};

/// Adds a parallelogram with separate corners.
inline void addQuad(TriangleSoup& soup, Point3 corner, Vec3 right, Vec3 up) {
    const auto a = soup.add(corner), b = soup.add(corner + right);
    const auto c = soup.add(corner + right + up), d = soup.add(corner + up);
    soup.triangles.push_back({a, b, c});
    soup.triangles.push_back({a, c, d});
}

/// Converts lines to walls from 1 m under the floor to 1 m over it.
inline TriangleSoup standing(const std::vector<Segment2>& lines) {
    TriangleSoup soup;
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a;
        addQuad(soup, {line.a.x, line.a.y, -1}, {along.x, along.y, 0}, {0, 0, 2});
    }
    return soup;
}

/// Adds a box of twelve triangles, rotated about the vertical.
inline void addBox(TriangleSoup& soup, Point3 middle, Vec3 half, double turn) {
    std::uint32_t corners[8];
    const double c = std::cos(turn), s = std::sin(turn);
    for (unsigned i = 0; i < 8; ++i) {
        const double x = (i & 1U ? 1 : -1) * half.x, y = (i & 2U ? 1 : -1) * half.y;
        corners[i] = soup.add({middle.x + c * x - s * y, middle.y + s * x + c * y,
                               middle.z + (i & 4U ? 1 : -1) * half.z});
    }
    const unsigned faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (const auto& [i, j, k, l] : faces) {
        soup.triangles.push_back({corners[i], corners[j], corners[k]});
        soup.triangles.push_back({corners[i], corners[k], corners[l]});
    }
}

struct Beams {
    Directions directions;
    std::vector<float> ranges, cosines;

    explicit Beams(std::size_t count) : ranges(count), cosines(count) { directions.resize(count); }
    void aim(std::size_t i, Vec3 way) { directions.set(i, (1 / length(way)) * way); }
    void cast(const EmbreeScene& scene, Point3 origin, double most = 60) {
        scene.cast(origin, directions, most, {ranges, cosines});
    }
};

/// Computes where the ray meets the closed triangle, within a nanometre aside, or the round body,
/// all in doubles; +infinity if it misses within its reach.
inline double exactMeet(const TriangleSet& set, std::size_t triangle, const Ray& ray) {
    constexpr double kTouch = 1e-9;
    if (set.roundOf(triangle) != nullptr) return set.meet(triangle, ray, kTouching).multiple;
    const double size = length(ray.direction);
    bool left = true, right = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = set.corners(triangle)[i] - ray.origin;
        const Vec3 b = set.corners(triangle)[(i + 1) % 3] - ray.origin;
        const double aside = dot(ray.direction, cross(a, b));
        const double touch = kTouch * size * length(Vec3{b.x - a.x, b.y - a.y, b.z - a.z});
        if (aside < -touch) left = false;
        if (aside > touch) right = false;
    }
    return left || right ? set.meet(triangle, ray, kTouching).multiple : kInfinity;
}

/// Computes the nearest hit over all triangles, in doubles.
inline double bruteForce(const TriangleSet& set, const Ray& ray) {
    double nearest = kInfinity;
    for (std::size_t i = 0; i < set.size(); ++i)
        nearest = std::min(nearest, exactMeet(set, i, ray));
    return nearest;
}

/// Returns true if the range lies between those of rays within some tolerances of this one, aside
/// in any direction.
inline bool isWithinTolerance(const TriangleSet& set, const Ray& ray, double range,
                              double tolerance) {
    // Small rings for surfaces that the ray grazes.
    constexpr double kRings[] = {1.0 / 256, 1.0 / 16, 1, 4};
    constexpr int kTurns = 16;
    const Vec3 d = (1 / length(ray.direction)) * ray.direction;
    const Vec3 aside = std::fabs(d.z) < 0.9 ? cross(d, {0, 0, 1}) : cross(d, {1, 0, 0});
    const Vec3 right = (1 / length(aside)) * aside, up = cross(right, d);
    const double slack = 4 * tolerance / length(ray.direction) + 2e-7 * range;
    double least = bruteForce(set, ray), most = least;
    for (const double ring : kRings) {
        for (int i = 0; i < kTurns; ++i) {
            const double turn = 2 * std::numbers::pi * i / kTurns, size = ring * tolerance;
            const Point3 origin =
                (ray.origin + size * std::cos(turn) * right) + size * std::sin(turn) * up;
            const double exact = bruteForce(set, {origin, ray.direction, ray.reach});
            least = std::min(least, exact);
            most = std::max(most, exact);
        }
    }
    return range >= least - slack && range <= most + slack;
}

}  // namespace ispace::testing
