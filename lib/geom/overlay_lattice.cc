// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay_lattice.h"

#include <array>
#include <bit>
#include <numeric>

namespace ispace::lattice {

void PointTable::reserve(std::size_t count) {
    points_.reserve(count);
    if (2 * count > slots_.size()) grow(std::bit_ceil(2 * count));
}

void PointTable::grow(std::size_t slots) {
    slots_.assign(std::max<std::size_t>(slots, 16), kNone);
    shift_ = 64 - std::countr_zero(slots_.size());
    for (Index i = 0; i < points_.size(); ++i) slots_[slotOf(points_[i])] = i;
}

std::size_t PointTable::slotOf(Point p) const {
    const std::uint64_t key =
        std::uint64_t{static_cast<std::uint32_t>(p.x)} << 32 | static_cast<std::uint32_t>(p.y);
    // Two rounds, as coordinates often end in the same bits.
    const std::uint64_t mixed = (key ^ key >> 29) * 0x9E3779B97F4A7C15U;
    std::size_t slot = ((mixed ^ mixed >> 32) * 0xBF58476D1CE4E5B9U) >> shift_;
    while (slots_[slot] != kNone && points_[slots_[slot]] != p)
        slot = (slot + 1) & (slots_.size() - 1);
    return slot;
}

Index PointTable::add(Point p) {
    if (2 * (points_.size() + 1) > slots_.size()) grow(2 * slots_.size());
    Index& slot = slots_[slotOf(p)];
    if (slot == kNone) {
        slot = static_cast<Index>(points_.size());
        points_.push_back(p);
    }
    return slot;
}

SetStore::SetStore(std::size_t layers)
    : empty_(static_cast<Index>(layers)), first_(layers + 2), items_(layers) {
    std::iota(items_.begin(), items_.end(), Index{0});
    std::iota(first_.begin(), first_.end() - 1, std::size_t{0});
    first_.back() = layers;
}

Index SetStore::addOdd(std::vector<Index>& layers) {
    std::sort(layers.begin(), layers.end());
    const std::size_t start = items_.size();
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (items_.size() > start && items_.back() == layers[i])
            items_.pop_back();
        else
            items_.push_back(layers[i]);
    }
    if (items_.size() == start) return empty_;
    if (items_.size() == start + 1) {
        const Index only = items_.back();
        items_.pop_back();
        return only;
    }
    first_.push_back(items_.size());
    return size() - 1;
}

namespace {

/// Edges by their first end, those of each by the other.
std::vector<Edge> sorted(const std::vector<Edge>& edges, std::size_t points) {
    std::vector<std::size_t> next(points + 1, 0);
    for (const Edge& edge : edges) ++next[edge.from + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<Edge> out(edges.size());
    for (const Edge& edge : edges) out[next[edge.from]++] = edge;
    // next[v] is now the end of those that begin at v.
    std::size_t from = 0;
    for (std::size_t v = 0; v < points; from = next[v++]) {
        if (next[v] - from < 2) continue;
        std::sort(out.begin() + static_cast<std::ptrdiff_t>(from),
                  out.begin() + static_cast<std::ptrdiff_t>(next[v]),
                  [](const Edge& e, const Edge& f) {
                      return e.to != f.to ? e.to < f.to : e.set < f.set;
                  });
    }
    return out;
}

/// Merges edges with the same ends.
Edge joined(std::span<const Edge> same, SetStore& sets, std::vector<Index>& layers) {
    Edge edge = same.front();
    bool is_first = true;
    layers.clear();
    for (const Edge& other : same) {
        edge.is_wall = edge.is_wall || other.is_wall;
        const std::span<const Index> set = sets[other.set];
        if (set.empty()) continue;
        layers.insert(layers.end(), set.begin(), set.end());
        // An arc along another edge, within a chord's error, no longer counts as one.
        if (is_first)
            edge.circle = other.circle;
        else if (edge.circle != other.circle)
            edge.circle = kNone;
        is_first = false;
    }
    edge.set = sets.addOdd(layers);
    return edge;
}

}  // namespace

std::vector<Edge> merged(std::vector<Edge> edges, const std::vector<Point>& points,
                         SetStore& sets) {
    std::erase_if(edges, [](const Edge& edge) { return edge.from == edge.to; });
    for (Edge& edge : edges) {
        if (lexLess(points[edge.to], points[edge.from])) std::swap(edge.from, edge.to);
    }
    edges = sorted(edges, points.size());
    std::vector<Index> layers;
    std::size_t count = 0;
    for (std::size_t from = 0, to = 0; from < edges.size(); from = to) {
        while (to < edges.size() && edges[to].from == edges[from].from &&
               edges[to].to == edges[from].to)
            ++to;
        const Edge edge = to - from == 1
                              ? edges[from]
                              : joined(std::span(edges).subspan(from, to - from), sets, layers);
        if (edge.is_wall || edge.set != sets.emptySet()) edges[count++] = edge;
    }
    edges.resize(count);
    return edges;
}

namespace {

using Graph = plane::Graph<Point>;

/// The layers that contain a point, as it moves.
class Place {
  public:
    explicit Place(std::span<const Layer> layers) : layers_(layers), inside_(layers.size()) {}

    [[nodiscard]] const LayerLabel& label() const { return label_; }
    /// Crosses the boundary of these.
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

/// Connected components of the edges between points in some columns: each lies in a face of
/// another, or outside all. Those at the end of an edge that comes in from the left are left out.
class Nesting {
  public:
    Nesting(const Graph& graph, const Columns& columns, bool anything_enters)
        : columns_(columns),
          component_of_(graph.vertices(), kNone),
          first_inside_(graph.halves() / 2, kNone) {
        for (Index v = 0; v < graph.vertices(); ++v) {
            if (component_of_[v] == kNone && columns.hold(graph.pointOf(v)) &&
                !graph.leaving(v).empty())
                addComponent(graph, v);
        }
        next_.assign(roots_.size(), kNone);
        if (roots_.size() < 2 && !anything_enters) {
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

    /// Lowest points (lexLess) of the components outside all others.
    [[nodiscard]] const std::vector<Index>& outermost() const { return outermost_; }
    /// Calls visit(lowest point) for each component directly above this line.
    template <typename Visit>
    void forEachAbove(Index line, Visit visit) const {
        for (Index c = first_inside_[line]; c != kNone; c = next_[c]) visit(roots_[c]);
    }

  private:
    void addComponent(const Graph& graph, Index start) {
        const auto number = static_cast<Index>(roots_.size());
        Index lowest = start;
        bool is_entered = false;
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
                if (!columns_.hold(graph.pointOf(other))) {
                    is_entered = is_entered || graph.pointOf(other).x < columns_.first;
                    continue;
                }
                component_of_[other] = number;
                open.push_back(other);
            }
        }
        if (!is_entered) roots_.push_back(lowest);
    }

    const Columns& columns_;

    std::vector<Index> component_of_;  // points
    std::vector<Index> roots_;         // lowest point of each component
    std::vector<Index> next_;          // of the components right above the same line
    std::vector<Index> first_inside_;  // component right above each line
    std::vector<Index> outermost_;
    std::vector<Index> open_;
};

/// A walk around all points in some columns.
class Walk {
  public:
    Walk(std::span<const Layer> layers, const std::vector<Edge>& edges, const SetStore& sets,
         const Graph& graph, const Columns& columns)
        : edges_(edges),
          sets_(sets),
          graph_(graph),
          columns_(columns),
          place_(layers),
          begun_(graph.vertices()),
          labels_(edges.size()) {}

    std::vector<EdgeLabels> run() {
        const std::vector<Index> entering = linesThatEnter();
        const Nesting nesting(graph_, columns_, !entering.empty());
        for (const Index root : nesting.outermost()) {
            begin(root, 0);
            goOn(nesting);
        }
        // Up along the left side of the columns.
        for (const Index line : entering) {
            place_.cross(sets_[edges_[line].set]);
            nesting.forEachAbove(line, [&](Index lowest) { begin(lowest, 0); });
            begin(edges_[line].to, graph_.placeOf(2 * line + 1));
            goOn(nesting);
        }
        return std::move(labels_);
    }

  private:
    /// A turn around a point, from before the half-edge at `at`: at its end the place is the same
    /// again, so that turns begun meanwhile may be made one within another.
    struct Turn {
        Index vertex, at;
        Index left;  // half-edges to come
    };

    /// Lines from the left of the columns, from below.
    [[nodiscard]] std::vector<Index> linesThatEnter() const {
        std::vector<Index> lines;
        for (Index i = 0; i < edges_.size(); ++i)
            if (graph_.pointOf(edges_[i].from).x < columns_.first) lines.push_back(i);
        std::sort(lines.begin(), lines.end(),
                  [this](Index e, Index f) { return e != f && graph_.isAbove(f, e); });
        return lines;
    }

    void begin(Index vertex, Index at) {
        if (begun_[vertex] || !columns_.hold(graph_.pointOf(vertex))) return;
        begun_[vertex] = true;
        turns_.push_back({vertex, at, static_cast<Index>(graph_.leaving(vertex).size())});
    }

    void goOn(const Nesting& nesting) {
        while (!turns_.empty()) {
            Turn& turn = turns_.back();
            if (turn.left == 0) {
                turns_.pop_back();
                continue;
            }
            const std::span<const Index> about = graph_.leaving(turn.vertex);
            const Index half = about[turn.at];
            turn.at = turn.at + 1 == about.size() ? 0 : turn.at + 1;
            --turn.left;
            const Index line = half / 2;
            if (half % 2 == 0) labels_[line].right = place_.label();
            place_.cross(sets_[edges_[line].set]);
            if (half % 2 == 0) {
                labels_[line].left = place_.label();
                nesting.forEachAbove(line, [&](Index lowest) { begin(lowest, 0); });
            }
            begin(graph_.target(half), graph_.placeOf(plane::twin(half)));
        }
    }

    const std::vector<Edge>& edges_;
    const SetStore& sets_;
    const Graph& graph_;
    const Columns& columns_;
    Place place_;
    std::vector<bool> begun_;  // points
    std::vector<Turn> turns_;
    std::vector<EdgeLabels> labels_;
};

}  // namespace

std::vector<EdgeLabels> labelsOf(std::span<const Layer> layers, const std::vector<Point>& points,
                                 const std::vector<Edge>& edges, const SetStore& sets,
                                 const Columns& columns) {
    std::vector<plane::Line> lines;
    lines.reserve(edges.size());
    for (const Edge& edge : edges) lines.push_back({edge.from, edge.to});
    const Graph graph(points, lines);
    return Walk(layers, edges, sets, graph, columns).run();
}

}  // namespace ispace::lattice
