// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay_lattice.h"

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

}  // namespace ispace::lattice
