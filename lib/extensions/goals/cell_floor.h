// SPDX-License-Identifier: GPL-3.0-or-later
// Ways over the free cells of a target: the graph in which arrange looks for ways of an intruder.
//
// Lengths are whole numbers of kPathUnit, so that sums do not depend on their order. O(cells), and
// a test against the walls near each step.
//
//     CellPaths ways;
//     const std::size_t first = addFloor(environment, target, ways);
//     ways.from = freeCellsOf(environment, target, "entrance", first, target.grid.size());
#pragma once

#include <cstddef>
#include <string>

#include "base/cell_set.h"
#include "coverage/target.h"
#include "env/environment.h"
#include "extensions/goals/cell_paths.h"
#include "geom/point.h"

namespace ispace::goals {

/// Unit of the lengths of ways, metres.
constexpr double kPathUnit = 1e-4;

/// Adds the floor of a room: ways of a point over the centres of free cells. Steps lead to the 16
/// neighbours that are a king's or a knight's move away, if all cells under them are free and no
/// wall crosses them. No way is longer than the shortest one over free floor by more than 2.8 %,
/// besides two cells at each corner that it passes.
/// \returns the first of its cells
std::size_t addFloor(const Environment& environment, const Target& target, CellPaths& ways);

/// Returns the free cells of a zone, from `first` on, of `all` cells.
/// \throws UsageError for an unknown zone, and for one without a free cell
CellSet freeCellsOf(const Environment& environment, const Target& target, const std::string& zone,
                    std::size_t first, std::size_t all);

/// Returns the free cells of a landing: those with a centre on it or, with large cells, the one
/// with the nearest centre to which no wall bars the way, within two cells. Empty without any.
CellSet landingCellsOf(const Environment& environment, const Target& target, const Box2& landing,
                       std::size_t first, std::size_t all);

}  // namespace ispace::goals
