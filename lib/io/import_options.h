// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace ispace {

/// How plans, maps and meshes that somebody else made become records.
struct ImportOptions {
    double wall_height = 2.5;        ///< metres, of walls in plans without heights
    double wall_thickness = 0;       ///< metres, of lines in plans; 0: the line is the face
    std::optional<double> snap;      ///< metres within which ends of lines are joined; default: the
                                     ///< importer's own
    std::optional<double> simplify;  ///< metres outlines may move; default: the importer's own
    std::string units;               ///< m, cm, mm, inch or foot; "": as the file says
    std::string up = "auto";         ///< a mesh's upward axis: auto, x, y or z
    std::vector<std::string> wall_layers;    ///< globs; empty: every layer not named otherwise
    std::vector<std::string> door_layers;    ///< globs; default none
    std::vector<std::string> window_layers;  ///< globs; default none
    bool points = false;                     ///< points of an ARIA map become obstacles
    std::size_t most_points = 2'000'000;     ///< drawings that come to more are refused
    bool load_meshes = true;                 ///< false: `mesh` records keep their file unread
};

}  // namespace ispace
