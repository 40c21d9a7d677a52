// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// Triangles over a region's own vertices, counter-clockwise.
struct Triangulation {
    std::vector<Point2> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Constrained Delaunay triangulation of the region's inside (CGAL). Curves that touch are fine.
Triangulation triangulate(const Region& region);

}  // namespace ispace
