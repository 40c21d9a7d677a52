// SPDX-License-Identifier: GPL-3.0-or-later
// lib/kernel/raster: grids and sets of cells, scanlines, contours, morphology, pictures as maps.
// Uses geom; OpenCV and libpng inside.
//
// Cells count by their centres. Decisions whether a centre lies inside, on or outside of a curve
// are exact for the doubles of centre and curve (orientation() of geom/predicates.h). A centre on
// the edge of two neighbours is in neither by cellsIn(), in both by cellsBlocked(); any other is in
// one of them.
//
//     const Grid grid = gridOf({0, 0}, 0.1, 80, 50);
//     const CellSet indoor = cellsIn(grid, environment.indoor());
//     const double area = grid.cellArea() * double(indoor.count());  // m2
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/cell_set.h"
#include "geom/polygon.h"
#include "raster/cells.h"

namespace ispace {

/// A grid of P x Q cells over the limits; cell (column, row) has index row * columns + column, row
/// 0 at the low y. A cell counts by its centre.
struct Grid {
    Box2 limits;
    int columns = 100, rows = 100;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    /// Returns the centre of a column or row; centres never decrease.
    [[nodiscard]] double columnCenter(int column) const;
    [[nodiscard]] double rowCenter(int row) const;
    [[nodiscard]] std::size_t cell(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] Point2 center(std::size_t cell) const;
    /// Converts a point to cells: whole numbers are the centres of columns and rows.
    [[nodiscard]] Point2 toCells(Point2 p) const;
    /// Returns the area of one cell: the factor of eq. (4.6).
    [[nodiscard]] double cellArea() const;
    friend bool operator==(const Grid&, const Grid&) = default;
};
/// Creates a grid of square cells of this size, in metres.
Grid gridOf(Point2 low, double size, int columns, int rows);
/// Returns "57 x 50 cells of 0.1 m", "100 x 100 cells of 0.12 m x 0.1 m".
std::string cellsText(const Grid& grid);

/// Finds the cells with centres strictly inside one of the regions; exact, by scanline. O(cells +
/// sum of the rows that each edge spans).
CellSet cellsIn(const Grid& grid, const Regions& regions);
/// Finds the same for closed curves under the even-odd rule; they may touch and repeat edges.
CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves);
/// Finds the cells with centres in or on the edge of one of the solids, which may overlap.
CellSet cellsBlocked(const Grid& grid, std::span<const Polygon> solids);

/// Returns the runs of cells with centres strictly inside the curves by the even-odd rule, by
/// ascending rows.
std::vector<RowRun> runsWithin(const Grid& grid, std::span<const Polygon> curves);

/// Two cells above each other or side by side; may lie outside the grid.
struct CellPair {
    std::int64_t near_column = 0, near_row = 0;
    std::int64_t far_column = 0, far_row = 0;
    friend bool operator==(const CellPair&, const CellPair&) = default;
};

/// Appends the pairs of neighbours with centres on opposite sides of the closed segment, first the
/// cell it passes through; a centre on the segment gives a pair of that cell with itself. Limited
/// to the columns or rows of the grid. O(columns + rows along the segment).
void appendCrossings(const Segment2& segment, const Grid& grid, std::vector<CellPair>& pairs);

/// The centres of a grid's columns or rows, bit for bit those of Grid.
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
    /// Converts a coordinate to cells, centres being at about 0, 1, 2, ...: accurate to
    /// slack(|value|). Returns NaN if the axis has no extent.
    [[nodiscard]] double position(double value) const { return (value - low) * perMetre() - 0.5; }
    [[nodiscard]] double slack(double size) const;
    /// Finds the first i in [begin, count) with a centre not below (above) a value, else count.
    /// \pre begin <= count
    [[nodiscard]] int firstNotBelow(double value, int begin = 0) const;
    [[nodiscard]] int firstAbove(double value, int begin = 0) const;
};

/// Sorts the centres of a window of cells into inside, boundary and outside of closed curves.
///
/// For each row an edge that crosses it flips all cells to its left, so that after the last edge a
/// cell's parity is the number of flips at cells from it on. The start of a flip is computed in
/// doubles and, near rounding errors, settled by orientation(), so the result is exact. Rows are
/// bits: parities of 64 cells take six shifts. The order of edges does not matter, and curves need
/// not be added one by one; edges that come twice cancel out but for the boundary. O(rows of an
/// edge, or the columns of a level one) to add, O(cells of the window / 64) to finish. One per
/// thread.
///
///     Scanline scan(grid, bounds(polygon));
///     forEachEdge(polygon, [&](const Segment2& edge) { scan.add(edge); });
///     scan.addInside(cells);
class Scanline {
  public:
    Scanline() = default;
    /// Stores the window: cells with centres in the box.
    Scanline(const Grid& grid, const Box2& box) { reset(grid, box); }
    /// Starts over, reusing the memory.
    void reset(const Grid& grid, const Box2& box);

    void add(const Segment2& edge);
    /// Inserts the cells inside into `cells`; those on an edge are left out, or included.
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
    /// Removes the cells inside or on an edge from words in the layout of takeInside().
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
