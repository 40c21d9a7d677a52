// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of free cells, the search over it, and straightening.
//
// A cell is free if the circle with its margin is free at its centre; corners are passed only
// between free sides. Costs are 12 a side and 17 a corner, which is the root of two to within 0.2
// percent, so sums are whole and 35 buckets hold all open cells. The way is read back from costs,
// and a point is left out as long as the straight line past it is free.
#include "sim/path_finder.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace ispace {

namespace {

constexpr double kMaxCells = 2.5e5;
/// Costs of a side and of a corner.
constexpr std::int32_t kSide = 12, kCorner = 17;
/// A point may lie this far from the nearest free cell, in metres: movers stand at walls. The
/// straight line between them keeps kThin away from all bodies.
constexpr double kMostFromCell = 0.5, kThin = 0.01;

/// Returns a grid over the box with cells of kCell, or larger ones where the area has more than
/// kMaxCells of these.
Grid gridOver(const Box2& box) {
    const double width = std::max(box.width(), PathFinder::kCell);
    const double depth = std::max(box.depth(), PathFinder::kCell);
    const double size = std::max(PathFinder::kCell, std::sqrt(width * depth / kMaxCells));
    return gridOf(box.low, size, static_cast<int>(std::ceil(width / size)),
                  static_cast<int>(std::ceil(depth / size)));
}

}  // namespace

PathFinder::PathFinder(const Obstacles& obstacles, const Box2& box, double radius,
                       const std::vector<Polygon>& holes)
    : obstacles_(&obstacles),
      reach_(radius + kMargin),
      grid_(gridOver(box)),
      stride_(static_cast<std::size_t>(grid_.columns) + 2),
      free_(stride_ * (static_cast<std::size_t>(grid_.rows) + 2)) {
    for (const Polygon& hole : holes) {
        const Region region{hole, {}};
        holes_.emplace_back(std::span(&region, 1));
    }
    tbb::parallel_for(0, grid_.rows, [this](int row) {
        for (int column = 0; column < grid_.columns; ++column)
            free_[cellOf(column, row)] =
                isFree({grid_.columnCenter(column), grid_.rowCenter(row)}) ? 1 : 0;
    });
}

/// Calls visit(cell, cost) for the free neighbours of a cell; a corner is passed only between free
/// sides.
template <typename Visit>
void PathFinder::forEachNeighbour(std::size_t cell, Visit visit) const {
    const std::size_t east = cell + 1, west = cell - 1;
    const std::size_t north = cell + stride_, south = cell - stride_;
    const bool to_east = free_[east] != 0, to_west = free_[west] != 0;
    const bool to_north = free_[north] != 0, to_south = free_[south] != 0;
    if (to_east) visit(east, kSide);
    if (to_north) visit(north, kSide);
    if (to_west) visit(west, kSide);
    if (to_south) visit(south, kSide);
    if (to_north && to_east && free_[north + 1] != 0) visit(north + 1, kCorner);
    if (to_north && to_west && free_[north - 1] != 0) visit(north - 1, kCorner);
    if (to_south && to_west && free_[south - 1] != 0) visit(south - 1, kCorner);
    if (to_south && to_east && free_[south + 1] != 0) visit(south + 1, kCorner);
}

PathFinder PathFinder::around(std::span<const Spot> spots) const {
    PathFinder finder = *this;
    finder.spots_.assign(spots.begin(), spots.end());
    // Hundreds of people each plan around all others.
    std::vector<double> x, y;
    for (int column = 0; column < grid_.columns; ++column) x.push_back(grid_.columnCenter(column));
    for (int row = 0; row < grid_.rows; ++row) y.push_back(grid_.rowCenter(row));
    for (const Spot& spot : spots) {
        const double apart = reach_ + spot.radius;
        const auto stretch = [apart](const std::vector<double>& centers, double middle) {
            const auto first =
                std::lower_bound(centers.begin(), centers.end(), middle - apart) - centers.begin();
            const auto end =
                std::upper_bound(centers.begin(), centers.end(), middle + apart) - centers.begin();
            return std::pair(static_cast<std::size_t>(first), static_cast<std::size_t>(end));
        };
        const auto [left, right] = stretch(x, spot.center.x);
        const auto [bottom, top] = stretch(y, spot.center.y);
        for (std::size_t row = bottom; row < top; ++row) {
            const double dy = y[row] - spot.center.y;
            const auto cells = finder.free_.begin() +
                               static_cast<std::ptrdiff_t>(cellOf(0, static_cast<int>(row)));
            for (std::size_t column = left; column < right; ++column) {
                const double dx = x[column] - spot.center.x;
                if (dx * dx + dy * dy < apart * apart)
                    cells[static_cast<std::ptrdiff_t>(column)] = 0;
            }
        }
    }
    return finder;
}

/// Calls visit(cell) for each cell whose centre is in the box, and possibly for others, by rows.
template <typename Visit>
void PathFinder::forEachCellIn(const Box2& box, Visit visit) const {
    if (box.empty()) return;
    const auto within = [](double at, int count) {
        return static_cast<int>(std::clamp(at, -1.0, static_cast<double>(count)));
    };
    const Point2 low = grid_.toCells(box.low), high = grid_.toCells(box.high);
    const int left = std::max(0, within(std::floor(low.x) - 1, grid_.columns));
    const int right = std::min(grid_.columns - 1, within(std::ceil(high.x) + 1, grid_.columns));
    const int bottom = std::max(0, within(std::floor(low.y) - 1, grid_.rows));
    const int top = std::min(grid_.rows - 1, within(std::ceil(high.y) + 1, grid_.rows));
    for (int row = bottom; row <= top; ++row)
        for (int column = left; column <= right; ++column) visit(cellOf(column, row));
}

/// Returns the cell of those that pass the test whose centre is nearest to a point.
template <typename Test>
std::optional<std::size_t> PathFinder::nearestCell(Point2 to, const Box2& box, Test test) const {
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::infinity();
    forEachCellIn(box, [&](std::size_t cell) {
        const double apart = distance(centerOf(cell), to);
        if (apart >= least || !test(cell)) return;
        least = apart;
        best = cell;
    });
    return best;
}

/// Returns true if the circle with the margin meets a spot somewhere on the way.
bool PathFinder::isInSpot(const Segment2& way) const {
    return std::any_of(spots_.begin(), spots_.end(), [&](const Spot& spot) {
        const double apart = reach_ + spot.radius;
        return squaredDistance(spot.center, way) < apart * apart;
    });
}

bool PathFinder::isFree(Point2 p) const {
    return !isInSpot({p, p}) && !isOverHole({p, p}) && !obstacles_->overlap(p, reach_);
}

bool PathFinder::isStraight(Point2 from, Point2 to) const {
    return !isInSpot({from, to}) && !isOverHole({from, to}) &&
           !obstacles_->near({from, to}, reach_);
}

/// Returns true if the circle with the margin is over a hole somewhere on the way.
bool PathFinder::isOverHole(const Segment2& way) const {
    // Piece by piece, as the box about a long way holds edges far from it.
    constexpr double kMaxPieces = 1000, kRounding = 1.01;
    const Vec2 along = way.b - way.a;
    const double pieces = std::clamp(std::ceil(ispace::length(along) / reach_), 1.0, kMaxPieces);
    const double half = kRounding * (ispace::length(along) / pieces + reach_);
    return std::any_of(holes_.begin(), holes_.end(), [&](const RegionIndex& hole) {
        if (hole.locate(way.a) == Side::Inside) return true;
        bool is_near = false;
        for (double i = 0; i < pieces && !is_near; ++i) {
            const Point2 middle = way.a + (i + 0.5) / pieces * along;
            hole.edgesIn({middle - Vec2{half, half}, middle + Vec2{half, half}},
                         [&](const Segment2& edge) {
                             is_near = is_near || ispace::distance(way, edge) < reach_;
                         });
        }
        return is_near;
    });
}

/// A cell behind a thin wall does not count: the line to its middle has to keep kThin from all
/// bodies. Empty for points far outside, without overflow.
std::optional<std::size_t> PathFinder::cellNear(Point2 p) const {
    const double size = grid_.limits.width() / grid_.columns;
    const Point2 at = grid_.toCells(p);
    const auto reach = static_cast<int>(std::ceil(kMostFromCell / size));
    const double largest = 2 * (kMaxCells + reach);
    if (!(std::abs(at.x) < largest && std::abs(at.y) < largest)) return std::nullopt;
    const int column = static_cast<int>(std::lround(at.x));
    const int row = static_cast<int>(std::lround(at.y));
    std::optional<std::size_t> best;
    double least = kMostFromCell;
    for (int r = std::max(0, row - reach); r <= std::min(grid_.rows - 1, row + reach); ++r)
        for (int c = std::max(0, column - reach); c <= std::min(grid_.columns - 1, column + reach);
             ++c) {
            const std::size_t cell = cellOf(c, r);
            const double apart = distance(p, centerOf(cell));
            if (free_[cell] == 0 || apart >= least) continue;
            if (apart > kThin && obstacles_->near({p, centerOf(cell)}, kThin)) continue;
            least = apart;
            best = cell;
        }
    return best;
}

Point2 PathFinder::centerOf(std::size_t cell) const {
    return {grid_.columnCenter(static_cast<int>(cell % stride_) - 1),
            grid_.rowCenter(static_cast<int>(cell / stride_) - 1)};
}

/// Returns the least cost between two cells if all are free.
std::int32_t PathFinder::leastCost(std::size_t a, std::size_t b) const {
    const auto apart = [](std::size_t i, std::size_t k) {
        return static_cast<std::int32_t>(i > k ? i - k : k - i);
    };
    const std::int32_t columns = apart(a % stride_, b % stride_);
    const std::int32_t rows = apart(a / stride_, b / stride_);
    return kSide * std::max(columns, rows) + (kCorner - kSide) * std::min(columns, rows);
}

PathFinder::Field PathFinder::waysFrom(Point2 from) const {
    return search(from, std::nullopt, false);
}

PathFinder::Field PathFinder::search(Point2 from, std::optional<std::size_t> goal,
                                     bool aims) const {
    Field field{from, std::vector<std::int32_t>(free_.size(), kNoPath), 0};
    const auto start = cellNear(from);
    if (!start) return field;
    // Dial's algorithm, with A*'s estimate: a step adds at most two corners to cost and estimate.
    struct Entry {
        std::size_t cell;
        std::int32_t cost;
    };
    const auto estimate = [&](std::size_t cell) { return aims ? leastCost(cell, *goal) : 0; };
    std::array<std::vector<Entry>, 2 * kCorner + 1> buckets;
    const auto bucket = [&](std::int32_t sum) -> std::vector<Entry>& {
        return buckets[static_cast<std::size_t>(sum) % buckets.size()];
    };
    field.cost[*start] = 0;
    std::int32_t sum = estimate(*start);
    bucket(sum).push_back({*start, 0});
    for (std::size_t waiting = 1; waiting > 0; ++sum) {
        std::vector<Entry>& cells = bucket(sum);
        // Grows by cells that cost as much.
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Entry entry = cells[i];
            if (entry.cost != field.cost[entry.cell]) continue;
            if (entry.cell == goal) return field;
            ++field.expanded;
            forEachNeighbour(entry.cell, [&](std::size_t to, std::int32_t step) {
                std::int32_t& known = field.cost[to];
                if (known != kNoPath && known <= entry.cost + step) return;
                known = entry.cost + step;
                bucket(known + estimate(to)).push_back({to, known});
                ++waiting;
            });
        }
        waiting -= cells.size();
        cells.clear();
    }
    return field;
}

std::vector<Point2> PathFinder::wayBetween(Point2 from, Point2 to) const {
    const auto goal = cellNear(to);
    return goal ? way(search(from, goal, true), to) : std::vector<Point2>();
}

std::optional<double> PathFinder::length(const Field& field, Point2 to) const {
    const auto cell = cellNear(to);
    if (!cell || field.cost[*cell] == kNoPath) return std::nullopt;
    return field.cost[*cell] * (grid_.limits.width() / grid_.columns) / kSide;
}

PathFinder::Approach PathFinder::approach(Point2 from, Point2 to, const Box2& box,
                                          const std::function<bool(Point2)>& is_suitable) const {
    auto goal = nearestCell(
        to, box, [&](std::size_t i) { return free_[i] != 0 && is_suitable(centerOf(i)); });
    if (!goal) return {};
    Approach found{search(from, goal, false), std::nullopt};
    // No way leads there: all cells with a way are known.
    if (found.field.cost[*goal] == kNoPath)
        goal = nearestCell(to, box, [&](std::size_t i) {
            return found.field.cost[i] != kNoPath && is_suitable(centerOf(i));
        });
    if (goal) found.goal = centerOf(*goal);
    return found;
}

std::optional<Point2> PathFinder::farthestReached(const Field& field) const {
    const auto most = std::max_element(field.cost.begin(), field.cost.end());
    if (most == field.cost.end() || *most == kNoPath) return std::nullopt;
    return centerOf(static_cast<std::size_t>(most - field.cost.begin()));
}

std::vector<Point2> PathFinder::way(const Field& field, Point2 to) const {
    const auto end = cellNear(to);
    if (!end || field.cost[*end] == kNoPath) return {};
    std::vector<Point2> points = {to};
    for (std::size_t cell = *end; field.cost[cell] > 0;) {
        points.push_back(centerOf(cell));
        std::size_t before = cell;
        forEachNeighbour(cell, [&](std::size_t other, std::int32_t step) {
            if (before == cell && field.cost[other] != kNoPath &&
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
