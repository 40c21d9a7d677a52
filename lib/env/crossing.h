// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geom/polygon.h"

namespace ispace {

/// A place where two edges of the closed curve cross, or nothing. Edges that only
/// touch or overlap do not cross. Sweeps along x: O(n log n) for short edges, O(n^2) at worst.
std::optional<Point2> selfCrossing(const Polygon& polygon);

}  // namespace ispace
