// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Tells which of a slice's solids a place is in or at. Thread-safe once built.
class SolidTree {
  public:
    SolidTree() = default;
    explicit SolidTree(std::vector<Polygon> solids);

    /// Strictly inside one of them, farther than `contact` from its surface.
    [[nodiscard]] bool isInside(Point2 p, double contact) const;
    /// Those whose surface comes within `contact` of p.
    [[nodiscard]] std::vector<Polygon> touching(Point2 p, double contact) const;

  private:
    std::vector<Polygon> solids_;
    BoxTree boxes_;
};

}  // namespace ispace
