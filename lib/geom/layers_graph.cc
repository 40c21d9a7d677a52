// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/layers_graph.h"

#include <numeric>
#include <set>

namespace ispace::lattice {

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
