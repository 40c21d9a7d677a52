// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs: the floor that proofs over poses are about.
#pragma once

#include <string>
#include <vector>

#include "env/level.h"
#include "geom/polygon.h"

namespace ispace::proofs {

/// Why sight on a level differs from sight within the outlines of its free floor; empty if the two
/// agree: the proofs take each edge of the floor as opaque, and see through all else.
/// Wrong are round bodies, whose edges are arcs; sheets inside the floor, also in part; and edges
/// without a wall behind them, as windows and walls below the level leave. One such stretch alone
/// is allowed: a line of sight that leaves through it does not come back. O(n log n)
/// \param elements of the environment, whose ids it names
std::string whyNotOpaque(const Level& level, const std::vector<Region>& floor,
                         const std::vector<Element>& elements);

}  // namespace ispace::proofs
