// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of drawings: maps as pixels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "drawing/drawing.h"
#include "report/map/map_parts.h"
#include "support/test_scenes.h"

namespace ispace {

/// A room with a shaft, things, a zone, three level lasers and a tilted one.
inline const char* const kOffice =
    "fence path=0,0;8,0;8,6;3,6;3,5;0,5 closed=yes\ninside at=1,1\n"
    "fence id=shaft path=6,4;7,4;7,5;6,5 closed=yes\n"
    "desk at=2,3 heading=30 size=1.2,0.8,0.7\ncube at=4,2 size=0.5,0.5,0.5\n"
    "zone id=z path=1,1;2,1;2,2\n"
    "laser id=a at=0.1,2.5\nlaser id=b at=7.9,3 heading=180 range=4\n"
    "laser id=c at=3.5,5.9 heading=-90 fov=240\n"
    "laser id=d at=7,0.3,1.5 heading=120 fov=90 tilt=-20\n";

inline std::uint32_t pixelOf(Color color) {
    const auto part = [](double share) {
        return static_cast<std::uint32_t>(std::lround(share * 255));
    };
    return part(color.red) << 16 | part(color.green) << 8 | part(color.blue);
}

/// Returns true if a pixel has a colour up to rounding, which mixing causes.
inline bool isNear(std::uint32_t pixel, Color color) {
    for (const unsigned shift : {16U, 8U, 0U}) {
        const auto part = [shift](std::uint32_t rgb) {
            return static_cast<int>(rgb >> shift & 0xFFU);
        };
        if (std::abs(part(pixel) - part(pixelOf(color))) > 2) return false;
    }
    return true;
}

inline std::string mapOf(const std::string& lines, const MapOptions& options = {}) {
    const Scene scene = sceneOf(lines);
    return drawCoverageMap(scene, coverageOf(scene), options);
}

/// The decoded picture of a square room with its middle at 0,0: without a title its plan lies
/// beside the legend, the corner at the margin.
struct PlanPixels : Image {
    double half, scale;
    int margin;

    PlanPixels(const std::string& png, double side) : Image(decodePng(png)), half(side / 2) {
        margin = static_cast<int>(std::max(width / 40.0, 1.4 * width / 1200.0 * 17));
        int right = margin;  // measured on the wall's line
        while (Image::at(right + 1, margin) == pixelOf(palette::kWall)) ++right;
        scale = (right - margin) / side;
    }
    /// Returns the pixel at a point of the room.
    [[nodiscard]] std::uint32_t at(double x, double y) const {
        return Image::at(static_cast<int>(margin + (x + half) * scale),
                         static_cast<int>(margin + (half - y) * scale));
    }
    /// Computes the share of the pixels of this colour in a square about a point; `half_side` in
    /// pixels.
    [[nodiscard]] double shareOf(Color color, double x, double y, int half_side) const {
        const int column = static_cast<int>(margin + (x + half) * scale);
        const int row = static_cast<int>(margin + (half - y) * scale);
        int count = 0;
        for (int j = -half_side; j < half_side; ++j)
            for (int i = -half_side; i < half_side; ++i)
                count += isNear(Image::at(column + i, row + j), color) ? 1 : 0;
        return count / (4.0 * half_side * half_side);
    }
};

}  // namespace ispace
