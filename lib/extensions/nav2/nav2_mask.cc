// SPDX-License-Identifier: GPL-3.0-or-later
// Format: the parameters of CostmapFilterInfo (nav2_msgs) and the mask as a map of map_server with
// `mode: scale`, occupied 1 and free 0 (nav2_map_server, map_io). A value v is the shade 255 -
// round(2.55 v), which map_server turns back into v for all v from 0 to 100. Rows go from the top
// of the map down, as in each PGM of a map.
#include "extensions/nav2/nav2_mask.h"

#include <cmath>

#include "io/map/ros_map_text.h"

namespace ispace::nav2 {

const Nav2Filter kKeepoutFilter{"nav2_costmap_2d::KeepoutFilter",        "keepout", 0, 0, 1,
                                "100 (black): keep out; 0 (white): free"};
const Nav2Filter kSpeedFilter{
    "nav2_costmap_2d::SpeedFilter",
    "speed",
    1,
    100,
    -1,
    "v above 0: at most 100 - v per cent of full speed; 0 (white): no limit"};

namespace {

std::string mapText(const Nav2Mask& mask, const std::string& picture_name) {
    const Nav2Filter& filter = mask.filter;
    const std::string name(filter.name);
    std::string text = "# A mask for " + std::string(filter.plugin) + ". Values of cells:\n# " +
                       std::string(filter.meaning) +
                       "\n# The nodes that publish it take:\n"
                       "# costmap_filter_info_server:\n#   ros__parameters:\n#     type: " +
                       std::to_string(filter.type) + "\n#     base: " + yamlDouble(filter.base) +
                       "\n#     multiplier: " + yamlDouble(filter.multiplier) +
                       "\n#     mask_topic: /" + name + "_filter_mask\n#     filter_info_topic: /" +
                       name +
                       "_costmap_filter_info\n# filter_mask_server:\n#   ros__parameters:\n" +
                       "#     topic_name: /" + name +
                       "_filter_mask\n#     frame_id: map\n#     yaml_filename: this file\n";
    return text + rosMapYaml({.image = picture_name,
                              .mode = "scale",
                              .resolution = mask.cell,
                              .origin = mask.grid.limits.low,
                              .occupied = 1,
                              .free = 0});
}

}  // namespace

Nav2MaskFiles nav2MaskFiles(const Nav2Mask& mask, const std::string& picture_name) {
    constexpr double kWhite = 255, kMaxValue = 100;
    const Grid& grid = mask.grid;
    std::string picture =
        "P5\n" + std::to_string(grid.columns) + " " + std::to_string(grid.rows) + "\n255\n";
    picture.reserve(picture.size() + grid.size());
    for (int row = grid.rows; row-- > 0;)
        for (int column = 0; column < grid.columns; ++column) {
            // map_server computes round(100 * (255 - shade) / 255), which restores the value.
            const double dark =
                std::round(mask.values[grid.cell(column, row)] * kWhite / kMaxValue);
            picture += static_cast<char>(static_cast<std::uint8_t>(kWhite - dark));
        }
    return {mapText(mask, picture_name), std::move(picture)};
}

}  // namespace ispace::nav2
