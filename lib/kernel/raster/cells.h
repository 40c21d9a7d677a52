// SPDX-License-Identifier: GPL-3.0-or-later
// Sets of cells as bytes, their runs and connected pieces, for maps of robots and plans of pixels.
// (CellSet of base has a bit a cell, for views.) Everything is exact and in row order: results
// depend on the set alone. Const members are thread-safe.
//
//     const CellPieces pieces(free, CellPieces::Joined::BySides);
//     for (const CellPiece& piece : pieces.list())
//         if (piece.border > 0) outside += piece.cells;
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "base/cell_set.h"

namespace ispace {

/// Column and row of a cell.
struct CellIndex {
    int x = 0, y = 0;
};

/// A run of cells of one row, both ends included.
struct RowRun {
    int row = 0, first = 0, last = 0;
    friend bool operator==(const RowRun&, const RowRun&) = default;
};

/// The cells above, below and beside a cell.
constexpr std::array<CellIndex, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// Stores a set of cells, one byte each; column 0 is on the left, row 0 at the bottom.
class MapCells {
  public:
    MapCells(int width, int height)
        : width_(width),
          height_(height),
          cells_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
    /// Cell (x, y) is number y * width + x of the set.
    MapCells(const CellSet& cells, int width, int height) : MapCells(width, height) {
        cells.forEach([this](std::size_t i) { cells_[i] = 1; });
    }

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int height() const { return height_; }
    /// Returns false outside of the grid.
    [[nodiscard]] bool contains(int x, int y) const {
        return x >= 0 && y >= 0 && x < width_ && y < height_ && cells_[index(x, y)] != 0;
    }
    /// Inserts a cell.
    /// \pre the cell lies in the grid
    void insert(int x, int y) { cells_[index(x, y)] = 1; }
    /// Removes a cell.
    /// \pre the cell lies in the grid
    void erase(int x, int y) { cells_[index(x, y)] = 0; }
    /// Inserts the cells from `first` to `last` of a row.
    /// \pre they lie in the grid, first <= last
    void insertRun(int y, int first, int last) { fillRun(y, first, last, 1); }
    /// Removes them.
    void eraseRun(int y, int first, int last) { fillRun(y, first, last, 0); }
    [[nodiscard]] std::size_t count() const;
    /// One byte per cell, 1 for cells in the set: the whole grid, and one row.
    [[nodiscard]] std::span<const std::uint8_t> data() const { return cells_; }
    [[nodiscard]] std::span<const std::uint8_t> row(int y) const {
        return std::span(cells_).subspan(index(0, y), static_cast<std::size_t>(width_));
    }
    /// Returns a writable row of zeros and ones.
    [[nodiscard]] std::span<std::uint8_t> row(int y) {
        return std::span(cells_).subspan(index(0, y), static_cast<std::size_t>(width_));
    }
    /// Returns the index of cell (x, y) in data(): row by row from the bottom.
    [[nodiscard]] std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
               static_cast<std::size_t>(x);
    }

    /// Calls visit(x, y) for each cell of the set, row by row.
    template <typename Visit>
    void forEach(Visit visit) const {
        for (int y = 0; y < height_; ++y) {
            const std::span<const std::uint8_t> cells = row(y);
            for (std::size_t x = 0; x < cells.size(); ++x)
                if (cells[x] != 0) visit(static_cast<int>(x), y);
        }
    }

  private:
    void fillRun(int y, int first, int last, std::uint8_t value) {
        std::memset(&cells_[index(first, y)], value, static_cast<std::size_t>(last - first) + 1);
    }

    int width_, height_;
    std::vector<std::uint8_t> cells_;
};

/// Calls visit(first, last) for each run of ones in a row of zeros and ones.
template <typename Visit>
void forEachRunOf(std::span<const std::uint8_t> row, Visit visit) {
    const std::uint8_t* const begin = row.data();
    const std::uint8_t* const end = begin + row.size();
    const auto find = [end](const std::uint8_t* at, int value) {
        constexpr int kShort = 8;  // runs this short are found faster without a call
        for (int i = 0; i < kShort; ++i, ++at)
            if (at == end || *at == value) return at;
        const void* const found = std::memchr(at, value, static_cast<std::size_t>(end - at));
        return found == nullptr ? end : static_cast<const std::uint8_t*>(found);
    };
    for (const std::uint8_t* at = find(begin, 1); at != end;) {
        const std::uint8_t* const past = find(at, 0);
        visit(static_cast<int>(at - begin), static_cast<int>(past - begin) - 1);
        at = find(past, 1);
    }
}

/// Returns the cells of the first set that are not in the second, of the same size.
MapCells difference(const MapCells& cells, const MapCells& others);
/// Returns the cells of the grid that are not in the set.
MapCells complement(const MapCells& cells);

/// A connected piece of a set of cells.
struct CellPiece {
    std::size_t cells = 0;
    std::size_t border = 0;     ///< of these, cells at the grid's border
    CellIndex first;            ///< the lowest, then leftmost
    CellIndex lowest, highest;  ///< corners of its bounding box
    [[nodiscard]] int extent() const {
        return std::max(highest.x - lowest.x, highest.y - lowest.y) + 1;
    }
};

/// Finds the connected pieces of a set of cells, in the order of their first cells: runs of rows
/// are labelled and joined with those of the row below (A. Rosenfeld, J. L. Pfaltz, Sequential
/// operations in digital picture processing, 1966, by runs, with union and find). Memory: 16 bytes
/// a run.
class CellPieces {
  public:
    enum class Joined { BySides, ByCorners };

    /// O(cells)
    CellPieces(const MapCells& cells, Joined joined);

    [[nodiscard]] const std::vector<CellPiece>& list() const { return pieces_; }
    [[nodiscard]] const CellPiece& operator[](std::size_t i) const { return pieces_[i]; }
    [[nodiscard]] std::size_t size() const { return pieces_.size(); }
    /// Finds the piece that holds a cell; O(log runs of the row).
    [[nodiscard]] std::optional<std::size_t> at(CellIndex place) const;
    /// Returns the fraction of the grid's border that the piece occupies.
    [[nodiscard]] double borderShare(std::size_t piece) const;
    /// Returns the cells of one piece, in a grid of the same size.
    [[nodiscard]] MapCells cellsOf(std::size_t piece) const;

    /// Calls visit(RowRun, piece), row by row.
    template <typename Visit>
    void forEachRun(Visit visit) const {
        for (std::size_t i = 0; i < runs_.size(); ++i)
            visit(runs_[i], static_cast<std::size_t>(piece_of_[i]));
    }
    /// Calls visit(RowRun) for the runs of one piece, row by row, scanning its bounding box only.
    template <typename Visit>
    void forEachRunOfPiece(std::size_t piece, Visit visit) const {
        const CellPiece& box = pieces_[piece];
        for (int y = box.lowest.y; y <= box.highest.y; ++y) {
            const std::size_t end = row_begin_[static_cast<std::size_t>(y) + 1];
            for (std::size_t i = firstRun({box.lowest.x, y});
                 i < end && runs_[i].first <= box.highest.x; ++i)
                if (piece_of_[i] == piece) visit(runs_[i]);
        }
    }

  private:
    /// Type of run and piece indices: a map can have half as many runs as cells.
    using Index = std::uint32_t;

    void findRuns(const MapCells& cells);
    void joinRows(Joined joined, std::vector<Index>& root) const;
    void addUp(std::vector<Index>& root);
    /// Returns the index of the first run of the row that does not end left of the cell.
    [[nodiscard]] std::size_t firstRun(CellIndex place) const;

    int width_, height_;
    std::vector<RowRun> runs_;
    std::vector<std::size_t> row_begin_;  ///< index of the first run of each row, and the end
    std::vector<Index> piece_of_;         ///< for each run
    std::vector<CellPiece> pieces_;
};

}  // namespace ispace
