// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/cells.h"
#include "raster/picture.h"

namespace ispace {

/// How pixels map to cells: the keys of map_server's YAML.
struct OccupancyRule {
    enum class Mode {
        Trinary,  ///< by the two thresholds
        Scale,    ///< the same, with shades of unknown between the thresholds
        Raw,      ///< the pixel (of 255) is the value: 0 free, 100 occupied
    };
    Mode mode = Mode::Trinary;
    bool negate = false;            ///< white is occupied
    double occupied_thresh = 0.65;  ///< occupied if the darkness is above
    double free_thresh = 0.196;     ///< free if the darkness is below
};

enum class Cell : std::uint8_t { Free, Occupied, Unknown };

/// Meaning of a sample out of 0 .. max_value. Both comparisons are strict, occupied comes first.
Cell classify(int sample, int max_value, const OccupancyRule& rule);

/// The free and the occupied cells of a map; the picture's top row becomes the highest row. Opacity
/// is treated as map_server does: Trinary averages it with the colours; with Scale, pixels that
/// are not opaque are unknown.
MapCells freeCells(const GreyPicture& image, const OccupancyRule& rule);
MapCells occupiedCells(const GreyPicture& image, const OccupancyRule& rule);

/// How many samples of the shade that map_server writes for unknown (205 of 255, a darkness of
/// 0.196) count as free. Nav2 writes a free_thresh of 0.25.
std::size_t unknownCountedFree(const GreyPicture& image, const OccupancyRule& rule);

}  // namespace ispace
