// SPDX-License-Identifier: GPL-3.0-or-later
// What lies over each face, and pieces made of faces.
#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <utility>

#include "geom/arrangement.h"
#include "geom/overlay.h"
#include "geom/overlay_lattice.h"

namespace ispace::lattice {

namespace {

/// The layers that hold a place.
class Place {
  public:
    explicit Place(std::span<const Layer> layers) : layers_(layers), inside_(layers.size()) {}

    [[nodiscard]] const LayerLabel& label() const { return label_; }
    /// Goes across the boundary of these.
    void cross(std::span<const Index> set) {
        for (const Index i : set) {
            const bool enters = inside_[i] == 0;
            inside_[i] = enters ? 1 : 0;
            const Layer& layer = layers_[i];
            if (!layer.counts) {
                crossMarks(layer.marks, enters);
                continue;
            }
            label_.count += enters ? 1 : -1;
            // Numbers may be anything: their sum may wrap around.
            const auto number = static_cast<std::uint64_t>(layer.number);
            const auto sum = static_cast<std::uint64_t>(label_.numbers);
            label_.numbers = static_cast<std::int64_t>(enters ? sum + number : sum - number);
        }
    }

  private:
    void crossMarks(std::uint64_t marks, bool enters) {
        for (; marks != 0; marks &= marks - 1) {
            const int bit = std::countr_zero(marks);
            Index& count = marking_[static_cast<std::size_t>(bit)];
            count += enters ? 1 : static_cast<Index>(-1);
            const std::uint64_t mask = std::uint64_t{1} << bit;
            label_.marks = count > 0 ? label_.marks | mask : label_.marks & ~mask;
        }
    }

    std::span<const Layer> layers_;
    std::vector<std::uint8_t> inside_;
    std::array<Index, 64> marking_{};  // layers with each mark
    LayerLabel label_;
};

/// What hangs together: components lie in faces of others, or outside of all.
class Nesting {
  public:
    explicit Nesting(const PlaneGraph& graph)
        : component_of_(graph.vertices(), kNone), first_inside_(graph.halves() / 2, kNone) {
        for (Index v = 0; v < graph.vertices(); ++v) {
            if (component_of_[v] == kNone && !graph.leaving(v).empty()) addComponent(graph, v);
        }
        next_.assign(roots_.size(), kNone);
        if (roots_.size() < 2) {
            outermost_ = roots_;
            return;
        }
        const std::vector<Index> below = graph.linesBelow(roots_);
        for (Index c = 0; c < roots_.size(); ++c) {
            if (below[c] == kNone) {
                outermost_.push_back(roots_[c]);
            } else {
                next_[c] = first_inside_[below[c]];
                first_inside_[below[c]] = c;
            }
        }
    }

    /// The lowest points (lexLess) of components outside of all.
    [[nodiscard]] const std::vector<Index>& outermost() const { return outermost_; }
    /// Calls visit(lowest point) for the components that are right above this line.
    template <typename Visit>
    void forEachAbove(Index line, Visit visit) const {
        for (Index c = first_inside_[line]; c != kNone; c = next_[c]) visit(roots_[c]);
    }

  private:
    void addComponent(const PlaneGraph& graph, Index start) {
        const auto number = static_cast<Index>(roots_.size());
        Index lowest = start;
        std::vector<Index>& open = open_;
        open.assign(1, start);
        component_of_[start] = number;
        while (!open.empty()) {
            const Index v = open.back();
            open.pop_back();
            if (lexLess(graph.pointOf(v), graph.pointOf(lowest))) lowest = v;
            for (const Index half : graph.leaving(v)) {
                const Index other = graph.target(half);
                if (component_of_[other] != kNone) continue;
                component_of_[other] = number;
                open.push_back(other);
            }
        }
        roots_.push_back(lowest);
    }

    std::vector<Index> component_of_;  // points
    std::vector<Index> roots_;         // lowest point of each component
    std::vector<Index> next_;          // of the components right above the same line
    std::vector<Index> first_inside_;  // component right above each line
    std::vector<Index> outermost_;
    std::vector<Index> open_;
};

}  // namespace

std::vector<EdgeLabels> labelsOf(std::span<const Layer> layers, const std::vector<Point>& points,
                                 const std::vector<Edge>& edges, const SetStore& sets) {
    std::vector<Line> lines;
    lines.reserve(edges.size());
    for (const Edge& edge : edges) lines.push_back({edge.from, edge.to});
    const PlaneGraph graph(points, lines);
    const Nesting nesting(graph);
    std::vector<EdgeLabels> labels(edges.size());
    Place place(layers);
    // A turn around a point, from before the half-edge at `at`: at its end the place is the same
    // again, so that turns begun meanwhile may be made one within another.
    struct Turn {
        Index vertex, at;
        Index left;  // half-edges to come
    };
    std::vector<Turn> turns;
    std::vector<bool> begun(points.size());
    const auto begin = [&](Index vertex, Index at) {
        if (begun[vertex]) return;
        begun[vertex] = true;
        turns.push_back({vertex, at, static_cast<Index>(graph.leaving(vertex).size())});
    };
    for (const Index root : nesting.outermost()) {
        begin(root, 0);
        while (!turns.empty()) {
            Turn& turn = turns.back();
            if (turn.left == 0) {
                turns.pop_back();
                continue;
            }
            const std::span<const Index> about = graph.leaving(turn.vertex);
            const Index half = about[turn.at];
            turn.at = turn.at + 1 == about.size() ? 0 : turn.at + 1;
            --turn.left;
            const Index line = half / 2;
            if (half % 2 == 0) labels[line].right = place.label();
            place.cross(sets[edges[line].set]);
            if (half % 2 == 0) {
                labels[line].left = place.label();
                nesting.forEachAbove(line, [&](Index lowest) { begin(lowest, 0); });
            }
            begin(graph.target(half), graph.placeOf(twin(half)));
        }
    }
    return labels;
}

}  // namespace ispace::lattice

namespace ispace {

namespace {

using lattice::Index;
using lattice::kNone;
using lattice::twin;

/// Half-edges that follow each other along a boundary, what it bounds on the left.
using Loop = std::vector<Index>;

/// Faces of lines that have a piece on the left of some half-edges: of one of a line, or of both of
/// a wall.
class PieceTrace {
  public:
    PieceTrace(const std::vector<lattice::Point>& points, const std::vector<lattice::Line>& lines,
               std::vector<bool> has_piece)
        : graph_(points, lines), has_piece_(std::move(has_piece)), lines_(lines.size()) {
        walkCycles();
        placeHoles();
    }

    [[nodiscard]] Index faces() const { return faces_; }

    /// Calls visit(face, loop, twice its area is positive) for all boundaries, without walls that
    /// part nothing.
    template <typename Visit>
    void forEachBoundary(Visit visit) const {
        std::vector<bool> walked(2 * lines_);
        Loop loop;
        for (Index start = 0; start < 2 * lines_; ++start) {
            if (walked[start] || !isBoundary(start)) continue;
            loop.clear();
            Index half = start;
            do {
                walked[half] = true;
                loop.push_back(half);
                half = graph_.next(half);
                while (!isBoundary(half)) half = graph_.next(twin(half));
            } while (half != start);
            visit(face(half), loop, isOutline(loop));
        }
    }

    /// Its corners, without those where it goes straight on.
    template <typename Place>
    [[nodiscard]] Polygon curveOf(const Loop& loop, Place place) const {
        Polygon curve;
        curve.reserve(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Index before = loop[i == 0 ? loop.size() - 1 : i - 1];
            const Index vertex = graph_.source(loop[i]);
            if (lattice::cross(graph_.pointOf(graph_.source(before)), graph_.pointOf(vertex),
                               graph_.pointOf(graph_.target(loop[i]))) != 0)
                curve.push_back(place(vertex));
        }
        return curve;
    }

  private:
    [[nodiscard]] Index face(Index half) const { return face_of_cycle_[cycle_[half]]; }

    [[nodiscard]] bool isBoundary(Index half) const {
        if (!has_piece_[half] || face(half) == kNone) return false;
        return !has_piece_[twin(half)] || face(twin(half)) != face(half);
    }

    [[nodiscard]] bool isOutline(const Loop& loop) const {
        __int128 twice_area = 0;
        for (const Index half : loop)
            twice_area += lattice::cross({}, graph_.pointOf(graph_.source(half)),
                                         graph_.pointOf(graph_.target(half)));
        return twice_area > 0;
    }

    void walkCycles() {
        cycle_.assign(2 * lines_, kNone);
        Loop loop;
        for (Index start = 0; start < 2 * lines_; ++start) {
            if (!has_piece_[start] || cycle_[start] != kNone) continue;
            loop.clear();
            const auto number = static_cast<Index>(face_of_cycle_.size());
            for (Index half = start; cycle_[half] == kNone; half = graph_.next(half)) {
                cycle_[half] = number;
                loop.push_back(half);
            }
            const bool is_outline = isOutline(loop);
            face_of_cycle_.push_back(is_outline ? faces_++ : kNone);
            if (!is_outline) holes_.push_back(lowestOf(loop));
        }
    }

    /// The half-edge that leaves the lowest point.
    [[nodiscard]] Index lowestOf(const Loop& loop) const {
        return *std::min_element(loop.begin(), loop.end(), [this](Index g, Index h) {
            return lexLess(graph_.pointOf(graph_.source(g)), graph_.pointOf(graph_.source(h)));
        });
    }

    /// Finds the face in which each hole lies, from left to right: what is below begins farther
    /// left.
    void placeHoles() {
        std::sort(holes_.begin(), holes_.end(), [this](Index g, Index h) {
            const lattice::Point p = graph_.pointOf(graph_.source(g));
            const lattice::Point q = graph_.pointOf(graph_.source(h));
            return p == q ? g < h : lexLess(p, q);
        });
        std::vector<Index> vertices;
        vertices.reserve(holes_.size());
        for (const Index half : holes_) vertices.push_back(graph_.source(half));
        const std::vector<Index> below = graph_.linesBelow(vertices);
        for (std::size_t i = 0; i < holes_.size(); ++i) {
            if (below[i] == kNone) continue;
            const Index upper = 2 * below[i];
            if (has_piece_[upper]) face_of_cycle_[cycle_[holes_[i]]] = face(upper);
        }
    }

    lattice::PlaneGraph graph_;
    std::vector<bool> has_piece_;  // half-edges
    std::size_t lines_;
    std::vector<Index> cycle_;  // of half-edges
    std::vector<Index> face_of_cycle_;
    std::vector<Index> holes_;  // a half-edge of each that leaves its lowest point
    Index faces_ = 0;
};

}  // namespace

std::vector<Region> Overlay::trace(const std::vector<Sides>& sides) const {
    std::vector<lattice::Point> points;
    points.reserve(points_.size());
    for (const auto& [x, y] : points_) points.push_back({x, y});
    std::vector<lattice::Line> lines;
    std::vector<bool> has_piece;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] == kNowhere) continue;
        lines.push_back({ends_[i].from, ends_[i].to});
        has_piece.push_back((sides[i] & kLeft) != 0);
        has_piece.push_back((sides[i] & kRight) != 0);
    }
    const PieceTrace trace(points, lines, std::move(has_piece));
    std::vector<Region> regions(trace.faces());
    trace.forEachBoundary([&](Index face, const Loop& loop, bool is_outline) {
        Polygon curve = trace.curveOf(loop, [this](Index point) { return place(point); });
        rotateToLowest(curve);
        if (is_outline)
            regions[face].outline = std::move(curve);
        else
            regions[face].holes.push_back(std::move(curve));
    });
    putInOrder(regions);
    return regions;
}

}  // namespace ispace
