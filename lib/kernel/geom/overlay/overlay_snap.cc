// SPDX-License-Identifier: GPL-3.0-or-later
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "geom/overlay/overlay_cells.h"
#include "geom/overlay/overlay_lattice.h"

namespace ispace::lattice {

void mustBeFew(std::size_t crossings) {
    constexpr std::size_t kMaxCrossings = 16'000'000;
    if (crossings > kMaxCrossings)
        throw FormatError(
            {"", 0, 0, "outlines cross more than " + std::to_string(kMaxCrossings) + " times"});
}

void PassBudget::spend(std::size_t passes) {
    if ((spent_ += passes) > most_)
        throw FormatError({"", 0, 0,
                           "outlines cross more than " + std::to_string(most_) +
                               " times (`--max-work " + std::to_string(2 * most_) +
                               "` allows more)"});
}

namespace {

/// An edge passes a point.
struct Pass {
    Index edge, point;
    std::int64_t at;  // grows along the edge
};

/// By edge, in their order along it.
EdgeWaypoints waysOf(const std::vector<Pass>& passes, std::size_t edges) {
    std::vector<std::size_t> next(edges + 1, 0);
    for (const Pass& pass : passes) ++next[pass.edge + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    EdgeWaypoints ways{next, {}};
    std::vector<Pass> ordered(passes.size());
    for (const Pass& pass : passes) ordered[next[pass.edge]++] = pass;
    ways.points.reserve(passes.size());
    for (std::size_t i = 0; i < edges; ++i) {
        const auto first = ordered.begin() + static_cast<std::ptrdiff_t>(ways.first[i]);
        const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(ways.first[i + 1]);
        const auto less = [](const Pass& p, const Pass& q) {
            return p.at != q.at ? p.at < q.at : p.point < q.point;
        };
        if (last - first == 2 && less(first[1], first[0])) std::swap(first[0], first[1]);
        if (last - first > 2) std::sort(first, last, less);
        for (auto pass = first; pass != last; ++pass) ways.points.push_back(pass->point);
    }
    return ways;
}

/// An edge with its cached differences.
struct Span {
    Point a, b;
    std::int32_t low_y, high_y;
    Index edge;

    Span(Index i, const Edge& e, const std::vector<Point>& points)
        : a(points[e.from]),
          b(points[e.to]),
          low_y(std::min(a.y, b.y)),
          high_y(std::max(a.y, b.y)),
          edge(i) {}

    [[nodiscard]] std::int64_t dx() const { return std::int64_t{b.x} - a.x; }
    [[nodiscard]] std::int64_t dy() const { return std::int64_t{b.y} - a.y; }
    /// |dx| + |dy|
    [[nodiscard]] std::int64_t reach() const { return dx() + (std::int64_t{high_y} - low_y); }

    /// True if it meets the pixel about p: the square of half-width 1/2 with its lower and left
    /// sides and the corner between them.
    [[nodiscard]] bool meetsPixel(Point p) const {
        // The pixels that the line meets outside of the box of its ends lie outside of that too.
        if (p.x < a.x || p.x > b.x || p.y < low_y || p.y > high_y) return false;
        const std::int64_t twice = 2 * cross(a, b, p);
        if (std::abs(twice) != reach()) return std::abs(twice) < reach();
        return twice == dx() - dy();  // it touches at a corner: this is the lower left one
    }

    /// Grows from pixel to pixel that it meets.
    [[nodiscard]] std::int64_t at(Point p) const {
        return std::int64_t{p.x} - a.x +
               (b.y < a.y ? std::int64_t{a.y} - p.y : std::int64_t{p.y} - a.y);
    }
};

/// Ends of edges that lay along another before rounding: both were moved by at most half a step in
/// x and in y.
std::vector<Pass> passesOfEnds(const std::vector<Edge>& edges, const std::vector<Point>& points) {
    constexpr std::size_t kAtOnce = 8192;  // edges
    const PointGrid grid(points);
    const auto add_of = [&](Index i, std::vector<Pass>& passes) {
        const Span s(i, edges[i], points);
        const std::int64_t reach = s.reach(), square = s.dx() * s.dx() + s.dy() * s.dy();
        grid.forEachNear(s.a, s.b, [&](Point p, Index number) {
            // All at once, as most are near enough that are ends of the edge itself.
            const std::int64_t at = dot(s.a, s.b, p);
            const int is_near = int(std::abs(cross(s.a, s.b, p)) <= reach);
            if ((is_near & int(at > 0) & int(at < square)) != 0) passes.push_back({i, number, at});
        });
        mustBeFew(passes.size());
    };
    std::vector<std::vector<Pass>> blocks(edges.size() / kAtOnce + 1);
    std::atomic<std::size_t> count = 0;
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
        const std::size_t end = std::min(edges.size(), (b + 1) * kAtOnce);
        for (std::size_t i = b * kAtOnce; i < end; ++i) add_of(static_cast<Index>(i), blocks[b]);
        mustBeFew(count += blocks[b].size());
    });
    std::vector<Pass> passes = std::move(blocks.front());
    for (std::size_t b = 1; b < blocks.size(); ++b) {
        passes.insert(passes.end(), blocks[b].begin(), blocks[b].end());
        blocks[b] = {};
    }
    return passes;
}

/// Computes start + length * num / den rounded to the nearest, halves up. \pre 0 < num < den
std::int32_t along(std::int32_t start, std::int64_t length, std::int64_t num, std::int64_t den) {
    // Doubles err by less than 2^-20 here.
    constexpr double kSure = 1e-5;
    const double v =
        static_cast<double>(length) * (static_cast<double>(num) / static_cast<double>(den)) + 0.5;
    const double floor = std::floor(v);
    if (v - floor > kSure && v - floor < 1 - kSure) return start + static_cast<std::int32_t>(floor);
    const __int128 top = 2 * static_cast<__int128>(length) * num + den;
    const __int128 bottom = 2 * static_cast<__int128>(den);
    const __int128 quotient = top / bottom - (top % bottom < 0 ? 1 : 0);
    return start + static_cast<std::int32_t>(quotient);
}

/// Finds the pixel in which two edges cross, if they do so at a point that is no end.
bool crossingOf(const Span& s, const Span& t, Point& pixel) {
    if (s.b.x < t.a.x || t.b.x < s.a.x || s.high_y < t.low_y || t.high_y < s.low_y) return false;
    const std::int64_t from = cross(s.a, s.b, t.a), to = cross(s.a, s.b, t.b);
    if (from == 0 || to == 0 || (from > 0) == (to > 0)) return false;
    const std::int64_t left = cross(t.a, t.b, s.a), right = cross(t.a, t.b, s.b);
    if (left == 0 || right == 0 || (left > 0) == (right > 0)) return false;
    const std::int64_t num = std::abs(from), den = std::abs(from) + std::abs(to);
    pixel = {along(t.a.x, t.dx(), num, den), along(t.a.y, t.dy(), num, den)};
    return true;
}

/// Finds all edges that meet the pixels of ends and crossings.
std::vector<Pass> passesOfPixels(const std::vector<Edge>& edges, PointTable& table,
                                 const Columns& columns, PassBudget& budget) {
    std::vector<Pass> passes;
    passes.reserve(4 * edges.size());
    std::vector<Index> pixels;
    std::vector<Span> spans;
    forEachCell(table.points(), edges, columns, [&](const Cell& cell) {
        const std::size_t passes_before = passes.size();
        pixels.assign(cell.points.begin(), cell.points.end());
        spans.clear();
        for (const Index i : cell.edges) spans.emplace_back(i, edges[i], table.points());
        for (std::size_t i = 0; i < spans.size(); ++i) {
            for (std::size_t k = i + 1; k < spans.size(); ++k) {
                Point p;
                // Each pixel belongs to one cell, which holds all edges that meet it.
                if (!crossingOf(spans[i], spans[k], p) || !cell.box.holds(p)) continue;
                const std::size_t before = table.points().size();
                if (const Index id = table.add(p); id == before) pixels.push_back(id);
            }
        }
        for (const Index id : pixels) {
            const Point p = table.points()[id];
            for (const Span& s : spans) {
                if (s.meetsPixel(p) && p != s.a && p != s.b)
                    passes.push_back({s.edge, id, s.at(p)});
            }
        }
        mustBeFew(passes.size());
        budget.spend(passes.size() - passes_before);
    });
    return passes;
}

}  // namespace

std::vector<Edge> routed(const std::vector<Edge>& edges, const EdgeWaypoints& ways) {
    std::vector<Edge> pieces;
    pieces.reserve(edges.size() + ways.points.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
        Edge piece = edges[i];
        const auto lead_to = [&](Index point) {
            piece.to = point;
            if (piece.from != kNone && piece.to != kNone) pieces.push_back(piece);
            piece.from = point;
        };
        for (const Index point : ways[i]) lead_to(point);
        lead_to(edges[i].to);
    }
    return pieces;
}

std::vector<Edge> splitAtVertices(const std::vector<Edge>& edges,
                                  const std::vector<Point>& points) {
    return routed(edges, waysOf(passesOfEnds(edges, points), edges.size()));
}

EdgeWaypoints waysThroughPixels(const std::vector<Edge>& edges, PointTable& table,
                                const Columns& columns, PassBudget& budget) {
    return waysOf(passesOfPixels(edges, table, columns, budget), edges.size());
}

std::vector<Edge> snapRounded(std::vector<Edge> edges, PointTable& table, SetStore& sets) {
    edges = merged(splitAtVertices(edges, table.points()), table.points(), sets);
    PassBudget budget(Overlay::kAnyCrossings);
    const EdgeWaypoints ways = waysThroughPixels(edges, table, {}, budget);
    return merged(routed(edges, ways), table.points(), sets);
}

}  // namespace ispace::lattice
