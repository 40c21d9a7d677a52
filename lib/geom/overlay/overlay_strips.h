// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only: large overlays in strips, each small enough for caches, several at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "geom/overlay/overlay_lattice.h"

namespace ispace::lattice {

/// Edges that begin in one strip, which meet at common ends only, with their labels. Where edges
/// leave the strip their other ends are among the points, too, and again in other parts.
struct Part {
    std::vector<Point> points;
    std::vector<Edge> edges;
    std::vector<EdgeLabels> labels;
    bool is_whole = false;  ///< there is no other part
};

/// Called for several parts at once; what it returns, which is not empty, is called in their order,
/// one at a time, by any of the threads.
using PartVisitor = std::function<std::function<void()>(Part)>;

/// What snapRounded() makes of all edges together, and labelsOf() that, part by part: the same
/// edges and labels whatever the number of strips. Strips stand side by side, with about as many
/// ends of edges in each; their number depends on the input alone. What is known of a strip is
/// forgotten when it is visited.
/// \pre edges are merged()
/// \param at_least so many ends of edges in each strip; 0: as many as are quick
/// \throws FormatError as snapRounded, for each strip
void forEachPart(std::span<const Layer> layers, std::vector<Edge> edges, PointTable table,
                 SetStore& sets, std::size_t at_least, const PartVisitor& visit);

}  // namespace ispace::lattice
