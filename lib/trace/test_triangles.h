// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of triangles: how they come about, and what rays meet of them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "trace/embree_scene.h"

namespace ispace::testing {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kNoReturn = std::numeric_limits<float>::infinity();
inline constexpr double kTouching = 1e-4;
inline constexpr int kWidths[] = {16, 8, 4, 1};

/// A parallelogram of its own corners.
inline void addQuad(TriangleSoup& soup, Point3 corner, Vec3 right, Vec3 up) {
    const auto a = soup.add(corner), b = soup.add(corner + right);
    const auto c = soup.add(corner + right + up), d = soup.add(corner + up);
    soup.triangles.push_back({a, b, c});
    soup.triangles.push_back({a, c, d});
}

/// Lines as walls from 1 m under the floor to 1 m over it.
inline TriangleSoup standing(const std::vector<Segment2>& lines) {
    TriangleSoup soup;
    for (const Segment2& line : lines) {
        const Vec2 along = line.b - line.a;
        addQuad(soup, {line.a.x, line.a.y, -1}, {along.x, along.y, 0}, {0, 0, 2});
    }
    return soup;
}

/// A box of twelve triangles, turned about the vertical.
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

/// Over all triangles, in doubles.
inline double bruteForce(const TriangleSet& set, const Ray& ray) {
    double nearest = kInfinity;
    for (std::size_t i = 0; i < set.size(); ++i) nearest = std::min(nearest, set.meet(i, ray));
    return nearest;
}

}  // namespace ispace::testing
