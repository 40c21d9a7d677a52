// SPDX-License-Identifier: GPL-3.0-or-later
// Shortest ways of a circle over the floor.
//
// A* over cells of 0.1 m (P. E. Hart, N. J. Nilsson, B. Raphael, A formal basis for the heuristic
// determination of minimum cost paths, 1968) with whole costs and buckets in place of a heap (R. B.
// Dial, Algorithm 360: shortest-path forest with topological ordering, 1969). On open floor a way
// from cell to cell is at most 8.4 % longer than the straight line, before it is straightened; ways
// through gaps narrower than about a cell more than the circle with its margin may be missed.
//
// Equal inputs give equal ways; ties between ways depend on the direction of search. A finder takes
// a byte a cell, a Field four.
//
//     const Obstacles obstacles(environment, model.height, nullptr);
//     const PathFinder finder(obstacles, bounds(environment.indoor()), model.radius);
//     const std::vector<Point2> way = finder.wayBetween({0, 0}, {4, 2});    // empty: no way
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "env/point_location.h"
#include "geom/point.h"
#include "geom/polygon.h"
#include "raster/grid.h"
#include "sim/collision.h"

namespace ispace {

/// Shortest ways of a circle over a floor, by a grid of the cells in which it is free.
///
/// A way steps from cell to cell across sides, at a cost of 12, or corners, at 17, and is then
/// straightened where the straight line is free. It keeps the radius and kMargin away from
/// obstacles and from holes in the floor. Movers are ignored, but see around().
///
/// Ends of ways need not be free: a point counts as the nearest free cell within 0.5 m of it to
/// which the straight line keeps 1 cm away from all bodies; for the circle the pieces between are
/// not tested, so that a mover at a wall gets away and to a goal beside one. Pilots steer there, or
/// give the point up.
class PathFinder {
  public:
    static constexpr double kMargin = 0.05, kCell = 0.1;

    /// Tests all cells. \param box that bounds the ways; cells are larger than kCell where it has
    /// more than 250 000 \pre the obstacles outlive this object
    /// \param holes without floor
    PathFinder(const Obstacles& obstacles, const Box2& box, double radius,
               const std::vector<Polygon>& holes = {});

    /// A circle on the floor that a mover occupies.
    struct Spot {
        Point2 center;
        double radius = 0;
    };
    /// Returns a finder whose ways lead round these circles, too. Copies the cells, and tests those
    /// that a circle may reach.
    [[nodiscard]] PathFinder around(std::span<const Spot> spots) const;

    /// Ways from one point to all cells.
    struct Field {
        Point2 from;
        std::vector<std::int32_t> cost;  ///< by cell, kNoPath without a way or unknown
        std::size_t expanded = 0;        ///< cells from which the search went on
    };
    static constexpr std::int32_t kNoPath = -1;

    /// Finds the ways from a point; no way if no cell near it is free. O(cells)
    [[nodiscard]] Field waysFrom(Point2 from) const;
    /// Returns the points of the shortest way after its first, up to `to`; empty without a way.
    /// Searches mostly the cells towards the goal.
    [[nodiscard]] std::vector<Point2> wayBetween(Point2 from, Point2 to) const;
    /// Returns the length of the way, not yet straightened, from cell to cell, in metres; empty
    /// without a way. \pre the field is of this finder
    [[nodiscard]] std::optional<double> length(const Field& field, Point2 to) const;
    /// Returns the points of the way after its first, up to `to`; empty without a way. \pre the
    /// field is of this finder
    [[nodiscard]] std::vector<Point2> way(const Field& field, Point2 to) const;
    /// Ways from one point to some cells, and a goal among these.
    struct Approach {
        Field field;
        std::optional<Point2> goal;
    };
    /// Finds the suitable free point with a way that is nearest to a point, and searches no farther
    /// than to the nearest suitable one unless no way leads there. \param box holds all suitable
    /// points
    [[nodiscard]] Approach approach(Point2 from, Point2 to, const Box2& box,
                                    const std::function<bool(Point2)>& is_suitable) const;
    /// Number of cells, with a border.
    [[nodiscard]] std::size_t cells() const { return free_.size(); }
    /// Returns the point with the longest way; empty without ways. O(cells)
    [[nodiscard]] std::optional<Point2> farthestReached(const Field& field) const;
    /// Returns true if the circle with the margin is free at that point.
    [[nodiscard]] bool isFree(Point2 p) const;
    /// Returns true if the circle is free all along the straight line.
    [[nodiscard]] bool isStraight(Point2 from, Point2 to) const;

  private:
    [[nodiscard]] std::optional<std::size_t> cellNear(Point2 p) const;
    [[nodiscard]] std::size_t cellOf(int column, int row) const {
        return (static_cast<std::size_t>(row) + 1) * stride_ + static_cast<std::size_t>(column) + 1;
    }
    [[nodiscard]] Point2 centerOf(std::size_t cell) const;
    [[nodiscard]] std::int32_t leastCost(std::size_t a, std::size_t b) const;
    /// \param aims estimates the cost to the goal: expands fewer cells, and of equal ways may find
    /// another one
    [[nodiscard]] Field search(Point2 from, std::optional<std::size_t> goal, bool aims) const;
    template <typename Visit>
    void forEachCellIn(const Box2& box, Visit visit) const;
    template <typename Test>
    [[nodiscard]] std::optional<std::size_t> nearestCell(Point2 to, const Box2& box,
                                                         Test test) const;
    template <typename Visit>
    void forEachNeighbour(std::size_t cell, Visit visit) const;

    [[nodiscard]] bool isOverHole(const Segment2& way) const;
    [[nodiscard]] bool isInSpot(const Segment2& way) const;

    const Obstacles* obstacles_;
    std::vector<RegionIndex> holes_;
    std::vector<Spot> spots_;
    double reach_;  // radius and margin
    Grid grid_;
    std::size_t stride_;
    std::vector<std::uint8_t> free_;  // with a border of cells that are not
};

}  // namespace ispace
