// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/grid.h"

#include "base/number.h"
#include "raster/scanline.h"

namespace ispace {

double Grid::columnCenter(int column) const {
    return limits.low.x + limits.width() * ((column + 0.5) / columns);
}

double Grid::rowCenter(int row) const {
    return limits.low.y + limits.depth() * ((row + 0.5) / rows);
}

Point2 Grid::center(std::size_t cell) const {
    const auto across = static_cast<std::size_t>(columns);
    return {columnCenter(static_cast<int>(cell % across)),
            rowCenter(static_cast<int>(cell / across))};
}

double Grid::cellArea() const {
    return limits.width() * limits.depth() / static_cast<double>(size());
}

std::string cellsText(const Grid& grid) {
    constexpr int kDigits = 3;
    const std::string x = formatDouble(tidy(grid.limits.width() / grid.columns, kDigits));
    const std::string y = formatDouble(tidy(grid.limits.depth() / grid.rows, kDigits));
    return std::to_string(grid.columns) + " x " + std::to_string(grid.rows) + " cells of " + x +
           " m" + (x == y ? "" : " x " + y + " m");
}

CellSet cellsIn(const Grid& grid, const Regions& regions) {
    CellSet inside(grid.size());
    for (const Region& part : regions.parts) {
        Scanline scan(grid, bounds(part.outline));
        part.forEachEdge([&scan](const Segment2& edge) { scan.add(edge); });
        scan.addInside(inside);
    }
    return inside;
}

CellSet cellsWithin(const Grid& grid, std::span<const Polygon> curves) {
    Box2 box;
    for (const Polygon& curve : curves)
        for (const Point2 p : curve) box.add(p);
    Scanline scan(grid, box);
    for (const Polygon& curve : curves)
        forEachEdge(curve, [&scan](const Segment2& edge) { scan.add(edge); });
    CellSet inside(grid.size());
    scan.addInside(inside);
    return inside;
}

CellSet cellsBlocked(const Grid& grid, std::span<const Polygon> solids) {
    CellSet blocked(grid.size());
    for (const Polygon& solid : solids) {
        Scanline scan(grid, bounds(solid));
        forEachEdge(solid, [&scan](const Segment2& edge) { scan.add(edge); });
        scan.addClosed(blocked);
    }
    return blocked;
}

}  // namespace ispace
