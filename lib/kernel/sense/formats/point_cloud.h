// SPDX-License-Identifier: GPL-3.0-or-later
// Point clouds of depth pictures and scans, and their files: PCD 0.7 of the Point Cloud Library (R.
// B. Rusu, S. Cousins, 3D is here: Point Cloud Library (PCL), 2011) and PLY 1.0 (G. Turk, The PLY
// polygon file format, 1994).
//
// Coordinates are float32: 1 mm at 10 km from the origin. Equal clouds give equal bytes.
// Thread-safe but for CloudStream; O(points).
//
//     const PointCloud cloud = cloudOf(ranger, frame, Coordinates::World);
//     writeAll("room.pcd", pcdOf(cloud, Encoding::Binary));
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
    /// Pose of the viewpoint: that of the sensor if points are in its frame, else the origin.
    Pose3 viewpoint;

    [[nodiscard]] std::size_t size() const { return width * height; }
};

/// The frame of a cloud's points.
enum class Coordinates { World, Sensor };

/// Converts a depth picture to an organised cloud with its columns and rows.
PointCloud cloudOf(const Ranger& ranger, const DepthFrame& frame, Coordinates in);
/// Converts scans of one laser to a cloud, a row per scan. The sensor's frame is that of the first
/// scan.
PointCloud cloudOf(const Laser& laser, std::span<const Scan> scans, Coordinates in);

enum class Encoding { Binary, Ascii };

/// Writes PCD 0.7: x y z as float32, the viewpoint as translation and quaternion, with the rows of
/// an organised cloud; missing points are nan. Binary is little-endian.
std::string pcdOf(const PointCloud& cloud, Encoding encoding);

/// Writes PLY 1.0: x y z as float, vertices in order. Skips missing points; stores the rows of an
/// organised cloud in `obj_info num_cols`, `num_rows` and an element range_grid, as Stanford's
/// range scans do.
std::string plyOf(const PointCloud& cloud, Encoding encoding);

enum class CloudFormat { Pcd, Ply };
/// Maps "pcd" and "ply" to a format.
std::optional<CloudFormat> cloudFormatOf(std::string_view name);

/// Size of concatenated clouds.
struct CloudRows {
    std::size_t width = 0;  ///< points of each row; 0 if there are no rows, or their widths differ
    std::size_t count = 0;
    std::size_t points = 0;

    void add(std::size_t row_width, std::size_t rows);
};

/// Writes concatenated clouds to one file. Stores rows if all have equal width; else drops points
/// without return and stores one row. Points are not held in memory: they are written at once if
/// the header is known, else to a Spool; PLY with rows requires one bit a point, and numbers less
/// than 2^31 points.
class CloudStream {
  public:
    /// \param width points of each row of all clouds, or 0 if widths differ
    /// \param rows of all clouds together, if known
    CloudStream(CloudFormat format, Encoding encoding, std::size_t width,
                std::optional<std::size_t> rows, ByteSink write);
    /// Adds a cloud. \pre the cloud is in the world frame
    void add(const PointCloud& cloud);
    /// Writes the rest, after the last cloud.
    void finish();

  private:
    CloudFormat format_;
    Encoding encoding_;
    std::size_t width_;
    ByteSink write_;
    bool is_begun_ = false;  // the header is written
    Spool points_;
    std::vector<bool> grid_;  // of PLY: true for returns
    std::size_t rows_ = 0, returns_ = 0;
};

}  // namespace ispace
