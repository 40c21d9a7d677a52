// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/ros_messages.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geom/rotation.h"
#include "sense/formats/camera_info.h"
#include "sense/formats/cdr.h"

namespace ispace {

namespace {

CdrWriter& put(CdrWriter& out, const RosHeader& header) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    out.put(static_cast<std::int32_t>(header.nanoseconds / kSecond));
    out.put(static_cast<std::uint32_t>(header.nanoseconds % kSecond));
    return out.put(header.frame);
}

/// Returns a message that begins with a header.
CdrWriter headed(const RosHeader& header) {
    CdrWriter out;
    put(out, header);
    return out;
}

void putPoint(CdrWriter& out, Point3 point) { out.put(point.x).put(point.y).put(point.z); }

void putRotation(CdrWriter& out, const Eigen::Quaterniond& turn) {
    out.put(turn.x()).put(turn.y()).put(turn.z()).put(turn.w());
}

Pose3 onFloor(const Pose2& pose) {
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
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

void addMoverFrame(std::vector<RosTransform>& out, std::uint64_t nanoseconds,
                   std::string_view frame, const Pose2& pose) {
    out.push_back({{nanoseconds, kRosWorld}, frame, onFloor(pose)});
}

void addRobotFrames(std::vector<RosTransform>& out, std::uint64_t nanoseconds,
                    std::string_view odometry_frame, std::string_view frame, const Pose2& pose,
                    const Pose2& odometry) {
    const Angle heading = pose.heading - odometry.heading;
    const Vec2 way = Pose2{{}, heading} * (odometry.position - Point2{});
    addMoverFrame(out, nanoseconds, odometry_frame, {pose.position - way, heading});
    out.push_back({{nanoseconds, odometry_frame}, frame, onFloor(odometry)});
}

std::string transformsMessage(std::span<const RosTransform> transforms) {
    CdrWriter out;
    out.count(transforms.size());
    for (const RosTransform& one : transforms) {
        put(out, one.header).put(one.child);
        putPoint(out, one.pose.position);
        constexpr double kHalf = 0.5;
        const Eigen::Quaterniond optical(kHalf, -kHalf, kHalf, -kHalf);
        const Eigen::Quaterniond turn = quaternionOf(one.pose);
        putRotation(out, one.is_optical ? turn * optical : turn);
    }
    return out.take();
}

std::string laserScanMessage(const RosHeader& header, const Laser& laser, double time_increment,
                             std::span<const float> ranges) {
    CdrWriter out = headed(header);
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
    CdrWriter out = headed(header);
    out.count(cloud.height).count(cloud.width).count(names.size());
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
    CdrWriter out = headed(header);
    const auto columns = static_cast<std::size_t>(ranger.columns);
    out.count(static_cast<std::size_t>(ranger.rows)).count(columns);
    out.put("32FC1").put(false).count(columns * sizeof(float));
    std::string bytes;
    bytes.reserve(depths.size_bytes());
    for (const float depth : depths)
        appendLittle(bytes, std::isfinite(depth) ? depth : std::numeric_limits<float>::quiet_NaN());
    return out.bytes(bytes).take();
}

std::string compressedImageMessage(const RosHeader& header, std::string_view format,
                                   std::string_view bytes) {
    return headed(header).put(format).bytes(bytes).take();
}

std::string cameraInfoMessage(const RosHeader& header, const CameraInfo& info) {
    CdrWriter out = headed(header);
    out.count(static_cast<std::size_t>(info.rows));
    out.count(static_cast<std::size_t>(info.columns)).put(info.lens.name);
    out.sequence(info.lens.coefficients);
    out.array(std::span<const double>(info.matrix()));
    out.array(std::span<const double>(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    out.array(std::span<const double>(info.projection()));
    // The whole picture: no binning, no region of interest.
    for (int i = 0; i < 2 + 4; ++i) out.count(0);
    return out.put(false).take();
}

std::string imuMessage(const RosHeader& header, Vec3 rates, Vec3 accelerations) {
    // By the definition, -1 in the first place: there is no orientation, and 0: unknown.
    constexpr std::array<double, 9> kNone{-1}, kUnknown{};
    CdrWriter out = headed(header);
    putRotation(out, Eigen::Quaterniond::Identity());
    out.array(std::span<const double>(kNone));
    for (const Vec3& axes : {rates, accelerations})
        out.put(axes.x).put(axes.y).put(axes.z).array(std::span<const double>(kUnknown));
    return out.take();
}

std::string measureMessage(const RosHeader& header, double value) {
    return headed(header).put(value).put(0.0).take();
}

std::string radarMessage(const RosHeader& header, std::span<const RosRadarReturn> returns) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    CdrWriter out = headed(header);
    out.count(returns.size());
    for (const RosRadarReturn& one : returns)
        for (const double value :
             {one.range, one.azimuth.radians(), one.elevation.radians(), one.speed, kUnknown})
            out.put(static_cast<float>(value));
    return out.take();
}

std::string boolMessage(bool value) { return CdrWriter().put(value).take(); }
std::string integerMessage(std::int32_t value) { return CdrWriter().put(value).take(); }
std::string numberMessage(double value) { return CdrWriter().put(value).take(); }
std::string textMessage(std::string_view text) { return CdrWriter().put(text).take(); }

std::string batteryMessage(const RosHeader& header, float volts) {
    constexpr std::uint8_t kFull = 4, kGood = 1, kUnknown = 0;
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kWhole = 1;
    CdrWriter out = headed(header);
    out.put(volts);
    for (int i = 0; i < 5; ++i) out.put(kNan);  // temperature, current, charge, capacities
    out.put(kWhole).put(kFull).put(kGood).put(kUnknown).put(true);
    return out.count(0).count(0).put("").put("").take();
}

std::string jointsMessage(const RosHeader& header, std::span<const RosJoint> joints) {
    CdrWriter out = headed(header);
    out.count(joints.size());
    std::vector<double> angles, rates;
    angles.reserve(joints.size());
    rates.reserve(joints.size());
    bool has_rates = false;
    for (const RosJoint& joint : joints) {
        out.put(joint.name);
        angles.push_back(joint.angle.radians());
        rates.push_back(joint.rate ? joint.rate->radians()
                                   : std::numeric_limits<double>::quiet_NaN());
        has_rates = has_rates || joint.rate;
    }
    if (!has_rates) rates.clear();
    return out.sequence<double>(angles).sequence<double>(rates).count(0).take();
}

std::string pointMessage(const RosHeader& header, Point3 point) {
    return headed(header).put(point.x).put(point.y).put(point.z).take();
}

namespace {

/// Returns the rows of ROS' covariances: x, y, z, and turns about them.
std::array<double, 36> rosCovariance(const PoseCovariance& errors) {
    constexpr std::size_t kRow = 6, kTurn = 5;
    std::array<double, 36> all{};
    const auto set = [&all](std::size_t i, std::size_t k, double value) {
        all[kRow * i + k] = all[kRow * k + i] = value;
    };
    set(0, 0, errors.xx);
    set(0, 1, errors.xy);
    set(1, 1, errors.yy);
    set(0, kTurn, errors.xh);
    set(1, kTurn, errors.yh);
    set(kTurn, kTurn, errors.hh);
    return all;
}

}  // namespace

std::string odometryMessage(const RosHeader& header, std::string_view child,
                            const EstimatedPose& estimate, const RosTwist& twist,
                            const MotionAlphas& alphas, double seconds) {
    const Pose2& pose = estimate.pose;
    const PoseCovariance of_twist =
        twistCovariance({twist.forward, twist.left}, twist.turn, alphas, seconds);
    CdrWriter out = headed(header);
    out.put(child).put(pose.position.x).put(pose.position.y).put(0.0);
    putRotation(out, Eigen::Quaterniond(turnAbout(2, pose.heading)));
    out.array(std::span<const double>(rosCovariance(estimate.covariance)));
    out.put(twist.forward).put(twist.left).put(0.0);
    out.put(0.0).put(0.0).put(twist.turn.radians());
    return out.array(std::span<const double>(rosCovariance(of_twist))).take();
}

namespace {

/// Of visualization_msgs/Marker.
enum class MarkerType : std::int32_t { Cube = 1, Cylinder = 3, Text = 9, Mesh = 10 };

/// A marker, which a message of the same namespace and id replaces.
struct Marker {
    RosHeader header;
    std::int32_t id = 0;
    MarkerType type = MarkerType::Cylinder;
    Point3 position = {};
    Angle heading = {};
    Vec3 scale{1, 1, 1};
    std::array<float, 4> color{};  // red, green, blue, opacity
    std::string_view text = {}, mesh = {};
};

void putMarker(CdrWriter& out, const Marker& marker, std::int32_t action = 0) {
    put(out, marker.header)
        .put("ispace")
        .put(marker.id)
        .put(static_cast<std::int32_t>(marker.type))
        .put(action);
    putPoint(out, marker.position);
    putRotation(out, Eigen::Quaterniond(turnAbout(2, marker.heading)));
    out.put(marker.scale.x).put(marker.scale.y).put(marker.scale.z);
    out.array(std::span<const float>(marker.color));
    out.count(0).count(0).put(true);                  // lasts for ever, moves with its frame
    out.count(0).count(0).put("");                    // points, colors, texture_resource
    put(out, RosHeader()).put("").count(0).count(0);  // texture, uv_coordinates
    out.put(marker.text).put(marker.mesh).put("").count(0).put(true);
}

/// Deletes all markers of the topic.
void putDeletion(CdrWriter& out, const RosHeader& header) {
    constexpr std::int32_t kDeleteAll = 3;
    putMarker(out, {.header = header}, kDeleteAll);
}

}  // namespace

std::string clockMessage(std::uint64_t nanoseconds) {
    // The time alone, without a frame.
    constexpr std::uint64_t kSecond = 1'000'000'000;
    return CdrWriter()
        .put(static_cast<std::int32_t>(nanoseconds / kSecond))
        .put(static_cast<std::uint32_t>(nanoseconds % kSecond))
        .take();
}

std::string mapMessage(const RosHeader& header, const RosGrid& map) {
    CdrWriter out = headed(header);
    out.put(std::int32_t{0}).count(0).put(static_cast<float>(map.resolution));
    out.count(map.columns).count(map.columns == 0 ? 0 : map.cells.size() / map.columns);
    putPoint(out, {map.origin.x, map.origin.y, 0});
    putRotation(out, Eigen::Quaterniond::Identity());
    return out.sequence(std::span<const std::int8_t>(map.cells)).take();
}

std::string rangeMessage(const RosHeader& header, const SonarRing& ring, float range) {
    constexpr std::uint8_t kUltrasound = 0;
    CdrWriter out = headed(header);
    out.put(kUltrasound).put(static_cast<float>(ring.fov.radians()));
    out.put(static_cast<float>(ring.min_range)).put(static_cast<float>(ring.max_range));
    return out.put(range).put(0.0F).take();
}

namespace {

std::string bodiesMessage(const RosHeader& header, std::span<const RosPerson> people,
                          const std::array<float, 4>& body) {
    constexpr std::array<float, 4> kLetters{1, 1, 1, 1};
    CdrWriter out;
    out.count(1 + 2 * people.size());
    putDeletion(out, header);
    for (std::int32_t i = 0; const RosPerson& person : people) {
        const double width = 2 * person.radius, letters = 0.2;
        const RosPerson::Box box = person.box.value_or(
            RosPerson::Box{{0, 0, person.height / 2}, {width, width, person.height}});
        const Point2 place = person.pose * box.middle.onFloor();
        putMarker(out, {.header = header,
                        .id = i++,
                        .type = person.box ? MarkerType::Cube : MarkerType::Cylinder,
                        .position = {place.x, place.y, box.middle.z},
                        .heading = person.pose.heading,
                        .scale = box.size,
                        .color = body});
        putMarker(out, {.header = header,
                        .id = i++,
                        .type = MarkerType::Text,
                        .position = {place.x, place.y, box.middle.z + box.size.z / 2 + letters},
                        .scale = {letters, letters, letters},
                        .color = kLetters,
                        .text = person.id});
    }
    return out.take();
}

}  // namespace

std::string peopleMessage(const RosHeader& header, std::span<const RosPerson> people) {
    return bodiesMessage(header, people, {0.85F, 0.45F, 0.1F, 1});
}

std::string robotsMessage(const RosHeader& header, std::span<const RosPerson> robots) {
    return bodiesMessage(header, robots, {0.15F, 0.4F, 0.8F, 1});
}

std::string roomMessage(const RosHeader& header, std::string_view mesh) {
    CdrWriter out;
    out.count(1);
    putMarker(out, {.header = header, .type = MarkerType::Mesh, .mesh = mesh});
    return out.take();
}

std::string diagnosticsMessage(const RosHeader& header, std::span<const RosDiagnostic> all) {
    CdrWriter out = headed(header);
    out.count(all.size());
    for (const RosDiagnostic& one : all) {
        out.put(static_cast<std::uint8_t>(one.is_warning ? 1 : 0)).put(one.name).put(one.message);
        out.put("simrun").count(one.values.size());
        for (const auto& [key, value] : one.values) out.put(key).put(value);
    }
    return out.take();
}

namespace {

RosTwist readTwist(CdrReader& in) {
    RosTwist twist;
    twist.forward = in.number<double>();
    twist.left = in.number<double>();
    for (int i = 0; i < 3; ++i) in.number<double>();  // up, and turns about x and y
    twist.turn = Angle::radians(in.number<double>());
    return twist;
}

RosReadHeader readHeader(CdrReader& in) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    const auto seconds = in.number<std::int32_t>();
    const auto nanoseconds = in.number<std::uint32_t>();
    return {static_cast<std::uint64_t>(std::max(seconds, 0)) * kSecond + nanoseconds,
            std::string(in.text())};
}

}  // namespace

RosTwist twistOf(RosType type, std::string_view message) {
    CdrReader in(message);
    if (type == RosType::TwistStamped) readHeader(in);
    return readTwist(in);
}

namespace {

RosPose readPoint(CdrReader& in) {
    RosPose out;
    out.frame = readHeader(in).frame;
    out.pose.position.x = in.number<double>();
    out.pose.position.y = in.number<double>();
    out.height = in.number<double>();
    return out;
}

}  // namespace

RosPose pointOf(std::string_view message) {
    CdrReader in(message);
    return readPoint(in);
}

RosPose poseOf(std::string_view message) {
    CdrReader in(message);
    RosPose out = readPoint(in);
    const auto x = in.number<double>(), y = in.number<double>(), z = in.number<double>(),
               w = in.number<double>();
    out.pose.heading =
        Angle::radians(std::atan2(2 * (w * z + x * y), w * w + x * x - y * y - z * z));
    return out;
}

namespace {

/// Skips the members of a marker from its lifetime up to its text.
void skipShapes(CdrReader& in) {
    in.number<std::int32_t>();  // lifetime
    in.number<std::uint32_t>();
    in.number<std::uint8_t>();  // frame_locked
    constexpr std::size_t kPoint = 3, kColor = 4;
    const std::size_t points = in.count();
    in.values(kPoint * points, sizeof(double));
    const std::size_t colors = in.count();
    in.values(kColor * colors, sizeof(float));
    in.text();  // texture_resource
    readHeader(in);
    in.text();  // format of the texture
    in.values(in.count(), 1);
    const std::size_t coordinates = in.count();
    in.values(2 * coordinates, sizeof(float));
}

}  // namespace

std::vector<RosTrack> tracksOf(std::string_view message) {
    constexpr std::int32_t kText = 9, kAdd = 0;
    CdrReader in(message);
    std::vector<RosTrack> tracks;
    const std::size_t count = in.count();
    for (std::size_t i = 0; i < count; ++i) {
        const RosReadHeader header = readHeader(in);
        RosTrack track;
        track.frame = header.frame;
        track.time = header.nanoseconds;
        const std::string space(in.text());
        track.name = space.empty() ? "" : space + "/";
        track.name += std::to_string(in.number<std::int32_t>());
        const auto type = in.number<std::int32_t>(), action = in.number<std::int32_t>();
        track.place.x = in.number<double>();
        track.place.y = in.number<double>();
        for (int k = 0; k < 8; ++k) in.number<double>();  // height, orientation, scale
        for (int k = 0; k < 4; ++k) in.number<float>();   // colour
        skipShapes(in);
        const std::string_view text = in.text();
        if (text == "person" || text == "robot") track.kind = text;
        in.text();  // mesh_resource
        in.text();  // name of the mesh file
        in.values(in.count(), 1);
        in.number<std::uint8_t>();
        if (type != kText && action == kAdd) tracks.push_back(std::move(track));
    }
    return tracks;
}

}  // namespace ispace
