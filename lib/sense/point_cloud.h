// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "sense/depth.h"
#include "sense/scan.h"

namespace ispace {

/// Points as float32 x,y,z, row by row; a pixel or beam without return is NaN, NaN, NaN.
struct PointCloud {
    std::size_t width = 0, height = 1;  ///< height 1: not organised
    std::vector<float> xyz;             ///< 3 * width * height
    /// Where it was seen from: the frame of the points if they are the sensor's, else the origin.
    Pose3 viewpoint;

    [[nodiscard]] std::size_t size() const { return width * height; }
};

/// The frame that the points of a cloud are in.
enum class Coordinates { World, Sensor };

/// A depth picture as an organised cloud, columns wide and rows high.
PointCloud cloudOf(const Ranger& ranger, const DepthFrame& frame, Coordinates in);
/// Scans of one laser as one cloud, a row per scan. The sensor's frame is that of the first scan.
PointCloud cloudOf(const Laser& laser, std::span<const Scan> scans, Coordinates in);

/// Clouds one below the other. Rows stay rows if all are equally wide; else points without return
/// are dropped and the rest is one row. \pre clouds are in the world frame
class CloudPile {
  public:
    void add(PointCloud cloud);
    /// Everything added so far; the pile is empty afterwards.
    PointCloud take();

  private:
    PointCloud all_;
    bool organised_ = true;
};

enum class Encoding { Binary, Ascii };

/// PCD 0.7: x y z as float32, the viewpoint as translation and quaternion, organised as the cloud
/// is; missing points are nan. Binary is little-endian.
std::string pcdOf(const PointCloud& cloud, Encoding encoding);

/// PLY 1.0: x y z as float, vertices in order. Missing points are left out; an organised cloud
/// keeps its rows through `obj_info num_cols`, `num_rows` and an element range_grid, as Stanford's
/// range scans do.
std::string plyOf(const PointCloud& cloud, Encoding encoding);

}  // namespace ispace
