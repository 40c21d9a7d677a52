// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/kernel/geom only: finds points and edges of the lattice by the square cell that holds
// them.
//
// Uniform grids, of which crowded cells are divided again: most overlays are spread evenly, and one
// level answers; views that end at one wall crowd, and levels below part them. Sides are powers of
// two, so a cell is a shift. Candidates within kReach are never missed; more may be visited. Orders
// depend on the input alone. Grids are immutable once built and thread-safe.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "geom/overlay/overlay_lattice.h"

namespace ispace::lattice {

/// Distance within which points and edges are found, in steps of the lattice, in x as well as in y.
/// Snap rounding needs 1 for ends, 1/2 for pixels.
constexpr std::int32_t kReach = 2;
/// Few enough to test each, or each with each.
constexpr std::size_t kFew = 32;

/// Square cells over a box; their sides are powers of two. Points outside the box have a column or
/// row outside [0, columns()).
class CellGrid {
  public:
    /// Chooses the smallest cells of which there are at most so many.
    CellGrid(const Box& box, std::size_t most);

    [[nodiscard]] std::int64_t columns() const { return columns_; }
    [[nodiscard]] std::int64_t rows() const { return rows_; }
    [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(columns_ * rows_); }
    [[nodiscard]] Box boxOf(std::int64_t column, std::int64_t row) const;
    [[nodiscard]] std::int64_t columnOf(Point p) const {
        return (std::int64_t{p.x} - box_.low.x) >> shift_;
    }
    [[nodiscard]] std::int64_t rowOf(Point p) const {
        return (std::int64_t{p.y} - box_.low.y) >> shift_;
    }

    /// Calls visit(column, first row, last row) for the columns in which a line from a to b comes
    /// within kReach of these cells, and maybe of a few others. \pre a.x <= b.x
    template <typename Visit>
    void forEachStretch(Point a, Point b, Visit visit) const;

  private:
    /// Beyond kReach: for the rounding of heights, which is far below a step.
    static constexpr std::int64_t kSlack = kReach + 1;

    Box box_;
    int shift_ = 31;
    std::int64_t columns_ = 1, rows_ = 1;
};

template <typename Visit>
void CellGrid::forEachStretch(Point a, Point b, Visit visit) const {
    const Point low = box_.low;
    const std::int64_t first =
        std::max<std::int64_t>(0, (std::int64_t{a.x} - low.x - kSlack) >> shift_);
    const std::int64_t last =
        std::min(columns_ - 1, (std::int64_t{b.x} - low.x + kSlack) >> shift_);
    const auto stretch = [&](std::int64_t column, std::int64_t from, std::int64_t to) {
        const std::int64_t row0 = (from - low.y - kSlack - 1) >> shift_;
        const std::int64_t row1 = (to - low.y + kSlack + 1) >> shift_;
        const std::int64_t lowest = std::max<std::int64_t>(0, row0);
        const std::int64_t highest = std::min(rows_ - 1, row1);
        if (lowest <= highest) visit(column, lowest, highest);
    };
    const std::int32_t bottom = std::min(a.y, b.y), top = std::max(a.y, b.y);
    if (a.x == b.x || first >= last) {
        for (std::int64_t c = first; c <= last; ++c) stretch(c, bottom, top);
        return;
    }
    const double slope = (double(b.y) - a.y) / (double(b.x) - a.x);
    for (std::int64_t c = first; c <= last; ++c) {
        const std::int64_t left = low.x + (c << shift_) - kSlack;
        const std::int64_t right = left + (std::int64_t{1} << shift_) + 2 * kSlack;
        const double y0 = a.y + static_cast<double>(left - a.x) * slope;
        const double y1 = a.y + static_cast<double>(right - a.x) * slope;
        stretch(c, static_cast<std::int64_t>(std::max<double>(bottom, std::min(y0, y1))),
                static_cast<std::int64_t>(std::min<double>(top, std::max(y0, y1))));
    }
}

/// Finds points along a line: stores points by cells, and divides crowded cells again.
class PointGrid {
  public:
    /// O(n log n)
    explicit PointGrid(const std::vector<Point>& points);

    /// Calls visit(point, its number) for all points within kReach of a line from a to b, and maybe
    /// some others. \pre a.x <= b.x
    template <typename Visit>
    void forEachNear(Point a, Point b, const Visit& visit) const {
        if (!levels_.empty()) search(levels_.front(), a, b, visit);
    }

  private:
    struct Place {
        Point at;
        Index number;
    };
    /// A box that is divided.
    struct Level {
        CellGrid grid;
        std::size_t first_cell;  // column by column; one more marks the end of the last
        bool is_nested = false;  // there are cells that are divided again
    };

    void divide(std::size_t from, std::size_t to);
    template <typename Visit>
    void search(const Level& level, Point a, Point b, const Visit& visit) const;

    std::vector<Place> places_;  // by cell
    std::vector<Level> levels_;
    std::vector<Index> first_;   // of each cell's points
    std::vector<Index> inner_;   // the level that divides a cell, or kNone
    std::vector<Place> before_;  // while they are sorted
};

template <typename Visit>
void PointGrid::search(const Level& level, Point a, Point b, const Visit& visit) const {
    const auto rows = static_cast<std::size_t>(level.grid.rows());
    level.grid.forEachStretch(
        a, b, [&](std::int64_t column, std::int64_t lowest, std::int64_t highest) {
            const std::size_t bottom = level.first_cell + static_cast<std::size_t>(column) * rows;
            const std::size_t from = bottom + static_cast<std::size_t>(lowest);
            const std::size_t to = bottom + static_cast<std::size_t>(highest) + 1;
            if (!level.is_nested || first_[to] - first_[from] <= kFew) {
                for (Index i = first_[from]; i < first_[to]; ++i)
                    visit(places_[i].at, places_[i].number);
                return;
            }
            for (std::size_t cell = from; cell < to; ++cell) {
                if (inner_[cell] != kNone) {
                    search(levels_[inner_[cell]], a, b, visit);
                    continue;
                }
                for (Index i = first_[cell]; i < first_[cell + 1]; ++i)
                    visit(places_[i].at, places_[i].number);
            }
        });
}

/// A part of the lattice.
struct Cell {
    Box box;                        ///< cells do not overlap and cover all points
    std::span<const Index> edges;   ///< all that come within kReach of the box, and others
    std::span<const Index> points;  ///< those in the box
};

/// Divides the box of all points, as far as it lies in these columns, into square cells, and
/// crowded ones again, until few edges come near each cell or dividing no longer separates them
/// (because they lie along each other). The order depends only on the input. `visit` may add
/// points; they belong to no cell. \pre edges begin at their lower end (lexLess)
void forEachCell(const std::vector<Point>& points, const std::vector<Edge>& edges,
                 const Columns& columns, const std::function<void(const Cell&)>& visit);

}  // namespace ispace::lattice
