// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/geom/overlay: unions of polygons and arcs, and the areas of all their depths.
//
//     const std::vector<Layer> layers{{view_of_a, true, 1}, {view_of_b, true, 2}};
//     const Overlay overlay(layers);
//     const double seen = overlay.area([](const LayerLabel& l) { return l.count > 0; });
//     const double twice = overlay.area([](const LayerLabel& l) { return l.count >= 2; });
//     const auto outline = overlay.curves([](const LayerLabel& l) { return l.count > 0; });
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "geom/curve.h"
#include "geom/shared_curves.h"

namespace ispace {

/// The set of layers that contain a point.
struct LayerLabel {
    std::int32_t count = 0;    ///< of counted layers that contain it
    std::int64_t numbers = 0;  ///< sum of their numbers: identifies a single layer
    std::uint64_t marks = 0;   ///< bits of the marking layers that contain it
    friend bool operator==(const LayerLabel&, const LayerLabel&) = default;
};

/// A point set to overlay with others: the points to the left of its curves, the outlines and holes
/// of one or more disjoint regions, which may touch.
struct Layer {
    SharedCurves curves;
    /// If true it adds 1 to `count` and its number to `numbers`, else it sets bits of `marks`.
    bool counts = true;
    std::int64_t number = 0;
    std::uint64_t marks = 0;
};

/// The overlay of layers: the faces into which their boundaries divide the plane, each with the set
/// of layers that contain it. One pass computes the areas covered by no layer, by any, by exactly
/// one and by k.
///
/// Robust against coincidences (many views end at the same walls): end points and crossings are
/// rounded to a lattice of step unit() by snap rounding (J. D. Hobby, Practical segment
/// intersection with finite precision output, 1999), so that edges meet at common ends only. A
/// layer contains the points that its rounded curves enclose by the even-odd rule, so labels are
/// consistent even in slivers made by rounding. Arcs are replaced by chords (kChordError) and the
/// area between arc and chord is added in closed form. Areas err by at most 3 * unit() times the
/// length of all boundaries, plus kChordError squared where an arc is crossed (kChordError times a
/// chord's length where an edge ends or passes between an arc and its chord). Near circles, as of
/// sensors that stand almost at one point, have chords at the same directions; of chords that
/// become one, the largest circle remains. Where input vertices must keep their doubles, as for
/// rooms and walls, use arrangement.h or planar_map.h.
///
/// Deterministic: the same edges, labels and sums for any number of threads. Immutable and
/// thread-safe once built. O((n + crossings) log n) unless edges crowd at one point. Large overlays
/// are computed in strips, several in parallel, and take about 130 bytes an edge.
class Overlay {
  public:
    /// An edge of the overlay, with the labels of the faces on its left and right.
    struct Edge {
        Point2 from, to;
        LayerLabel left, right;
        double bulge = 0;   ///< area between the chord and its arc, m2; positive if the arc lies to
                            ///< the right of from -> to
        double radius = 0;  ///< of the arc's circle; 0: straight
        Point2 center = {};
    };

    static constexpr std::size_t kAnyCrossings = std::numeric_limits<std::size_t>::max();

    /// Reduces the stored faces of an overlay by mapping their labels, and bounds its work.
    struct Coarse {
        /// Maps labels: neighbouring faces with equal new labels are merged into one face with that
        /// label. Called by several threads at once. \pre label({}) == {}
        std::function<LayerLabel(const LayerLabel&)> label;
        /// Receives the areas of all faces as addAreas() reports them: one call at a time, by any
        /// of the threads, in an order that depends only on the input.
        std::function<void(const LayerLabel&, double)> add_area;
        /// Of all pairs of an edge and an end or crossing that it passes, the measure of time.
        std::size_t most_crossings = kAnyCrossings;
    };

    /// `walls` separate the regions of regions() without changing any label.
    /// \pre all coordinates are finite
    /// \throws FormatError (without a line number) for outlines that cross by the ten million
    explicit Overlay(std::span<const Layer> layers, std::span<const Segment2> walls = {})
        : Overlay(layers, walls, Coarse()) {}
    /// Memory is required for the stored edges and for those of some strips.
    /// \throws FormatError (without a line number) for outlines that cross by the ten million in
    /// one strip, or more than `coarse` allows in all
    Overlay(std::span<const Layer> layers, std::span<const Segment2> walls, const Coarse& coarse);

    /// Edges between faces of different labels, in an order that depends only on the input.
    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
    /// Step of the lattice, metres, a power of two: at most 2^-29 of the extent of all layers
    /// (1.2e-7 m for 100 m); 0 without extent.
    [[nodiscard]] double unit() const { return unit_; }

    /// Calls add(label, area) several times for each label; the areas, some of them negative, add
    /// up to that of all faces with this label. Ignore those of {0, 0, 0}, the unbounded face.
    template <typename Add>
    void addAreas(Add add) const;
    /// Computes the area of all faces with labels that satisfy `in`, m2: a sum over the edges in
    /// their order, so the same bits each time. O(edges). \pre not in({})
    template <typename In>
    [[nodiscard]] double area(In in) const;
    /// Builds the connected regions of the faces whose label satisfies `in`, with chords for arcs.
    /// Regions that touch only at a point are separate. Sorted; curves begin at their lowest
    /// vertex. Vertices within straight edges are removed. \pre not in({})
    template <typename In>
    [[nodiscard]] std::vector<Region> regions(In in) const;

    /// Returns the outlines and holes of regions(), with arcs instead of chords.
    template <typename In>
    [[nodiscard]] std::vector<Curve> curves(In in) const {
        return withArcs(regions(in));
    }

    /// Returns for each of `sets` what curves() returns for the labels in it, together in the time
    /// of one: set_of(label) is the label's set, or `sets` for none. \pre set_of({}) == sets
    ///
    ///     overlay.curvesOfSets(2, [](const LayerLabel& l) { return l.count == 1 ? 0U : 2U; });
    template <typename SetOf>
    [[nodiscard]] std::vector<std::vector<Curve>> curvesOfSets(std::size_t sets,
                                                               SetOf set_of) const;

    /// Computes the areas of regions(), arcs included.
    [[nodiscard]] std::vector<double> areasOf(std::span<const Region> regions) const;

  private:
    /// Points of the lattice, and the ends of an edge among them.
    struct LatticePoint {
        std::int32_t x, y;
    };
    struct Ends {
        std::uint32_t from, to;
        bool is_wall;
    };
    class Maker;
    Overlay(Point2 middle, double unit) : middle_(middle), unit_(unit) {}
    /// Returns the overlay of these edges and, from edges_.size() on, walls alone. \pre ascending
    [[nodiscard]] Overlay partOf(std::span<const std::size_t> chosen) const;
    /// Position of a piece relative to an edge.
    enum Sides : std::uint8_t { kNowhere = 0, kLeft = 1, kRight = 2, kBoth = 3 };

    [[nodiscard]] Point2 placeOf(LatticePoint point) const {
        return middle_ + Vec2{unit_ * point.x, unit_ * point.y};
    }
    /// Area that an edge adds to the face on its left.
    static double areaLeftOf(Point2 middle, Point2 from, Point2 to, double bulge) {
        return cross(from - middle, to - middle) / 2 + bulge;
    }
    [[nodiscard]] double areaLeftOf(const Edge& edge) const {
        return areaLeftOf(middle_, edge.from, edge.to, edge.bulge);
    }
    friend void forEachArea(std::span<const Layer> layers,
                            const std::function<void(const LayerLabel&, double)>& add,
                            std::size_t most_crossings);
    /// Builds the pieces with these boundaries: for each of edges_ and then of walls_.
    [[nodiscard]] std::vector<Region> trace(const std::vector<Sides>& sides) const;
    [[nodiscard]] std::vector<Curve> withArcs(std::span<const Region> regions) const;
    [[nodiscard]] Point2 place(std::uint32_t point) const { return placeOf(points_[point]); }

    std::vector<Edge> edges_;
    std::vector<LayerLabel> walls_;  // walls inside a face, with its label
    std::vector<Ends> ends_;         // of edges_, then of walls_; from lower (lexLess) to upper
    std::vector<LatticePoint> points_;
    Point2 middle_;  // of the lattice
    double unit_ = 0;
};

/// Computes Overlay(layers).addAreas(add) without storing edges: memory for some strips alone.
/// `add` is called by one thread at a time, in an order that depends only on the input. \throws
/// FormatError as for Coarse
void forEachArea(std::span<const Layer> layers,
                 const std::function<void(const LayerLabel&, double)>& add,
                 std::size_t most_crossings = Overlay::kAnyCrossings);

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

template <typename SetOf>
std::vector<std::vector<Curve>> Overlay::curvesOfSets(std::size_t sets, SetOf set_of) const {
    std::vector<std::vector<std::size_t>> borders(sets);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const std::size_t left = set_of(edges_[i].left), right = set_of(edges_[i].right);
        if (left < sets && (left != right || ends_[i].is_wall)) borders[left].push_back(i);
        if (right < sets && left != right) borders[right].push_back(i);
    }
    for (std::size_t i = 0; i < walls_.size(); ++i)
        if (const std::size_t set = set_of(walls_[i]); set < sets)
            borders[set].push_back(edges_.size() + i);
    std::vector<std::vector<Curve>> curves_of(sets);
    for (std::size_t set = 0; set < sets; ++set)
        if (!borders[set].empty())
            curves_of[set] = partOf(borders[set]).curves([&](const LayerLabel& label) {
                return set_of(label) == set;
            });
    return curves_of;
}

/// The regions with a vertex over the middle of each chord, so that their areas are those of
/// Overlay::areasOf(): for formats without arcs. The vertices lie within a third of kChordError of
/// the arcs and are the same in regions on either side. An arc that another boundary has cut to
/// less than a millimetre or so keeps its chord.
/// \param regions from overlay.regions()
std::vector<Region> withArcAreas(const Overlay& overlay, std::vector<Region> regions);

}  // namespace ispace
