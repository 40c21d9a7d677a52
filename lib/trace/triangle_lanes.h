// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "geom/point.h"

namespace ispace {

/// Eight triangles, an array per component, as vector units want them.
struct TriangleLanes {
    static constexpr std::size_t kSize = 8;

    struct Vectors {
        alignas(64) double x[kSize], y[kSize], z[kSize];
    };
    std::array<Vectors, 3> corners;

    void set(std::size_t lane, std::size_t corner, Point3 p) {
        corners[corner].x[lane] = p.x;
        corners[corner].y[lane] = p.y;
        corners[corner].z[lane] = p.z;
    }
};

/// What a TriangleSet keeps of eight triangles: their planes.
struct TriangleLanePlanes {
    TriangleLanes::Vectors normals;
    alignas(64) double offsets[TriangleLanes::kSize];
    /// Height over the longest side; no number, or 0, where there is no triangle.
    alignas(64) double thin[TriangleLanes::kSize];
};
void findPlanes(const TriangleLanes& triangles, TriangleLanePlanes& planes);

/// Moves the corners outwards, each by `tolerance` away from the sides that meet there; sharp ones
/// by no more than 16 times that.
void enlarge(TriangleLanes& triangles, double tolerance);

}  // namespace ispace
