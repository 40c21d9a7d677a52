// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "io/cell_raster.h"
#include "io/occupancy.h"

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
        for (std::size_t i = 0; i < runs_.size(); ++i) visit(runs_[i], piece_of_[i]);
    }

  private:
    void findRuns(const MapCells& cells);
    void joinRows(Joined joined, std::vector<std::size_t>& root) const;
    void addUp(const std::vector<std::size_t>& root);

    int width_, height_;
    std::vector<CellRun> runs_;
    std::vector<std::size_t> row_begin_;  ///< index of the first run of each row, and the end
    std::vector<std::size_t> piece_of_;   ///< for each run
    std::vector<CellPiece> pieces_;
};

}  // namespace ispace
