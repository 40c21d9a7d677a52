// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cover/grid.h"
#include "env/environment.h"

namespace ispace {

/// What is to be covered, in cells.
struct Target {
    Grid grid;
    double height = kScanHeight;  ///< at which free floor is judged
    CellSet indoor;               ///< centre strictly inside the indoor region
    CellSet free;                 ///< indoor and not in a solid at `height`
};

/// Most cells of a grid.
constexpr int kMostCells = 10'000'000;

/// \throws UsageError unless columns and rows are at least 1 and make at most kMostCells
Target makeTarget(const Environment& environment, int columns, int rows, double height);
/// The same with square cells of this edge from the lower left corner of the limits on, the last
/// column and row as far beyond the limits as need be. \pre cell > 0
/// \throws UsageError for more than kMostCells
Target makeTarget(const Environment& environment, double cell, double height);

}  // namespace ispace
