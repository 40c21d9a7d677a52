// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/plane_graph.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <limits>
#include <numeric>
#include <set>

#include "geom/overlay/overlay_lattice.h"
#include "geom/predicates.h"

namespace ispace {

static bool isLeft(Point2 a, Point2 b, Point2 c) { return orientation(a, b, c) == Turn::Left; }

namespace lattice {

static bool isLeft(Point a, Point b, Point c) { return cross(a, b, c) > 0; }

}  // namespace lattice

namespace plane {

namespace {

/// The order of lines over a common stretch of x, from below.
template <typename P>
struct Lower {
    using is_transparent = void;  // NOLINT: as std::set looks for it
    const Graph<P>* graph;
    bool operator()(Index e, Index f) const { return e != f && graph->isAbove(f, e); }
    bool operator()(Index line, const P& p) const { return graph->isAbove(p, line); }
};

}  // namespace

template <typename P>
Graph<P>::Graph(const std::vector<P>& points, const std::vector<Line>& lines)
    : points_(points), lines_(lines), first_(points.size() + 1, 0), order_(2 * lines.size()) {
    // About each point first those that lead to the right or straight up, which are even, then the
    // others, to the left or down.
    std::vector<Index> odd(points.size(), 0);
    for (const Line& line : lines) {
        ++first_[line.from + 1];
        ++odd[line.to];
    }
    std::vector<Index> even(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        even[v] = first_[v];
        const Index middle = first_[v] + first_[v + 1];
        first_[v + 1] = middle + odd[v];
        odd[v] = middle;
    }
    for (Index i = 0; i < lines.size(); ++i) {
        order_[even[lines[i].from]++] = 2 * i;
        order_[odd[lines[i].to]++] = 2 * i + 1;
    }
    place_.resize(order_.size());
    for (Index v = 0; v + 1 < first_.size(); ++v) {
        sortAbout(v, first_[v], even[v]);
        sortAbout(v, even[v], first_[v + 1]);
        for (Index i = first_[v]; i < first_[v + 1]; ++i) place_[order_[i]] = i - first_[v];
    }
}

/// Counter-clockwise. \pre all lead to the right, or all to the left
template <typename P>
void Graph<P>::sortAbout(Index vertex, Index from, Index to) {
    const auto less = [&](Index g, Index h) {
        return g != h && isLeft(points_[vertex], points_[target(g)], points_[target(h)]);
    };
    // Mostly there are one or two.
    if (to - from == 2 && less(order_[from + 1], order_[from]))
        std::swap(order_[from], order_[from + 1]);
    if (to - from > 2) std::sort(order_.begin() + from, order_.begin() + to, less);
}

template <typename P>
bool Graph<P>::isAbove(const P& p, Index line) const {
    return isLeft(points_[lines_[line].from], points_[lines_[line].to], p);
}

template <typename P>
bool Graph<P>::isAbove(Index line, Index other) const {
    const Line e = lines_[line], f = lines_[other];
    if (lexLess(points_[e.from], points_[f.from])) return !isAbove(other, line);
    return isAbove(points_[e.from == f.from ? e.to : e.from], other);
}

template <typename P>
std::vector<Index> Graph<P>::linesBelow(const std::vector<Index>& vertices) const {
    // For a few points it is quicker to look at all lines.
    constexpr std::size_t kFew = 16;
    std::vector<Index> below(vertices.size(), kNone);
    if (vertices.size() > kFew) {
        sweepBelow(vertices, below);
        return below;
    }
    for (std::size_t k = 0; k < vertices.size(); ++k) {
        const P& p = points_[vertices[k]];
        for (Index i = 0; i < lines_.size(); ++i) {
            if (points_[lines_[i].from].x >= p.x || p.x > points_[lines_[i].to].x) continue;
            if (isAbove(p, i) && (below[k] == kNone || isAbove(i, below[k]))) below[k] = i;
        }
    }
    return below;
}

/// Lines bear only on points above them: in stretches of x, several at once.
template <typename P>
void Graph<P>::sweepBelow(const std::vector<Index>& vertices, std::vector<Index>& below) const {
    constexpr std::size_t kMany = 20'000;  // lines
    const auto stretches = lines_.size() < kMany
                               ? std::size_t{1}
                               : static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    std::vector<decltype(P::x)> xs, last;  // where lines begin; ends of all stretches but the last
    if (stretches > 1) {
        xs.reserve(lines_.size());
        for (const Line& line : lines_) xs.push_back(points_[line.from].x);
        tbb::this_task_arena::isolate([&] { tbb::parallel_sort(xs.begin(), xs.end()); });
        for (std::size_t i = 1; i < stretches; ++i) last.push_back(xs[i * xs.size() / stretches]);
    }
    const auto sweep = [&](std::size_t i) {
        using Limits = std::numeric_limits<decltype(P::x)>;
        constexpr auto kFirst = Limits::has_infinity ? -Limits::infinity() : Limits::lowest();
        sweepBelow(vertices, i == 0 ? kFirst : last[i - 1],
                   i == last.size() ? Limits::max() : last[i], below);
    };
    if (stretches == 1) return sweep(0);
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, stretches, sweep); });
}

/// For points with after < x <= last.
template <typename P>
void Graph<P>::sweepBelow(const std::vector<Index>& vertices, decltype(P::x) after,
                          decltype(P::x) last, std::vector<Index>& below) const {
    enum Kind { Ask, End, Begin };
    struct Event {
        decltype(P::x) x;
        Kind kind;
        Index index;
    };
    std::vector<Event> events;
    events.reserve(lines_.size());
    for (Index k = 0; k < vertices.size(); ++k)
        if (const auto x = points_[vertices[k]].x; after < x && x <= last)
            events.push_back({x, Ask, k});
    if (events.empty()) return;
    for (Index i = 0; i < lines_.size(); ++i) {
        const auto x0 = points_[lines_[i].from].x, x1 = points_[lines_[i].to].x;
        if (x0 == x1 || x1 <= after || x0 >= last) continue;
        events.push_back({x0, Begin, i});
        events.push_back({x1, End, i});
    }
    std::sort(events.begin(), events.end(), [](const Event& e, const Event& f) {
        if (e.x != f.x) return e.x < f.x;
        return e.kind != f.kind ? e.kind < f.kind : e.index < f.index;
    });
    std::set<Index, Lower<P>> status(Lower<P>{this});
    std::vector<typename std::set<Index, Lower<P>>::iterator> place(lines_.size());
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

template <typename P>
Faces<P>::Faces(const std::vector<P>& points, const std::vector<Line>& lines,
                std::vector<bool> wanted)
    : graph_(points, lines) {
    wanted.resize(graph_.halves(), wanted.empty());
    walkCycles(wanted);
    placeHoles();
}

template <typename P>
Index Faces<P>::lowestOf(const Loop& loop) const {
    return *std::min_element(loop.begin(), loop.end(), [this](Index g, Index h) {
        return lexLess(graph_.pointOf(graph_.source(g)), graph_.pointOf(graph_.source(h)));
    });
}

/// The boundary is a hole if the direction to the left of its lowest point lies on its left, at
/// one of its visits there.
template <typename P>
bool Faces<P>::isOutline(const Loop& loop) const {
    const Index lowest = graph_.source(lowestOf(loop));
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (graph_.source(loop[i]) != lowest) continue;
        const Index before = loop[i == 0 ? loop.size() - 1 : i - 1];
        // The left side extends from the half-edge that leaves, counter-clockwise, to the one that
        // came.
        if (graph_.placeOf(twin(before)) <= graph_.placeOf(loop[i])) return false;
    }
    return true;
}

/// Cycles of half-edges, each around a face or around a connected component.
template <typename P>
void Faces<P>::walkCycles(const std::vector<bool>& wanted) {
    cycle_.assign(graph_.halves(), kNone);
    Loop loop;
    for (Index start = 0; start < graph_.halves(); ++start) {
        if (!wanted[start] || cycle_[start] != kNone) continue;
        loop.clear();
        const auto number = static_cast<Index>(face_of_cycle_.size());
        for (Index half = start; cycle_[half] == kNone; half = graph_.next(half)) {
            cycle_[half] = number;
            loop.push_back(half);
        }
        const bool is_outline = isOutline(loop);
        face_of_cycle_.push_back(is_outline ? count_++ : kNone);
        if (!is_outline) holes_.push_back(lowestOf(loop));
    }
}

/// Finds the face that contains each hole, from left to right: the line below begins farther left.
template <typename P>
void Faces<P>::placeHoles() {
    std::sort(holes_.begin(), holes_.end(), [this](Index g, Index h) {
        const P &p = graph_.pointOf(graph_.source(g)), &q = graph_.pointOf(graph_.source(h));
        return p == q ? g < h : lexLess(p, q);
    });
    std::vector<Index> vertices;
    vertices.reserve(holes_.size());
    for (const Index half : holes_) vertices.push_back(graph_.source(half));
    const std::vector<Index> below = graph_.linesBelow(vertices);
    for (std::size_t i = 0; i < holes_.size(); ++i)
        if (below[i] != kNone) face_of_cycle_[cycle_[holes_[i]]] = of(2 * below[i]);
}

template class Graph<Point2>;
template class Graph<lattice::Point>;
template class Faces<Point2>;
template class Faces<lattice::Point>;

}  // namespace plane
}  // namespace ispace
