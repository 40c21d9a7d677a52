// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "raster/grid.h"

namespace ispace {

/// The middles of a grid's columns or rows, as Grid has them to the bit.
struct GridAxis {
    double low = 0, extent = 0;
    int count = 0;

    static GridAxis columnsOf(const Grid& grid) {
        return {grid.limits.low.x, grid.limits.width(), grid.columns};
    }
    static GridAxis rowsOf(const Grid& grid) {
        return {grid.limits.low.y, grid.limits.depth(), grid.rows};
    }
    [[nodiscard]] double center(int i) const { return low + extent * ((i + 0.5) / count); }
    [[nodiscard]] double perMetre() const { return count / extent; }
    /// Where a coordinate is among the middles, which are about at 0, 1, 2, ...: off by no more
    /// than slack(|value|). Not a number where the axis has no extent.
    [[nodiscard]] double position(double value) const { return (value - low) * perMetre() - 0.5; }
    [[nodiscard]] double slack(double size) const;
    /// First i in [begin, count) whose middle is not below (is above) a value, else count.
    /// \pre begin <= count
    [[nodiscard]] int firstNotBelow(double value, int begin = 0) const;
    [[nodiscard]] int firstAbove(double value, int begin = 0) const;
};

/// Sorts the centres of a window of cells into inside, boundary and outside of closed curves.
///
/// For each row an edge that crosses it flips all cells to its left, so that after the last edge a
/// cell's parity is the number of flips at cells from it on. Where the flip starts is computed in
/// doubles and, where that may be off by rounding, settled by orientation(), which makes the result
/// exact. Rows are bits: parities of 64 cells come of six shifts.
class Scanline {
  public:
    Scanline() = default;
    /// The window: cells with centres in the box.
    Scanline(const Grid& grid, const Box2& box) { reset(grid, box); }
    /// Begins anew, in the same memory.
    void reset(const Grid& grid, const Box2& box);

    void add(const Segment2& edge);
    /// Adds to `cells` those inside, those on an edge left out or included.
    void addInside(CellSet& cells) const { finish(cells, false); }
    void addClosed(CellSet& cells) const { finish(cells, true); }

    /// The window.
    [[nodiscard]] int firstColumn() const { return first_column_; }
    [[nodiscard]] int firstRow() const { return first_row_; }
    [[nodiscard]] int columns() const { return last_column_ - first_column_; }
    [[nodiscard]] int rows() const { return last_row_ - first_row_; }
    [[nodiscard]] std::size_t wordsPerRow() const {
        return static_cast<std::size_t>(columns() + 63) / 64;
    }
    /// Sets `words` to the cells inside: wordsPerRow() of each row, bit 0 the first column; bits
    /// beyond the window are 0.
    void takeInside(std::vector<std::uint64_t>& words) const;
    /// Removes the cells inside or on an edge from words as takeInside() has them.
    void removeClosed(std::vector<std::uint64_t>& words) const;

  private:
    [[nodiscard]] int firstRowFrom(double y) const;
    void addSloped(Point2 low, Point2 high, int row);
    void addLevel(const Segment2& edge, int row);
    [[nodiscard]] int settle(Point2 low, Point2 high, int row, int guess);
    void mark(std::vector<std::uint64_t>& rows, int column, int row, bool toggle);
    template <typename Visit>
    void forEachWord(bool closed, Visit visit) const;
    void finish(CellSet& cells, bool closed) const;

    Grid grid_;
    GridAxis x_axis_, y_axis_;
    double columns_per_metre_ = 0, slack_ = 0;
    std::vector<double> y_;                   // middles of the rows of the window
    int first_column_ = 0, last_column_ = 0;  // [first, last)
    int first_row_ = 0, last_row_ = 0;
    std::vector<std::uint64_t> flips_, edges_;  // by row, bit 0 the first column
};

}  // namespace ispace
