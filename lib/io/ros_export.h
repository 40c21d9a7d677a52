// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "layout/scene.h"

namespace ispace {

/// A map as ROS' map_server reads and writes it.
struct RosMapFiles {
    std::string yaml;  ///< map.yaml
    std::string pgm;   ///< the picture: P5, 254 free, 0 occupied, 205 unknown
};

/// Most cells of a map along a side, and in all.
constexpr int kMostMapSide = 30'000;
constexpr std::int64_t kMostMapCells = 400'000'000;

/// The obstacle map at a height. Cell edges lie on multiples of the resolution, with a rim of some
/// unknown cells; the room alone is on it, not what lies outside.
///
/// A cell is free if its middle lies on the free floor (strictly inside the indoor region, in no
/// solid). No wall is lost for being thin: where a sheet or the edge of a solid passes between two
/// free middles that are neighbours, the nearer cell is occupied, so that floor on both sides is
/// not joined (by sides) through it, and every solid and every hole of the region has at least
/// one occupied cell. Cells that touch free ones are free or occupied, never unknown. So an import
/// of the map gives the region back within one cell.
///
/// free_thresh is 0.196, which keeps 205 (darkness 0.19608) unknown for every reader.
/// O(cells + cells along all lines).
/// \param image_name how map.yaml names the picture
/// \throws UsageError for a resolution that is no length from 0.001 to 1000, or too many cells
RosMapFiles writeRosMap(const Scene& scene, double height, double resolution,
                        const std::string& image_name);

}  // namespace ispace
