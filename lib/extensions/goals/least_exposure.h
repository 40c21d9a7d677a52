// SPDX-License-Identifier: GPL-3.0-or-later
// Ways over floor of which some is hidden: the least length outside hidden regions.
//
// Exact up to rounding, by a finite graph of the pieces that such a way can have; it knows polygons
// alone, neither sensors nor rooms.
//
//     const FloorSight floor(free_regions, 1e-6);
//     if (const auto way = leastExposedPath(floor, hidden, starts, goals)) print(way->exposed);
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "env/point_location.h"
#include "geom/point.h"
#include "geom/polygon.h"

namespace ispace::goals {

/// Lines of sight within regions, their boundaries included.
class FloorSight {
  public:
    /// A vertex about which shortest ways bend.
    struct Corner {
        Point2 at;
        Point2 before, after;  ///< its neighbours along the boundary
    };

    /// \param tolerance errors of coordinates, metres
    FloorSight(std::span<const Region> regions, double tolerance);

    /// Returns true if the segment lies in the regions.
    [[nodiscard]] bool sees(Point2 a, Point2 b) const;
    [[nodiscard]] const std::vector<Corner>& corners() const { return corners_; }
    /// Finds the shortest way, both ends included; empty without one. A* over the corners.
    [[nodiscard]] std::vector<Point2> shortestPath(Point2 from, Point2 to) const;
    /// Returns false if no shortest way bends about a corner on its way to this point.
    [[nodiscard]] bool isTangent(const Corner& corner, Point2 towards) const;
    /// Returns a length that no shortest way exceeds.
    [[nodiscard]] double longest() const { return longest_; }
    [[nodiscard]] double tolerance() const { return tolerance_; }

  private:
    RegionIndex index_;
    double tolerance_, longest_ = 0;
    std::vector<Corner> corners_;
};

/// A straight piece of a way over exposed floor.
struct ExposedLeg {
    Point2 from, to;
    /// Hidden regions at its ends; empty: a corner of the floor.
    std::optional<std::size_t> leaves = {}, reaches = {};
};

/// The way with the least exposed length.
struct ExposedPath {
    double exposed = 0;  ///< metres
    std::vector<ExposedLeg> legs;
    std::size_t first = 0, last = 0;  ///< the hidden regions in which it begins and ends
};

/// Finds the way from one of some hidden regions to one of others whose length outside hidden
/// regions is least: the weighted region problem with weights 0, 1 and infinity (Gewali, Meng,
/// Mitchell, Ntafos: Path planning in 0/1/infinity weighted regions with applications, 1990).
///
/// Exact up to rounding. A locally shortest piece over exposed floor leads straight between convex
/// vertices of hidden regions, their nearest points on edges of others, and corners of the floor.
/// Dijkstra over these with pieces up to a length that doubles until the goal is within it.
/// O(v (v + e)) lines of sight for v vertices and e edges at worst; mostly a small part of these.
/// \param hidden disjoint parts of the floor, which may touch
/// \param starts, goals true for each hidden region that is one
/// Empty without a way.
std::optional<ExposedPath> leastExposedPath(const FloorSight& floor, std::span<const Region> hidden,
                                            const std::vector<bool>& starts,
                                            const std::vector<bool>& goals);

}  // namespace ispace::goals
