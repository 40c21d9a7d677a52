// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/way_finder.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ispace {

namespace {

constexpr double kMostCells = 1e6;
/// Costs of a side and of a corner.
constexpr std::int32_t kSide = 12, kCorner = 17;
/// A point may lie this far from the nearest free cell, in metres: movers stand at walls.
constexpr double kNear = 0.5;

struct Neighbour {
    int column, row;
    std::int32_t cost;
};
constexpr std::array<Neighbour, 8> kNeighbours = {{{1, 0, kSide},
                                                   {0, 1, kSide},
                                                   {-1, 0, kSide},
                                                   {0, -1, kSide},
                                                   {1, 1, kCorner},
                                                   {-1, 1, kCorner},
                                                   {-1, -1, kCorner},
                                                   {1, -1, kCorner}}};

Grid gridOver(const Box2& box) {
    const double width = std::max(box.width(), WayFinder::kCell);
    const double depth = std::max(box.depth(), WayFinder::kCell);
    const double size = std::max(WayFinder::kCell, std::sqrt(width * depth / kMostCells));
    return gridOf(box.low, size, static_cast<int>(std::ceil(width / size)),
                  static_cast<int>(std::ceil(depth / size)));
}

/// Calls visit(cell, cost) for the free neighbours of a cell; a corner is passed only between free
/// sides.
template <typename Visit>
void forEachNeighbour(const Grid& grid, const std::vector<std::uint8_t>& free, std::size_t cell,
                      Visit visit) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    const int column = static_cast<int>(cell % columns), row = static_cast<int>(cell / columns);
    const auto is_free = [&](int c, int r) {
        return c >= 0 && r >= 0 && c < grid.columns && r < grid.rows && free[grid.cell(c, r)] != 0;
    };
    for (const Neighbour& to : kNeighbours) {
        if (!is_free(column + to.column, row + to.row)) continue;
        if (to.cost == kCorner &&
            (!is_free(column + to.column, row) || !is_free(column, row + to.row)))
            continue;
        visit(grid.cell(column + to.column, row + to.row), to.cost);
    }
}

}  // namespace

WayFinder::WayFinder(const Obstacles& obstacles, const Box2& box, double radius)
    : obstacles_(&obstacles), reach_(radius + kMargin), grid_(gridOver(box)), free_(grid_.size()) {
    tbb::parallel_for(0, grid_.rows, [this](int row) {
        for (int column = 0; column < grid_.columns; ++column)
            free_[grid_.cell(column, row)] =
                isFree({grid_.columnCenter(column), grid_.rowCenter(row)}) ? 1 : 0;
    });
}

bool WayFinder::isFree(Point2 p) const { return !obstacles_->overlap(p, reach_); }

bool WayFinder::isStraight(Point2 from, Point2 to) const {
    return !obstacles_->near({from, to}, reach_);
}

std::optional<std::size_t> WayFinder::cellNear(Point2 p) const {
    const double size = grid_.limits.width() / grid_.columns;
    const Point2 at = grid_.toCells(p);
    const auto reach = static_cast<int>(std::ceil(kNear / size));
    const double largest = 2 * (kMostCells + reach);
    if (!(std::abs(at.x) < largest && std::abs(at.y) < largest)) return std::nullopt;
    const int column = static_cast<int>(std::lround(at.x));
    const int row = static_cast<int>(std::lround(at.y));
    std::optional<std::size_t> best;
    double least = kNear;
    for (int r = std::max(0, row - reach); r <= std::min(grid_.rows - 1, row + reach); ++r)
        for (int c = std::max(0, column - reach); c <= std::min(grid_.columns - 1, column + reach);
             ++c) {
            const std::size_t cell = grid_.cell(c, r);
            const double apart = distance(p, grid_.center(cell));
            if (free_[cell] == 0 || apart >= least) continue;
            least = apart;
            best = cell;
        }
    return best;
}

WayFinder::Field WayFinder::waysFrom(Point2 from) const {
    Field field{from, std::vector<std::int32_t>(grid_.size(), kNoWay)};
    const auto start = cellNear(from);
    if (!start) return field;
    // Dial's algorithm: no cost of a neighbour is larger than the number of buckets.
    std::array<std::vector<std::size_t>, kCorner + 1> buckets;
    std::vector<bool> is_done(grid_.size());
    field.cost[*start] = 0;
    buckets[0].push_back(*start);
    std::size_t waiting = 1;
    for (std::int32_t cost = 0; waiting > 0; ++cost) {
        std::vector<std::size_t> cells;
        cells.swap(buckets[static_cast<std::size_t>(cost) % buckets.size()]);
        waiting -= cells.size();
        for (const std::size_t cell : cells) {
            if (is_done[cell]) continue;
            is_done[cell] = true;
            forEachNeighbour(grid_, free_, cell, [&](std::size_t to, std::int32_t step) {
                std::int32_t& known = field.cost[to];
                if (is_done[to] || (known != kNoWay && known <= cost + step)) return;
                known = cost + step;
                buckets[static_cast<std::size_t>(known) % buckets.size()].push_back(to);
                ++waiting;
            });
        }
    }
    return field;
}

std::optional<double> WayFinder::length(const Field& field, Point2 to) const {
    const auto cell = cellNear(to);
    if (!cell || field.cost[*cell] == kNoWay) return std::nullopt;
    return field.cost[*cell] * (grid_.limits.width() / grid_.columns) / kSide;
}

std::vector<Point2> WayFinder::way(const Field& field, Point2 to) const {
    const auto end = cellNear(to);
    if (!end || field.cost[*end] == kNoWay) return {};
    std::vector<Point2> points = {to};
    for (std::size_t cell = *end; field.cost[cell] > 0;) {
        points.push_back(grid_.center(cell));
        std::size_t before = cell;
        forEachNeighbour(grid_, free_, cell, [&](std::size_t other, std::int32_t step) {
            if (before == cell && field.cost[other] != kNoWay &&
                field.cost[other] + step == field.cost[cell])
                before = other;
        });
        if (before == cell) return {};
        cell = before;
    }
    std::reverse(points.begin(), points.end());
    // From each corner as far as the way is straight.
    std::vector<Point2> corners;
    Point2 at = field.from;
    for (std::size_t i = 0; i < points.size();) {
        std::size_t next = i;
        while (next + 1 < points.size() && isStraight(at, points[next + 1])) ++next;
        at = points[next];
        corners.push_back(at);
        i = next + 1;
    }
    return corners;
}

}  // namespace ispace
