// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "env/environment.h"
#include "env/zone.h"
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

/// \throws UsageError for less than one column or row, or more than kMaxCells in all
Grid gridOver(const Box2& limits, const CellChoice& cells);

/// What is to be covered, in cells.
struct Target {
    Grid grid;
    double height = kScanHeight;  ///< at which the floor is free or not
    CellSet indoor;               ///< centre strictly inside the indoor region
    CellSet free;                 ///< indoor and not in a solid at `height`
};

/// Most cells of a grid.
constexpr int kMaxCells = 10'000'000;

/// \throws UsageError as gridOver
Target makeTarget(const Environment& environment, const CellChoice& cells, double height);

/// The weight of each part of the floor; by default all indoor floor weighs the same.
struct FloorWeights {
    std::vector<NamedZone> targets;  ///< only floor in one of them counts; none: all
    /// The last that holds a place decides; else 1.
    std::vector<std::pair<NamedZone, double>> weights;

    [[nodiscard]] bool isUniform() const { return targets.empty() && weights.empty(); }
};

/// Weight of each cell of the target's grid: 0 outside the indoor region and all targets. A cell
/// counts by its centre, strictly inside.
std::vector<double> weightsOfCells(const Target& target, const FloorWeights& floor);

}  // namespace ispace
