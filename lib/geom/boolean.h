// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The pieces of `region` outside all closed `solids`: simple polygons of either orientation, which
/// may overlap and touch. Crossings are rounded to doubles, nothing else is.
/// \throws FormatError (without a place) for outlines that cross each other by the million
std::vector<Region> difference(const Region& region, std::span<const Polygon> solids);

/// The same of each part.
std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids);

/// The union of closed `solids`, which are as for difference().
std::vector<Region> unite(std::span<const Polygon> solids);

/// Sum of the areas of disjoint regions.
double totalArea(std::span<const Region> regions);

// Convex polygons, in time linear in their corners: round tables have tens of thousands.

/// The support function of a convex polygon, for a sequence of directions. Each query walks on from
/// the last answer: O(1) on average if the directions turn steadily, O(n) if they jump.
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

/// Intersection of two counter-clockwise convex polygons; empty if they share no area. O(n + m)
Polygon sharedByConvex(const Polygon& a, const Polygon& b);

}  // namespace ispace
