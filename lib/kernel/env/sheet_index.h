// SPDX-License-Identifier: GPL-3.0-or-later
// Points on the lines of a level: a site on a wall without thickness is not free.
#pragma once

#include <cstddef>
#include <span>

#include "geom/point.h"
#include "geom/spatial_index.h"

namespace ispace {

/// Tells whether a point lies on one of many segments. Long oblique segments, with boxes that
/// overlap, are indexed in pieces: a star of n walls costs a point some n / 32 comparisons at most
/// outside of its middle, instead of n / 4. Thread-safe. O(n log n) to build, with up to 32 pieces
/// a segment.
class SheetIndex {
  public:
    /// \param sheets outlive this object
    explicit SheetIndex(std::span<const Segment2> sheets);

    /// Returns true if p lies on a segment, ends included; exact.
    [[nodiscard]] bool holds(Point2 p) const;

  private:
    std::span<const Segment2> sheets_;
    std::size_t pieces_ = 1;  // of each sheet
    BoxTree tree_;            // of the pieces, sheet after sheet
};

}  // namespace ispace
