// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// What triangulate(region) gave where these were its triangles and its vertices those of the
/// region, each once, by x and y, none made where rounded curves cross. Nothing if a triangle has a
/// corner that is no vertex or turns clockwise, or if they have another area than the region
/// together. O(n log n), without CGAL's net.
std::optional<Triangulation> triangulationOf(const Region& region,
                                             std::vector<std::array<std::uint32_t, 3>> triangles);

}  // namespace ispace
