// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom only: computes large overlays in strips, each small enough for caches, in
// parallel.
//
// A strip is a range of columns of the lattice. Snap rounding decides each pixel by the edges that
// meet it, so strips are independent but for edges that cross them: routes are computed in each
// strip and joined. The union of the parts equals the result in one piece, edge by edge
// (overlay_strips_test compares them wherever strips end).
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "geom/overlay/overlay_lattice.h"

namespace ispace::lattice {

/// Edges that begin in one strip, which meet at common ends only, with their labels. Ends of edges
/// that leave the strip are among the points, too, and again in other parts.
struct Part {
    std::vector<Point> points;
    std::vector<Edge> edges;
    std::vector<EdgeLabels> labels;
    bool is_whole = false;  ///< the only part
};

/// Called for several parts at once; the functions it returns, which are not empty, are called in
/// the order of the parts, one at a time, by any of the threads.
using PartVisitor = std::function<std::function<void()>(Part)>;

/// Computes snapRounded() of all edges and their labelsOf(), part by part; edges and labels do not
/// depend on the number of strips. Strips are adjacent, with about as many ends of edges in each;
/// their number depends on the input alone. Data of a strip are freed once it is visited.
/// \pre edges are merged()
/// \param at_least ends of edges in each strip; 0: the fastest number
/// \param most_passes of the strips together; see PassBudget
/// \throws FormatError as snapRounded, for each strip
void forEachPart(std::span<const Layer> layers, std::vector<Edge> edges, PointTable table,
                 SetStore& sets, std::size_t at_least, const PartVisitor& visit,
                 std::size_t most_passes = Overlay::kAnyCrossings);

}  // namespace ispace::lattice
