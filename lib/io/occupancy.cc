// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/occupancy.h"

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
        const std::span<const std::uint8_t> row = cells.row(y);
        for (std::size_t x = 0; x < row.size(); ++x)
            if (row[x] == 0) others.insert(static_cast<int>(x), y);
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
    const int width = cells.width();
    const int height = cells.height();
    std::vector<int> rings(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto at = [&](int x, int y) {
        return x < 0 || y < 0 || x >= width || y >= height ? 0 : rings[cells.index(x, y)];
    };
    // Distance transform in two passes: from below and the left, then from above and the right.
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (cells.contains(x, y))
                rings[cells.index(x, y)] =
                    1 + std::min({at(x - 1, y), at(x - 1, y - 1), at(x, y - 1), at(x + 1, y - 1)});
    CellPlace best;
    for (int y = height - 1; y >= 0; --y)
        for (int x = width - 1; x >= 0; --x) {
            int& ring = rings[cells.index(x, y)];
            ring = std::min(ring, 1 + std::min({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1),
                                                at(x - 1, y + 1)}));
            if (ring >= at(best.x, best.y)) best = {x, y};
        }
    return best;
}

}  // namespace ispace
