// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string>

#include "base/error.h"
#include "geom/overlay_lattice.h"

namespace ispace::lattice {

namespace {

/// Few enough to be compared each with each.
constexpr std::size_t kFew = 32;
constexpr std::size_t kCellsPerEdge = 2;
constexpr int kSmallestShift = 4;  // of a cell's side

/// Beyond kReach: for the rounding of heights, which is far below a step.
constexpr std::int64_t kSlack = kReach + 1;

/// Lists for each cell, one after another.
struct Lists {
    std::vector<std::size_t> first;
    std::vector<Index> items;

    [[nodiscard]] std::span<const Index> operator[](std::size_t i) const {
        return std::span(items).subspan(first[i], first[i + 1] - first[i]);
    }
};

/// Items by cell, in the order in which they came.
Lists listsOf(std::size_t cells, const std::vector<Index>& cell, const std::vector<Index>& item) {
    Lists lists;
    lists.first.assign(cells + 2, 0);
    for (const Index c : cell) ++lists.first[c + 2];
    std::partial_sum(lists.first.begin(), lists.first.end(), lists.first.begin());
    lists.items.resize(item.size());
    for (std::size_t i = 0; i < item.size(); ++i) lists.items[lists.first[cell[i] + 1]++] = item[i];
    return lists;
}

class Division {
  public:
    Division(const std::vector<Point>& points, const std::vector<Edge>& edges,
             const std::function<void(const Cell&)>& visit)
        : points_(points), edges_(edges), visit_(visit) {}

    void divide(const Cell& cell) const {
        const std::size_t n = cell.edges.size();
        if (n == 0) return;
        const Grid grid(cell.box, n);
        if (n <= kFew || grid.columns * grid.rows == 1) return visit_(cell);
        const Lists edges = edgesByCell(grid, cell.edges);
        const Lists points = pointsByCell(grid, cell.points);
        const auto count = static_cast<std::size_t>(grid.columns * grid.rows);
        std::size_t work = 0;
        for (std::size_t i = 0; i < count; ++i)
            work += edges[i].size() * (edges[i].size() + points[i].size());
        // Most of them may crowd in one cell, to be parted there.
        const bool is_parted = 2 * work <= n * (n + cell.points.size());
        if (!is_parted && 2 * edges.items.size() > 3 * n) return visit_(cell);
        for (std::size_t i = 0; i < count; ++i) divide({grid.boxOf(i), edges[i], points[i]});
    }

  private:
    struct Grid {
        Box box;
        int shift = 31;
        std::int64_t columns = 1, rows = 1;

        Grid(const Box& b, std::size_t edges) : box(b) {
            const std::int64_t width = std::int64_t{box.high.x} - box.low.x;
            const std::int64_t depth = std::int64_t{box.high.y} - box.low.y;
            const auto most = static_cast<std::int64_t>(kCellsPerEdge * edges);
            for (int s = shift; s >= kSmallestShift; --s) {
                const std::int64_t across = (width >> s) + 1, along = (depth >> s) + 1;
                if (across > most || along > most || across * along > most) break;
                shift = s;
                columns = across;
                rows = along;
            }
        }

        [[nodiscard]] Box boxOf(std::size_t cell) const {
            const auto i = static_cast<std::int64_t>(cell);
            const std::int64_t x = box.low.x + ((i % columns) << shift);
            const std::int64_t y = box.low.y + ((i / columns) << shift);
            const std::int64_t side = (std::int64_t{1} << shift) - 1;
            const auto up_to = [](std::int64_t v, std::int32_t most) {
                return static_cast<std::int32_t>(std::min<std::int64_t>(v, most));
            };
            return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                    {up_to(x + side, box.high.x), up_to(y + side, box.high.y)}};
        }
    };

    /// Calls visit for the cells to which the edge comes near, each once.
    template <typename Visit>
    void forEachCellOf(const Grid& grid, const Edge& edge, Visit visit) const {
        const Point a = points_[edge.from], b = points_[edge.to];  // a.x <= b.x
        const Point low = grid.box.low;
        const std::int64_t first =
            std::max<std::int64_t>(0, (std::int64_t{a.x} - low.x - kSlack) >> grid.shift);
        const std::int64_t last =
            std::min(grid.columns - 1, (std::int64_t{b.x} - low.x + kSlack) >> grid.shift);
        const double bottom = std::min(a.y, b.y), top = std::max(a.y, b.y);
        const double slope = a.x == b.x ? 0 : (double(b.y) - a.y) / (double(b.x) - a.x);
        for (std::int64_t c = first; c <= last; ++c) {
            double from = bottom, to = top;
            if (a.x != b.x && first != last) {
                // The stretch of the edge over this column.
                const std::int64_t left = low.x + (c << grid.shift) - kSlack;
                const std::int64_t right = left + (std::int64_t{1} << grid.shift) + 2 * kSlack;
                const double y0 = a.y + static_cast<double>(left - a.x) * slope;
                const double y1 = a.y + static_cast<double>(right - a.x) * slope;
                from = std::max(bottom, std::min(y0, y1));
                to = std::min(top, std::max(y0, y1));
            }
            const std::int64_t row0 =
                (static_cast<std::int64_t>(from) - low.y - kSlack - 1) >> grid.shift;
            const std::int64_t row1 =
                (static_cast<std::int64_t>(to) - low.y + kSlack + 1) >> grid.shift;
            for (std::int64_t r = std::max<std::int64_t>(0, row0);
                 r <= std::min(grid.rows - 1, row1); ++r)
                visit(static_cast<Index>(r * grid.columns + c));
        }
    }

    [[nodiscard]] Lists edgesByCell(const Grid& grid, std::span<const Index> edges) const {
        std::vector<Index> cell, item;
        cell.reserve(4 * edges.size());
        item.reserve(4 * edges.size());
        for (const Index i : edges) {
            forEachCellOf(grid, edges_[i], [&](Index c) {
                cell.push_back(c);
                item.push_back(i);
            });
        }
        return listsOf(static_cast<std::size_t>(grid.columns * grid.rows), cell, item);
    }

    [[nodiscard]] Lists pointsByCell(const Grid& grid, std::span<const Index> points) const {
        std::vector<Index> cell;
        cell.reserve(points.size());
        for (const Index i : points) {
            const std::int64_t c = (std::int64_t{points_[i].x} - grid.box.low.x) >> grid.shift;
            const std::int64_t r = (std::int64_t{points_[i].y} - grid.box.low.y) >> grid.shift;
            cell.push_back(static_cast<Index>(r * grid.columns + c));
        }
        return listsOf(static_cast<std::size_t>(grid.columns * grid.rows), cell,
                       {points.begin(), points.end()});
    }

    const std::vector<Point>& points_;
    const std::vector<Edge>& edges_;
    const std::function<void(const Cell&)>& visit_;
};

}  // namespace

void forEachCell(const std::vector<Point>& points, const std::vector<Edge>& edges,
                 const Columns& columns, const std::function<void(const Cell&)>& visit) {
    // What is visited may add points: those that were there are enough to look for.
    std::vector<Index> all_edges(edges.size()), points_there;
    std::iota(all_edges.begin(), all_edges.end(), Index{0});
    points_there.reserve(points.size());
    Box box;
    for (Index i = 0; i < points.size(); ++i) {
        box.add(points[i]);
        if (columns.hold(points[i])) points_there.push_back(i);
    }
    box.low.x = std::max(box.low.x, columns.first);
    box.high.x = std::min(box.high.x, columns.last);
    if (box.low.x > box.high.x) return;
    Division(points, edges, visit).divide({box, all_edges, points_there});
}

void mustBeFew(std::size_t crossings) {
    constexpr std::size_t kMost = 16'000'000;
    if (crossings > kMost)
        throw FormatError(
            {"", 0, 0, "outlines cross more than " + std::to_string(kMost) + " times"});
}

namespace {

/// An edge passes a point.
struct Pass {
    Index edge, point;
    std::int64_t at;  // grows along the edge
};

/// By edge, in their order along it.
Ways waysOf(const std::vector<Pass>& passes, std::size_t edges) {
    std::vector<std::size_t> next(edges + 1, 0);
    for (const Pass& pass : passes) ++next[pass.edge + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    Ways ways{next, {}};
    std::vector<Pass> ordered(passes.size());
    for (const Pass& pass : passes) ordered[next[pass.edge]++] = pass;
    ways.points.reserve(passes.size());
    for (std::size_t i = 0; i < edges; ++i) {
        const auto first = ordered.begin() + static_cast<std::ptrdiff_t>(ways.first[i]);
        const auto last = ordered.begin() + static_cast<std::ptrdiff_t>(ways.first[i + 1]);
        std::sort(first, last, [](const Pass& p, const Pass& q) {
            return p.at != q.at ? p.at < q.at : p.point < q.point;
        });
        for (auto pass = first; pass != last; ++pass) ways.points.push_back(pass->point);
    }
    return ways;
}

/// An edge with what is asked of it again and again.
struct Span {
    Index edge;
    Point a, b;
    std::int64_t dx, dy;
    std::int64_t reach;  // |dx| + |dy|
    std::int32_t low_y, high_y;

    Span(Index i, const Edge& e, const std::vector<Point>& points)
        : edge(i),
          a(points[e.from]),
          b(points[e.to]),
          dx(std::int64_t{b.x} - a.x),
          dy(std::int64_t{b.y} - a.y),
          reach(std::abs(dx) + std::abs(dy)),
          low_y(std::min(a.y, b.y)),
          high_y(std::max(a.y, b.y)) {}

    /// True if it meets the pixel about p: the square of half-width 1/2 with its lower and left
    /// sides and the corner between them.
    [[nodiscard]] bool meetsPixel(Point p) const {
        // The pixels that the line meets outside of the box of its ends lie outside of that too.
        if (p.x < a.x || p.x > b.x || p.y < low_y || p.y > high_y) return false;
        const std::int64_t twice = 2 * cross(a, b, p);
        if (std::abs(twice) != reach) return std::abs(twice) < reach;
        return twice == dx - dy;  // it touches at a corner: this is the lower left one
    }

    /// Grows from pixel to pixel that it meets.
    [[nodiscard]] std::int64_t at(Point p) const {
        return std::int64_t{p.x} - a.x +
               (dy < 0 ? std::int64_t{a.y} - p.y : std::int64_t{p.y} - a.y);
    }
};

std::vector<Span> spansOf(const Cell& cell, const std::vector<Edge>& edges,
                          const std::vector<Point>& points) {
    std::vector<Span> spans;
    spans.reserve(cell.edges.size());
    for (const Index i : cell.edges) spans.emplace_back(i, edges[i], points);
    return spans;
}

/// Ends of edges that lay along another before rounding: both were moved by at most half a step in
/// x and in y.
std::vector<Pass> passesOfEnds(const std::vector<Edge>& edges, const std::vector<Point>& points) {
    std::vector<Pass> passes;
    passes.reserve(edges.size());
    forEachCell(points, edges, {}, [&](const Cell& cell) {
        for (const Span& s : spansOf(cell, edges, points)) {
            for (const Index i : cell.points) {
                const Point p = points[i];
                if (std::abs(cross(s.a, s.b, p)) > s.reach) continue;
                const std::int64_t at = dot(s.a, s.b, p);
                if (at > 0 && at < s.dx * s.dx + s.dy * s.dy && p != s.a && p != s.b)
                    passes.push_back({s.edge, i, at});
            }
        }
        mustBeFew(passes.size());
    });
    return passes;
}

/// start + length * num / den rounded to the nearest, halves up. \pre 0 < num < den
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
    pixel = {along(t.a.x, t.dx, num, den), along(t.a.y, t.dy, num, den)};
    return true;
}

/// All edges that meet the pixels of ends and crossings.
std::vector<Pass> passesOfPixels(const std::vector<Edge>& edges, PointTable& table,
                                 const Columns& columns) {
    std::vector<Pass> passes;
    passes.reserve(4 * edges.size());
    std::vector<Index> pixels;
    forEachCell(table.points(), edges, columns, [&](const Cell& cell) {
        pixels.assign(cell.points.begin(), cell.points.end());
        const std::vector<Span> spans = spansOf(cell, edges, table.points());
        for (std::size_t i = 0; i < spans.size(); ++i) {
            for (std::size_t k = i + 1; k < spans.size(); ++k) {
                Point p;
                // Each pixel belongs to one cell, which knows all edges that meet it.
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
    });
    return passes;
}

}  // namespace

std::vector<Edge> routed(const std::vector<Edge>& edges, const Ways& ways) {
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

std::vector<Edge> ledThroughEnds(const std::vector<Edge>& edges, const std::vector<Point>& points) {
    return routed(edges, waysOf(passesOfEnds(edges, points), edges.size()));
}

Ways waysThroughPixels(const std::vector<Edge>& edges, PointTable& table, const Columns& columns) {
    return waysOf(passesOfPixels(edges, table, columns), edges.size());
}

std::vector<Edge> snapRounded(std::vector<Edge> edges, PointTable& table, SetStore& sets) {
    edges = merged(ledThroughEnds(edges, table.points()), table.points(), sets);
    const Ways ways = waysThroughPixels(edges, table, {});
    return merged(routed(edges, ways), table.points(), sets);
}

}  // namespace ispace::lattice
