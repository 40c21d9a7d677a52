// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/coverage_formats.h"

#include <algorithm>

#include "base/number.h"
#include "cover/seen_regions.h"
#include "draw/feature_writer.h"
#include "env/level.h"
#include "geom/boolean.h"
#include "geom/overlay_regions.h"
#include "raster/contour.h"
#include "raster/nav2_mask.h"
#include "sensor/camera.h"

namespace ispace {

namespace {

bool hasDensities(const Coverage& coverage) { return !coverage.report.densities.indoor.empty(); }

/// Of each cell how many of pixelDensities(), the coarsest first, some camera sees it with; empty
/// without cameras.
std::vector<std::size_t> classesOfCells(const Coverage& coverage) {
    std::vector<std::size_t> reached;
    if (!hasDensities(coverage)) return reached;
    reached.resize(coverage.target.grid.size());
    for (std::size_t i = 0; i < pixelDensities().size(); ++i)
        cellsOfClass(coverage, i).forEach([&](std::size_t cell) { reached[cell] = i + 1; });
    return reached;
}

}  // namespace

std::string coverageCsv(const Coverage& coverage) {
    const Target& target = coverage.target;
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const std::vector<std::size_t> classes = classesOfCells(coverage);
    std::string text = "column,row,x,y,indoor,free,seen";
    text += classes.empty() ? "\n" : ",density\n";
    const auto columns = static_cast<std::size_t>(target.grid.columns);
    for (std::size_t cell = 0; cell < target.grid.size(); ++cell) {
        const Point2 center = target.grid.center(cell);
        text += std::to_string(cell % columns);
        text += ',';
        text += std::to_string(cell / columns);
        text += ',';
        appendDouble(text, roundSignificant(center.x));
        text += ',';
        appendDouble(text, roundSignificant(center.y));
        text += target.indoor.test(cell) ? ",1" : ",0";
        text += target.free.test(cell) ? ",1," : ",0,";
        text += std::to_string(times[cell]);
        if (!classes.empty()) {
            text += ',';
            if (classes[cell] > 0) text += pixelDensities()[classes[cell] - 1].name;
        }
        text += '\n';
    }
    return text;
}

CoverageFiles coverageRosMap(const Coverage& coverage, double cell, const std::string& image_name) {
    constexpr char kFree = static_cast<char>(254), kUnknown = static_cast<char>(205), kOccupied = 0;
    const Target& target = coverage.target;
    const Grid& grid = target.grid;
    const CellSet covered = coveredCells(coverage);
    CoverageFiles map;
    map.product = rosMapYaml({.image = image_name, .resolution = cell, .origin = grid.limits.low});
    map.beside =
        "P5\n" + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n";
    map.beside.reserve(map.beside.size() + grid.size());
    for (int row = grid.rows; row-- > 0;)
        for (int column = 0; column < grid.columns; ++column) {
            const std::size_t at = grid.cell(column, row);
            map.beside += !target.free.test(at) ? kOccupied : covered.test(at) ? kFree : kUnknown;
        }
    return map;
}

namespace {

/// Indoor floor that cameras see with the pixels of a class, by its index.
std::vector<Region> withPixelsOf(const Coverage& coverage, std::size_t density_class) {
    const std::uint64_t wanted = kIndoorMark | classMark(density_class);
    if (!coverage.density_overlays.empty()) {
        const Overlay& overlay = coverage.density_overlays.front();
        return withArcAreas(overlay, overlay.regions([wanted](const LayerLabel& label) {
            return (label.marks & wanted) == wanted;
        }));
    }
    CellSet cells = cellsOfClass(coverage, density_class);
    cells &= coverage.target.indoor;
    return cellRegions(coverage.target.grid, cells);
}

void writeDensities(FeatureWriter& out, const Coverage& coverage) {
    if (!hasDensities(coverage)) return;
    for (std::size_t i = 0; i < pixelDensities().size(); ++i) {
        const std::vector<Region> pieces = withPixelsOf(coverage, i);
        if (pieces.empty()) continue;
        const PixelDensity& density = pixelDensities()[i];
        out.begin("density-" + std::string(density.name), "density", "region")
            .key("pixels_per_metre")
            .value(density.pixels_per_metre);
        out.json().key("area").value(roundSignificant(totalArea(pieces)));
        out.endAsArea(pieces);
    }
}

}  // namespace

std::string coverageGeoJson(const Scene& scene, const Coverage& coverage) {
    FeatureWriter out;
    const Metric& share = coverage.report.coverage;
    out.json().key("coverage");
    if (const auto known = share.exact ? share.exact : share.grid)
        out.json().value(roundSignificant(*known));
    else
        out.json().null();
    out.beginFeatures();
    out.begin("indoor", "indoor", "region");
    out.endAsArea(scene.environment.indoor().parts);
    out.begin("free", "free", "region");
    out.endAsArea(scene.environment.level(coverage.target.height)->freeFloor());
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    const std::uint32_t most = mostSeen(coverage, times);
    for (std::uint32_t k = 1; k <= most; ++k) {
        const std::vector<Region> pieces = seenBy(coverage, k, times);
        if (pieces.empty()) continue;
        out.begin("seen-" + std::to_string(k), "seen", "region")
            .key("sensors")
            .value(std::size_t{k});
        out.json().key("area").value(roundSignificant(totalArea(pieces)));
        out.endAsArea(pieces);
    }
    writeDensities(out, coverage);
    for (const SensorView& view : coverage.sensors) {
        out.begin(view.id, view.kind->keyword, "placement");
        out.json().key("heading").value(roundSignificant(view.pose.heading.degrees()));
        out.endAsPoint(view.pose.position.onFloor());
        out.begin(view.id, "view", "region");
        out.endAsArea(viewRegions(view, coverage.target.grid));
    }
    for (std::size_t i = 0; i < coverage.report.unseen.size(); ++i) {
        const UnseenSpot& spot = coverage.report.unseen[i];
        out.begin("unseen-" + std::to_string(i + 1), "unseen", "spot")
            .key("area")
            .value(roundSignificant(spot.area));
        out.endAsPoint(spot.place);
    }
    return out.finish();
}

namespace {

template <PictureFormat kFormat>
CoverageFiles mapFiles(const CoverageProduct& product) {
    MapOptions options = product.map;
    options.format = kFormat;
    return {drawCoverageMap(product.scene, product.coverage, options, product.other), ""};
}

template <PictureFormat kFormat>
constexpr CoverageFormat mapFormat() {
    return {.name = nameOf(kFormat), .picture = kFormat, .write = mapFiles<kFormat>};
}

}  // namespace

std::span<const CoverageFormat> coverageFormats() {
    static constexpr CoverageFormat kFormats[] = {
        mapFormat<PictureFormat::Png>(),
        mapFormat<PictureFormat::Svg>(),
        mapFormat<PictureFormat::Pdf>(),
        {.name = "csv",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageCsv(product.coverage), ""};
         }},
        {.name = "geojson",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageGeoJson(product.scene, product.coverage), ""};
         }},
        {.name = "dxf",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageDxf(product.scene, product.coverage), ""};
         }},
        {.name = "glb",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageGlb(product.scene, product.coverage, product.document), ""};
         }},
        {.name = "ros",
         .square_cell = 0.05,
         .suffix = "yaml",
         .beside_suffix = ".pgm",
         .write =
             [](const CoverageProduct& product) {
                 return coverageRosMap(product.coverage, product.cell, product.beside_name);
             }},
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
        {.name = "npy",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageNpy(product.coverage), ""};
         }},
        {.name = "npz", .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageNpz(product.coverage), ""};
         }}};
    return kFormats;
}

const CoverageFormat& coverageFormat(std::string_view name) {
    const auto formats = coverageFormats();
    return *std::find_if(formats.begin(), formats.end(),
                         [name](const CoverageFormat& format) { return format.name == name; });
}

}  // namespace ispace
