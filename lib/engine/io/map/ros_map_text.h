// SPDX-License-Identifier: GPL-3.0-or-later
// The text of map.yaml, as ROS 1 (map_server) and ROS 2 (nav2_map_server) read it.
#pragma once

#include <string>
#include <string_view>

#include "geom/point.h"

namespace ispace {

/// The description of a map's picture that map_server reads.
struct RosMap {
    std::string image;  ///< how the description names the picture
    std::string_view mode = "trinary";
    double resolution = 0;                 ///< metres a cell
    Point2 origin = {};                    ///< lower left corner of the picture
    double occupied = 0.65, free = 0.196;  ///< thresholds of darkness
};
/// Writes the lines of a map.yaml.
std::string rosMapYaml(const RosMap& map);

/// Writes a number that YAML parsers take for a double.
std::string yamlDouble(double value);

}  // namespace ispace
