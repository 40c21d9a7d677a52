// SPDX-License-Identifier: GPL-3.0-or-later
// Two convex polygons, in time linear in their corners: round tables have tens of thousands.
#pragma once

#include <cstddef>
#include <span>

#include "geom/polygon.h"

namespace ispace {

/// How far a convex polygon reaches in directions that are asked in turn. It walks from one answer
/// to the next: O(1) on average if the directions go once round, O(n) if they jump.
class Caliper {
  public:
    /// Keeps a view of the corners; at least one.
    explicit Caliper(std::span<const Point2> corners) : corners_(corners) {}
    /// The greatest dot product of a corner (from the origin) and a unit vector.
    double reach(Vec2 direction);

  private:
    std::span<const Point2> corners_;
    std::size_t at_ = 0;
    Vec2 last_;
};

/// What two convex polygons share; both counter-clockwise. Empty if nothing. O(n + m)
Polygon sharedByConvex(const Polygon& a, const Polygon& b);

}  // namespace ispace
