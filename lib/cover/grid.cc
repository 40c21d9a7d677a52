// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/grid.h"

#include <algorithm>
#include <cassert>

#include "geom/predicates.h"

namespace ispace {

namespace {

/// Sorts the centres of a window of cells into inside, boundary and outside of closed curves.
///
/// For each row an edge that crosses it flips all cells to its left, so that after the last edge a
/// cell's parity is the number of flips at cells from it on. Where the flip starts is guessed in
/// doubles and settled by orientation(), which makes the result exact.
class Scanline {
  public:
    Scanline(const Grid& grid, const Box2& box) : grid_(grid) {
        if (box.empty()) return;
        const auto x = [&grid](int column) { return grid.columnCenter(column); };
        const auto y = [&grid](int row) { return grid.rowCenter(row); };
        first_column_ = lowerBound(0, grid.columns, x, box.low.x);
        last_column_ = upperBound(first_column_, grid.columns, x, box.high.x);
        first_row_ = lowerBound(0, grid.rows, y, box.low.y);
        last_row_ = upperBound(first_row_, grid.rows, y, box.high.y);
        marks_.resize(static_cast<std::size_t>(last_column_ - first_column_) *
                      static_cast<std::size_t>(last_row_ - first_row_));
    }

    void add(const Segment2& edge) {
        if (marks_.empty()) return;
        const bool upward = edge.a.y <= edge.b.y;
        const Point2 low = upward ? edge.a : edge.b, high = upward ? edge.b : edge.a;
        const auto y = [this](int row) { return grid_.rowCenter(row); };
        const int end = upperBound(first_row_, last_row_, y, high.y);
        for (int row = lowerBound(first_row_, last_row_, y, low.y); row < end; ++row)
            addToRow(low, high, row);
    }

    /// Calls visit(cell, Side) for the cells that are not outside.
    template <typename Visit>
    void finish(Visit visit) const {
        for (int row = first_row_; row < last_row_; ++row) {
            bool inside = false;
            for (int column = last_column_; column-- > first_column_;) {
                const std::uint8_t mark = marks_[index(column, row)];
                if ((mark & kFlip) != 0) inside = !inside;
                if ((mark & kBoundary) != 0)
                    visit(grid_.cell(column, row), Side::Boundary);
                else if (inside)
                    visit(grid_.cell(column, row), Side::Inside);
            }
        }
    }

  private:
    static constexpr std::uint8_t kFlip = 1, kBoundary = 2;

    /// First i in [begin, end) with at(i) >= value (or > value), else end; at never decreases.
    template <typename At>
    static int lowerBound(int begin, int end, At at, double value) {
        while (begin < end) {
            const int middle = begin + (end - begin) / 2;
            if (at(middle) < value)
                begin = middle + 1;
            else
                end = middle;
        }
        return begin;
    }
    template <typename At>
    static int upperBound(int begin, int end, At at, double value) {
        while (begin < end) {
            const int middle = begin + (end - begin) / 2;
            if (at(middle) <= value)
                begin = middle + 1;
            else
                end = middle;
        }
        return begin;
    }

    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row - first_row_) *
                   static_cast<std::size_t>(last_column_ - first_column_) +
               static_cast<std::size_t>(column - first_column_);
    }

    void addToRow(Point2 low, Point2 high, int row) {
        const auto x = [this](int column) { return grid_.columnCenter(column); };
        const double y = grid_.rowCenter(row);
        if (low.y == high.y) {
            const int end = upperBound(first_column_, last_column_, x, std::max(low.x, high.x));
            int column = lowerBound(first_column_, last_column_, x, std::min(low.x, high.x));
            for (; column < end; ++column) marks_[index(column, row)] |= kBoundary;
            return;
        }
        const auto turn = [&](int column) { return orientation(low, high, {x(column), y}); };
        const double guess = low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
        // The first column that is not to the left of the upward edge.
        int column = lowerBound(first_column_, last_column_, x, guess);
        while (column > first_column_ && turn(column - 1) != Turn::Left) --column;
        while (column < last_column_ && turn(column) == Turn::Left) ++column;
        // An edge owns its lower end only, so that a vertex between two edges flips once or twice.
        if (y < high.y && column > first_column_) marks_[index(column - 1, row)] ^= kFlip;
        for (; column < last_column_ && turn(column) == Turn::Straight; ++column)
            marks_[index(column, row)] |= kBoundary;
    }

    const Grid& grid_;
    int first_column_ = 0, last_column_ = 0;  // [first, last)
    int first_row_ = 0, last_row_ = 0;
    std::vector<std::uint8_t> marks_;
};

}  // namespace

double Grid::columnCenter(int column) const {
    return limits.low.x + limits.width() * ((column + 0.5) / columns);
}

double Grid::rowCenter(int row) const {
    return limits.low.y + limits.depth() * ((row + 0.5) / rows);
}

Point2 Grid::center(std::size_t cell) const {
    const auto across = static_cast<std::size_t>(columns);
    return {columnCenter(static_cast<int>(cell % across)),
            rowCenter(static_cast<int>(cell / across))};
}

double Grid::cellArea() const {
    return limits.width() * limits.depth() / static_cast<double>(size());
}

std::size_t CellSet::count() const {
    std::size_t sum = 0;
    for (const std::uint64_t word : words_) sum += static_cast<std::size_t>(std::popcount(word));
    return sum;
}

CellSet& CellSet::operator|=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= other.words_[i];
    return *this;
}

CellSet& CellSet::operator&=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= other.words_[i];
    return *this;
}

CellSet& CellSet::operator-=(const CellSet& other) {
    assert(cells_ == other.cells_);
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] &= ~other.words_[i];
    return *this;
}

std::size_t countCommon(const CellSet& a, const CellSet& b) {
    assert(a.cells_ == b.cells_);
    std::size_t sum = 0;
    for (std::size_t i = 0; i < a.words_.size(); ++i)
        sum += static_cast<std::size_t>(std::popcount(a.words_[i] & b.words_[i]));
    return sum;
}

CellSet cellsIn(const Grid& grid, const Region& region) {
    Scanline scan(grid, bounds(region.outline));
    region.forEachEdge([&scan](const Segment2& edge) { scan.add(edge); });
    CellSet inside(grid.size());
    scan.finish([&inside](std::size_t cell, Side side) {
        if (side == Side::Inside) inside.set(cell);
    });
    return inside;
}

CellSet cellsBlocked(const Grid& grid, const Slice& slice) {
    CellSet blocked(grid.size());
    for (const Polygon& solid : slice.solids) {
        Scanline scan(grid, bounds(solid));
        forEachEdge(solid, [&scan](const Segment2& edge) { scan.add(edge); });
        scan.finish([&blocked](std::size_t cell, Side) { blocked.set(cell); });
    }
    return blocked;
}

}  // namespace ispace
