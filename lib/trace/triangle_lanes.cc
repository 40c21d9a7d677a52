// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_lanes.h"

#include <cmath>

#include "base/simd.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

constexpr std::size_t kSize = TriangleLanes::kSize;
using Vectors = TriangleLanes::Vectors;

ISPACE_INLINE Point3 pointAt(const Vectors& v, std::size_t lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}

/// To the last bit what std::hypot of libstdc++ gives, but without a branch.
ISPACE_INLINE double sizeOf(Vec3 v) {
    const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    const double most = flatMax(flatMax(x, y), z);
    const double over = flatChoice(most > 0, most, 1.0);
    return most *
           std::sqrt((x / over) * (x / over) + (y / over) * (y / over) + (z / over) * (z / over));
}

ISPACE_INLINE Vec3 unit(Vec3 v) { return (1 / sizeOf(v)) * v; }

}  // namespace

ISPACE_SIMD_CLONES void findPlanes(const TriangleLanes& triangles, TriangleLanePlanes& planes) {
    ISPACE_LANES for (std::size_t i = 0; i < kSize; ++i) {
        const Point3 a = pointAt(triangles.corners[0], i), b = pointAt(triangles.corners[1], i),
                     c = pointAt(triangles.corners[2], i);
        const Vec3 across = cross(b - a, c - a);
        const double twice = sizeOf(across);
        const double longest = flatMax(flatMax(sizeOf(b - a), sizeOf(c - b)), sizeOf(a - c));
        const Vec3 normal = (1 / twice) * across;
        planes.normals.x[i] = normal.x;
        planes.normals.y[i] = normal.y;
        planes.normals.z[i] = normal.z;
        planes.offsets[i] = normal.x * a.x + normal.y * a.y + normal.z * a.z;
        planes.thin[i] = twice / longest;
    }
}

namespace {

/// Where a corner moves to. \param left, right unit vectors along its sides
ISPACE_INLINE Point3 movedOut(Point3 p, Vec3 left, Vec3 right, double tolerance) {
    // Sharper corners would move far away.
    constexpr double kMinSine = 1.0 / 16;
    // The tolerance over the sine of half the angle, along the line that halves it.
    const double sine = sizeOf({left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
    const Vec3 between{left.x + right.x, left.y + right.y, left.z + right.z};
    return p + (-tolerance / flatMax(sine, kMinSine)) * unit(between);
}

ISPACE_INLINE void put(Point3 p, Vectors& v, std::size_t lane) {
    v.x[lane] = p.x;
    v.y[lane] = p.y;
    v.z[lane] = p.z;
}

}  // namespace

ISPACE_SIMD_CLONES void enlarge(TriangleLanes& triangles, double tolerance) {
    auto& [first, second, third] = triangles.corners;
    ISPACE_LANES for (std::size_t i = 0; i < kSize; ++i) {
        const Point3 a = pointAt(first, i), b = pointAt(second, i), c = pointAt(third, i);
        const Vec3 ab = unit(b - a), bc = unit(c - b), ca = unit(a - c);
        put(movedOut(a, ab, -1 * ca, tolerance), first, i);
        put(movedOut(b, bc, -1 * ab, tolerance), second, i);
        put(movedOut(c, ca, -1 * bc, tolerance), third, i);
    }
}

}  // namespace ispace
