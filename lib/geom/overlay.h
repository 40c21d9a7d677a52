// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/curve.h"

namespace ispace {

/// What lies over a place.
struct LayerLabel {
    std::int32_t count = 0;    ///< of counted layers that hold it
    std::int64_t numbers = 0;  ///< sum of their numbers: of one layer, which it is
    std::uint64_t marks = 0;   ///< bits of the marking layers that hold it
    friend bool operator==(const LayerLabel&, const LayerLabel&) = default;
};

/// A set of places to be laid over others: what its curves hold on their left, each place once (a
/// region and its holes, or several that are disjoint; they may touch).
struct Layer {
    std::vector<Curve> curves;
    /// Adds 1 to count and its number to numbers, else sets bits of marks.
    bool counts = true;
    std::int64_t number = 0;
    std::uint64_t marks = 0;
};

/// Layers laid over each other: the faces into which all boundaries divide the plane, and what lies
/// over each. One pass answers how much is held by any, by none, by one alone, by k at once.
///
/// Robust for whatever coincides (views end at the same walls all the time): end points and
/// crossings are rounded to a lattice, by snap rounding (Hobby 1999), so that edges meet at common
/// ends only; its step is unit(). A layer holds what its rounded curves enclose by the even-odd
/// rule, so that every label is of a set of layers, in slivers of rounding too. Arcs are laid out
/// as chords (kChordError), and the area between arc and chord is added in closed form: figures err
/// by no more than three times unit() by the length of all boundaries, and by the square of
/// kChordError where an arc is crossed (by up to kChordError times the length of a chord where
/// something ends or passes between an arc and its chord). Deterministic. O((n + crossings) log n)
/// for what does not crowd at one place; memory about 300 bytes an edge.
class Overlay {
  public:
    /// An edge of the overlay. Label `left` is what lies on its left.
    struct Edge {
        Point2 from, to;
        LayerLabel left, right;
        double bulge = 0;   ///< area between the chord and its arc, m2; positive if the arc lies to
                            ///< the right of from -> to
        double radius = 0;  ///< of the arc's circle; 0: straight
        Point2 center = {};
    };

    /// `walls` part what regions() gives: it joins nothing across them. They change no label.
    /// \pre all coordinates are finite
    /// \throws FormatError (without a place) for outlines that cross by the ten million (16 million
    /// places
    ///         where an edge passes a point of another)
    explicit Overlay(std::span<const Layer> layers, std::span<const Segment2> walls = {});

    /// Edges between different labels; in an order that depends only on the input.
    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
    /// Step of the lattice, metres, a power of two: at most 2^-29 of the extent of all layers. 0 if
    /// they have none.
    [[nodiscard]] double unit() const { return unit_; }

    /// Calls add(label, area) so that the areas given for a label add up to that of all faces with
    /// it; single ones may be negative. The plane outside of everything ({0, 0, 0}) comes as well
    /// and is to be ignored.
    template <typename Add>
    void addAreas(Add add) const;
    /// Area of all faces whose label `in` accepts. \pre not in({})
    template <typename In>
    [[nodiscard]] double area(In in) const;
    /// The connected pieces of what `in` accepts, chords for arcs. Pieces that touch at a point are
    /// apart. Sorted; curves begin at their lowest vertex. Vertices where an outline goes straight
    /// on are left out. \pre not in({})
    template <typename In>
    [[nodiscard]] std::vector<Region> regions(In in) const;

    /// The outlines and holes of regions() with arcs in the place of their chords, each with the
    /// area of its piece of the arc.
    template <typename In>
    [[nodiscard]] std::vector<Curve> curves(In in) const {
        return withArcs(regions(in));
    }

    /// The areas of regions(), each with the arcs of its outline.
    [[nodiscard]] std::vector<double> areasOf(std::span<const Region> regions) const;

  private:
    /// Places of the lattice, and the ends of an edge among them.
    struct LatticePoint {
        std::int32_t x, y;
    };
    struct Ends {
        std::uint32_t from, to;
        bool is_wall;
    };
    /// Where a piece lies, seen along an edge.
    enum Sides : std::uint8_t { kNowhere = 0, kLeft = 1, kRight = 2, kBoth = 3 };

    /// What the edge adds to the area of what lies on its left.
    [[nodiscard]] double areaLeftOf(const Edge& edge) const {
        return cross(edge.from - middle_, edge.to - middle_) / 2 + edge.bulge;
    }
    /// The pieces with these boundaries: for each of edges_ and then of walls_.
    [[nodiscard]] std::vector<Region> trace(const std::vector<Sides>& sides) const;
    [[nodiscard]] std::vector<Curve> withArcs(std::span<const Region> regions) const;
    [[nodiscard]] Point2 place(std::uint32_t point) const {
        return middle_ + Vec2{unit_ * points_[point].x, unit_ * points_[point].y};
    }

    std::vector<Edge> edges_;
    std::vector<LayerLabel> walls_;  // walls with the same label on both sides, and what it is
    std::vector<Ends> ends_;         // of edges_, then of walls_; from lower (lexLess) to upper
    std::vector<LatticePoint> points_;
    Point2 middle_;  // of the lattice
    double unit_ = 0;
};

template <typename Add>
void Overlay::addAreas(Add add) const {
    for (const Edge& edge : edges_) {
        const double area = areaLeftOf(edge);
        add(edge.left, area);
        add(edge.right, -area);
    }
}

template <typename In>
double Overlay::area(In in) const {
    double sum = 0;
    for (const Edge& edge : edges_) {
        const bool left = in(edge.left), right = in(edge.right);
        if (left != right) sum += left ? areaLeftOf(edge) : -areaLeftOf(edge);
    }
    return sum;
}

template <typename In>
std::vector<Region> Overlay::regions(In in) const {
    std::vector<Sides> sides;
    sides.reserve(ends_.size());
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const bool left = in(edges_[i].left), right = in(edges_[i].right);
        if (left == right)
            sides.push_back(left && ends_[i].is_wall ? kBoth : kNowhere);
        else
            sides.push_back(left ? kLeft : kRight);
    }
    for (const LayerLabel& label : walls_) sides.push_back(in(label) ? kBoth : kNowhere);
    return trace(sides);
}

}  // namespace ispace
