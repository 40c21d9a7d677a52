// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The cut of everything that stands at one height: what a level laser meets.
struct Slice {
    double height = 0;
    std::vector<Segment2> sheets;  ///< walls without thickness
    std::vector<Polygon> solids;   ///< closed sets, counter-clockwise; may overlap

    /// Calls visit(Segment2) for every line that stops a beam: sheets, then edges of solids.
    template <typename Visit>
    void forEachLine(Visit visit) const;
    /// True if p lies in a solid or on its edge.
    [[nodiscard]] bool blocked(Point2 p) const;
};

template <typename Visit>
void Slice::forEachLine(Visit visit) const {
    for (const Segment2& sheet : sheets) visit(sheet);
    for (const Polygon& solid : solids) forEachEdge(solid, visit);
}

}  // namespace ispace
