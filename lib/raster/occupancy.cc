// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/occupancy.h"

#include <algorithm>
#include <cmath>

namespace ispace {

Cell classify(int sample, int max_value, const OccupancyRule& rule) {
    if (rule.mode == OccupancyRule::Mode::Raw) {
        const long value = std::lround(255.0 * sample / max_value);
        return value == 0 ? Cell::Free : value == 100 ? Cell::Occupied : Cell::Unknown;
    }
    // One division, correctly rounded, so that a threshold of 0.2 meets 51 of 255 exactly.
    const double darkness = static_cast<double>(rule.negate ? sample : max_value - sample) /
                            static_cast<double>(max_value);
    if (darkness > rule.occupied_thresh) return Cell::Occupied;
    return darkness < rule.free_thresh ? Cell::Free : Cell::Unknown;
}

std::size_t MapCells::count() const {
    return static_cast<std::size_t>(std::count(cells_.begin(), cells_.end(), 1));
}

MapCells difference(const MapCells& cells, const MapCells& others) {
    MapCells rest = cells;
    others.forEach([&rest](int x, int y) { rest.erase(x, y); });
    return rest;
}

MapCells complement(const MapCells& cells) {
    MapCells others(cells.width(), cells.height());
    for (int y = 0; y < cells.height(); ++y) {
        int next = 0;
        forEachRunOf(cells.row(y), [&](int first, int last) {
            if (next < first) others.insertRun(y, next, first - 1);
            next = last + 1;
        });
        if (next < cells.width()) others.insertRun(y, next, cells.width() - 1);
    }
    return others;
}

namespace {

MapCells cellsThatAre(Cell kind, const Picture& image, const OccupancyRule& rule) {
    using Mode = OccupancyRule::Mode;
    const bool averaged = rule.mode == Mode::Trinary && !image.opacity.empty();
    const bool wants_opaque = rule.mode == Mode::Scale && !image.opacity.empty();
    const int white = image.max_value + (averaged ? 255 : 0);
    std::vector<std::uint8_t> is_meant(static_cast<std::size_t>(white) + 1);
    for (int sample = 0; sample <= white; ++sample)
        is_meant[static_cast<std::size_t>(sample)] = classify(sample, white, rule) == kind ? 1 : 0;
    MapCells cells(image.width, image.height);
    std::size_t i = 0;
    for (int y = image.height - 1; y >= 0; --y)
        for (int x = 0; x < image.width; ++x, ++i) {
            if (wants_opaque && image.opacity[i] != 255) continue;
            const std::size_t opacity = averaged ? image.opacity[i] : 0;
            if (is_meant[image.samples[i] + opacity] != 0) cells.insert(x, y);
        }
    return cells;
}

}  // namespace

MapCells freeCells(const Picture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Free, image, rule);
}

MapCells occupiedCells(const Picture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Occupied, image, rule);
}

std::size_t unknownCountedFree(const Picture& image, const OccupancyRule& rule) {
    constexpr int kUnknown = 205;
    const int grey = kUnknown * (image.max_value / 255);
    if (image.max_value % 255 != 0 || rule.negate || rule.mode == OccupancyRule::Mode::Raw ||
        classify(grey, image.max_value, rule) != Cell::Free)
        return 0;
    return static_cast<std::size_t>(std::count(image.samples.begin(), image.samples.end(), grey));
}

CellPlace widestPlace(const MapCells& cells) {
    const int width = cells.width(), height = cells.height();
    // Rows with a column on each side, and a row below and above: rings grow from beyond the grid.
    // They are at most half as many as the shorter side, which 16 bits hold for any picture.
    const std::size_t n = static_cast<std::size_t>(width) + 2;
    std::vector<std::uint16_t> rings(n * (static_cast<std::size_t>(height) + 2));
    const auto row_of = [&](int y) { return &rings[n * (static_cast<std::size_t>(y) + 1) + 1]; };
    // Distance transform in two passes: from below and the left, then from above and the right.
    const auto grown = [](std::uint16_t ring) { return static_cast<std::uint16_t>(ring + 1); };
    for (int y = 0; y < height; ++y) {
        const std::uint8_t* const is_in = cells.row(y).data();
        std::uint16_t* const row = row_of(y);
        const std::uint16_t* const below = row - n;
        for (int x = 0; x < width; ++x)
            if (is_in[x] != 0)
                row[x] = grown(std::min({row[x - 1], below[x - 1], below[x], below[x + 1]}));
    }
    CellPlace best;
    std::uint16_t widest = 0;
    for (int y = height - 1; y >= 0; --y) {
        std::uint16_t* const row = row_of(y);
        const std::uint16_t* const above = row + n;
        for (int x = width - 1; x >= 0; --x) {
            if (row[x] == 0) continue;
            row[x] = std::min(row[x],
                              grown(std::min({row[x + 1], above[x + 1], above[x], above[x - 1]})));
            if (row[x] < widest) continue;
            widest = row[x];
            best = {x, y};
        }
    }
    return best;
}

}  // namespace ispace
