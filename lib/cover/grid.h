// SPDX-License-Identifier: GPL-3.0-or-later
// lib/cover: cells, areas, coverage and its map. Uses sense, draw and below; TBB inside.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "env/slice.h"
#include "geom/polygon.h"

namespace ispace {

/// P x Q cells over the limits; cell (column, row) has index row * columns + column, row 0 at the
/// low y. A cell counts by its centre.
struct Grid {
    Box2 limits;
    int columns = 100, rows = 100;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    /// Middles of the columns and of the rows; neither ever decreases.
    [[nodiscard]] double columnCenter(int column) const;
    [[nodiscard]] double rowCenter(int row) const;
    [[nodiscard]] std::size_t cell(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] Point2 center(std::size_t cell) const;
    /// Area of one cell: the factor of eq. (4.6).
    [[nodiscard]] double cellArea() const;
    friend bool operator==(const Grid&, const Grid&) = default;
};
/// "57 x 50 cells of 0.1 m", "100 x 100 cells of 0.12 m x 0.1 m".
std::string cellsText(const Grid& grid);

/// A set of cells of one grid, 64 to a word.
class CellSet {
  public:
    explicit CellSet(std::size_t cells = 0) : words_((cells + 63) / 64), cells_(cells) {}
    [[nodiscard]] std::size_t size() const { return cells_; }
    [[nodiscard]] bool test(std::size_t cell) const {
        return (words_[cell / 64] >> (cell % 64)) & 1U;
    }
    void set(std::size_t cell) { words_[cell / 64] |= std::uint64_t{1} << (cell % 64); }
    void reset(std::size_t cell) { words_[cell / 64] &= ~(std::uint64_t{1} << (cell % 64)); }
    /// Adds the cells first + i for which bit i is set. \pre all of them are < size()
    void addBits(std::size_t first, std::uint64_t bits);
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] bool empty() const;
    CellSet& operator|=(const CellSet& other);
    CellSet& operator&=(const CellSet& other);
    /// Removes the cells of `other`. All three: \pre both are of one size
    CellSet& operator-=(const CellSet& other);
    /// Calls visit(std::size_t) for each cell of the set, in order.
    template <typename Visit>
    void forEach(Visit visit) const;
    friend bool operator==(const CellSet&, const CellSet&) = default;
    /// Number of cells in both.
    friend std::size_t countCommon(const CellSet& a, const CellSet& b);

  private:
    std::vector<std::uint64_t> words_;
    std::size_t cells_ = 0;
};
std::size_t countCommon(const CellSet& a, const CellSet& b);

template <typename Visit>
void CellSet::forEach(Visit visit) const {
    for (std::size_t i = 0; i < words_.size(); ++i)
        for (std::uint64_t word = words_[i]; word != 0; word &= word - 1)
            visit(i * 64 + static_cast<std::size_t>(std::countr_zero(word)));
}

/// Cells whose centre lies strictly inside one of the regions; exact, by scanline. O(cells + sum of
/// the rows that each edge spans).
CellSet cellsIn(const Grid& grid, const Regions& regions);
/// The same of closed curves by the even-odd rule, which may touch and repeat edges.
CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves);
/// Cells whose centre lies in a solid or on its edge.
CellSet cellsBlocked(const Grid& grid, const Slice& slice);

}  // namespace ispace
