// SPDX-License-Identifier: GPL-3.0-or-later
// A mask of zones has the cells of the map that envc exports as `ros`, so that both match cell by
// cell; those of coverage have the cells in which floor was measured.
#include "extensions/nav2/masks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.h"
#include "env/zone.h"
#include "extensions/nav2/nav2_mask.h"
#include "raster/cells.h"
#include "raster/grid.h"
#include "report/map/map_parts.h"

namespace ispace::nav2 {

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

namespace {

constexpr double kMaxValue = 100;

CoverageFiles filesOf(const Nav2Mask& mask, const std::string& picture_name) {
    Nav2MaskFiles files = nav2MaskFiles(mask, picture_name);
    return {std::move(files.map), std::move(files.picture)};
}

}  // namespace

CoverageFiles coverageSpeedMask(const Coverage& coverage, double cell,
                                std::span<const double> speeds, const std::string& picture_name) {
    const Target& target = coverage.target;
    Nav2Mask mask{kSpeedFilter, target.grid, cell, {}};
    mask.values.resize(target.grid.size());
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    target.free.forEach([&](std::size_t at) {
        const double speed = speeds[std::min<std::size_t>(times[at], speeds.size() - 1)];
        mask.values[at] = static_cast<std::uint8_t>(std::lround(kMaxValue * (1 - speed)));
    });
    return filesOf(mask, picture_name);
}

CoverageFiles coverageKeepoutMask(const Coverage& coverage, double cell,
                                  const std::string& picture_name) {
    const Target& target = coverage.target;
    Nav2Mask mask{kKeepoutFilter, target.grid, cell, {}};
    mask.values.resize(target.grid.size());
    const CellSet covered = coveredCells(coverage);
    target.free.forEach([&](std::size_t at) {
        if (!covered.test(at)) mask.values[at] = static_cast<std::uint8_t>(kMaxValue);
    });
    return filesOf(mask, picture_name);
}

void addMasks() {
    static constexpr ExportFormat kExporters[] = {
        {.name = "nav2-keepout",
         .suffix = "yaml",
         .help =
             "FILE.yaml and FILE.pgm: a mask for the keep-out filter of Nav2's costmaps, on the "
             "cells that ros has: 100 in each --zone, 0 elsewhere. FILE.yaml holds the parameters "
             "of the filter as a comment (type 0, base 0, multiplier 1).",
         .takes_zones = true,
         .write =
             [](const Scene& scene, const Document& /*document*/, const ExportOptions& options) {
                 return writeKeepoutMask(scene, options.zones,
                                         options.resolution.value_or(kMapResolution),
                                         options.beside);
             },
         .beside_suffix = ".pgm",
         .beside_role = "the picture of the mask",
         .needs_beside = true,
         .naming_hint = "a mask is two files, FILE.yaml and FILE.pgm: name it with -o FILE.yaml"},
    };
    static constexpr CoverageFormat kCoverageFormats[] = {
        {.name = "nav2-speed",
         .square_cell = 0.05,
         .suffix = "yaml",
         .beside_suffix = ".pgm",
         .takes_speeds = true,
         .write =
             [](const CoverageProduct& product) {
                 return coverageSpeedMask(product.coverage, product.cell, product.speeds,
                                          product.beside_name);
             }},
        {.name = "nav2-keepout",
         .square_cell = 0.05,
         .suffix = "yaml",
         .beside_suffix = ".pgm",
         .write =
             [](const CoverageProduct& product) {
                 return coverageKeepoutMask(product.coverage, product.cell, product.beside_name);
             }},
    };
    addExporters(kExporters);
    addCoverageFormats(kCoverageFormats);
}

}  // namespace ispace::nav2
