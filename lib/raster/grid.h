// SPDX-License-Identifier: GPL-3.0-or-later
// lib/raster: grids of cells, scanlines, contours, components, pictures in. Uses geom and below;
// OpenCV and libpng inside.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "base/cell_set.h"
#include "geom/polygon.h"

namespace ispace {

/// P x Q cells over the limits; cell (column, row) has index row * columns + column, row 0 at the
/// low y. A cell counts by its centre.
struct Grid {
    Box2 limits;
    int columns = 100, rows = 100;

    [[nodiscard]] std::size_t size() const {
        return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    }
    /// Middles of the columns and of the rows; neither ever decreases.
    [[nodiscard]] double columnCenter(int column) const;
    [[nodiscard]] double rowCenter(int row) const;
    [[nodiscard]] std::size_t cell(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
    [[nodiscard]] Point2 center(std::size_t cell) const;
    /// Area of one cell: the factor of eq. (4.6).
    [[nodiscard]] double cellArea() const;
    friend bool operator==(const Grid&, const Grid&) = default;
};
/// "57 x 50 cells of 0.1 m", "100 x 100 cells of 0.12 m x 0.1 m".
std::string cellsText(const Grid& grid);

/// Cells whose centre lies strictly inside one of the regions; exact, by scanline. O(cells + sum of
/// the rows that each edge spans).
CellSet cellsIn(const Grid& grid, const Regions& regions);
/// The same of closed curves by the even-odd rule, which may touch and repeat edges.
CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves);
/// Cells whose centre lies in one of the solids, which may overlap, or on its edge.
CellSet cellsBlocked(const Grid& grid, std::span<const Polygon> solids);

}  // namespace ispace
