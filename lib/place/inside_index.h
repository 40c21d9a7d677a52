// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/place only: whether places lie inside, for very many of them.
#pragma once

#include <vector>

#include "geom/polygon.h"
#include "geom/spatial_index.h"
#include "raster/grid.h"

namespace ispace {

/// Answers "strictly inside these regions?" as Region::locate does, for places by the ten thousand.
///
/// It is the thesis' Insider Judge (section 4.4.4) with a known point in each cell of a grid, most
/// often so near that no line lies between: the centres of all cells are judged at once, exactly,
/// by scanline. A place then needs the edges that come near the segment from it to the centre of
/// its cell. Thread-safe once built. O(cells + n log n) to build; mostly O(log n) a place.
class InsideIndex {
  public:
    /// \param regions disjoint, as of Region; they may touch
    explicit InsideIndex(std::vector<Region> regions);

    /// Strictly inside one of the regions; exact.
    [[nodiscard]] bool isInside(Point2 p) const;
    /// The cells whose centres are the known points; none without regions.
    [[nodiscard]] const Grid& cells() const { return grid_; }

  private:
    [[nodiscard]] bool isInsideSlowly(Point2 p) const;

    std::vector<Region> regions_;
    std::vector<Segment2> edges_;
    BoxTree tree_;
    Grid grid_;
    CellSet inside_;  // by the centres of the cells
};

}  // namespace ispace
