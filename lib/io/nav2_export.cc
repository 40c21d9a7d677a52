// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <span>

#include "base/error.h"
#include "env/door_zones.h"
#include "io/exporters.h"
#include "raster/nav2_mask.h"

namespace ispace {

namespace {

constexpr std::uint8_t kKeepOut = 100;

void keepOut(const NamedZone& zone, Nav2Mask& mask) {
    const Grid& grid = mask.grid;
    const CellSet inside = cellsBlocked(grid, std::span(&zone.outline, 1));
    bool is_empty = true;
    inside.forEach([&](std::size_t cell) {
        mask.values[cell] = kKeepOut;
        is_empty = false;
    });
    if (!is_empty) return;
    const Point2 middle = grid.toCells(zone.inside);
    const double column = std::round(middle.x), row = std::round(middle.y);
    if (!(column >= 0 && row >= 0 && column < grid.columns && row < grid.rows))
        throw UsageError("--zone: " + zone.name + " lies beside the room, whose map is masked");
    mask.values[grid.cell(static_cast<int>(column), static_cast<int>(row))] = kKeepOut;
}

}  // namespace

ExportedFiles writeKeepoutMask(const Scene& scene, const std::vector<std::string>& zones,
                               double resolution, const std::string& image_name) {
    Nav2Mask mask{kKeepoutFilter,
                  rosMapCells(bounds(scene.environment.indoor()), resolution),
                  resolution,
                  {}};
    mask.values.resize(mask.grid.size());
    for (const std::string& text : zones)
        for (const NamedZone& zone : readZones(text, scene.environment)) keepOut(zone, mask);
    Nav2MaskFiles files = nav2MaskFiles(mask, image_name);
    return {std::move(files.map), std::move(files.picture)};
}

}  // namespace ispace
