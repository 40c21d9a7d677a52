// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom: the half-edge graph of segments that meet at common ends only, and the
// faces into which they divide the plane. Points are doubles or lattice points; all decisions are
// exact.
//
// The doubly connected edge list without pointers (D. E. Muller, F. P. Preparata, Finding the
// intersection of two convex polyhedra, 1978): line i is the half-edges 2i and 2i + 1, so the twin
// is one bit away. The cycle of half-edges around a face lies on its left side. Components without
// common points are nested by a sweep that finds the line below each component's lowest point
// (M. I. Shamos, D. Hoey, Geometric intersection problems, 1976).
//
// Every result depends on points and lines alone: the sweep may run in stretches of x by several
// threads, each of which answers its own points. O(n log n) time, O(n) memory. Const members are
// thread-safe. Indices are 32 bits: less than 2^31 lines.
//
//     const plane::Faces<Point2> faces(points, lines);
//     const plane::Index room = faces.of(2 * wall);       // left of the wall, from its lower end
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace ispace::plane {

using Index = std::uint32_t;
constexpr Index kNone = std::numeric_limits<Index>::max();

/// A segment from its lower end (lexLess) to its upper.
struct Line {
    Index from = 0, to = 0;
};

/// Half-edge 2i leads along line i from its lower end to its upper, 2i + 1 back.
inline Index twin(Index half) { return half ^ 1U; }

/// Computes the half-edges about each point. P requires lexLess(p, q) and isLeft(a, b, c): true if
/// c lies to the left of a -> b, exactly. Instantiated for Point2 and lattice::Point.
template <typename P>
class Graph {
  public:
    /// Stores references to both. \pre lines are distinct and meet at common ends only. O(n log n)
    Graph(const std::vector<P>& points, const std::vector<Line>& lines);

    [[nodiscard]] Index source(Index half) const {
        const Line& line = lines_[half / 2];
        return half % 2 == 0 ? line.from : line.to;
    }
    [[nodiscard]] Index target(Index half) const { return source(twin(half)); }
    [[nodiscard]] const P& pointOf(Index vertex) const { return points_[vertex]; }
    [[nodiscard]] std::size_t vertices() const { return first_.size() - 1; }
    [[nodiscard]] Index halves() const { return static_cast<Index>(order_.size()); }

    /// Half-edges that leave a point, counter-clockwise: from straight down those to the right,
    /// then those to the left.
    [[nodiscard]] std::span<const Index> leaving(Index vertex) const {
        return std::span(order_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    /// Index of a half-edge in leaving(source(half)).
    [[nodiscard]] Index placeOf(Index half) const { return place_[half]; }
    /// Next half-edge around the face on the left: at a dangling end, back along the same line.
    /// O(1)
    [[nodiscard]] Index next(Index half) const {
        const Index back = twin(half);
        const std::span<const Index> about = leaving(source(back));
        return about[place_[back] == 0 ? about.size() - 1 : place_[back] - 1];
    }

    /// Compares two lines with a common range of x, or a point with a line that spans its x.
    [[nodiscard]] bool isAbove(Index line, Index other) const;
    [[nodiscard]] bool isAbove(const P& p, Index line) const;
    /// For each point finds the line directly below a position just to the left of it, or kNone.
    /// \pre no line that ends at such a point comes from the left. O((n + points) log n)
    [[nodiscard]] std::vector<Index> linesBelow(const std::vector<Index>& vertices) const;

  private:
    void sortAbout(Index vertex, Index from, Index to);
    void sweepBelow(const std::vector<Index>& vertices, std::vector<Index>& below) const;
    void sweepBelow(const std::vector<Index>& vertices, decltype(P::x) after, decltype(P::x) last,
                    std::vector<Index>& below) const;

    const std::vector<P>& points_;
    const std::vector<Line>& lines_;
    std::vector<Index> first_;  // of the half-edges that leave each point
    std::vector<Index> order_;
    std::vector<Index> place_;
};

/// Consecutive half-edges of a boundary; the bounded face is on the left.
using Loop = std::vector<Index>;

/// Finds the faces of a graph, and the boundaries of pieces that consist of several faces. Faces
/// are numbered by the lowest half-edge of their outlines; the unbounded face has no number.
template <typename P>
class Faces {
  public:
    /// \param wanted for each half-edge whether the face on its left is required (the same for all
    /// half-edges around a face); empty: all faces
    Faces(const std::vector<P>& points, const std::vector<Line>& lines,
          std::vector<bool> wanted = {});

    [[nodiscard]] const Graph<P>& graph() const { return graph_; }
    [[nodiscard]] Index count() const { return count_; }
    /// Face on the left; kNone for the unbounded face and unwanted faces.
    [[nodiscard]] Index of(Index half) const {
        return cycle_[half] == kNone ? kNone : face_of_cycle_[cycle_[half]];
    }

    /// Calls visit(piece, loop, is_outline) for each boundary of each piece. A piece consists of
    /// the faces for whose half-edges piece_of(half) returns its number; kNone excludes a face. A
    /// loop may visit a point twice. Ascending by their lowest half-edge. O(n)
    template <typename PieceOf, typename Visit>
    void forEachBoundary(PieceOf piece_of, Visit visit) const {
        const auto is_boundary = [&](Index half) {
            const Index left = piece_of(half);
            return left != kNone && left != piece_of(twin(half));
        };
        std::vector<bool> walked(graph_.halves());
        Loop loop;
        for (Index start = 0; start < graph_.halves(); ++start) {
            if (walked[start] || !is_boundary(start)) continue;
            loop.clear();
            Index half = start;
            do {
                walked[half] = true;
                loop.push_back(half);
                half = graph_.next(half);
                // Lines with the same piece on both sides bound no piece: turn past them.
                while (!is_boundary(half)) half = graph_.next(twin(half));
            } while (half != start);
            visit(piece_of(start), loop, isOutline(loop));
        }
    }

  private:
    [[nodiscard]] Index lowestOf(const Loop& loop) const;
    [[nodiscard]] bool isOutline(const Loop& loop) const;
    void walkCycles(const std::vector<bool>& wanted);
    void placeHoles();

    Graph<P> graph_;
    std::vector<Index> cycle_;  // of half-edges
    std::vector<Index> face_of_cycle_;
    std::vector<Index> holes_;  // a half-edge of each that leaves its lowest point
    Index count_ = 0;
};

}  // namespace ispace::plane
