// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/overlay/overlay_cells.h"

#include <numeric>
#include <utility>

namespace ispace::lattice {

namespace {

constexpr std::size_t kCellsPerEdge = 2;
constexpr std::size_t kCellsPerPoint = 1;
constexpr int kMinShift = 4;  // of a cell's side

}  // namespace

CellGrid::CellGrid(const Box& box, std::size_t most) : box_(box) {
    const std::int64_t width = std::int64_t{box.high.x} - box.low.x;
    const std::int64_t depth = std::int64_t{box.high.y} - box.low.y;
    const auto limit = static_cast<std::int64_t>(most);
    for (int s = shift_; s >= kMinShift; --s) {
        const std::int64_t across = (width >> s) + 1, along = (depth >> s) + 1;
        if (across > limit || along > limit || across * along > limit) break;
        shift_ = s;
        columns_ = across;
        rows_ = along;
    }
}

Box CellGrid::boxOf(std::int64_t column, std::int64_t row) const {
    const std::int64_t x = box_.low.x + (column << shift_), y = box_.low.y + (row << shift_);
    const std::int64_t side = (std::int64_t{1} << shift_) - 1;
    const auto up_to = [](std::int64_t v, std::int32_t most) {
        return static_cast<std::int32_t>(std::min<std::int64_t>(v, most));
    };
    return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
            {up_to(x + side, box_.high.x), up_to(y + side, box_.high.y)}};
}

PointGrid::PointGrid(const std::vector<Point>& points) {
    if (points.empty()) return;
    places_.reserve(points.size());
    for (Index i = 0; i < points.size(); ++i) places_.push_back({points[i], i});
    divide(0, places_.size());
    before_ = {};
}

void PointGrid::divide(std::size_t from, std::size_t to) {
    Box box;
    for (std::size_t i = from; i < to; ++i) box.add(places_[i].at);
    const CellGrid grid(box, kCellsPerPoint * (to - from));
    const auto cell_of = [&](Point p) {
        return static_cast<std::size_t>(grid.columnOf(p) * grid.rows() + grid.rowOf(p));
    };
    const std::size_t number = levels_.size(), first = first_.size(), count = grid.count();
    levels_.push_back({grid, first});
    first_.resize(first + count + 1, 0);
    inner_.resize(first + count + 1, kNone);
    // first_[i + 1] counts the points in cell i, then is the index of its next point.
    for (std::size_t i = from; i < to; ++i) ++first_[first + cell_of(places_[i].at) + 1];
    auto next = static_cast<Index>(from);
    for (std::size_t i = 1; i <= count; ++i) next += std::exchange(first_[first + i], next);
    first_[first] = static_cast<Index>(from);
    before_.assign(places_.begin() + static_cast<std::ptrdiff_t>(from),
                   places_.begin() + static_cast<std::ptrdiff_t>(to));
    for (const Place& place : before_) places_[first_[first + cell_of(place.at) + 1]++] = place;
    if (count == 1) return;
    for (std::size_t i = first; i < first + count; ++i) {
        if (first_[i + 1] - first_[i] <= kFew) continue;
        levels_[number].is_nested = true;
        inner_[i] = static_cast<Index>(levels_.size());
        divide(first_[i], first_[i + 1]);
    }
}

namespace {

/// Lists for each cell, one after another.
struct Lists {
    std::vector<std::size_t> first;
    std::vector<Index> items;

    [[nodiscard]] std::span<const Index> operator[](std::size_t i) const {
        return std::span(items).subspan(first[i], first[i + 1] - first[i]);
    }
};

/// Items by cell, in the order in which they came.
Lists listsOf(std::size_t cells, const std::vector<Index>& cell, std::span<const Index> item) {
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
        if (n <= kFew) return visit_(cell);
        const CellGrid grid(cell.box, kCellsPerEdge * n);
        if (grid.count() == 1) return visit_(cell);
        const Lists edges = edgesByCell(grid, cell.edges);
        const Lists points = pointsByCell(grid, cell.points);
        std::size_t work = 0;
        for (std::size_t i = 0; i < grid.count(); ++i)
            work += edges[i].size() * (edges[i].size() + points[i].size());
        // Most of them may crowd in one cell, to be parted there.
        const bool is_parted = 2 * work <= n * (n + cell.points.size());
        if (!is_parted && 2 * edges.items.size() > 3 * n) return visit_(cell);
        std::size_t i = 0;
        for (std::int64_t row = 0; row < grid.rows(); ++row)
            for (std::int64_t column = 0; column < grid.columns(); ++column, ++i)
                if (!edges[i].empty()) divide({grid.boxOf(column, row), edges[i], points[i]});
    }

  private:
    [[nodiscard]] Lists edgesByCell(const CellGrid& grid, std::span<const Index> edges) const {
        std::vector<Index> cell, item;
        cell.reserve(4 * edges.size());
        item.reserve(4 * edges.size());
        for (const Index i : edges) {
            grid.forEachStretch(
                points_[edges_[i].from], points_[edges_[i].to],
                [&](std::int64_t column, std::int64_t from, std::int64_t to) {
                    for (std::int64_t row = from; row <= to; ++row) {
                        cell.push_back(static_cast<Index>(row * grid.columns() + column));
                        item.push_back(i);
                    }
                });
        }
        return listsOf(grid.count(), cell, item);
    }

    [[nodiscard]] Lists pointsByCell(const CellGrid& grid, std::span<const Index> points) const {
        std::vector<Index> cell;
        cell.reserve(points.size());
        for (const Index i : points) {
            cell.push_back(static_cast<Index>(grid.rowOf(points_[i]) * grid.columns() +
                                              grid.columnOf(points_[i])));
        }
        return listsOf(grid.count(), cell, points);
    }

    const std::vector<Point>& points_;
    const std::vector<Edge>& edges_;
    const std::function<void(const Cell&)>& visit_;
};

}  // namespace

void forEachCell(const std::vector<Point>& points, const std::vector<Edge>& edges,
                 const Columns& columns, const std::function<void(const Cell&)>& visit) {
    // `visit` may add points; only the earlier ones are searched.
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

}  // namespace ispace::lattice
