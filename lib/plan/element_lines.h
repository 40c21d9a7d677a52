// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/environment.h"

namespace ispace {

/// What a plan draws of an element as lines: mid-lines of walls, and where doors and windows are.
struct ElementLines {
    std::vector<std::vector<Point2>> chains;  ///< closed ones end where they begin; none: no lines
    double thickness = 0;                     ///< of the wall, or through it, in metres
};

/// Of each element. O(n log n).
std::vector<ElementLines> elementLinesOf(const Environment& environment);

/// Area of a `floor` record.
Polygon floorOutline(const Record& record);

/// Segments joined where one begins at the end of the one before.
std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments);

}  // namespace ispace
