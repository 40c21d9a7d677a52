// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "env/slice.h"
#include "geom/box_tree.h"
#include "geom/visibility.h"

namespace ispace {

/// A slice as level sensors at its height see it. Thread-safe once built.
class SliceSight {
  public:
    /// Lines of the slice stop sight. With boxes, those alone that meet one of them: enough for
    /// viewpoints whose reach lies within a box.
    explicit SliceSight(Slice slice, std::span<const Box2> reach = {});

    /// As VisibilityMap::look; but nothing is seen from strictly inside a solid, farther than
    /// kSightContact from its surface.
    void look(Point2 viewpoint, double max_range, VisibleRegion& region) const;
    [[nodiscard]] bool isInSolid(Point2 p) const;

  private:
    std::vector<Polygon> solids_;
    BoxTree boxes_;
    VisibilityMap map_;
};

}  // namespace ispace
