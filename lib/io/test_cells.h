// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of maps made of cells: sets of cells as they look.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/occupancy.h"

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

}  // namespace ispace::testing
