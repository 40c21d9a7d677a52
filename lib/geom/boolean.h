// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The connected pieces of `region` outside all closed `solids`, which are simple polygons of
/// either orientation and may overlap and touch. Only crossings are rounded, to doubles.
/// \throws FormatError (without a place) for outlines that cross each other by the million
std::vector<Region> difference(const Region& region, std::span<const Polygon> solids);

/// The same for each part.
std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids);

/// The union of closed `solids`, as in difference().
std::vector<Region> unite(std::span<const Polygon> solids);

/// Sum of the areas of disjoint regions.
double totalArea(std::span<const Region> regions);

// Convex polygons, in time linear in their vertices: round tables have tens of thousands.

/// The support function of a convex polygon, for a sequence of directions. Each query walks on from
/// the last answer: O(1) on average if the directions turn steadily, O(n) if they jump.
class Caliper {
  public:
    /// Keeps a view of the vertices. \pre at least one
    explicit Caliper(std::span<const Point2> corners) : corners_(corners) {}
    /// Largest dot product of a vertex (from the origin) and a unit vector.
    double reach(Vec2 direction);

  private:
    std::span<const Point2> corners_;
    std::size_t at_ = 0;
    Vec2 last_;
};

/// Intersection of two counter-clockwise convex polygons; empty if they share no area. O(n + m)
Polygon sharedByConvex(const Polygon& a, const Polygon& b);

}  // namespace ispace
