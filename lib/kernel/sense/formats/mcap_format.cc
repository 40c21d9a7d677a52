// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/number.h"
#include "sense/formats/mcap_writer.h"
#include "sense/formats/reading_format.h"
#include "sense/formats/ros_messages.h"
#include "sense/formats/rosbag.h"

namespace ispace {

namespace {

constexpr const char* kOptical = "_optical";

constexpr RosTopic kOdometry{RosType::Odometry, "odom", RosFrame::World};

/// Returns the topics of a sensor, in the order of its channels.
std::vector<const RosTopic*> topicsOf(const Sensor& sensor) {
    std::vector<const RosTopic*> topics;
    for (const RosTopic& topic : readingKind(sensor.model).topics)
        if (topic.is_sent == nullptr || topic.is_sent(sensor)) topics.push_back(&topic);
    return topics;
}

/// Converts to nanoseconds; ROS counts seconds in 31 bits. \param who subject of messages
std::uint64_t rosTime(double seconds, const std::string& who) {
    constexpr double kMaxSeconds = 2147483647, kSecond = 1e9;
    if (!(seconds >= 0 && seconds <= kMaxSeconds))
        throw FormatError({"", 0, 0,
                           who + " is read at t=" + formatDouble(seconds) +
                               ", and times of ROS go from 0 to " + formatDouble(kMaxSeconds)});
    const double whole = std::floor(seconds);
    return static_cast<std::uint64_t>(whole) * 1'000'000'000U +
           static_cast<std::uint64_t>(std::llround((seconds - whole) * kSecond));
}

/// Appends the messages of one reading.
class Messages {
  public:
    /// \param first channel of the sensor \param room null: the world's frame is that of the room
    Messages(std::string& out, const std::string& name, std::uint16_t first, const Sensor& sensor,
             const SensorRoom* room)
        : out_(out),
          name_(name),
          room_(room),
          world_(room == nullptr ? std::string(kRosWorld) : rosName(room->id)),
          optical_(name + kOptical),
          first_(first),
          sensor_(sensor),
          kind_(readingKind(sensor.model)),
          topics_(topicsOf(sensor)) {
        for (const RosTopic* topic : topics_)
            is_optical_ = is_optical_ || topic->frame == RosFrame::Optical;
    }

    void add(const Reading& reading) {
        const std::vector<ReadingView> views = viewsOf(sensor_, reading);
        for (const ReadingView& view : views) addPart(view);
        for (std::size_t i = 0; i < topics_.size() && !views.empty(); ++i) {
            if (topics_[i]->message != nullptr) continue;
            const std::uint64_t end = nanoseconds(views.back().time);
            send(i, sequenceOf(views.back()), end,
                 pointCloudMessage({end, world_},
                                   kind_.points(sensor_, reading, Coordinates::World)));
        }
    }

  private:
    void addPart(const ReadingView& view) {
        const std::uint32_t sequence = sequenceOf(view);
        const std::uint64_t begin = nanoseconds(view.time);
        addPose(begin, sequence, view.pose);
        std::uint64_t measured = begin;
        if (kind_.delay != nullptr) {
            // A clockwise scanner measures its last beam first.
            const std::size_t last = kind_.counts(sensor_).front() - 1;
            const std::size_t latest = kind_.delay(sensor_, last) > 0 ? last : 0;
            if (const double delay = kind_.delay(sensor_, latest); delay > 0)
                addPose(nanoseconds(view.time + delay), sequence, kind_.pose(view, latest));
            measured = nanoseconds(view.time + kind_.delay(sensor_, 0));
        }
        for (std::size_t i = 0; i < topics_.size(); ++i) {
            if (topics_[i]->message == nullptr) continue;
            const std::string message = topics_[i]->message({measured, frameOf(*topics_[i])}, view);
            if (!message.empty()) send(i, sequence, begin, message);
        }
    }

    [[nodiscard]] std::string_view frameOf(const RosTopic& topic) const {
        if (topic.frame == RosFrame::World) return world_;
        return topic.frame == RosFrame::Optical ? optical_ : name_;
    }

    [[nodiscard]] std::uint32_t sequenceOf(const ReadingView& view) const {
        const int part = kind_.part == nullptr ? 0 : kind_.part(view);
        return static_cast<std::uint32_t>(view.frame) *
                   static_cast<std::uint32_t>(std::max(1, partsOf(sensor_))) +
               static_cast<std::uint32_t>(part);
    }

    void addPose(std::uint64_t time, std::uint32_t sequence, const Pose3& pose) {
        std::vector<RosTransform> transforms{{{time, world_}, name_, pose}};
        if (room_ != nullptr)
            transforms.push_back({{time, kRosWorld}, world_, *room_->site_from_room});
        if (is_optical_) transforms.push_back({{time, name_}, optical_, Pose3(), true});
        appendMcapMessage(out_, 0, sequence, time, transformsMessage(transforms));
    }

    void send(std::size_t topic, std::uint32_t sequence, std::uint64_t time,
              const std::string& message) {
        appendMcapMessage(out_, static_cast<std::uint16_t>(first_ + topic), sequence, time,
                          message);
    }

    [[nodiscard]] std::uint64_t nanoseconds(double seconds) const {
        return rosTime(seconds, sensor_.id);
    }

    std::string& out_;
    const std::string& name_;
    const SensorRoom* room_;
    std::string world_, optical_;  // frames
    std::uint16_t first_;
    const Sensor& sensor_;
    const ReadingKind& kind_;
    std::vector<const RosTopic*> topics_;
    bool is_optical_ = false;
};

class McapStream final : public ReadingStream {
  public:
    McapStream(ByteSink write, const std::vector<McapChannel>& channels,
               McapCompression compression)
        : file_(std::move(write), "ros2", "cdr", rosSchemas(), channels, compression,
                kRecordedRosTypes) {}
    void write(std::string_view appended) override { file_.add(appended); }
    void finish() override { file_.finish(); }

  private:
    McapWriter file_;
};

/// A mover of a recorded run, with its topics and frames.
struct Member {
    std::string name, odometry;  ///< its frames
    std::uint16_t channel = 0;   ///< of a robot's odometry
    MotionAlphas alphas{};
};

class Mcap final : public FormatBase {
  public:
    Mcap(const Sensors& sensors, FormatOptions options)
        : FormatBase(sensors, std::move(options), ".mcap") {
        channels_.push_back(
            bagChannel(static_cast<std::uint16_t>(RosType::TFMessage), "/tf", {.depth = 100}));
        for (const SensorRoom& room : options_.rooms) {
            if (!room.site_from_room) continue;
            takeName(rosName(room.id), "the frame of " + room.id);
            frames_.push_back(&room);
        }
        for (const Sensor& one : sensors.read) {
            names_.push_back(takeName(rosName(one.id), one.id));
            first_.push_back(static_cast<std::uint16_t>(channels_.size()));
            for (const RosTopic* topic : topicsOf(one)) addChannel(names_.back(), *topic);
            if (channels_.size() > McapWriter::kMaxChannels)
                throw UsageError("mcap has 65535 channels, which " +
                                 std::to_string(sensors.read.size()) +
                                 " sensors exceed; choose sensors with --select");
        }
        for (const RunMember& one : options_.members) addMember(one);
    }
    void append(std::string& out, std::size_t index, const Reading& reading) const override {
        Messages(out, names_[index], first_[index], sensor(index),
                 frames_.empty() ? nullptr : room(index))
            .add(reading);
    }
    void appendMoment(std::string& out, std::uint32_t sequence, double time, std::size_t room,
                      std::span<const RunState> states) const override {
        std::vector<RosTransform> transforms;
        std::string odometries;
        for (const RunState& state : states) {
            const std::uint64_t now = rosTime(time, options_.members[state.member].id);
            const Member& one = members_[state.member];
            if (!state.odometry) {
                addMoverFrame(transforms, now, one.name, state.pose);
                continue;
            }
            addRobotFrames(transforms, now, one.odometry, one.name, state.pose,
                           state.odometry->pose);
            appendMcapMessage(
                odometries, one.channel, sequence, now,
                odometryMessage({now, one.odometry}, one.name, *state.odometry,
                                {state.speed, state.sidespeed, state.rotspeed}, one.alphas,
                                std::max(kOdometryPeriod, options_.moment_interval)));
        }
        if (transforms.empty()) return;
        const SensorRoom* const own = room < frames_.size() ? frames_[room] : nullptr;
        const std::string frame = own == nullptr ? "" : rosName(own->id);
        if (own != nullptr) {
            for (RosTransform& one : transforms)
                if (one.header.frame == kRosWorld) one.header.frame = frame;
            transforms.push_back(
                {{transforms.front().header.nanoseconds, kRosWorld}, frame, *own->site_from_room});
        }
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
    /// Reserves a name. \throws UsageError if another id has the same name
    std::string takeName(std::string name, const std::string& id) {
        const auto [other, is_new] = taken_.emplace(name, id);
        if (!is_new)
            throw UsageError("mcap: ROS would call " + id + " " + name + ", as it does " +
                             other->second +
                             "; choose sensors with --select, or give them other ids");
        return name;
    }
    void addChannel(const std::string& name, const RosTopic& topic) {
        channels_.push_back(bagChannel(static_cast<std::uint16_t>(topic.type),
                                       "/" + name + "/" + std::string(topic.name), {}));
    }
    void addMember(const RunMember& one) {
        Member member{takeName(rosName(one.id), one.id), "", 0, one.alphas};
        if (!one.is_person) {
            member.odometry = takeName(member.name + "_odom", one.id + "'s odometry");
            member.channel = static_cast<std::uint16_t>(channels_.size());
            addChannel(member.name, kOdometry);
        }
        members_.push_back(std::move(member));
    }

    std::map<std::string, std::string> taken_{{std::string(kRosWorld), "the world's frame"},
                                              {"tf", "the topic of poses"}};
    std::vector<const SensorRoom*> frames_;  ///< of the rooms; empty: the world's
    std::vector<McapChannel> channels_;
    std::vector<Member> members_;
    std::vector<std::string> names_;  ///< of each sensor, in topics and frames
    std::vector<std::uint16_t> first_;
};

}  // namespace

std::unique_ptr<ReadingFormat> makeMcap(const Sensors& sensors, FormatOptions options) {
    return std::make_unique<Mcap>(sensors, std::move(options));
}

}  // namespace ispace
