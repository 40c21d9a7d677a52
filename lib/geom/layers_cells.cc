// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/layers_cells.h"

#include <numeric>

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
                 const std::function<void(const Cell&)>& visit) {
    // What is visited may add points: those that were there are enough to look for.
    std::vector<Index> all_edges(edges.size()), all_points(points.size());
    std::iota(all_edges.begin(), all_edges.end(), Index{0});
    std::iota(all_points.begin(), all_points.end(), Index{0});
    Box box;
    for (const Point p : points) box.add(p);
    Division(points, edges, visit).divide({box, all_edges, all_points});
}

}  // namespace ispace::lattice
