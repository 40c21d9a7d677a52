// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of maps made of cells: sets of cells as they look.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "raster/cells.h"

namespace ispace::testing {

/// Rows from the top, '.' is in the set.
inline MapCells cellsOf(const std::vector<std::string>& rows) {
    MapCells cells(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()));
    for (int y = 0; y < cells.height(); ++y)
        for (int x = 0; x < cells.width(); ++x)
            if (rows[static_cast<std::size_t>(cells.height() - 1 - y)]
                    [static_cast<std::size_t>(x)] == '.')
                cells.insert(x, y);
    return cells;
}

/// As they look, from the top.
inline std::vector<std::string> rowsOf(const MapCells& cells) {
    std::vector<std::string> rows;
    for (int y = cells.height() - 1; y >= 0; --y) {
        rows.emplace_back();
        for (int x = 0; x < cells.width(); ++x) rows.back() += cells.contains(x, y) ? '.' : '#';
    }
    return rows;
}

/// The largest piece, of equal ones the first. \pre not empty
inline MapCells largestPiece(const MapCells& cells) {
    const CellPieces pieces(cells, CellPieces::Joined::BySides);
    const auto& list = pieces.list();
    const auto largest =
        std::max_element(list.begin(), list.end(),
                         [](const CellPiece& a, const CellPiece& b) { return a.cells < b.cells; });
    return pieces.cellsOf(static_cast<std::size_t>(largest - list.begin()));
}

}  // namespace ispace::testing
