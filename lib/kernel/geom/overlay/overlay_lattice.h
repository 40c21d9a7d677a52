// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom only: the lattice to which overlays are rounded, and edges between its
// points.
//
// Coordinates are integers below 2^29, so that orientation, order along an edge and the pixel of a
// crossing are exact in 64 bits (the rounding of a crossing in 128 where a double cannot decide):
// no predicate below has an error bound, because none rounds. Deterministic; functions that run
// several threads say so, and their results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/overlay/overlay.h"
#include "geom/plane_graph.h"

namespace ispace::lattice {

using plane::Index;
using plane::kNone;

/// Coordinates are at most 2^kBits from 0, so that all predicates are exact in 64 bits: a cross
/// product of differences is at most 2^(2 * kBits + 3), twice of that is still less than 2^63.
constexpr int kBits = 29;

/// A point of the lattice, in steps from its middle.
struct Point {
    std::int32_t x = 0, y = 0;
    friend bool operator==(const Point&, const Point&) = default;
};

/// By x, then by y.
inline bool lexLess(Point a, Point b) { return a.x < b.x || (a.x == b.x && a.y < b.y); }

/// Cross product of b - a and c - a: positive if c lies to the left of a -> b.
inline std::int64_t cross(Point a, Point b, Point c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
           (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

/// Dot product of b - a and c - a.
inline std::int64_t dot(Point a, Point b, Point c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.x} - a.x) +
           (std::int64_t{b.y} - a.y) * (std::int64_t{c.y} - a.y);
}

/// A box that includes its boundary; empty until a point is added.
struct Box {
    Point low{std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max()};
    Point high{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min()};

    void add(Point p) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    [[nodiscard]] bool holds(Point p) const {
        return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y;
    }
};

/// Distinct points, numbered in the order of arrival. Not thread-safe while points are added.
class PointTable {
  public:
    void reserve(std::size_t count);
    /// Number of the point, which is added if it is new. Amortised O(1)
    Index add(Point p);
    [[nodiscard]] const std::vector<Point>& points() const { return points_; }

  private:
    void grow(std::size_t slots);
    [[nodiscard]] std::size_t slotOf(Point p) const;

    std::vector<Point> points_;
    std::vector<Index> slots_;  // open addressing; a power of two, at most half full
    int shift_ = 64;            // of the hash
};

/// Sets of layers, by number.
class SetStore {
  public:
    /// Sets 0 ... layers - 1 hold that layer alone, set `layers` is empty.
    explicit SetStore(std::size_t layers);
    /// Shares the sets of another table, which must not change, under the same numbers; new ones
    /// follow.
    explicit SetStore(const SetStore* base)
        : base_(base), empty_(base->empty_), offset_(base->size()), first_(1) {}
    [[nodiscard]] Index emptySet() const { return empty_; }
    [[nodiscard]] bool isOwn(Index set) const { return set >= offset_; }
    [[nodiscard]] std::span<const Index> operator[](Index set) const {
        if (set < offset_) return (*base_)[set];
        const std::size_t own = set - offset_;
        return std::span(items_).subspan(first_[own], first_[own + 1] - first_[own]);
    }
    /// Finds the set of the layers that are in an odd number of sets. \param layers of all sets one
    /// after another; sorted in place
    Index addOdd(std::vector<Index>& layers);

  private:
    [[nodiscard]] Index size() const { return offset_ + static_cast<Index>(first_.size() - 1); }

    const SetStore* base_ = nullptr;
    Index empty_;
    Index offset_ = 0;  // number of the first set stored here
    std::vector<std::size_t> first_;
    std::vector<Index> items_;  // by set, ascending
};

/// A straight line between two points of the table.
struct Edge {
    Index from = 0, to = 0;
    Index set = 0;         ///< layers that have it in their boundary, an odd number of times
    Index circle = kNone;  ///< of the arc for which it stands
    bool is_wall = false;
};

/// Merges equal edges and turns each from its lower end (lexLess); of their circles the lowest
/// number remains. Edges without length, and those that cancel out in the boundary of each layer,
/// are removed unless they are walls. O(n)
std::vector<Edge> merged(std::vector<Edge> edges, const std::vector<Point>& points, SetStore& sets);

/// Columns of the lattice, both ends included.
struct Columns {
    std::int32_t first = std::numeric_limits<std::int32_t>::min();
    std::int32_t last = std::numeric_limits<std::int32_t>::max();

    [[nodiscard]] bool hold(Point p) const { return first <= p.x && p.x <= last; }
};

/// \throws FormatError (without a line number) for more crossings than some gigabytes hold
void mustBeFew(std::size_t crossings);

/// Adds up the passes of several threads: pairs of an edge and an end or crossing that it passes.
/// Whether a sum is too large does not depend on their order.
class PassBudget {
  public:
    explicit PassBudget(std::size_t most) : most_(most) {}
    /// \throws FormatError (without a line number) for more passes in all than allowed
    void spend(std::size_t passes);

  private:
    std::size_t most_;
    std::atomic<std::size_t> spent_ = 0;
};

/// Points through which each edge is routed, between its ends and in their order.
struct EdgeWaypoints {
    std::vector<std::size_t> first;  // of the points of each edge, and the end
    std::vector<Index> points;

    [[nodiscard]] std::span<const Index> operator[](std::size_t edge) const {
        return std::span(points).subspan(first[edge], first[edge + 1] - first[edge]);
    }
};

/// Snap rounding (J. D. Hobby, Practical segment intersection with finite precision output, 1999),
/// in three steps; see snapRounded(). Edges are merged() before each.
///
/// First, edges pass the ends of others within the square of half-width 1 about them. In blocks of
/// edges, by several threads.
std::vector<Edge> splitAtVertices(const std::vector<Edge>& edges, const std::vector<Point>& points);
/// Then, edges pass all ends and crossings in these columns, rounded to the lattice, which are
/// inserted in the table. Crossings in other columns are ignored.
/// \throws FormatError (without a line number) for edges that cross by the ten million, or more
/// often than the budget allows
EdgeWaypoints waysThroughPixels(const std::vector<Edge>& edges, PointTable& table,
                                const Columns& columns, PassBudget& budget);
/// Cuts each edge into pieces from point to point; pieces from or to kNone are skipped.
std::vector<Edge> routed(const std::vector<Edge>& edges, const EdgeWaypoints& ways);

/// Replaces edges (which are merged()) by edges that meet at common ends only: each is routed
/// through points near it. First through ends of others, so that edges that overlapped before
/// rounding become equal; then through all ends and crossings. No point of an edge moves by more
/// than 1.42 and then 0.71 steps. Inserts points in the table.
/// \throws FormatError (without a line number) for edges that cross by the ten million
std::vector<Edge> snapRounded(std::vector<Edge> edges, PointTable& table, SetStore& sets);

/// Labels on both sides of an edge.
struct EdgeLabels {
    LayerLabel left, right;
};

/// Computes labels of the edges that end in these columns, for edges that are merged() and meet at
/// common ends only; the unbounded face is {0, 0, 0}. Walks around all points and updates the set
/// of layers that contain the current position. O(layers + edges and the sizes of their sets), and
/// plane::Graph::linesBelow for the components.
/// \pre edges include all those over these columns, and no others; edges do not both begin and end
/// to the left
std::vector<EdgeLabels> labelsOf(std::span<const Layer> layers, const std::vector<Point>& points,
                                 const std::vector<Edge>& edges, const SetStore& sets,
                                 const Columns& columns = {});

}  // namespace ispace::lattice
