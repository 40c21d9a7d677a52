// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/seen_regions.h"

#include <algorithm>

#include "geom/overlay_regions.h"
#include "raster/contour.h"

namespace ispace {

std::uint32_t mostSeen(const Coverage& coverage, const std::vector<std::uint32_t>& cell_times) {
    if (!coverage.overlay) return *std::max_element(cell_times.begin(), cell_times.end());
    std::int32_t most = 0;
    for (const Overlay::Edge& edge : coverage.overlay->edges())
        most = std::max({most, edge.left.count, edge.right.count});
    return static_cast<std::uint32_t>(most);
}

std::vector<Region> viewRegions(const SensorView& view, const Grid& grid) {
    if (!view.region) return cellRegions(grid, view.cells);
    const Overlay overlay(std::vector<Layer>{{.curves = *view.region}});
    return withArcAreas(overlay,
                        overlay.regions([](const LayerLabel& label) { return label.count > 0; }));
}

std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times) {
    if (coverage.overlay)
        return withArcAreas(*coverage.overlay,
                            coverage.overlay->regions([times](const LayerLabel& label) {
                                return label.count == static_cast<std::int32_t>(times) &&
                                       (label.marks & kIndoorMark) != 0;
                            }));
    const Target& target = coverage.target;
    CellSet cells(target.grid.size());
    target.indoor.forEach([&](std::size_t cell) {
        if (cell_times[cell] == times) cells.set(cell);
    });
    return cellRegions(target.grid, cells);
}

}  // namespace ispace
