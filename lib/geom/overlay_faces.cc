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

using Graph = plane::Graph<Point>;

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
    explicit Nesting(const Graph& graph)
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
    void addComponent(const Graph& graph, Index start) {
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
    std::vector<plane::Line> lines;
    lines.reserve(edges.size());
    for (const Edge& edge : edges) lines.push_back({edge.from, edge.to});
    const Graph graph(points, lines);
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
            begin(graph.target(half), graph.placeOf(plane::twin(half)));
        }
    }
    return labels;
}

}  // namespace ispace::lattice

namespace ispace {

using plane::Index;

std::vector<Region> Overlay::trace(const std::vector<Sides>& sides) const {
    std::vector<lattice::Point> points;
    points.reserve(points_.size());
    for (const auto& [x, y] : points_) points.push_back({x, y});
    std::vector<plane::Line> lines;
    std::vector<bool> has_piece;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i] == kNowhere) continue;
        lines.push_back({ends_[i].from, ends_[i].to});
        has_piece.push_back((sides[i] & kLeft) != 0);
        has_piece.push_back((sides[i] & kRight) != 0);
    }
    const plane::Faces<lattice::Point> faces(points, lines, std::move(has_piece));
    const plane::Graph<lattice::Point>& graph = faces.graph();
    const auto goes_on = [&](Index before, Index half) {
        return lattice::cross(graph.pointOf(graph.source(before)),
                              graph.pointOf(graph.source(half)),
                              graph.pointOf(graph.target(half))) == 0;
    };
    std::vector<Region> regions(faces.count());
    const auto face_of = [&](Index half) { return faces.of(half); };
    faces.forEachBoundary(face_of, [&](Index face, const plane::Loop& loop, bool is_outline) {
        Polygon curve;
        curve.reserve(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (!goes_on(loop[i == 0 ? loop.size() - 1 : i - 1], loop[i]))
                curve.push_back(place(graph.source(loop[i])));
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
