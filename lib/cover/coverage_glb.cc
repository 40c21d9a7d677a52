// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "cover/coverage_formats.h"
#include "cover/map_parts.h"
#include "model/glb_write.h"
#include "raster/encode.h"

namespace ispace {

namespace {

/// Viewers take pictures of this many pixels a side.
constexpr int kMaxSide = 4096;

using Pixel = std::array<std::uint8_t, 3>;

Pixel pixelOf(const Color& color) {
    const auto part = [](double share) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
    };
    return {part(color.red), part(color.green), part(color.blue)};
}

/// The cells from above, a pixel each unless they are too many; the top row has the high y.
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
