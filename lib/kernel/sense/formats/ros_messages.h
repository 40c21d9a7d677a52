// SPDX-License-Identifier: GPL-3.0-or-later
// Writes messages of ROS 2 in CDR, the encoding that its bags and Foxglove read; little-endian.
// Units and axes are those of REP 103: metres, radians, x forward, y left. Pure functions,
// O(bytes); equal values give equal bytes.
//
//     const std::string bytes = laserScanMessage({2'000'000'000, "l1"}, laser, 0, ranges);
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "scene/odometry_covariance.h"
#include "scene/robot.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/point_cloud.h"
#include "sense/formats/ros_types.h"
#include "sense/photo.h"
#include "sense/scan.h"

namespace ispace {

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

/// The frame of poses: fixed in the world, by REP 105.
inline constexpr std::string_view kRosWorld = "map";

/// Appends the pose of a mover's frame in the world.
void addMoverFrame(std::vector<RosTransform>& out, std::uint64_t nanoseconds,
                   std::string_view frame, const Pose2& pose);
/// Appends the frame of a robot's odometry in the world, and the robot's frame in it.
/// \param odometry the robot's pose in that frame
void addRobotFrames(std::vector<RosTransform>& out, std::uint64_t nanoseconds,
                    std::string_view odometry_frame, std::string_view frame, const Pose2& pose,
                    const Pose2& odometry);

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
/// \pre not a mirror, for which ROS has no model
std::string cameraInfoMessage(const RosHeader& header, const CameraInfo& info);
std::string pointMessage(const RosHeader& header, Point3 point);
/// Velocity in the body's frame: ahead and to the left in m/s, and the rate of turn in radians a
/// second.
struct RosTwist {
    double forward = 0, left = 0;
    Angle turn;
};
/// Seconds between messages of odometry, over which their twist is a mean.
constexpr double kOdometryPeriod = 0.02;
/// Writes the odometry pose of `child` in the header's frame. Covariances are 0 without noise, and
/// of z, roll and pitch, which are exact; those of the twist are of a mean over `seconds`.
/// \param alphas of the errors of motion and odometry
std::string odometryMessage(const RosHeader& header, std::string_view child,
                            const EstimatedPose& estimate, const RosTwist& twist,
                            const MotionAlphas& alphas, double seconds);

/// Writes rates of turn in radians a second and accelerations in m/s^2; the orientation is unknown,
/// and so are the covariances.
std::string imuMessage(const RosHeader& header, Vec3 rates, Vec3 accelerations);
/// Writes an Illuminance in lux or a Temperature in degrees Celsius, the variance unknown.
std::string measureMessage(const RosHeader& header, double value);
/// A return of a radar; its strength is unknown.
struct RosRadarReturn {
    double range = 0;          ///< metres
    Angle azimuth, elevation;  ///< in the sensor's frame
    double speed = 0;          ///< along the beam, m/s, away from the sensor
};
std::string radarMessage(const RosHeader& header, std::span<const RosRadarReturn> returns);

// Messages of std_msgs, without a header.

std::string boolMessage(bool value);
std::string integerMessage(std::int32_t value);
std::string numberMessage(double value);
std::string textMessage(std::string_view text);

// Messages of a running world.

std::string clockMessage(std::uint64_t nanoseconds);

/// An occupancy grid: rows from the lowest y, each from the lowest x.
struct RosGrid {
    Point2 origin;  ///< corner of the first cell
    double resolution = 0.05;
    std::size_t columns = 0;
    std::vector<std::int8_t> cells;  ///< 0 free, 100 occupied, -1 unknown
};
std::string mapMessage(const RosHeader& header, const RosGrid& map);
/// Writes the range of one sonar: metres, +infinity without an echo (REP 117).
std::string rangeMessage(const RosHeader& header, const SonarRing& ring, float range);

struct RosPerson {
    std::string_view id;
    Pose2 pose;
    double radius = 0, height = 0;  ///< of a person that stands
    /// The box that holds the body of one that does not, in its frame.
    struct Box {
        Point3 middle;
        Vec3 size;
    };
    std::optional<Box> box = {};
};
/// Writes a cylinder or a box, and a name for each person; earlier markers of the topic disappear.
std::string peopleMessage(const RosHeader& header, std::span<const RosPerson> people);
/// Writes robots likewise, in another colour.
std::string robotsMessage(const RosHeader& header, std::span<const RosPerson> robots);
/// Writes a mesh by its URI, in the header's frame.
std::string roomMessage(const RosHeader& header, std::string_view mesh);

/// Writes the state of a full battery, whose charge is not simulated: the rest is unknown (NaN).
std::string batteryMessage(const RosHeader& header, float volts);
/// An angle of a joint.
struct RosJoint {
    std::string name;
    Angle angle;
    std::optional<Angle> rate = {};  ///< a second; empty: unknown
};
/// Writes angles and, if any is known, rates: those that are not are NaN.
std::string jointsMessage(const RosHeader& header, std::span<const RosJoint> joints);

struct RosDiagnostic {
    std::string name, message;
    bool is_warning = false;
    std::vector<std::pair<std::string, std::string>> values = {};
};
std::string diagnosticsMessage(const RosHeader& header, std::span<const RosDiagnostic> all);

// Messages to a running world. \throws FormatError for messages that are too short

struct RosReadHeader {
    std::uint64_t nanoseconds = 0;
    std::string frame;
};
/// Reads a Twist or a TwistStamped: the motion in the plane.
RosTwist twistOf(RosType type, std::string_view message);

struct RosPose {
    std::string frame;
    Pose2 pose;
    double height = 0;  ///< metres
};
/// Reads the pose of a PoseStamped or a PoseWithCovarianceStamped, turned about z alone.
RosPose poseOf(std::string_view message);
/// Reads a PointStamped: a pose with the heading 0.
RosPose pointOf(std::string_view message);

/// A marker that stands for a person or robot: what a tracker tells.
struct RosTrack {
    std::string frame;
    std::uint64_t time = 0;  ///< nanoseconds; 0: unknown
    std::string name;        ///< "NS/ID", or "ID" without a namespace
    std::string kind;        ///< "person" or "robot" if its text is that, else ""
    Point2 place;
};
/// Reads the markers of a MarkerArray, but for those that delete or that are text alone.
std::vector<RosTrack> tracksOf(std::string_view message);

}  // namespace ispace
