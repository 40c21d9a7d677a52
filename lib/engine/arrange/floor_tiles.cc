// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles by bisection: the floor is clipped along the middle of the longer side of its part (columns
// first), and each half is divided on, so each of its points is clipped O(log tiles) times. Prefix
// sums over both axes then hold the weight to the left of and below each corner of a tile. Clipping
// by halves keeps signed areas, also of curves that touch themselves; edges along a cut cancel out.
#include "arrange/floor_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "geom/polygon.h"

namespace ispace {

namespace {

constexpr double kChordErrorOfTiles = 1e-3;  // metres

/// Clips a polygon by an axis (Sutherland and Hodgman, 1974): edges along the cut cancel out in its
/// signed area.
Polygon sideOf(const Polygon& polygon, double Point2::*axis, double at, bool is_low) {
    Polygon side;
    const auto is_in = [&](Point2 p) { return is_low ? p.*axis <= at : p.*axis >= at; };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point2 p = polygon[i], q = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        if (is_in(p)) side.push_back(p);
        if (is_in(p) != is_in(q)) {
            Point2 cut = p + (at - p.*axis) / (q.*axis - p.*axis) * (q - p);
            cut.*axis = at;
            side.push_back(cut);
        }
    }
    if (side.size() < 3) side.clear();
    return side;
}

}  // namespace

/// A square of tiles.
struct FloorTiles::Part {
    std::size_t x = 0, y = 0, columns = kSide, rows = kSide;
};

FloorTiles::FloorTiles(const Box2& box) : box_(box), sums_((kSide + 1) * (kSide + 1)) {}

void FloorTiles::add(std::span<const Curve> curves, double weight) {
    if (curves.empty() || box_.empty()) return;
    std::vector<double> before = std::exchange(sums_, std::vector<double>(sums_.size()));
    std::vector<Polygon> floor;
    for (const Curve& curve : curves) {
        floor.push_back(chords(curve, kChordErrorOfTiles));
        if (std::any_of(curve.begin(), curve.end(), [](const CurveEdge& e) { return e.isArc(); }))
            beyond_chords_ += weight * kChordErrorOfTiles * perimeter(curve);
    }
    divide(floor, {}, weight);
    constexpr std::size_t kWidth = kSide + 1;
    for (std::size_t y = 1; y < kWidth; ++y)
        for (std::size_t x = 1; x < kWidth; ++x) {
            const std::size_t i = x + y * kWidth;
            sums_[i] += sums_[i - 1] + sums_[i - kWidth] - sums_[i - 1 - kWidth];
        }
    for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += before[i];
}

/// Divides the floor by halves, down to tiles, and stores their weights.
void FloorTiles::divide(const std::vector<Polygon>& floor, const Part& part, double weight) {
    if (floor.empty()) return;
    if (part.columns == 1 && part.rows == 1) {
        double area = 0;
        for (const Polygon& polygon : floor) area += signedArea(polygon);
        sums_[(part.x + 1) + (part.y + 1) * (kSide + 1)] += weight * std::max(0.0, area);
        return;
    }
    const bool by_column = part.columns >= part.rows;
    Part low = part, high = part;
    if (by_column) {
        low.columns = high.columns = part.columns / 2;
        high.x += low.columns;
    } else {
        low.rows = high.rows = part.rows / 2;
        high.y += low.rows;
    }
    double Point2::*const axis = by_column ? &Point2::x : &Point2::y;
    const double share = static_cast<double>(by_column ? high.x : high.y) / kSide;
    const double at =
        by_column ? box_.low.x + share * box_.width() : box_.low.y + share * box_.depth();
    for (const bool is_low : {true, false}) {
        std::vector<Polygon> side;
        for (const Polygon& polygon : floor)
            if (Polygon cut = sideOf(polygon, axis, at, is_low); !cut.empty())
                side.push_back(std::move(cut));
        divide(side, is_low ? low : high, weight);
    }
}

std::size_t FloorTiles::tileAt(double offset, double extent) {
    const double tile = extent > 0 ? std::floor(offset / extent * kSide) : 0;
    return static_cast<std::size_t>(std::clamp(tile, 0.0, static_cast<double>(kSide - 1)));
}

double FloorTiles::mostIn(const Box2& box) const {
    if (!box_.meets(box)) return 0;
    constexpr std::size_t kWidth = kSide + 1;
    const std::size_t left = tileAt(box.low.x - box_.low.x, box_.width());
    const std::size_t right = tileAt(box.high.x - box_.low.x, box_.width()) + 1;
    const std::size_t bottom = tileAt(box.low.y - box_.low.y, box_.depth()) * kWidth;
    const std::size_t top = (tileAt(box.high.y - box_.low.y, box_.depth()) + 1) * kWidth;
    const double sum =
        sums_[right + top] - sums_[left + top] - sums_[right + bottom] + sums_[left + bottom];
    return std::max(0.0, sum) + beyond_chords_;
}

double mostWithin(double range, const CellSet& cells, const Grid& grid) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    const auto rows = static_cast<std::size_t>(grid.rows);
    // [x + y * (columns + 1)]: the cells to the left of x and below y.
    std::vector<std::uint32_t> sums((columns + 1) * (rows + 1));
    for (std::size_t y = 1; y <= rows; ++y)
        for (std::size_t x = 1; x <= columns; ++x) {
            const std::size_t i = x + y * (columns + 1);
            sums[i] = sums[i - 1] + sums[i - columns - 1] - sums[i - columns - 2] +
                      (cells.test(x - 1 + (y - 1) * columns) ? 1 : 0);
        }
    const auto reach = [range](double edge, std::size_t most) {
        return static_cast<std::size_t>(
            std::min(std::ceil(range / edge) + 1, static_cast<double>(most)));
    };
    const std::size_t wide = reach(grid.limits.width() / grid.columns, columns);
    const std::size_t high = reach(grid.limits.depth() / grid.rows, rows);
    std::uint32_t most = 0;
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t left = x - std::min(x, wide), right = std::min(columns, x + wide + 1);
            const std::size_t low = (y - std::min(y, high)) * (columns + 1);
            const std::size_t top = std::min(rows, y + high + 1) * (columns + 1);
            most = std::max(
                most, sums[right + top] - sums[left + top] - sums[right + low] + sums[left + low]);
        }
    return most * grid.cellArea();
}

}  // namespace ispace
