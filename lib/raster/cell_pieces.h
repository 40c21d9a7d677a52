// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "raster/cell_raster.h"
#include "raster/occupancy.h"

namespace ispace {

/// A connected piece of a set of cells.
struct CellPiece {
    std::size_t cells = 0;
    std::size_t border = 0;     ///< how many of them lie at the grid's border
    CellPlace first;            ///< the lowest, then leftmost
    CellPlace lowest, highest;  ///< corners of its bounding box
    [[nodiscard]] int extent() const {
        return std::max(highest.x - lowest.x, highest.y - lowest.y) + 1;
    }
};

/// The connected pieces of a set of cells, in the order of their first cells.
class CellPieces {
  public:
    enum class Joined { BySides, ByCorners };

    /// O(cells)
    CellPieces(const MapCells& cells, Joined joined);

    [[nodiscard]] const std::vector<CellPiece>& list() const { return pieces_; }
    [[nodiscard]] const CellPiece& operator[](std::size_t i) const { return pieces_[i]; }
    [[nodiscard]] std::size_t size() const { return pieces_.size(); }
    /// The piece that holds a cell; O(log runs of the row).
    [[nodiscard]] std::optional<std::size_t> at(CellPlace place) const;
    /// Share of the grid's border that a piece runs along.
    [[nodiscard]] double borderShare(std::size_t piece) const;
    /// The cells of one piece, in a grid of the same size.
    [[nodiscard]] MapCells cellsOf(std::size_t piece) const;

    /// Calls visit(CellRun, piece), row by row.
    template <typename Visit>
    void forEachRun(Visit visit) const {
        for (std::size_t i = 0; i < runs_.size(); ++i)
            visit(runs_[i], static_cast<std::size_t>(piece_of_[i]));
    }
    /// Calls visit(CellRun) for the runs of one piece, row by row; looks at its bounding box alone.
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
    /// Of runs and pieces: maps of 100 million cells can have half as many runs.
    using Index = std::uint32_t;

    void findRuns(const MapCells& cells);
    void joinRows(Joined joined, std::vector<Index>& root) const;
    void addUp(std::vector<Index>& root);
    /// Index of the first run of the row that does not end left of the place.
    [[nodiscard]] std::size_t firstRun(CellPlace place) const;

    int width_, height_;
    std::vector<CellRun> runs_;
    std::vector<std::size_t> row_begin_;  ///< index of the first run of each row, and the end
    std::vector<Index> piece_of_;         ///< for each run
    std::vector<CellPiece> pieces_;
};

}  // namespace ispace
