// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.h"
#include "base/number.h"
#include "raster/encode.h"
#include "sense/format_base.h"
#include "sense/mcap_writer.h"
#include "sense/ros_messages.h"

namespace ispace {

namespace {

/// The frame that poses are in: fixed in the world, by REP 105.
constexpr std::string_view kWorldFrame = "map";
constexpr const char* kOptical = "_optical";

/// A topic of a sensor.
struct Topic {
    RosType type;
    const char* name;
};

constexpr Topic kScan{RosType::LaserScan, "scan"}, kPoints{RosType::PointCloud2, "points"},
    kDepth{RosType::Image, "depth/image_rect"},
    kDepthInfo{RosType::CameraInfo, "depth/camera_info"},
    kImage{RosType::CompressedImage, "image_raw/compressed"},
    kImageInfo{RosType::CameraInfo, "camera_info"}, kPosition{RosType::PointStamped, "position"},
    kOdometry{RosType::Odometry, "odom"};

bool isPinhole(const Ranger& ranger) { return ranger.projection == Projection::Pinhole; }

/// What a sensor publishes, in the order of its channels.
std::vector<Topic> topicsOf(const Sensor& sensor) {
    if (sensor.is<Laser>()) {
        if (sensor.as<Laser>().sweep == SweepAxis::None) return {kScan};
        return {kScan, kPoints};
    }
    if (sensor.is<Ranger>()) {
        if (!isPinhole(sensor.as<Ranger>())) return {kPoints};
        return {kPoints, kDepth, kDepthInfo};
    }
    if (sensor.is<Camera>()) {
        if (sensor.as<Camera>().lens == Lens::Mirror) return {kImage};
        return {kImage, kImageInfo};
    }
    return {kPosition};
}

/// In nanoseconds; ROS counts seconds in 31 bits. \param who for messages
std::uint64_t rosTime(double seconds, const std::string& who) {
    constexpr double kMost = 2147483647, kSecond = 1e9;
    if (!(seconds >= 0 && seconds <= kMost))
        throw FormatError({"", 0, 0,
                           who + " is read at t=" + formatDouble(seconds) +
                               ", and times of ROS go from 0 to " + formatDouble(kMost)});
    const double whole = std::floor(seconds);
    return static_cast<std::uint64_t>(whole) * 1'000'000'000U +
           static_cast<std::uint64_t>(std::llround((seconds - whole) * kSecond));
}

/// Appends the messages of one reading.
class Messages {
  public:
    /// \param first channel of the sensor
    Messages(std::string& out, const std::string& name, std::uint16_t first, const Sensor& sensor)
        : out_(out), name_(name), optical_(name + kOptical), first_(first), sensor_(sensor) {}

    void add(const std::vector<Scan>& scans) {
        const Laser& laser = sensor_.as<Laser>();
        for (const Scan& scan : scans) add(laser, scan);
        if (laser.sweep == SweepAxis::None || scans.empty()) return;
        const std::uint64_t end = nanoseconds(scans.back().time);
        send(1, sequenceOf(scans.back()), end,
             pointCloudMessage({end, kWorldFrame}, cloudOf(laser, scans, Coordinates::World)));
    }

    void add(const DepthFrame& frame) {
        const Ranger& ranger = sensor_.as<Ranger>();
        const std::uint64_t time = nanoseconds(frame.time);
        const auto sequence = static_cast<std::uint32_t>(frame.frame);
        addPose(time, sequence, frame.pose, isPinhole(ranger));
        send(0, sequence, time,
             pointCloudMessage({time, name_}, cloudOf(ranger, frame, Coordinates::Sensor)));
        if (!isPinhole(ranger)) return;
        send(1, sequence, time, depthImageMessage({time, optical_}, ranger, frame.depths));
        send(2, sequence, time, cameraInfoMessage({time, optical_}, ranger));
    }

    void add(const Photo& photo) {
        const Camera& camera = sensor_.as<Camera>();
        const std::uint64_t time = nanoseconds(photo.time);
        const auto sequence = static_cast<std::uint32_t>(photo.frame);
        addPose(time, sequence, photo.pose, true);
        send(0, sequence, time,
             compressedImageMessage({time, optical_}, "png",
                                    pngOfRgb(camera.columns, camera.rows, photo.rgb)));
        if (camera.lens == Lens::Mirror) return;
        send(1, sequence, time, cameraInfoMessage({time, optical_}, camera));
    }

    void add(const Burst& burst) {
        const std::uint64_t time = nanoseconds(burst.time);
        const auto sequence = static_cast<std::uint32_t>(burst.frame);
        addPose(time, sequence, burst.pose, false);
        std::optional<Point3> place;
        if (burst.fix) place = burst.fix->position;
        if (burst.simple) place = Point3{burst.simple->x, burst.simple->y, burst.pose.position.z};
        if (place) send(0, sequence, time, pointMessage({time, kWorldFrame}, *place));
    }

  private:
    void add(const Laser& laser, const Scan& scan) {
        const std::uint32_t sequence = sequenceOf(scan);
        const std::uint64_t begin = nanoseconds(scan.time);
        addPose(begin, sequence, scan.pose, false);
        // A clockwise scanner measures its last beam first.
        const int last = laser.beams - 1;
        const int latest = laser.timeOf(last) > 0 ? last : 0;
        if (laser.timeOf(latest) > 0)
            addPose(nanoseconds(scan.time + laser.timeOf(latest)), sequence,
                    scan.poseAt(static_cast<std::size_t>(latest)), false);
        const double first_beam = laser.timeOf(0);
        const double increment = last > 0 ? (laser.timeOf(last) - first_beam) / last : 0;
        send(0, sequence, begin,
             laserScanMessage({nanoseconds(scan.time + first_beam), name_}, laser, increment,
                              scan.ranges));
    }

    [[nodiscard]] std::uint32_t sequenceOf(const Scan& scan) const {
        const auto scans = static_cast<std::uint32_t>(sensor_.as<Laser>().scans());
        return static_cast<std::uint32_t>(scan.frame) * scans +
               static_cast<std::uint32_t>(scan.number);
    }

    void addPose(std::uint64_t time, std::uint32_t sequence, const Pose3& pose, bool is_optical) {
        std::vector<RosTransform> transforms{{{time, kWorldFrame}, name_, pose}};
        if (is_optical) transforms.push_back({{time, name_}, optical_, Pose3(), true});
        appendMcapMessage(out_, 0, sequence, time, transformsMessage(transforms));
    }

    void send(std::uint16_t topic, std::uint32_t sequence, std::uint64_t time,
              const std::string& message) {
        appendMcapMessage(out_, static_cast<std::uint16_t>(first_ + topic), sequence, time,
                          message);
    }

    [[nodiscard]] std::uint64_t nanoseconds(double seconds) const {
        return rosTime(seconds, sensor_.id);
    }

    std::string& out_;
    const std::string& name_;
    std::string optical_;
    std::uint16_t first_;
    const Sensor& sensor_;
};

class McapStream final : public ReadingStream {
  public:
    McapStream(ByteSink write, std::vector<McapChannel> channels, McapCompression compression)
        : file_(std::move(write), "ros2", "cdr", rosSchemas(), std::move(channels), compression) {}
    void write(std::string_view appended) override { file_.add(appended); }
    void finish() override { file_.finish(); }

  private:
    McapWriter file_;
};

/// Somebody in a recorded run, as topics and frames have them.
struct Member {
    std::string name, odometry;  ///< the frames
    std::uint16_t channel = 0;   ///< of a robot's odometry
};

/// Where the frame of a robot's odometry is, by where the robot is in both.
Pose2 odometryFrame(const Pose2& robot, const Pose2& odometry) {
    const Angle heading = robot.heading - odometry.heading;
    const Vec2 way = Pose2{{}, heading} * (odometry.position - Point2{});
    return {robot.position - way, heading};
}

Pose3 onFloor(const Pose2& pose) {
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

class Mcap final : public FormatBase {
  public:
    Mcap(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".mcap") {
        channels_.push_back({static_cast<std::uint16_t>(RosType::TFMessage), "/tf"});
        for (const Sensor& one : sensors.read) {
            names_.push_back(takeName(rosName(one.id), one.id));
            first_.push_back(static_cast<std::uint16_t>(channels_.size()));
            for (const Topic& topic : topicsOf(one)) addChannel(names_.back(), topic);
            if (channels_.size() > std::numeric_limits<std::uint16_t>::max())
                throw UsageError("mcap has 65535 channels, which " +
                                 std::to_string(sensors.read.size()) +
                                 " sensors exceed; choose sensors with --select");
        }
        for (const RunMember& one : options_.members) addMember(one);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        Messages messages(out, names_[index], first_[index], sensor(index));
        std::visit([&](const auto& one) { messages.add(one); }, reading);
    }
    void appendMoment(std::string& out, std::uint32_t sequence, double time,
                      std::span<const RunState> states) const override {
        std::vector<RosTransform> transforms;
        std::string odometries;
        for (const RunState& state : states) {
            const std::uint64_t now = rosTime(time, options_.members[state.who].id);
            const Member& one = members_[state.who];
            if (!state.odometry) {
                transforms.push_back({{now, kWorldFrame}, one.name, onFloor(state.pose)});
                continue;
            }
            const Pose2 frame = odometryFrame(state.pose, *state.odometry);
            transforms.push_back({{now, kWorldFrame}, one.odometry, onFloor(frame)});
            transforms.push_back({{now, one.odometry}, one.name, onFloor(*state.odometry)});
            appendMcapMessage(odometries, one.channel, sequence, now,
                              odometryMessage({now, one.odometry}, one.name, *state.odometry,
                                              {state.speed, state.sidespeed, state.rotspeed}));
        }
        if (transforms.empty()) return;
        const std::uint64_t now = transforms.front().header.nanoseconds;
        appendMcapMessage(out, 0, sequence, now, transformsMessage(transforms));
        out += odometries;
    }
    [[nodiscard]] std::unique_ptr<ReadingStream> stream(ByteSink write) const override {
        return std::make_unique<McapStream>(std::move(write), channels_, options_.compression);
    }
    [[nodiscard]] bool isPlain() const override { return false; }
    [[nodiscard]] bool isBinary() const override { return true; }

  private:
    /// \throws UsageError if another id has the same name
    std::string takeName(std::string name, const std::string& id) {
        const auto [other, is_new] = taken_.emplace(name, id);
        if (!is_new)
            throw UsageError("mcap: ROS would call " + id + " " + name + ", as it does " +
                             other->second +
                             "; choose sensors with --select, or give them other ids");
        return name;
    }
    void addChannel(const std::string& name, const Topic& topic) {
        channels_.push_back(
            {static_cast<std::uint16_t>(topic.type), "/" + name + "/" + topic.name});
    }
    void addMember(const RunMember& one) {
        Member member{takeName(rosName(one.id), one.id), "", 0};
        if (!one.is_person) {
            member.odometry = takeName(member.name + "_odom", one.id + "'s odometry");
            member.channel = static_cast<std::uint16_t>(channels_.size());
            addChannel(member.name, kOdometry);
        }
        members_.push_back(std::move(member));
    }

    std::map<std::string, std::string> taken_{{std::string(kWorldFrame), "the world's frame"},
                                              {"tf", "the topic of poses"}};
    std::vector<McapChannel> channels_;
    std::vector<Member> members_;
    std::vector<std::string> names_;  ///< of each sensor, as topics and frames have it
    std::vector<std::uint16_t> first_;
};

}  // namespace

std::unique_ptr<ReadingFormat> makeMcap(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Mcap>(sensors, std::move(options));
}

}  // namespace ispace
