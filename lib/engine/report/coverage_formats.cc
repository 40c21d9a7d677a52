// SPDX-License-Identifier: GPL-3.0-or-later
// Writes coverage in the formats of other programs: tables, GIS, glTF, NumPy, maps of ROS.
#include "report/coverage_formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/number.h"
#include "base/numpy_file.h"
#include "coverage/coverage.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/overlay/overlay.h"
#include "io/geojson.h"
#include "io/glb/glb_write.h"
#include "io/map/ros_map_text.h"
#include "raster/codec.h"
#include "raster/contour.h"
#include "report/map/map_parts.h"
#include "scene/sensor/camera.h"

namespace ispace {

namespace {

bool hasDensities(const Coverage& coverage) { return !coverage.report.densities.indoor.empty(); }

/// Returns for each cell the number of pixelDensities(), sorted from the coarsest, that the best
/// camera reaches; empty without cameras.
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

/// Returns the indoor floor that cameras see with the pixels of a class, by its index.
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
    const std::uint32_t most = maxMultiplicity(coverage, times);
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
        const UncoveredSpot& spot = coverage.report.unseen[i];
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

namespace {

std::vector<CoverageFormat>& allFormats() {
    static std::vector<CoverageFormat> formats = {
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
        {.name = "npy",
         .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageNpy(product.coverage), ""};
         }},
        {.name = "npz", .write = [](const CoverageProduct& product) -> CoverageFiles {
             return {coverageNpz(product.coverage), ""};
         }}};
    return formats;
}

}  // namespace

void addCoverageFormats(std::span<const CoverageFormat> formats) {
    allFormats().insert(allFormats().end(), formats.begin(), formats.end());
}

std::span<const CoverageFormat> coverageFormats() { return allFormats(); }

const CoverageFormat& coverageFormat(std::string_view name) {
    const auto formats = coverageFormats();
    return *std::find_if(formats.begin(), formats.end(),
                         [name](const CoverageFormat& format) { return format.name == name; });
}

namespace {

std::vector<std::uint64_t> shapeOf(const Grid& grid) {
    return {static_cast<std::uint64_t>(grid.rows), static_cast<std::uint64_t>(grid.columns)};
}

std::string flags(const Grid& grid, const CellSet& cells) {
    std::string bytes(grid.size(), '\0');
    cells.forEach([&bytes](std::size_t cell) { bytes[cell] = 1; });
    return npyHeader("|b1", shapeOf(grid)) + bytes;
}

template <typename Center>
std::string centers(int count, Center center) {
    std::string bytes = npyHeader("<f8", std::vector{static_cast<std::uint64_t>(count)});
    for (int i = 0; i < count; ++i) appendLittle(bytes, center(i));
    return bytes;
}

}  // namespace

std::string coverageNpy(const Coverage& coverage) {
    const Target& target = coverage.target;
    std::string bytes = npyHeader("<i4", shapeOf(target.grid));
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    for (std::size_t cell = 0; cell < times.size(); ++cell)
        appendLittle(bytes, target.indoor.test(cell) ? static_cast<std::int32_t>(times[cell]) : -1);
    return bytes;
}

std::string coverageNpz(const Coverage& coverage) {
    const Target& target = coverage.target;
    const Grid& grid = target.grid;
    std::string out;
    ZipWriter zip([&out](std::string_view bytes) { out += bytes; });
    std::string seen = npyHeader("<u4", shapeOf(grid));
    for (const std::uint32_t count : timesSeen(coverage)) appendLittle(seen, count);
    zip.add("seen.npy", seen);
    zip.add("indoor.npy", flags(grid, target.indoor));
    zip.add("free.npy", flags(grid, target.free));
    zip.add("x.npy", centers(grid.columns, [&](int i) { return grid.columnCenter(i); }));
    zip.add("y.npy", centers(grid.rows, [&](int i) { return grid.rowCenter(i); }));
    if (!coverage.report.densities.indoor.empty()) {
        std::vector<double> densities(grid.size());
        for (std::size_t i = 0; i < pixelDensities().size(); ++i)
            cellsOfClass(coverage, i).forEach([&](std::size_t cell) {
                densities[cell] = pixelDensities()[i].pixels_per_metre;
            });
        std::string bytes = npyHeader("<f8", shapeOf(grid));
        for (const double density : densities) appendLittle(bytes, density);
        zip.add("density.npy", bytes);
    }
    zip.finish();
    return out;
}

namespace {

/// Maximum side of a picture in pixels, as viewers accept it.
constexpr int kMaxSide = 4096;

using Pixel = std::array<std::uint8_t, 3>;

Pixel pixelOf(const Color& color) {
    const auto part = [](double share) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
    };
    return {part(color.red), part(color.green), part(color.blue)};
}

/// Draws the cells from above, a pixel each unless there are too many; the top row has the greatest
/// y.
std::string cellsPng(const Coverage& coverage) {
    const Grid& grid = coverage.target.grid;
    const Shades shades = shadesFor(coverage.report);
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    std::vector<Pixel> colors{pixelOf(palette::kFloor)};
    for (int shade = 1; shade <= shades.count; ++shade)
        colors.push_back(pixelOf(shades.color(shade)));
    const int columns = std::min(grid.columns, kMaxSide), rows = std::min(grid.rows, kMaxSide);
    std::vector<std::uint8_t> samples;
    samples.reserve(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    const auto cell_of = [](int pixel, int pixels, int cells) {
        return static_cast<int>((pixel + 0.5) / pixels * cells);
    };
    for (int row = rows; row-- > 0;)
        for (int column = 0; column < columns; ++column) {
            const std::size_t cell =
                grid.cell(cell_of(column, columns, grid.columns), cell_of(row, rows, grid.rows));
            const int shade = std::min(shades.of(times[cell]), shades.count);
            const Pixel& pixel = colors[static_cast<std::size_t>(shade)];
            samples.insert(samples.end(), pixel.begin(), pixel.end());
        }
    return pngOfRgb(columns, rows, samples);
}

}  // namespace

std::string coverageGlb(const Scene& scene, const Coverage& coverage, const Document& document) {
    const FloorPicture picture{"coverage", coverage.target.grid.limits, cellsPng(coverage)};
    return writeGlb(scene, document, &picture);
}

}  // namespace ispace
