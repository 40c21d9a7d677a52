// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/slice.h"
#include "env/solid_tree.h"
#include "geom/visibility.h"

namespace ispace {

/// A slice as level sensors at its height see it: its lines and round bodies stop sight.
/// Thread-safe once built.
class SliceSight {
  public:
    explicit SliceSight(Slice slice);

    /// As VisibilityMap::look; but nothing is seen from strictly inside a solid, farther than
    /// kRayEpsilon from its surface.
    void query(Point2 viewpoint, double max_range, VisibleRegion& region) const;
    /// The solids whose surface p touches (within kRayEpsilon): sight passes into them there, but
    /// there is nothing to be seen.
    [[nodiscard]] std::vector<Polygon> solidsTouching(Point2 p) const {
        return solids_.touching(p, kRayEpsilon);
    }

  private:
    VisibilityMap map_;
    SolidTree solids_;
};

}  // namespace ispace
