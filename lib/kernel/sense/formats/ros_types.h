// SPDX-License-Identifier: GPL-3.0-or-later
// The types of ROS 2 that are written and read here. Constant tables, thread-safe.
//
//     const auto type = rosTypeNamed("sensor_msgs/LaserScan");  // of ROS 1 or 2
//     const std::string text = rosDefinition(*type);            // as MCAP files hold it
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sense/formats/mcap_writer.h"

namespace ispace {

/// In the order of rosSchemas(). All files of readings hold those before Clock, all files of runs
/// those before Imu, and each file those of its channels.
enum class RosType : std::uint16_t {
    TFMessage,
    LaserScan,
    PointCloud2,
    Image,
    CompressedImage,
    CameraInfo,
    PointStamped,
    Odometry,
    Clock,
    OccupancyGrid,
    Range,
    Bool,
    MarkerArray,
    DiagnosticArray,
    Twist,
    TwistStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
    Empty,
    Imu,
    Illuminance,
    Temperature,
    RadarScan,
    Int32,
    Float64,
    String,
    BatteryState,
    JointState,
    LiftState,
    LiftRequest,
    DoorState,
    DoorRequest,
    FleetState
};
constexpr std::size_t kRosTypes = static_cast<std::size_t>(RosType::FleetState) + 1;
constexpr auto kRecordedRosTypes = static_cast<std::size_t>(RosType::Clock),
               kRunRosTypes = static_cast<std::size_t>(RosType::Imu);

/// Returns the name: "sensor_msgs/msg/LaserScan".
std::string_view nameOf(RosType type);
/// Finds a type by name, also in the form of ROS 1: "sensor_msgs/LaserScan".
std::optional<RosType> rosTypeNamed(std::string_view name);

/// Returns the definition of a type with all contained types (`ros2msg`).
std::string rosDefinition(RosType type);
/// Returns the definitions of all types.
std::vector<McapSchema> rosSchemas();

struct RosStruct;

/// A field of a message.
struct RosField {
    enum class Kind {
        Bool,
        Int8,
        Uint8,
        Int32,
        Uint32,
        Uint64,
        Float32,
        Float64,
        Text,
        Struct
    } kind = Kind::Bool;
    std::string name;
    std::string type;                   ///< as the definition has it: "float64[36]"
    const RosStruct* fields = nullptr;  ///< of Kind::Struct
    bool is_array = false;
    std::size_t length = 0;    ///< of an array; 0: the message counts the elements
    std::string text_default;  ///< "" or the default value: "1"
};

/// The fields of a message or of a contained type, in their order.
struct RosStruct {
    std::string name;  ///< "std_msgs/Header", "nav_msgs/msg/Odometry"
    std::vector<RosField> fields;
};

/// Returns the fields of a type; thread-safe.
const RosStruct& rosFields(RosType type);

/// Returns the bytes of a number or a bool; 0 for texts and structs.
std::size_t sizeOf(RosField::Kind kind);

}  // namespace ispace
