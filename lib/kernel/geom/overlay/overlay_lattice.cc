// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay_lattice.h"

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
    edge.circle = kNone;
    layers.clear();
    for (const Edge& other : same) {
        edge.is_wall = edge.is_wall || other.is_wall;
        const std::span<const Index> set = sets[other.set];
        if (set.empty()) continue;
        layers.insert(layers.end(), set.begin(), set.end());
        // Of arcs with one chord the first circle's remains: without any, the area between chord
        // and arc would be lost.
        edge.circle = std::min(edge.circle, other.circle);
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
    if (2 * count < edges.capacity()) edges.shrink_to_fit();  // results wait for others
    return edges;
}

namespace {

using Graph = plane::Graph<Point>;

/// The set of layers that contain a moving point.
class Place {
  public:
    explicit Place(std::span<const Layer> layers) {
        layers_.reserve(layers.size());
        for (const Layer& layer : layers)
            // Numbers may be anything: their sum may wrap around.
            layers_.push_back(
                {layer.counts ? static_cast<std::uint64_t>(layer.number) : layer.marks,
                 layer.counts, false});
    }

    [[nodiscard]] const LayerLabel& label() const { return label_; }
    /// Crosses the boundary of one layer.
    void cross(Index i) {
        Known& layer = layers_[i];
        layer.is_inside = !layer.is_inside;
        if (!layer.counts) return crossMarks(layer.value, layer.is_inside);
        label_.count += layer.is_inside ? 1 : -1;
        const auto sum = static_cast<std::uint64_t>(label_.numbers);
        label_.numbers =
            static_cast<std::int64_t>(layer.is_inside ? sum + layer.value : sum - layer.value);
    }

  private:
    struct Known {
        std::uint64_t value;  // number or marks
        bool counts, is_inside;
    };

    void crossMarks(std::uint64_t marks, bool enters) {
        for (; marks != 0; marks &= marks - 1) {
            const int bit = std::countr_zero(marks);
            Index& count = marking_[static_cast<std::size_t>(bit)];
            count += enters ? 1 : static_cast<Index>(-1);
            const std::uint64_t mask = std::uint64_t{1} << bit;
            label_.marks = count > 0 ? label_.marks | mask : label_.marks & ~mask;
        }
    }

    std::vector<Known> layers_;
    std::array<Index, 64> marking_{};  // layers with each mark
    LayerLabel label_;
};

/// Connected components of the edges between points in some columns: each lies in a face of
/// another, or outside all. Those at the end of an edge that comes in from the left are left out.
class Nesting {
  public:
    Nesting(const Graph& graph, const Columns& columns, bool anything_enters) {
        findRoots(graph, columns);
        if (roots_.size() < 2 && !anything_enters) {
            outermost_ = roots_;
            return;
        }
        const std::vector<Index> below = graph.linesBelow(roots_);
        next_.assign(roots_.size(), kNone);
        first_inside_.assign(graph.halves() / 2, kNone);
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
        if (first_inside_.empty()) return;
        for (Index c = first_inside_[line]; c != kNone; c = next_[c]) visit(roots_[c]);
    }

  private:
    /// Joins the points of each component in a tree with the lowest of them as root.
    void findRoots(const Graph& graph, const Columns& columns) {
        lower_.assign(graph.vertices(), kNone);
        std::vector<Index> entered;
        for (Index half = 0; half < graph.halves(); half += 2) {
            const Index from = graph.source(half), to = graph.target(half);
            const bool has_from = columns.hold(graph.pointOf(from));
            const bool has_to = columns.hold(graph.pointOf(to));
            if (has_from && lower_[from] == kNone) lower_[from] = from;
            if (has_to && lower_[to] == kNone) lower_[to] = to;
            if (has_from && has_to)
                join(graph, lowestFrom(from), lowestFrom(to));
            else if (has_to && graph.pointOf(from).x < columns.first)
                entered.push_back(to);
        }
        for (Index& v : entered) v = lowestFrom(v);
        for (const Index root : entered) lower_[root] = kNone;
        for (Index v = 0; v < lower_.size(); ++v)
            if (lower_[v] == v) roots_.push_back(v);
    }

    /// The root of its tree, to which all on the way are brought nearer.
    Index lowestFrom(Index v) {
        while (lower_[v] != v) {
            lower_[v] = lower_[lower_[v]];
            v = lower_[v];
        }
        return v;
    }

    void join(const Graph& graph, Index root, Index other) {
        if (root == other) return;
        if (lexLess(graph.pointOf(other), graph.pointOf(root))) std::swap(root, other);
        lower_[other] = root;
    }

    std::vector<Index> lower_;         // of each point; roots: themselves
    std::vector<Index> roots_;         // lowest point of each component
    std::vector<Index> next_;          // of the components right above the same line
    std::vector<Index> first_inside_;  // component directly above each line, or empty
    std::vector<Index> outermost_;
};

/// A walk around all points in some columns.
class Walk {
  public:
    Walk(std::span<const Layer> layers, const std::vector<Edge>& edges, const SetStore& sets,
         const Graph& graph, const Columns& columns)
        : sets_(sets), graph_(graph), columns_(columns), place_(layers), labels_(edges.size()) {
        set_of_.reserve(edges.size());
        for (const Edge& edge : edges) set_of_.push_back(edge.set);
        is_done_.reserve(graph.vertices());
        for (Index v = 0; v < graph.vertices(); ++v)
            is_done_.push_back(columns.hold(graph.pointOf(v)) ? 0 : 1);
    }

    std::vector<EdgeLabels> run() {
        const std::vector<Index> entering = linesThatEnter();
        const Nesting nesting(graph_, columns_, !entering.empty());
        for (const Index root : nesting.outermost()) {
            begin(root, 0);
            goOn(nesting);
        }
        // Up along the left side of the columns.
        for (const Index line : entering) {
            cross(line);
            nesting.forEachAbove(line, [&](Index lowest) { begin(lowest, 0); });
            begin(graph_.target(2 * line), graph_.placeOf(2 * line + 1));
            goOn(nesting);
        }
        return std::move(labels_);
    }

  private:
    /// A turn around a point, from before the half-edge at `at`: at its end the set of layers is
    /// the same again, so that turns begun meanwhile may be nested.
    struct Turn {
        std::span<const Index> about;
        Index at;
        Index left;  // half-edges to come
    };

    /// Lines from the left of the columns, from below.
    [[nodiscard]] std::vector<Index> linesThatEnter() const {
        std::vector<Index> lines;
        for (Index i = 0; i < set_of_.size(); ++i)
            if (graph_.pointOf(graph_.source(2 * i)).x < columns_.first) lines.push_back(i);
        std::sort(lines.begin(), lines.end(),
                  [this](Index e, Index f) { return e != f && graph_.isAbove(f, e); });
        return lines;
    }

    void begin(Index vertex, Index at) {
        if (is_done_[vertex] != 0) return;
        is_done_[vertex] = 1;
        const std::span<const Index> about = graph_.leaving(vertex);
        turns_.push_back({about, at, static_cast<Index>(about.size())});
    }

    void cross(Index line) {
        const Index set = set_of_[line];
        if (set < sets_.emptySet()) return place_.cross(set);  // a set with that layer only
        for (const Index layer : sets_[set]) place_.cross(layer);
    }

    void goOn(const Nesting& nesting) {
        while (!turns_.empty()) {
            Turn& turn = turns_.back();
            if (turn.left == 0) {
                turns_.pop_back();
                continue;
            }
            const Index half = turn.about[turn.at];
            turn.at = turn.at + 1 == turn.about.size() ? 0 : turn.at + 1;
            --turn.left;
            const Index line = half / 2;
            if (half % 2 == 0) {
                EdgeLabels& labels = labels_[line];
                labels.right = place_.label();
                cross(line);
                labels.left = place_.label();
                nesting.forEachAbove(line, [&](Index lowest) { begin(lowest, 0); });
            } else {
                cross(line);
            }
            begin(graph_.target(half), graph_.placeOf(plane::twin(half)));
        }
    }

    const SetStore& sets_;
    const Graph& graph_;
    const Columns& columns_;
    Place place_;
    std::vector<Index> set_of_;          // of lines
    std::vector<std::uint8_t> is_done_;  // points: begun, or in other columns
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
