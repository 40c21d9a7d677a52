// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include "geom/visibility.h"

namespace ispace {

/// How much farther than its range a place looks for the sake of cells: those at the greatest range
/// are then not on the outline of what is seen.
constexpr double kBeyondRange = 1 + 1e-6;

/// Calls visit(Point2) for the corners of a polygon that holds what is seen and, beyond the
/// greatest range, nothing that is nearer: arcs become the tangents at their ends. Neighbours may
/// be the same.
template <typename Visit>
void forEachCorner(const VisibleRegion& region, Visit visit) {
    for (const SightEdge& end : region.edges) {
        visit(end.from);
        if (end.line == SightEdge::kArc) {
            const Vec2 a = end.from - region.viewpoint, b = end.to - region.viewpoint;
            const double r2 = region.max_range * region.max_range;
            // Where the tangents meet: on a + b, at t with t (a + b) a = r2.
            visit(region.viewpoint + (r2 / (r2 + dot(a, b))) * (a + b));
        }
        visit(end.to);
    }
}

}  // namespace ispace
