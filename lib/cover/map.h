// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "cover/coverage.h"

namespace ispace {

enum class MapFormat { Png, Svg, Pdf };

struct MapOptions {
    MapFormat format = MapFormat::Png;
    int width = 1200;   ///< pixels; svg and pdf use it as their nominal width
    std::string title;  ///< e.g. base name of ENV; "" for none
};

/// The plan as a picture for a paper: covered floor by redundancy, walls, objects, each sensor with
/// its id, heading and fan, legend, scale bar, the figures. Returns the bytes of the file; equal
/// input gives equal bytes.
std::string drawCoverageMap(const Scene& scene, const Coverage& coverage,
                            const MapOptions& options);

}  // namespace ispace
