// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay_lattice.h"

#include <bit>
#include <numeric>
#include <set>

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
    return static_cast<Index>(first_.size() - 2);
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

/// Several edges with the same ends as one.
Edge joined(std::span<const Edge> same, SetStore& sets, std::vector<Index>& layers) {
    Edge edge = same.front();
    bool is_first = true;
    layers.clear();
    for (const Edge& other : same) {
        edge.is_wall = edge.is_wall || other.is_wall;
        const std::span<const Index> set = sets[other.set];
        if (set.empty()) continue;
        layers.insert(layers.end(), set.begin(), set.end());
        // Where an arc lies along something else, within a chord's error, it is nothing round.
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

PlaneGraph::PlaneGraph(const std::vector<Point>& points, const std::vector<Line>& lines)
    : points_(points), lines_(lines), first_(points.size() + 1, 0) {
    for (const Line& line : lines) {
        ++first_[line.from + 1];
        ++first_[line.to + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    order_.resize(2 * lines.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (Index half = 0; half < order_.size(); ++half) order_[next[source(half)]++] = half;
    place_.resize(order_.size());
    for (Index v = 0; v + 1 < first_.size(); ++v) {
        const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(first_[v]);
        const auto end = order_.begin() + static_cast<std::ptrdiff_t>(first_[v + 1]);
        std::sort(begin, end, [&](Index g, Index h) {
            // Even ones lead to the right or straight up, the others to the left or down.
            if (g % 2 != h % 2) return g % 2 < h % 2;
            return cross(points_[v], points_[target(g)], points_[target(h)]) > 0;
        });
        for (auto half = begin; half != end; ++half)
            place_[*half] = static_cast<Index>(half - begin);
    }
}

bool PlaneGraph::isAbove(Point p, Index line) const {
    return cross(points_[lines_[line].from], points_[lines_[line].to], p) > 0;
}

/// Of two lines over a common stretch of x.
bool PlaneGraph::isAbove(Index line, Index other) const {
    const Line e = lines_[line], f = lines_[other];
    if (lexLess(points_[e.from], points_[f.from])) return !isAbove(other, line);
    return isAbove(points_[e.from == f.from ? e.to : e.from], other);
}

std::vector<Index> PlaneGraph::linesBelow(const std::vector<Index>& vertices) const {
    // For a few points it is quicker to look at all lines.
    constexpr std::size_t kFew = 16;
    std::vector<Index> below(vertices.size(), kNone);
    if (vertices.size() > kFew) {
        sweepBelow(vertices, below);
        return below;
    }
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const Point p = points_[vertices[k]];
        for (Index i = 0; i < lines_.size(); ++i) {
            if (points_[lines_[i].from].x >= p.x || p.x > points_[lines_[i].to].x) continue;
            if (isAbove(p, i) && (below[k] == kNone || isAbove(i, below[k]))) below[k] = i;
        }
    }
    return below;
}

void PlaneGraph::sweepBelow(const std::vector<Index>& vertices, std::vector<Index>& below) const {
    enum Kind { Ask, End, Begin };
    struct Event {
        std::int32_t x;
        Kind kind;
        Index index;
    };
    std::vector<Event> events;
    events.reserve(vertices.size() + 2 * lines_.size());
    for (Index k = 0; k < vertices.size(); ++k) events.push_back({points_[vertices[k]].x, Ask, k});
    for (Index i = 0; i < lines_.size(); ++i) {
        const std::int32_t x0 = points_[lines_[i].from].x, x1 = points_[lines_[i].to].x;
        if (x0 == x1) continue;
        events.push_back({x0, Begin, i});
        events.push_back({x1, End, i});
    }
    std::sort(events.begin(), events.end(), [](const Event& e, const Event& f) {
        if (e.x != f.x) return e.x < f.x;
        return e.kind != f.kind ? e.kind < f.kind : e.index < f.index;
    });
    struct Lower {
        using is_transparent = void;  // NOLINT: as std::set looks for it
        const PlaneGraph* graph;
        bool operator()(Index e, Index f) const { return e != f && graph->isAbove(f, e); }
        bool operator()(Index line, Point p) const { return graph->isAbove(p, line); }
    };
    std::set<Index, Lower> status(Lower{this});
    std::vector<std::set<Index, Lower>::iterator> place(lines_.size());
    for (const Event& event : events) {
        if (event.kind == Begin) {
            place[event.index] = status.insert(event.index).first;
        } else if (event.kind == End) {
            status.erase(place[event.index]);
        } else {
            const auto above = status.lower_bound(points_[vertices[event.index]]);
            if (above != status.begin()) below[event.index] = *std::prev(above);
        }
    }
}

}  // namespace ispace::lattice
