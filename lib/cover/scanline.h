// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include <cstdint>
#include <vector>

#include "cover/grid.h"

namespace ispace {

/// Sorts the centres of a window of cells into inside, boundary and outside of closed curves.
///
/// For each row an edge that crosses it flips all cells to its left, so that after the last edge a
/// cell's parity is the number of flips at cells from it on. Where the flip starts is guessed in
/// doubles and settled by orientation(), which makes the result exact. Rows are bits: parities of
/// 64 cells come of six shifts.
class Scanline {
  public:
    /// The window: cells with centres in the box.
    Scanline(const Grid& grid, const Box2& box);

    void add(const Segment2& edge);
    /// Adds to `cells` those inside, those on an edge left out or included.
    void addInside(CellSet& cells) const { finish(cells, false); }
    void addClosed(CellSet& cells) const { finish(cells, true); }

  private:
    [[nodiscard]] std::size_t wordsPerRow() const {
        return static_cast<std::size_t>(last_column_ - first_column_ + 63) / 64;
    }
    void addLevel(const Segment2& edge, int row);
    void addToRow(Point2 low, Point2 high, int row);
    void mark(std::vector<std::uint64_t>& rows, int column, int row, bool toggle);
    void finish(CellSet& cells, bool closed) const;

    const Grid& grid_;
    std::vector<double> x_;                   // middles of the columns of the window
    int first_column_ = 0, last_column_ = 0;  // [first, last)
    int first_row_ = 0, last_row_ = 0;
    std::vector<std::uint64_t> flips_, edges_;  // by row, bit 0 the first column
};

}  // namespace ispace
