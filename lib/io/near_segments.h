// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Finds segments near a place, however unevenly they are spread: one line far out does not make
/// the search slow for the others. O(n log n) to build.
class NearSegments {
  public:
    explicit NearSegments(std::span<const Segment2> segments);

    /// Ascending indices of segments, among them all those within `reach` of p.
    [[nodiscard]] std::vector<std::size_t> near(Point2 p, double reach) const;
    /// The same for all those within `reach` of the box.
    [[nodiscard]] std::vector<std::size_t> near(const Box2& box, double reach) const;

  private:
    BoxTree tree_;
};

}  // namespace ispace
