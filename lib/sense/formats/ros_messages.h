// SPDX-License-Identifier: GPL-3.0-or-later
// Writes messages of ROS 2 in CDR, the encoding that its bags and Foxglove read; little-endian.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/pose.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/point_cloud.h"
#include "sense/photo.h"
#include "sense/scan.h"

namespace ispace {

/// The types written here, in the order of rosSchemas().
enum class RosType : std::uint16_t {
    TFMessage,
    LaserScan,
    PointCloud2,
    Image,
    CompressedImage,
    CameraInfo,
    PointStamped,
    Odometry
};

/// Returns their definitions with all contained types (`ros2msg`).
std::vector<McapSchema> rosSchemas();

/// Converts an id to a valid name of ROS topics and frames: letters, digits and single underscores,
/// a letter first. `camera-2/left` becomes camera_2_left.
std::string rosName(std::string_view id);

/// Time and frame of a measurement.
struct RosHeader {
    std::uint64_t nanoseconds = 0;
    std::string_view frame;
};

/// Pose of a frame in the header's frame.
struct RosTransform {
    RosHeader header;
    std::string_view child;
    Pose3 pose;
    bool is_optical = false;  ///< rotated further: x right, y down, z ahead
};

std::string transformsMessage(std::span<const RosTransform> transforms);
/// Writes a scan. \param time_increment seconds from beam to beam; the header has the time of beam
/// 0
std::string laserScanMessage(const RosHeader& header, const Laser& laser, double time_increment,
                             std::span<const float> ranges);
/// A number of each point beside x, y, z.
struct PointField {
    const char* name = nullptr;
    std::span<const float> values = {};
};
std::string pointCloudMessage(const RosHeader& header, const PointCloud& cloud,
                              std::span<const PointField> others = {});
/// Writes depths in metres as 32FC1 (REP 118); no return is NaN.
std::string depthImageMessage(const RosHeader& header, const Ranger& ranger,
                              std::span<const float> depths);
/// Writes a picture. \param format "png" or "jpeg"
std::string compressedImageMessage(const RosHeader& header, std::string_view format,
                                   std::string_view bytes);
/// Writes the intrinsics of a ranger. \pre a pinhole
std::string cameraInfoMessage(const RosHeader& header, const Ranger& ranger);
/// Writes the intrinsics of a camera. \pre not a mirror, for which ROS has no model
std::string cameraInfoMessage(const RosHeader& header, const Camera& camera);
std::string pointMessage(const RosHeader& header, Point3 point);
/// Velocity in the body's frame: ahead and to the left in m/s, and the rate of turn in radians a
/// second.
struct RosTwist {
    double forward = 0, left = 0;
    Angle turn;
};
/// Writes the odometry pose of `child` in the header's frame. Covariances are 0: unknown.
std::string odometryMessage(const RosHeader& header, std::string_view child, const Pose2& pose,
                            const RosTwist& twist);

}  // namespace ispace
