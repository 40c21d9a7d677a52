// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// Everything that stands between two heights, seen from above: what a robot of that height runs
/// into.
struct Band {
    double bottom = 0, top = 0;
    std::vector<Segment2> sheets;  ///< walls without thickness
    std::vector<Polygon> solids;   ///< closed sets, counter-clockwise; may overlap
    /// Whose they are: indices in Environment::elements().
    std::vector<std::size_t> sheet_owners = {}, solid_owners = {};

    /// Calls visit(Segment2) for each sheet, then for each edge of the solids.
    template <typename Visit>
    void forEachLine(Visit visit) const;
};

template <typename Visit>
void Band::forEachLine(Visit visit) const {
    for (const Segment2& sheet : sheets) visit(sheet);
    for (const Polygon& solid : solids) forEachEdge(solid, visit);
}

}  // namespace ispace
