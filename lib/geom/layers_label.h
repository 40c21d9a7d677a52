// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only.
#pragma once

#include "geom/layers.h"
#include "geom/layers_graph.h"

namespace ispace::lattice {

/// What lies on both sides of an edge.
struct EdgeLabels {
    LayerLabel left, right;
};

/// Labels of the edges, which are merged() and meet at common ends only; the outside of everything
/// is {0, 0, 0}. A walk around all points, along which the set of layers that hold the place is
/// kept. O(layers + edges and what is in their sets), and PlaneGraph::linesBelow for the
/// components.
std::vector<EdgeLabels> labelsOf(std::span<const Layer> layers, const std::vector<Point>& points,
                                 const std::vector<Edge>& edges, const SetStore& sets);

}  // namespace ispace::lattice
