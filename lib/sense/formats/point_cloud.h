// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/numpy_file.h"
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

enum class Encoding { Binary, Ascii };

/// PCD 0.7: x y z as float32, the viewpoint as translation and quaternion, organised as the cloud
/// is; missing points are nan. Binary is little-endian.
std::string pcdOf(const PointCloud& cloud, Encoding encoding);

/// PLY 1.0: x y z as float, vertices in order. Missing points are left out; an organised cloud
/// keeps its rows through `obj_info num_cols`, `num_rows` and an element range_grid, as Stanford's
/// range scans do.
std::string plyOf(const PointCloud& cloud, Encoding encoding);

enum class CloudFormat { Pcd, Ply };
/// That of a name, "pcd" or "ply".
std::optional<CloudFormat> cloudFormatOf(std::string_view name);

/// Rows of clouds one below the other.
struct CloudRows {
    std::size_t width = 0;  ///< points of each; 0 if there are none, or some are wider than others
    std::size_t count = 0;
    std::size_t points = 0;

    void add(std::size_t row_width, std::size_t rows);
};

/// Clouds one below the other as one file. Rows stay rows if all are equally wide; else points
/// without return are dropped and the rest is one row. Points are not held in memory: they are
/// written as they come where the header is known by then, else they wait in a Spool; of PLY with
/// rows a bit each is kept besides.
class CloudStream {
  public:
    /// \param width points of each row of all clouds, or 0 if some are wider than others
    /// \param rows of all clouds together, if that is known
    CloudStream(CloudFormat format, Encoding encoding, std::size_t width,
                std::optional<std::size_t> rows, ByteSink write);
    /// \pre the cloud is in the world frame
    void add(const PointCloud& cloud);
    /// After the last one.
    void finish();

  private:
    CloudFormat format_;
    Encoding encoding_;
    std::size_t width_;
    ByteSink write_;
    bool is_begun_ = false;  // the header is written
    Spool points_;
    std::vector<bool> grid_;  // of PLY: which points are returns
    std::size_t rows_ = 0, returns_ = 0;
};

}  // namespace ispace
