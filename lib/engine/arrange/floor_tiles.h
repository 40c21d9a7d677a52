// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/arrange: bounds of the floor in a box.
//
// Before a pose is measured exactly, a bound tells whether it can gain at all. Sums over 64 * 64
// tiles answer a box by four reads (F. C. Crow, Summed-area tables for texture mapping, 1984).
//
//     FloorTiles tiles(bounds);
//     tiles.add(unseen, weight);
//     if (tiles.mostIn(boxOfView) <= best) continue;   // no need to compute the view
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/cell_set.h"
#include "geom/curve.h"
#include "geom/point.h"
#include "raster/grid.h"

namespace ispace {

/// Bounds the weight of floor in boxes by tiles, in O(1) a box. Const members are thread-safe.
class FloorTiles {
  public:
    /// Of floor in this box, which is not empty.
    explicit FloorTiles(const Box2& box);

    /// Adds floor to the left of these curves. Arcs count as chords at most 1 mm from them.
    /// O((n + tiles) log tiles) \pre weight >= 0
    void add(std::span<const Curve> curves, double weight);
    /// Returns the weight in all tiles that the box meets, and all that may lie between arcs and
    /// their chords: at least the weight in the box, up to rounding. 0 for a box beside the
    /// floor's.
    [[nodiscard]] double mostIn(const Box2& box) const;

  private:
    static constexpr std::size_t kSide = 64;  // tiles, a power of two

    struct Part;
    void divide(const std::vector<Polygon>& floor, const Part& part, double weight);
    /// Returns the tile of a coordinate, within the first and last.
    [[nodiscard]] static std::size_t tileAt(double offset, double extent);

    Box2 box_;
    double beyond_chords_ = 0;  // the most that lies there, wherever it is
    /// [x + y * (kSide + 1)]: the sum over the tiles to the left of x and below y.
    std::vector<double> sums_;
};

/// Bounds the area of these cells within a range of any point of the grid, m2: the most of them in
/// a rectangle of cells that holds the disc about any point of its middle cell. O(cells of the
/// grid)
double mostWithin(double range, const CellSet& cells, const Grid& grid);

}  // namespace ispace
