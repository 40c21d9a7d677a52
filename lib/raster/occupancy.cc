// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/occupancy.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

namespace {

MapCells cellsThatAre(Cell kind, const GreyPicture& image, const OccupancyRule& rule) {
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

MapCells freeCells(const GreyPicture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Free, image, rule);
}

MapCells occupiedCells(const GreyPicture& image, const OccupancyRule& rule) {
    return cellsThatAre(Cell::Occupied, image, rule);
}

std::size_t unknownCountedFree(const GreyPicture& image, const OccupancyRule& rule) {
    constexpr int kUnknown = 205;
    const int grey = kUnknown * (image.max_value / 255);
    if (image.max_value % 255 != 0 || rule.negate || rule.mode == OccupancyRule::Mode::Raw ||
        classify(grey, image.max_value, rule) != Cell::Free)
        return 0;
    return static_cast<std::size_t>(std::count(image.samples.begin(), image.samples.end(), grey));
}

}  // namespace ispace
