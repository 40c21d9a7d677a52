// SPDX-License-Identifier: GPL-3.0-or-later
// Masks of costmap filters, as files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "raster/grid.h"

namespace ispace::nav2 {

/// A filter of Nav2's costmaps (nav2_costmap_2d/costmap_filters).
struct Nav2Filter {
    std::string_view plugin;  ///< "nav2_costmap_2d::KeepoutFilter"
    std::string_view name;    ///< of its topics: "keepout"
    int type = 0;             ///< in CostmapFilterInfo: 0 keep-out, 1 speed in per cent
    /// A mask value v means base + multiplier * v.
    double base = 0, multiplier = 1;
    std::string_view meaning;  ///< of the values, for messages, a line
};

/// 100 keeps robots out, 0 is free.
extern const Nav2Filter kKeepoutFilter;
/// Full speed less v per cent; 0 means unlimited. So the mask cannot express a limit of 0 %, which
/// Nav2 reads as unlimited.
extern const Nav2Filter kSpeedFilter;

/// Values from 0 to 100 of square cells.
struct Nav2Mask {
    const Nav2Filter& filter;
    Grid grid;
    double cell = 0;                   ///< edge, metres
    std::vector<std::uint8_t> values;  ///< by index of the cell
};

/// A map.yaml that Nav2's map_server reads (`mode: scale`, which restores the values exactly), with
/// the parameters of the filter as a comment, and its picture (P5).
struct Nav2MaskFiles {
    std::string map, picture;
};
/// \param picture_name how the map names the picture
Nav2MaskFiles nav2MaskFiles(const Nav2Mask& mask, const std::string& picture_name);

}  // namespace ispace::nav2
