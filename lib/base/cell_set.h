// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ispace {

/// A set of cells of a grid, stored as bits by cell index, 64 to a word.
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
    /// Removes the cells of `other`. All three require sets of one size.
    CellSet& operator-=(const CellSet& other);
    /// Calls visit(std::size_t) for each cell of the set, in order.
    template <typename Visit>
    void forEach(Visit visit) const;
    friend bool operator==(const CellSet&, const CellSet&) = default;
    /// Number of cells in both sets.
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

/// Consecutive cells of a grid: first, first + 1, ..., end - 1. A run may continue from the end of
/// a row at the beginning of the next.
struct CellRun {
    std::uint32_t first = 0, end = 0;
    friend bool operator==(const CellRun&, const CellRun&) = default;
};

/// Cells in parts; each part is a list of disjoint runs in ascending order.
struct CellParts {
    std::vector<CellRun> runs;
    std::vector<std::uint32_t> first;  ///< part k: runs [first[k], first[k + 1])

    [[nodiscard]] std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};

/// The set as one part. O(cells / 64 + runs)
CellParts partOf(const CellSet& cells);
/// Returns the cells of one part, as a set of a grid of `cells` cells.
CellSet cellsOf(const CellParts& parts, std::size_t part, std::size_t cells);

}  // namespace ispace
