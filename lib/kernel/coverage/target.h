// SPDX-License-Identifier: GPL-3.0-or-later
// The floor to be covered: cells over the limits of a room, and their weights.
//
//     const Target target = makeTarget(scene.environment, RoomCells(), kScanHeight);
//     const double share = double(target.indoor.count()) / double(target.grid.size());
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

/// Square cells sized by the room: their edge is 0.1 m, smaller if the limits held fewer than 10
/// 000 of them, larger if they held more than `most`; rounded to two decimal digits.
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
/// The choice of cells. Square cells start at the lower left corner of the limits; the last column
/// and row may reach beyond the limits.
using CellChoice = std::variant<RoomCells, CellCount, CellSize>;

/// Default edge of RoomCells, metres.
constexpr double kRoomCell = 0.1;

/// Builds the grid. \throws UsageError for less than one column or row, or more than kMaxCells in
/// all
Grid gridOver(const Box2& limits, const CellChoice& cells);

/// The floor to be covered, in cells.
struct Target {
    Grid grid;
    double height = kScanHeight;  ///< height at which the free floor is computed
    CellSet indoor;               ///< centre strictly inside the indoor region
    CellSet free;                 ///< indoor and outside solids at `height`
};

/// Maximum number of cells of a grid.
constexpr int kMaxCells = 10'000'000;

/// Computes the target's cells. \throws UsageError as gridOver
Target makeTarget(const Environment& environment, const CellChoice& cells, double height);

/// The weight of each part of the floor; by default all indoor floor has weight 1.
struct FloorWeights {
    std::vector<NamedZone> targets;  ///< only floor in one of them counts; empty: all floor
    /// The last zone that holds a point decides; 1 outside all zones.
    std::vector<std::pair<NamedZone, double>> weights;

    [[nodiscard]] bool isUniform() const { return targets.empty() && weights.empty(); }
};

/// Computes the weight of each cell of the target's grid: 0 outside the indoor region and all
/// targets. A cell counts by its centre, strictly inside.
std::vector<double> weightsOfCells(const Target& target, const FloorWeights& floor);

}  // namespace ispace
