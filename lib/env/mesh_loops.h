// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/env only: from the curves of a cut to the polygons of a slice.
#pragma once

#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// Turns the list of vertices so that the lowest (lexLess) comes first.
void beginAtLowest(Polygon& polygon);

/// Polygons for closed curves that have the solid on their left: counter-clockwise ones bound
/// solids, clockwise ones cavities. A cavity becomes part of the polygon around it, joined by a
/// seam to the left of its leftmost vertex, there and back, which stays in the solid; one that
/// nothing solid surrounds is a solid seen from inside, and turned. The polygons begin at their
/// lowest vertex (lexLess). \pre each curve begins so, too, has an area, and no two equal
/// neighbours.
/// O(n log n) for n vertices where solids do not overlap.
std::vector<Polygon> joinCavities(std::vector<Polygon> curves);

}  // namespace ispace
