// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of cells of a grid: as bits (CellSet) for unions, differences and counts, as runs
// (CellParts) for thousands of small parts. Cells are indices; the caller knows their grid
// (raster/grid.h).
//
//     CellSet seen(grid.size());
//     seen |= view_of_a;
//     const std::size_t both = countCommon(seen, view_of_b);
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ispace {

/// A set of cells of a grid, stored as bits by cell index, 64 to a word.
///
/// Set operations and counts take one step a word: 64 cells, and vector instructions do several
/// words at once; a grid of 1 million cells takes 125 kB. crop() drops the empty words at both
/// ends, which no result shows, so that thousands of small views of a large grid fit in memory.
/// Const members are thread-safe.
///
/// \pre cells passed are < size(), sets of one operation have one size
class CellSet {
  public:
    /// The empty set of a grid of `cells` cells.
    explicit CellSet(std::size_t cells = 0) : words_((cells + 63) / 64), cells_(cells) {}
    /// Cells of the grid, in the set or not; count() counts those in it.
    [[nodiscard]] std::size_t size() const { return cells_; }
    [[nodiscard]] bool test(std::size_t cell) const {
        const std::size_t word = cell / 64 - first_;
        return word < words_.size() && ((words_[word] >> (cell % 64)) & 1U) != 0;
    }
    void set(std::size_t cell) {
        if (cell / 64 - first_ >= words_.size()) widen();
        words_[cell / 64 - first_] |= std::uint64_t{1} << (cell % 64);
    }
    void reset(std::size_t cell) {
        const std::size_t word = cell / 64 - first_;
        if (word < words_.size()) words_[word] &= ~(std::uint64_t{1} << (cell % 64));
    }
    /// Frees the memory of all words before the first and after the last cell of the set. Does not
    /// change the set; a later set() or addBits() of cells beyond allocates all words again.
    void crop();
    /// Adds the cells first + i for which bit i is set. \pre all of them are < size()
    void addBits(std::size_t first, std::uint64_t bits);
    /// Number of cells in the set. O(words)
    [[nodiscard]] std::size_t count() const;
    [[nodiscard]] bool empty() const;
    CellSet& operator|=(const CellSet& other);
    CellSet& operator&=(const CellSet& other);
    /// Removes the cells of `other`. All three require sets of one size.
    CellSet& operator-=(const CellSet& other);
    /// Calls visit(std::size_t) for each cell of the set, ascending. O(words + cells of the set)
    template <typename Visit>
    void forEach(Visit visit) const;
    friend bool operator==(const CellSet& a, const CellSet& b);
    /// Number of cells in both sets, without storing their intersection.
    friend std::size_t countCommon(const CellSet& a, const CellSet& b);

  private:
    /// Numbers of words from `begin` to before `end`.
    struct Words {
        std::size_t begin, end;
    };
    /// Returns the words that both store.
    static Words commonWords(const CellSet& a, const CellSet& b);
    /// Stores all words.
    void widen();
    [[nodiscard]] std::size_t end() const { return first_ + words_.size(); }
    /// Iterator of a word by its number. \pre first_ <= word <= end()
    [[nodiscard]] auto at(std::size_t word) const {
        return words_.begin() + static_cast<std::ptrdiff_t>(word - first_);
    }
    [[nodiscard]] auto at(std::size_t word) {
        return words_.begin() + static_cast<std::ptrdiff_t>(word - first_);
    }

    std::vector<std::uint64_t> words_;  // from first_ on; the others are 0
    std::size_t first_ = 0;
    std::size_t cells_ = 0;
};
std::size_t countCommon(const CellSet& a, const CellSet& b);

template <typename Visit>
void CellSet::forEach(Visit visit) const {
    for (std::size_t i = 0; i < words_.size(); ++i)
        for (std::uint64_t word = words_[i]; word != 0; word &= word - 1)
            visit((first_ + i) * 64 + static_cast<std::size_t>(std::countr_zero(word)));
}

/// Consecutive cells of a grid: first, first + 1, ..., end - 1. A run may continue from the end of
/// a row at the beginning of the next.
struct CellRun {
    std::uint32_t first = 0, end = 0;
    friend bool operator==(const CellRun&, const CellRun&) = default;
};

/// Cells in parts; each part is a list of disjoint runs in ascending order. All runs lie in one
/// array: thousands of small parts cost two allocations. \pre cells are < 2^32
struct CellParts {
    std::vector<CellRun> runs;
    std::vector<std::uint32_t> first;  ///< part k: runs [first[k], first[k + 1])

    [[nodiscard]] std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
};

/// The set as one part. O(cells / 64 + runs)
CellParts partOf(const CellSet& cells);
/// Returns the cells of one part, as a set of a grid of `cells` cells: the inverse of partOf().
CellSet cellsOf(const CellParts& parts, std::size_t part, std::size_t cells);

}  // namespace ispace
