// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only.
#pragma once

#include <functional>

#include "geom/layers_lattice.h"

namespace ispace::lattice {

/// A part of the lattice.
struct Cell {
    Box box;                        ///< cells do not overlap and cover all points
    std::span<const Index> edges;   ///< all that come within kReach of the box, and others
    std::span<const Index> points;  ///< those in the box
};

/// In steps of the lattice, in x as well as in y.
constexpr std::int32_t kReach = 2;

/// Divides the box of all points so that few edges come near to each cell, as far as that can be:
/// square cells, crowded ones divided again. Where dividing does not part edges (because they lie
/// along each other) it stops. In an order that depends only on the input. `visit` may add points,
/// which belong to no cell.
/// \pre edges begin at their lower end (lexLess)
void forEachCell(const std::vector<Point>& points, const std::vector<Edge>& edges,
                 const std::function<void(const Cell&)>& visit);

}  // namespace ispace::lattice
