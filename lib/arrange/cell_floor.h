// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/arrange: ways over the free cells of a target.
#pragma once

#include "arrange/search/cell_ways.h"
#include "coverage/least_seen_way.h"
#include "coverage/target.h"
#include "env/environment.h"

namespace ispace {

/// Unit of the lengths of ways, metres.
constexpr double kWayUnit = 1e-4;

/// Returns the ways of a point between two zones, over the centres of free cells: steps lead to the
/// 16 neighbours that are a king's or a knight's move away, if all cells under them are free and no
/// wall crosses them. No way is longer than the shortest one over free floor by more than 2.8 %,
/// besides two cells at each corner that it passes.
/// \throws UsageError for an unknown zone, and for one without a free cell
CellWays cellWaysOf(const Environment& environment, const Target& target, const WayChoice& of);

}  // namespace ispace
