// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/ros_types.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "base/number.h"

namespace ispace {

namespace {

/// Definitions of ROS 2's common_interfaces, of radar_msgs and of Open-RMF, without their comments.
/// Types of other packages are prefixed with the package; contained types precede their users.
struct Definition {
    std::string_view name;  ///< as other definitions refer to it
    std::string_view text;
};

constexpr Definition kParts[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"geometry_msgs/Transform",
     "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\n"
     "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/RegionOfInterest",
     "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
     "geometry_msgs/Pose origin\n"},
    {"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
    {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"},
    {"visualization_msgs/Marker",
     "int32 ARROW=0\nint32 CUBE=1\nint32 SPHERE=2\nint32 CYLINDER=3\nint32 LINE_STRIP=4\n"
     "int32 LINE_LIST=5\nint32 CUBE_LIST=6\nint32 SPHERE_LIST=7\nint32 POINTS=8\n"
     "int32 TEXT_VIEW_FACING=9\nint32 MESH_RESOURCE=10\nint32 TRIANGLE_LIST=11\n"
     "int32 ADD=0\nint32 MODIFY=0\nint32 DELETE=2\nint32 DELETEALL=3\n"
     "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
     "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\n"
     "builtin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\n"
     "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
     "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\n"
     "string text\nstring mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
     "bool mesh_use_embedded_materials\n"},
    {"radar_msgs/RadarReturn",
     "float32 range\nfloat32 azimuth\nfloat32 elevation\nfloat32 doppler_velocity\n"
     "float32 amplitude\n"},
    {"rmf_door_msgs/DoorMode",
     "uint32 MODE_CLOSED=0\nuint32 MODE_MOVING=1\nuint32 MODE_OPEN=2\nuint32 MODE_OFFLINE=3\n"
     "uint32 MODE_UNKNOWN=4\nuint32 value\n"},
    {"rmf_fleet_msgs/RobotMode",
     "uint32 MODE_IDLE=0\nuint32 MODE_CHARGING=1\nuint32 MODE_MOVING=2\nuint32 MODE_PAUSED=3\n"
     "uint32 MODE_WAITING=4\nuint32 MODE_EMERGENCY=5\nuint32 MODE_GOING_HOME=6\n"
     "uint32 MODE_DOCKING=7\nuint32 MODE_ADAPTER_ERROR=8\nuint32 MODE_CLEANING=9\n"
     "uint32 MODE_PERFORMING_ACTION=10\nuint32 MODE_ACTION_COMPLETED=11\n"
     "uint32 mode\nuint64 mode_request_id\nstring performing_action\n"},
    {"rmf_fleet_msgs/Location",
     "builtin_interfaces/Time t\nfloat32 x\nfloat32 y\nfloat32 yaw\n"
     "bool obey_approach_speed_limit false\nfloat32 approach_speed_limit\nstring level_name\n"
     "uint64 index\n"},
    {"rmf_fleet_msgs/RobotState",
     "string name\nstring model\nstring task_id\nuint64 seq\nrmf_fleet_msgs/RobotMode mode\n"
     "float32 battery_percent\nrmf_fleet_msgs/Location location\n"
     "rmf_fleet_msgs/Location[] path\n"},
    {"diagnostic_msgs/KeyValue", "string key\nstring value\n"},
    {"diagnostic_msgs/DiagnosticStatus",
     "byte OK=0\nbyte WARN=1\nbyte ERROR=2\nbyte STALE=3\n"
     "byte level\nstring name\nstring message\nstring hardware_id\n"
     "diagnostic_msgs/KeyValue[] values\n"},
};

/// Sorted as RosType.
constexpr Definition kTypes[] = {
    {"tf2_msgs/msg/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"sensor_msgs/msg/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\n"
     "float32[] ranges\nfloat32[] intensities\n"},
    {"sensor_msgs/msg/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
     "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/msg/Image",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
     "uint32 step\nuint8[] data\n"},
    {"sensor_msgs/msg/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    {"sensor_msgs/msg/CameraInfo",
     "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
     "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
     "sensor_msgs/RegionOfInterest roi\n"},
    {"geometry_msgs/msg/PointStamped", "std_msgs/Header header\ngeometry_msgs/Point point\n"},
    {"nav_msgs/msg/Odometry",
     "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
     "geometry_msgs/TwistWithCovariance twist\n"},
    {"rosgraph_msgs/msg/Clock", "builtin_interfaces/Time clock\n"},
    {"nav_msgs/msg/OccupancyGrid",
     "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"sensor_msgs/msg/Range",
     "uint8 ULTRASOUND=0\nuint8 INFRARED=1\n"
     "std_msgs/Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n"
     "float32 max_range\nfloat32 range\nfloat32 variance\n"},
    {"std_msgs/msg/Bool", "bool data\n"},
    {"visualization_msgs/msg/MarkerArray", "visualization_msgs/Marker[] markers\n"},
    {"diagnostic_msgs/msg/DiagnosticArray",
     "std_msgs/Header header\ndiagnostic_msgs/DiagnosticStatus[] status\n"},
    {"geometry_msgs/msg/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/msg/TwistStamped", "std_msgs/Header header\ngeometry_msgs/Twist twist\n"},
    {"geometry_msgs/msg/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/msg/PoseWithCovarianceStamped",
     "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose\n"},
    {"std_msgs/msg/Empty", ""},
    {"sensor_msgs/msg/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
     "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
     "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
     "float64[9] linear_acceleration_covariance\n"},
    {"sensor_msgs/msg/Illuminance",
     "std_msgs/Header header\nfloat64 illuminance\nfloat64 variance\n"},
    {"sensor_msgs/msg/Temperature",
     "std_msgs/Header header\nfloat64 temperature\nfloat64 variance\n"},
    {"radar_msgs/msg/RadarScan", "std_msgs/Header header\nradar_msgs/RadarReturn[] returns\n"},
    {"std_msgs/msg/Int32", "int32 data\n"},
    {"std_msgs/msg/Float64", "float64 data\n"},
    {"std_msgs/msg/String", "string data\n"},
    {"sensor_msgs/msg/BatteryState",
     "uint8 POWER_SUPPLY_STATUS_UNKNOWN=0\nuint8 POWER_SUPPLY_STATUS_CHARGING=1\n"
     "uint8 POWER_SUPPLY_STATUS_DISCHARGING=2\nuint8 POWER_SUPPLY_STATUS_NOT_CHARGING=3\n"
     "uint8 POWER_SUPPLY_STATUS_FULL=4\n"
     "uint8 POWER_SUPPLY_HEALTH_UNKNOWN=0\nuint8 POWER_SUPPLY_HEALTH_GOOD=1\n"
     "uint8 POWER_SUPPLY_TECHNOLOGY_UNKNOWN=0\n"
     "std_msgs/Header header\nfloat32 voltage\nfloat32 temperature\nfloat32 current\n"
     "float32 charge\nfloat32 capacity\nfloat32 design_capacity\nfloat32 percentage\n"
     "uint8 power_supply_status\nuint8 power_supply_health\nuint8 power_supply_technology\n"
     "bool present\nfloat32[] cell_voltage\nfloat32[] cell_temperature\nstring location\n"
     "string serial_number\n"},
    {"sensor_msgs/msg/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
     "float64[] effort\n"},
    {"rmf_lift_msgs/msg/LiftState",
     "uint8 DOOR_CLOSED=0\nuint8 DOOR_MOVING=1\nuint8 DOOR_OPEN=2\n"
     "uint8 MOTION_STOPPED=0\nuint8 MOTION_UP=1\nuint8 MOTION_DOWN=2\nuint8 MOTION_UNKNOWN=3\n"
     "uint8 MODE_UNKNOWN=0\nuint8 MODE_HUMAN=1\nuint8 MODE_AGV=2\nuint8 MODE_FIRE=3\n"
     "uint8 MODE_OFFLINE=4\nuint8 MODE_EMERGENCY=5\n"
     "builtin_interfaces/Time lift_time\nstring lift_name\nstring[] available_floors\n"
     "string current_floor\nstring destination_floor\nuint8 door_state\nuint8 motion_state\n"
     "uint8[] available_modes\nuint8 current_mode\nstring session_id\n"},
    {"rmf_lift_msgs/msg/LiftRequest",
     "uint8 REQUEST_END_SESSION=0\nuint8 REQUEST_AGV_MODE=1\nuint8 REQUEST_HUMAN_MODE=2\n"
     "uint8 DOOR_CLOSED=0\nuint8 DOOR_OPEN=2\n"
     "string lift_name\nbuiltin_interfaces/Time request_time\nstring session_id\n"
     "uint8 request_type\nstring destination_floor\nuint8 door_state\n"},
    {"rmf_door_msgs/msg/DoorState",
     "builtin_interfaces/Time door_time\nstring door_name\nrmf_door_msgs/DoorMode current_mode\n"},
    {"rmf_door_msgs/msg/DoorRequest",
     "builtin_interfaces/Time request_time\nstring requester_id\nstring door_name\n"
     "rmf_door_msgs/DoorMode requested_mode\n"},
    {"rmf_fleet_msgs/msg/FleetState", "string name\nrmf_fleet_msgs/RobotState[] robots\n"},
};
static_assert(std::size(kTypes) == kRosTypes);

/// Returns a type and all types that it contains, as bags store it.
std::string wholeText(const Definition& type) {
    std::string own(type.text), out = own;
    // In reverse, as contained types precede their users in kParts.
    for (auto part = std::rbegin(kParts); part != std::rend(kParts); ++part) {
        if (own.find(part->name) == std::string::npos) continue;
        own += part->text;
        out += std::string(80, '=') + "\nMSG: " + std::string(part->name) + "\n";
        out += part->text;
    }
    return out;
}

using Kind = RosField::Kind;

struct Primitive {
    std::string_view name;
    Kind kind;
    std::size_t size;
};
constexpr Primitive kPrimitives[] = {{"bool", Kind::Bool, 1},       {"byte", Kind::Uint8, 1},
                                     {"int8", Kind::Int8, 1},       {"uint8", Kind::Uint8, 1},
                                     {"int32", Kind::Int32, 4},     {"uint32", Kind::Uint32, 4},
                                     {"uint64", Kind::Uint64, 8},   {"float32", Kind::Float32, 4},
                                     {"float64", Kind::Float64, 8}, {"string", Kind::Text, 0}};

/// Parses definitions once. Structs never move, as fields point to them.
class Definitions {
  public:
    Definitions() {
        for (const Definition& part : kParts) parts_.emplace(part.name, parse(part));
        for (const Definition& type : kTypes) types_.push_back(parse(type));
    }
    [[nodiscard]] const RosStruct& of(RosType type) const {
        return types_[static_cast<std::size_t>(type)];
    }

  private:
    [[nodiscard]] RosStruct parse(const Definition& definition) const {
        RosStruct out{std::string(definition.name), {}};
        for (std::string_view rest = definition.text; !rest.empty();) {
            const std::string_view line = rest.substr(0, rest.find('\n'));
            rest.remove_prefix(line.size() + 1);
            if (line.find('=') == std::string_view::npos) out.fields.push_back(field(line));
        }
        return out;
    }

    /// Parses "float64[36] covariance", "float64 w 1".
    [[nodiscard]] RosField field(std::string_view line) const {
        RosField out;
        const std::size_t blank = line.find(' ');
        out.type = line.substr(0, blank);
        const std::string_view rest = line.substr(blank + 1);
        out.name = rest.substr(0, rest.find(' '));
        if (rest.size() > out.name.size()) out.text_default = rest.substr(out.name.size() + 1);
        const std::string_view type = out.type;
        const std::string_view base = type.substr(0, type.find('['));
        if (base.size() < type.size()) {
            out.is_array = true;
            const std::string_view length =
                type.substr(base.size() + 1, type.size() - base.size() - 2);
            out.length = static_cast<std::size_t>(parseInteger(length).value_or(0));
        }
        const auto* const found =
            std::find_if(std::begin(kPrimitives), std::end(kPrimitives),
                         [&](const Primitive& one) { return one.name == base; });
        out.kind = found == std::end(kPrimitives) ? Kind::Struct : found->kind;
        if (out.kind == Kind::Struct) out.fields = &parts_.find(base)->second;
        return out;
    }

    std::map<std::string, RosStruct, std::less<>> parts_;
    std::vector<RosStruct> types_;
};

}  // namespace

std::size_t sizeOf(RosField::Kind kind) {
    const auto* const found = std::find_if(std::begin(kPrimitives), std::end(kPrimitives),
                                           [&](const Primitive& one) { return one.kind == kind; });
    return found == std::end(kPrimitives) ? 0 : found->size;
}

const RosStruct& rosFields(RosType type) {
    static const Definitions definitions;
    return definitions.of(type);
}

std::string_view nameOf(RosType type) { return kTypes[static_cast<std::size_t>(type)].name; }

std::optional<RosType> rosTypeNamed(std::string_view name) {
    constexpr std::string_view kInfix = "/msg/";
    for (std::size_t i = 0; i < kRosTypes; ++i) {
        const std::string_view known = kTypes[i].name;
        const std::size_t infix = known.find(kInfix);
        const bool is_short = name.size() + kInfix.size() - 1 == known.size() &&
                              name.substr(0, infix + 1) == known.substr(0, infix + 1) &&
                              name.substr(infix + 1) == known.substr(infix + kInfix.size());
        if (name == known || is_short) return static_cast<RosType>(i);
    }
    return std::nullopt;
}

std::string rosDefinition(RosType type) {
    return wholeText(kTypes[static_cast<std::size_t>(type)]);
}

std::vector<McapSchema> rosSchemas() {
    std::vector<McapSchema> schemas;
    for (const Definition& type : kTypes)
        schemas.push_back({std::string(type.name), "ros2msg", wholeText(type)});
    return schemas;
}

}  // namespace ispace
