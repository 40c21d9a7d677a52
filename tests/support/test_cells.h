// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of maps of cells: converts sets of cells from and to rows of text.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "raster/cells.h"

namespace ispace::testing {

/// Builds a set from rows, top row first; '.' is in the set.
inline MapCells cellsOf(const std::vector<std::string>& rows) {
    MapCells cells(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
    for (int y = 0; y < cells.height(); ++y)
        for (int x = 0; x < cells.width(); ++x)
            if (rows[static_cast<std::size_t>(cells.height() - 1 - y)]
                    [static_cast<std::size_t>(x)] == '.')
                cells.insert(x, y);
    return cells;
}

/// Converts a set to rows, top row first.
inline std::vector<std::string> rowsOf(const MapCells& cells) {
    std::vector<std::string> rows;
    for (int y = cells.height() - 1; y >= 0; --y) {
        rows.emplace_back();
        for (int x = 0; x < cells.width(); ++x) rows.back() += cells.contains(x, y) ? '.' : '#';
    }
    return rows;
}

/// Returns the largest piece, the first among equals.
/// \pre not empty
inline MapCells largestPiece(const MapCells& cells) {
    const CellPieces pieces(cells, CellPieces::Joined::BySides);
    const auto& list = pieces.list();
    const auto largest =
        std::max_element(list.begin(), list.end(),
                         [](const CellPiece& a, const CellPiece& b) { return a.cells < b.cells; });
    return pieces.cellsOf(static_cast<std::size_t>(largest - list.begin()));
}

}  // namespace ispace::testing
