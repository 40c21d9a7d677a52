// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/cell_groups.h"

#include <algorithm>
#include <cstdint>

namespace ispace {

namespace {

/// Calls visit(cell) for the up to four cells beside one.
template <typename Visit>
void forEachBeside(const Grid& grid, std::size_t cell, Visit visit) {
    const auto columns = static_cast<std::size_t>(grid.columns);
    if (cell % columns > 0) visit(cell - 1);
    if (cell % columns + 1 < columns) visit(cell + 1);
    if (cell >= columns) visit(cell - columns);
    if (cell + columns < grid.size()) visit(cell + columns);
}

bool isOnRim(const Grid& grid, const CellSet& cells, std::size_t cell) {
    int inside = 0;
    forEachBeside(grid, cell, [&](std::size_t next) { inside += cells.test(next) ? 1 : 0; });
    return inside < 4;
}

/// Steps from each cell of the set to the rim, 1 on it; 0 for all others.
std::vector<std::uint32_t> depthsOf(const Grid& grid, const CellSet& cells) {
    std::vector<std::uint32_t> depths(grid.size());
    std::vector<std::size_t> open;
    cells.forEach([&](std::size_t cell) {
        if (!isOnRim(grid, cells, cell)) return;
        depths[cell] = 1;
        open.push_back(cell);
    });
    for (std::size_t i = 0; i < open.size(); ++i)
        forEachBeside(grid, open[i], [&](std::size_t next) {
            if (!cells.test(next) || depths[next] != 0) return;
            depths[next] = depths[open[i]] + 1;
            open.push_back(next);
        });
    return depths;
}

}  // namespace

std::vector<CellGroup> piecesOf(const Grid& grid, const CellSet& cells) {
    const std::vector<std::uint32_t> depths = depthsOf(grid, cells);
    CellSet left = cells;
    std::vector<CellGroup> pieces;
    std::vector<std::size_t> open;
    cells.forEach([&](std::size_t first) {
        if (!left.test(first)) return;
        CellGroup piece{0, first};
        left.reset(first);
        open.assign(1, first);
        while (!open.empty()) {
            const std::size_t cell = open.back();
            open.pop_back();
            ++piece.cells;
            const bool deeper = depths[cell] > depths[piece.middle];
            if (deeper || (depths[cell] == depths[piece.middle] && cell < piece.middle))
                piece.middle = cell;
            forEachBeside(grid, cell, [&](std::size_t next) {
                if (!left.test(next)) return;
                left.reset(next);
                open.push_back(next);
            });
        }
        pieces.push_back(piece);
    });
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const CellGroup& a, const CellGroup& b) { return a.cells > b.cells; });
    return pieces;
}

}  // namespace ispace
