// SPDX-License-Identifier: GPL-3.0-or-later
// Point location for bulk queries: sides are exact, those of the single queries of geom/polygon.h;
// margins and reaches compare distances, which round. Built once, immutable and thread-safe after
// that.
//
//     const RegionIndex index(regions.parts);
//     const Side side = index.locate({2, 1});
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"
#include "geom/spatial_index.h"
#include "raster/grid.h"

namespace ispace {

/// Locates points as Regions::locate does, for bulk queries.
///
/// The thesis' Insider Judge (section 4.4.4) with a known point in each cell of a grid, usually so
/// near that no line lies between: construction locates the centres of all cells at once, exactly,
/// by scanline. A query reads the edges near the segment from the point to the centre of its cell.
/// Thread-safe. O(cells + n log n) to build; typically O(log n) per query.
class RegionIndex {
  public:
    /// \param regions disjoint; they may touch
    explicit RegionIndex(std::span<const Region> regions);

    /// Returns the side of a point; exact.
    [[nodiscard]] Side locate(Point2 p) const;
    /// Returns true if an edge comes within `reach` of p, or p lies inside.
    [[nodiscard]] bool isWithin(Point2 p, double reach) const;
    /// Calls visit(const Segment2&) for the edges with bounds that meet the window.
    template <typename Visit>
    void edgesIn(const Box2& window, Visit visit) const {
        tree_.search(window, [&](std::size_t i) { visit(edges_[i]); });
    }
    /// Returns the grid; its cell centres are the known points. Empty without regions.
    [[nodiscard]] const Grid& cells() const { return grid_; }

  private:
    [[nodiscard]] Side locateByRay(Point2 p) const;

    std::vector<Segment2> edges_;
    BoxTree tree_;
    Grid grid_;
    CellSet inside_;  // the cells with centres inside
};

/// Returns true if p lies strictly inside, farther than `margin` from the edge. O(corners)
[[nodiscard]] bool containsWithMargin(const Polygon& polygon, Point2 p, double margin);

/// Finds the polygons that contain a point, or have edges near it. Thread-safe.
class PolygonIndex {
  public:
    /// \param polygons stored by reference
    explicit PolygonIndex(std::span<const Polygon> polygons);

    [[nodiscard]] bool empty() const { return polygons_.empty(); }
    /// Finds the first polygon that contains p or has it on its boundary; exact.
    [[nodiscard]] std::optional<std::size_t> holder(Point2 p) const;
    /// Returns true if any polygon contains p with that margin.
    [[nodiscard]] bool containsWithMargin(Point2 p, double margin) const;
    /// Returns the polygons with an edge within `reach` of p.
    [[nodiscard]] std::vector<Polygon> touching(Point2 p, double reach) const;

  private:
    std::span<const Polygon> polygons_;
    BoxTree boxes_;
};

}  // namespace ispace
