// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <variant>

#include "env/environment.h"
#include "raster/grid.h"

namespace ispace {

/// Square cells that follow the room: their edge is 0.1 m, smaller where that makes fewer than
/// 10 000 of them over the limits, and larger where it makes more than `most`, both a number of two
/// digits.
struct RoomCells {
    int most = 200'000;
};
/// P x Q cells over the limits.
struct CellCount {
    int columns = 100, rows = 100;
};
/// Square cells with this edge, metres.
struct CellSize {
    double edge;
};
/// Which cells count. Square ones lie from the lower left corner of the limits on, the last column
/// and row as far beyond the limits as need be.
using CellChoice = std::variant<RoomCells, CellCount, CellSize>;

/// The edge of RoomCells that are not too many, metres.
constexpr double kRoomCell = 0.1;

/// \throws UsageError for less than one column or row, or more than kMostCells in all
Grid gridOver(const Box2& limits, const CellChoice& cells);

/// What is to be covered, in cells.
struct Target {
    Grid grid;
    double height = kScanHeight;  ///< at which free floor is judged
    CellSet indoor;               ///< centre strictly inside the indoor region
    CellSet free;                 ///< indoor and not in a solid at `height`
};

/// Most cells of a grid.
constexpr int kMostCells = 10'000'000;

/// \throws UsageError as gridOver
Target makeTarget(const Environment& environment, const CellChoice& cells, double height);

}  // namespace ispace
