// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap: cuts the shadows of round bodies from a region.
//
// A direction is the tangent w of its angle from the middle of the shadow: the inverse range of a
// straight line is linear in w. The near side of a body is the edges of its outline between the
// true tangents, so body and region are compared by closed forms, interval by interval, never by
// sampled rays. Cutting another body's shadow from the result is exact up to rounding, too: bodies
// may come in any order, and the nearest first is faster. Thread-safe once built.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geom/curve.h"
#include "geom/spatial_index.h"
#include "geom/visibility/visibility.h"

namespace ispace {

/// Round bodies that block the view. Their shadows are cut from a region computed without them, so
/// queries never cross their outlines edge by edge.
class RoundBodies {
  public:
    /// \param first_line VisibilityEdge::line of the first of them
    RoundBodies(std::span<const Ellipse> rounds, std::uint32_t first_line);

    [[nodiscard]] bool empty() const { return rounds_.empty(); }
    /// Distance within which all round bodies lie.
    [[nodiscard]] double farthest(Point2 p) const;
    /// Cuts the shadows of all bodies from the region. O(edges) for each body within range.
    void cut(VisibleRegion& region) const;

  private:
    /// Of those within range that may be seen; the nearest first, so that others are found hidden.
    [[nodiscard]] std::vector<std::uint32_t> within(const VisibleRegion& region) const;

    std::vector<Ellipse> rounds_;
    std::vector<Polygon> outlines_;  // computed once: sines take long
    std::uint32_t first_line_;
    BoxTree boxes_;
    Box2 box_;
};

}  // namespace ispace
