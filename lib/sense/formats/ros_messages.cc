// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/ros_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "geom/rotation.h"
#include "sense/formats/reading_picture.h"

namespace ispace {

namespace {

/// Writes Common Data Representation, version 1: numbers are aligned to multiples of their size,
/// counted from the end of the four bytes that name the encoding.
class CdrWriter {
  public:
    CdrWriter() : out_("\0\1\0\0", kBegin) {}

    template <typename Number>
    CdrWriter& put(Number value) {
        align(sizeof(Number));
        appendLittle(out_, value);
        return *this;
    }
    CdrWriter& put(bool value) { return put(static_cast<std::uint8_t>(value)); }
    CdrWriter& put(std::string_view text) {
        count(text.size() + 1);
        out_.append(text).append(1, '\0');
        return *this;
    }
    CdrWriter& put(const char* text) { return put(std::string_view(text)); }
    CdrWriter& put(const RosHeader& header) {
        constexpr std::uint64_t kSecond = 1'000'000'000;
        put(static_cast<std::int32_t>(header.nanoseconds / kSecond));
        put(static_cast<std::uint32_t>(header.nanoseconds % kSecond));
        return put(header.frame);
    }
    /// Writes a fixed number of values, known from the type.
    template <typename Number>
    CdrWriter& array(std::span<const Number> values) {
        align(sizeof(Number));
        out_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return *this;
    }
    /// Writes a count and its values.
    template <typename Number>
    CdrWriter& sequence(std::span<const Number> values) {
        count(values.size());
        return values.empty() ? *this : array(values);
    }
    CdrWriter& bytes(std::string_view values) {
        count(values.size());
        out_ += values;
        return *this;
    }
    CdrWriter& count(std::size_t number) { return put(static_cast<std::uint32_t>(number)); }

    [[nodiscard]] std::string take() { return std::move(out_); }

  private:
    static constexpr std::size_t kBegin = 4;
    void align(std::size_t size) {
        out_.append((size - (out_.size() - kBegin) % size) % size, '\0');
    }

    std::string out_;
};

void putRotation(CdrWriter& out, const Eigen::Quaterniond& turn) {
    out.put(turn.x()).put(turn.y()).put(turn.z()).put(turn.w());
}

/// Sizes and matrices of a picture.
struct Intrinsics {
    int columns = 0, rows = 0;
    double fx = 0, fy = 0, cx = 0, cy = 0;
    std::string_view model = "plumb_bob";
    std::vector<double> coefficients = {0, 0, 0, 0, 0};
};

std::string infoMessage(const RosHeader& header, const Intrinsics& info) {
    const auto [fx, fy, cx, cy] = std::array{info.fx, info.fy, info.cx, info.cy};
    CdrWriter out;
    out.put(header).count(static_cast<std::size_t>(info.rows));
    out.count(static_cast<std::size_t>(info.columns)).put(info.model);
    out.sequence(std::span<const double>(info.coefficients));
    out.array(std::span<const double>(std::array<double, 9>{fx, 0, cx, 0, fy, cy, 0, 0, 1}));
    out.array(std::span<const double>(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    out.array(
        std::span<const double>(std::array<double, 12>{fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0}));
    // The whole picture: no binning, no region of interest.
    for (int i = 0; i < 2 + 4; ++i) out.count(0);
    return out.put(false).take();
}

}  // namespace

std::string rosName(std::string_view id) {
    std::string name;
    for (const char c : id) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        const bool is_kept = is_letter || (c >= '0' && c <= '9');
        if (name.empty() && !is_letter) name = is_kept ? "s" : "s_";
        if (is_kept)
            name += c;
        else if (name.back() != '_')
            name += '_';
    }
    return name.empty() ? "s" : name;
}

std::string transformsMessage(std::span<const RosTransform> transforms) {
    CdrWriter out;
    out.count(transforms.size());
    for (const RosTransform& one : transforms) {
        out.put(one.header).put(one.child);
        const Point3& place = one.pose.position;
        out.put(place.x).put(place.y).put(place.z);
        constexpr double kHalf = 0.5;
        const Eigen::Quaterniond optical(kHalf, -kHalf, kHalf, -kHalf);
        const Eigen::Quaterniond turn = quaternionOf(one.pose);
        putRotation(out, one.is_optical ? turn * optical : turn);
    }
    return out.take();
}

std::string laserScanMessage(const RosHeader& header, const Laser& laser, double time_increment,
                             std::span<const float> ranges) {
    CdrWriter out;
    out.put(header);
    for (const double value : {laser.first.radians(), laser.last().radians(), laser.step.radians(),
                               time_increment, 1 / laser.rate, laser.min_range, laser.max_range})
        out.put(static_cast<float>(value));
    return out.sequence(ranges).count(0).take();  // no intensities
}

std::string pointCloudMessage(const RosHeader& header, const PointCloud& cloud,
                              std::span<const PointField> others) {
    constexpr std::uint8_t kFloat32 = 7;
    std::vector<const char*> names{"x", "y", "z"};
    for (const PointField& other : others) names.push_back(other.name);
    const std::size_t point = names.size() * sizeof(float);
    CdrWriter out;
    out.put(header).count(cloud.height).count(cloud.width).count(names.size());
    std::uint32_t offset = 0;
    for (const char* const name : names) {
        out.put(name).put(offset).put(kFloat32).count(1);
        offset += sizeof(float);
    }
    out.put(false).count(point).count(point * cloud.width);  // little-endian
    std::vector<float> numbers;
    for (std::size_t i = 0; i < cloud.size() && !others.empty(); ++i) {
        numbers.insert(numbers.end(), &cloud.xyz[3 * i], &cloud.xyz[3 * i] + 3);
        for (const PointField& other : others) numbers.push_back(other.values[i]);
    }
    const std::vector<float>& all = others.empty() ? cloud.xyz : numbers;
    out.bytes({reinterpret_cast<const char*>(all.data()), all.size() * sizeof(float)});
    return out.put(false).take();  // points may be missing
}

std::string depthImageMessage(const RosHeader& header, const Ranger& ranger,
                              std::span<const float> depths) {
    CdrWriter out;
    const auto columns = static_cast<std::size_t>(ranger.columns);
    out.put(header).count(static_cast<std::size_t>(ranger.rows)).count(columns);
    out.put("32FC1").put(false).count(columns * sizeof(float));
    std::string bytes;
    bytes.reserve(depths.size_bytes());
    for (const float depth : depths)
        appendLittle(bytes, std::isfinite(depth) ? depth : std::numeric_limits<float>::quiet_NaN());
    return out.bytes(bytes).take();
}

std::string compressedImageMessage(const RosHeader& header, std::string_view format,
                                   std::string_view bytes) {
    return CdrWriter().put(header).put(format).bytes(bytes).take();
}

std::string cameraInfoMessage(const RosHeader& header, const Ranger& ranger) {
    return infoMessage(header, {.columns = ranger.columns,
                                .rows = ranger.rows,
                                .fx = ranger.fx(),
                                .fy = ranger.fy(),
                                .cx = ranger.cx(),
                                .cy = ranger.cy()});
}

std::string cameraInfoMessage(const RosHeader& header, const Camera& camera) {
    Intrinsics info{.columns = camera.columns,
                    .rows = camera.rows,
                    .fx = camera.fx,
                    .fy = camera.fy,
                    .cx = camera.cx,
                    .cy = camera.cy};
    const auto [model, coefficients] = lensModelOf(camera);
    info.model = model;
    info.coefficients.assign(coefficients.begin(), coefficients.end());
    return infoMessage(header, info);
}

std::string pointMessage(const RosHeader& header, Point3 point) {
    return CdrWriter().put(header).put(point.x).put(point.y).put(point.z).take();
}

std::string odometryMessage(const RosHeader& header, std::string_view child, const Pose2& pose,
                            const RosTwist& twist) {
    constexpr std::array<double, 36> kUnknown{};
    CdrWriter out;
    out.put(header).put(child).put(pose.position.x).put(pose.position.y).put(0.0);
    putRotation(out, Eigen::Quaterniond(turnAbout(2, pose.heading)));
    out.array(std::span<const double>(kUnknown));
    out.put(twist.forward).put(twist.left).put(0.0);
    out.put(0.0).put(0.0).put(twist.turn.radians());
    return out.array(std::span<const double>(kUnknown)).take();
}

namespace {

/// Definitions of ROS 2's common_interfaces, without their comments. Types of other packages are
/// prefixed with the package; contained types precede their users.
struct Definition {
    std::string_view name;  ///< as other definitions refer to it
    std::string_view text;
};

constexpr Definition kParts[] = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
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
};

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

}  // namespace

std::vector<McapSchema> rosSchemas() {
    std::vector<McapSchema> schemas;
    for (const Definition& type : kTypes)
        schemas.push_back({std::string(type.name), "ros2msg", wholeText(type)});
    return schemas;
}

}  // namespace ispace
