// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/geom only: edges that meet at common ends only, as a plane graph.
#pragma once

#include "geom/layers_lattice.h"

namespace ispace::lattice {

/// From its lower end (lexLess) to its upper.
struct Line {
    Index from = 0, to = 0;
};

/// Half-edge 2i leads along line i from its lower end to its upper, 2i + 1 back.
inline Index twin(Index half) { return half ^ 1U; }

/// The half-edges about each point.
class PlaneGraph {
  public:
    /// O(n log(n))
    PlaneGraph(const std::vector<Point>& points, const std::vector<Line>& lines);

    [[nodiscard]] Index source(Index half) const {
        const Line& line = lines_[half / 2];
        return half % 2 == 0 ? line.from : line.to;
    }
    [[nodiscard]] Index target(Index half) const { return source(twin(half)); }
    [[nodiscard]] Point pointOf(Index vertex) const { return points_[vertex]; }
    [[nodiscard]] std::size_t vertices() const { return first_.size() - 1; }
    [[nodiscard]] std::size_t halves() const { return order_.size(); }

    /// Those that leave a point, counter-clockwise. The first follows on the direction straight
    /// down: before it, and behind the last, lies the direction to the left.
    [[nodiscard]] std::span<const Index> leaving(Index vertex) const {
        return std::span(order_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    /// Its place among those that leave the same point.
    [[nodiscard]] Index placeOf(Index half) const { return place_[half]; }
    /// The next on the way around the face to its left.
    [[nodiscard]] Index next(Index half) const {
        const Index back = twin(half);
        const std::span<const Index> about = leaving(source(back));
        return about[place_[back] == 0 ? about.size() - 1 : place_[back] - 1];
    }

    /// For each of these points the line right below the place just to the left of it, or kNone.
    /// \pre no line that ends at such a point comes from the left. O((n + points) log n)
    [[nodiscard]] std::vector<Index> linesBelow(const std::vector<Index>& vertices) const;

  private:
    [[nodiscard]] bool isAbove(Index line, Index other) const;
    [[nodiscard]] bool isAbove(Point p, Index line) const;
    void sweepBelow(const std::vector<Index>& vertices, std::vector<Index>& below) const;

    const std::vector<Point>& points_;
    const std::vector<Line>& lines_;
    std::vector<std::size_t> first_;  // of the half-edges that leave each point
    std::vector<Index> order_;
    std::vector<Index> place_;
};

}  // namespace ispace::lattice
