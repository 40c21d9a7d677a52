// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of ROS 2 in CDR: scans, clouds, pictures, odometry, transforms. Ranges follow REP 117:
// infinite ones are no return, those outside of the limits are discarded. Poses are interpolated
// between the transforms around a time.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "base/number.h"
#include "extensions/reality/log_parts.h"
#include "geom/rotation.h"
#include "sense/formats/cdr.h"

namespace ispace::reality {

namespace {

using Eigen::Isometry3d;

constexpr double kFarFrame = 1e6;  // metres

/// \throws FormatError without a place
[[noreturn]] void refuseMessage(const std::string& message) {
    throw FormatError({"", 0, 0, message});
}

struct RosStamp {
    double time = 0;
    std::string frame;
};

/// Names of frames begin with / in older programs.
std::string frameName(std::string_view name) {
    if (name.starts_with('/')) name.remove_prefix(1);
    return std::string(name);
}

RosStamp readStamp(CdrReader& in) {
    const auto seconds = in.number<std::int32_t>();
    const auto nanoseconds = in.number<std::uint32_t>();
    RosStamp stamp;
    stamp.time = static_cast<double>(seconds) + 1e-9 * static_cast<double>(nanoseconds);
    stamp.frame = frameName(in.text());
    return stamp;
}

double readFinite(CdrReader& in, double most) {
    const auto value = in.number<double>();
    if (!(std::abs(value) <= most)) refuseMessage("a pose that is out of range");
    return value;
}

/// Reads a position and a quaternion.
Isometry3d readPose(CdrReader& in) {
    const double x = readFinite(in, kFarFrame), y = readFinite(in, kFarFrame),
                 z = readFinite(in, kFarFrame);
    const double qx = readFinite(in, kFarFrame), qy = readFinite(in, kFarFrame),
                 qz = readFinite(in, kFarFrame), qw = readFinite(in, kFarFrame);
    Eigen::Quaterniond turn(qw, qx, qy, qz);
    constexpr double kLeast = 1e-6;
    if (turn.norm() < kLeast) refuseMessage("a quaternion of 0, which is no rotation");
    turn.normalize();
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() = turn.toRotationMatrix();
    pose.translation() = Eigen::Vector3d(x, y, z);
    return pose;
}

Pose3 pose3Of(const Isometry3d& pose) {
    const Eigen::Vector3d& at = pose.translation();
    return poseOf({at.x(), at.y(), at.z()}, Eigen::Quaterniond(pose.linear()));
}

Pose2 pose2Of(const Isometry3d& pose) {
    const Pose3 full = pose3Of(pose);
    return {full.position.onFloor(), full.heading};
}

/// A sample of a frame in its parent.
struct FrameSample {
    double time = 0;
    Isometry3d pose;
};

/// A frame with its parent.
struct RosFrameTrack {
    std::string parent;
    bool is_static = false;
    std::vector<FrameSample> samples = {};

    /// Interpolates; the ends hold outside.
    [[nodiscard]] Isometry3d at(double time) const {
        const auto after =
            std::upper_bound(samples.begin(), samples.end(), time,
                             [](double t, const FrameSample& sample) { return t < sample.time; });
        if (after == samples.begin()) return samples.front().pose;
        if (after == samples.end()) return samples.back().pose;
        const FrameSample &a = *(after - 1), &b = *after;
        const double share = (time - a.time) / (b.time - a.time);
        Isometry3d pose = Isometry3d::Identity();
        pose.translation() = (1 - share) * a.pose.translation() + share * b.pose.translation();
        pose.linear() = Eigen::Quaterniond(a.pose.linear())
                            .slerp(share, Eigen::Quaterniond(b.pose.linear()))
                            .toRotationMatrix();
        return pose;
    }
    void finish() {
        std::stable_sort(
            samples.begin(), samples.end(),
            [](const FrameSample& a, const FrameSample& b) { return a.time < b.time; });
        constexpr double kSame = 1e-9;
        is_static = is_static || std::all_of(samples.begin(), samples.end(), [&](const auto& each) {
                        return each.pose.isApprox(samples.front().pose, kSame);
                    });
    }
};

/// A field of a point cloud.
struct CloudField {
    std::uint32_t offset = 0;
    bool is_double = false;
    bool is_known = false;

    [[nodiscard]] double read(const char* point) const {
        if (is_double) {
            double value = 0;
            std::memcpy(&value, point + offset, sizeof value);
            return value;
        }
        float value = 0;
        std::memcpy(&value, point + offset, sizeof value);
        return double{value};
    }
    [[nodiscard]] std::size_t end() const {
        return offset + (is_double ? sizeof(double) : sizeof(float));
    }
};

}  // namespace

struct RosLogBuilder::Data {
    Data(std::string log_name, LogPictures kept)
        : name(std::move(log_name)), pictures(kept), budget(name) {}

    std::string name;
    LogPictures pictures;
    LogBudget budget;
    Log log;
    std::vector<std::string> scan_frames, cloud_frames, odometry_frames;
    std::map<std::string, RosFrameTrack> frames;  // by child

    void addScan(std::string_view topic, CdrReader in) {
        RosStamp stamp = readStamp(in);
        LogScan scan;
        scan.sensor = topic;
        scan.time = stamp.time;
        const auto first = in.number<float>();
        static_cast<void>(in.number<float>());
        const auto step = in.number<float>();
        const auto beam_time = in.number<float>();
        static_cast<void>(in.number<float>());
        const auto near = in.number<float>(), far = in.number<float>();
        constexpr float kMostRadians = 7;
        if (!(std::abs(first) <= kMostRadians && std::abs(step) <= kMostRadians))
            refuseMessage("the angles of the scan are out of range");
        if (!(near >= 0 && far >= near))
            refuseMessage("the range limits of the scan are not valid");
        scan.first = Angle::radians(double{first});
        scan.step = Angle::radians(double{step});
        constexpr float kMostSeconds = 1;
        if (std::abs(beam_time) <= kMostSeconds) scan.beam_time = double{beam_time};
        scan.min_range = double{near};
        scan.max_range = double{far};
        const std::size_t count = in.number<std::uint32_t>();
        const std::string_view bytes = in.values(count, sizeof(float));
        if (count == 0) return;
        budget.take(count);
        scan.ranges.resize(count);
        std::memcpy(scan.ranges.data(), bytes.data(), bytes.size());
        // REP 117: -infinity is too near; ranges outside the limits are to be discarded.
        for (float& range : scan.ranges)
            if (!(range >= near && range <= far) || range <= 0)
                range = std::numeric_limits<float>::infinity();
        log.scans.push_back(std::move(scan));
        scan_frames.push_back(std::move(stamp.frame));
    }

    void addCloud(std::string_view topic, CdrReader in) {
        RosStamp stamp = readStamp(in);
        const std::size_t height = in.number<std::uint32_t>(), width = in.number<std::uint32_t>();
        std::array<CloudField, 3> axes;
        const std::size_t fields = in.count();
        for (std::size_t i = 0; i < fields; ++i) {
            const std::string_view field = in.text();
            const auto offset = in.number<std::uint32_t>();
            const auto type = in.number<std::uint8_t>();
            static_cast<void>(in.number<std::uint32_t>());
            constexpr std::uint8_t kFloat32 = 7, kFloat64 = 8;
            if (field.size() != 1 || field[0] < 'x' || field[0] > 'z') continue;
            if (type != kFloat32 && type != kFloat64)
                refuseMessage("`" + std::string(field) + "` of the points is no float");
            axes[static_cast<std::size_t>(field[0] - 'x')] = {offset, type == kFloat64, true};
        }
        const bool is_big = in.number<std::uint8_t>() != 0;
        const std::size_t step = in.number<std::uint32_t>();
        static_cast<void>(in.number<std::uint32_t>());
        const std::size_t size = in.number<std::uint32_t>();
        const std::string_view data = in.values(size, 1);
        if (is_big) refuseMessage("the points are big-endian, which is not read");
        for (const CloudField& axis : axes)
            if (!axis.is_known || axis.end() > step)
                refuseMessage("the points have no x, y and z within their size");
        const std::size_t count = size / step;
        if (height * width > count) refuseMessage("fewer points than height times width");
        storeCloud(topic, std::move(stamp), data, step, height * width, axes);
    }

    void storeCloud(std::string_view topic, RosStamp stamp, std::string_view data, std::size_t step,
                    std::size_t count, const std::array<CloudField, 3>& axes) {
        LogCloud cloud;
        cloud.sensor = topic;
        cloud.time = stamp.time;
        cloud.max_range = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < count; ++i) {
            const char* const point = data.data() + i * step;
            const double x = axes[0].read(point), y = axes[1].read(point), z = axes[2].read(point);
            const double range = std::hypot(x, y, z);
            // NaN is no return, and so is the origin.
            if (!(range > 0 && range < kFarFrame)) continue;
            cloud.rays.push_back({static_cast<float>(x / range), static_cast<float>(y / range),
                                  static_cast<float>(z / range)});
            cloud.ranges.push_back(static_cast<float>(range));
        }
        if (cloud.ranges.empty()) return;
        budget.take(cloud.ranges.size());
        log.clouds.push_back(std::move(cloud));
        cloud_frames.push_back(std::move(stamp.frame));
    }

    void storePicture(std::string_view topic, double time, std::string bytes) {
        budget.take(bytes.size() / sizeof(float));
        log.pictures.push_back(
            {.sensor = std::string(topic), .time = time, .bytes = std::move(bytes)});
    }

    void addCompressed(std::string_view topic, CdrReader in) {
        const RosStamp stamp = readStamp(in);
        static_cast<void>(in.text());  // the bytes say it themselves
        const std::size_t size = in.number<std::uint32_t>();
        storePicture(topic, stamp.time, std::string(in.values(size, 1)));
    }

    /// Stores colours of eight bits as PPM, grey as PGM. Other pictures, such as depths, are left
    /// out.
    void addImage(std::string_view topic, CdrReader in) {
        const RosStamp stamp = readStamp(in);
        const std::size_t rows = in.number<std::uint32_t>(), columns = in.number<std::uint32_t>();
        const std::string_view encoding = in.text();
        static_cast<void>(in.number<std::uint8_t>());
        const std::size_t step = in.number<std::uint32_t>();
        const std::size_t size = in.number<std::uint32_t>();
        const std::string_view data = in.values(size, 1);
        const bool is_grey = encoding == "mono8" || encoding == "8UC1";
        const bool is_blue_first = encoding.starts_with("bgr");
        const std::size_t channels = is_grey                                      ? 1
                                     : encoding == "rgb8" || encoding == "bgr8"   ? 3
                                     : encoding == "rgba8" || encoding == "bgra8" ? 4
                                                                                  : 0;
        if (channels == 0) return;
        constexpr std::size_t kMostSide = 1U << 16U;
        if (rows == 0 || columns == 0 || rows > kMostSide || columns > kMostSide ||
            step < columns * channels || size < rows * step)
            refuseMessage("fewer bytes than the picture has pixels");
        std::string picture = (is_grey ? "P5\n" : "P6\n") + std::to_string(columns) + ' ' +
                              std::to_string(rows) + "\n255\n";
        for (std::size_t row = 0; row < rows; ++row) {
            const std::string_view line = data.substr(row * step, columns * channels);
            if (is_grey) {
                picture += line;
                continue;
            }
            for (std::size_t k = 0; k < line.size(); k += channels) {
                picture += line[k + (is_blue_first ? 2 : 0)];
                picture += line[k + 1];
                picture += line[k + (is_blue_first ? 0 : 2)];
            }
        }
        storePicture(topic, stamp.time, std::move(picture));
    }

    void addOdometry(std::string_view topic, CdrReader in) {
        const RosStamp stamp = readStamp(in);
        std::string child = frameName(in.text());
        const Isometry3d pose = readPose(in);
        budget.take(1);
        log.odometry.push_back({.source = std::string(topic),
                                .time = stamp.time,
                                .pose = pose2Of(pose),
                                .scans_before = 0,
                                .begins = false});
        odometry_frames.push_back(std::move(child));
    }

    void addTransforms(std::string_view topic, CdrReader in) {
        const std::size_t count = in.count();
        for (std::size_t i = 0; i < count; ++i) {
            RosStamp stamp = readStamp(in);
            const std::string child = frameName(in.text());
            const Isometry3d pose = readPose(in);
            if (child == stamp.frame) refuseMessage("the frame `" + child + "` is its own parent");
            budget.take(1);
            RosFrameTrack& track = frames[child];
            // The newest parent counts, as in tf2.
            if (track.parent != stamp.frame) track = {std::move(stamp.frame), false, {}};
            track.is_static = track.is_static || topic.ends_with("tf_static");
            track.samples.push_back({stamp.time, pose});
        }
    }

    /// Returns the frames from a sensor's up to the root.
    [[nodiscard]] std::vector<std::string> chainOf(const std::string& frame) const {
        std::vector<std::string> chain{frame};
        std::set<std::string> seen{frame};
        for (auto found = frames.find(frame); found != frames.end();
             found = frames.find(chain.back())) {
            if (!seen.insert(found->second.parent).second)
                throw FormatError({displayName(name), 0, 0,
                                   "the frame `" + found->second.parent + "` is its own ancestor"});
            chain.push_back(found->second.parent);
        }
        return chain;
    }

    /// Returns the pose of chain[from] in chain[to].
    [[nodiscard]] Isometry3d poseIn(const std::vector<std::string>& chain, std::size_t from,
                                    std::size_t to, double time) const {
        Isometry3d pose = Isometry3d::Identity();
        for (std::size_t i = from; i < to; ++i) pose = frames.at(chain[i]).at(time) * pose;
        return pose;
    }

    struct OdometryTrack {
        std::vector<const LogOdometry*> poses;
    };

    [[nodiscard]] LogPoses posesOf(const std::string& frame, double time,
                                   const std::map<std::string, OdometryTrack>& odometry) const {
        LogPoses poses;
        const std::vector<std::string> chain = chainOf(frame);
        std::size_t carrier = 0;
        while (carrier + 1 < chain.size() && frames.at(chain[carrier]).is_static) ++carrier;
        const bool is_fixed = carrier + 1 == chain.size();  // no link moves
        for (std::size_t i = 0; i < chain.size(); ++i)
            if (odometry.contains(chain[i])) return withOdometry(chain, i, time, odometry);
        if (is_fixed) return poses;
        if (carrier > 0) poses.mount = pose3Of(poseIn(chain, 0, carrier, time));
        const auto odom = std::find_if(chain.begin(), chain.end(),
                                       [](const auto& each) { return each.ends_with("odom"); });
        const auto at = static_cast<std::size_t>(odom - chain.begin());
        if (odom != chain.end() && at > carrier)
            poses.odometry = pose2Of(poseIn(chain, carrier, at, time));
        if (odom == chain.end() || at + 1 < chain.size())
            poses.corrected = pose3Of(poseIn(chain, 0, chain.size() - 1, time));
        return poses;
    }

    /// The carrier is the frame whose odometry the log has.
    [[nodiscard]] LogPoses withOdometry(
        const std::vector<std::string>& chain, std::size_t carrier, double time,
        const std::map<std::string, OdometryTrack>& odometry) const {
        LogPoses poses;
        poses.mount = pose3Of(poseIn(chain, 0, carrier, time));
        const std::vector<const LogOdometry*>& way = odometry.at(chain[carrier]).poses;
        const auto after =
            std::upper_bound(way.begin(), way.end(), time,
                             [](double t, const LogOdometry* each) { return t < each->time; });
        if (after == way.begin()) {
            poses.odometry = way.front()->pose;
        } else if (after == way.end()) {
            poses.odometry = way.back()->pose;
        } else {
            const LogOdometry &a = **(after - 1), &b = **after;
            const double share = (time - a.time) / (b.time - a.time);
            poses.odometry =
                Pose2{a.pose.position + share * (b.pose.position - a.pose.position),
                      wrapped(a.pose.heading + share * wrapped(b.pose.heading - a.pose.heading))};
        }
        const bool has_map = chain.size() > carrier + 1 && !chain.back().ends_with("odom");
        if (has_map) poses.corrected = pose3Of(poseIn(chain, 0, chain.size() - 1, time));
        return poses;
    }
};

RosLogBuilder::RosLogBuilder(std::string name, LogPictures pictures)
    : data_(std::make_unique<Data>(std::move(name), pictures)) {}
RosLogBuilder::~RosLogBuilder() = default;

bool RosLogBuilder::reads(std::string_view type) const {
    if (type == "sensor_msgs/msg/Image" || type == "sensor_msgs/msg/CompressedImage")
        return data_->pictures == LogPictures::Keep;
    return type == "sensor_msgs/msg/LaserScan" || type == "sensor_msgs/msg/PointCloud2" ||
           type == "nav_msgs/msg/Odometry" || type == "tf2_msgs/msg/TFMessage";
}

void RosLogBuilder::add(std::string_view topic, std::string_view type, std::string_view message,
                        const std::string& file, const std::string& place) {
    try {
        const CdrReader in(message);
        if (type == "sensor_msgs/msg/LaserScan") return data_->addScan(topic, in);
        if (type == "sensor_msgs/msg/PointCloud2") return data_->addCloud(topic, in);
        if (type == "nav_msgs/msg/Odometry") return data_->addOdometry(topic, in);
        if (type == "tf2_msgs/msg/TFMessage") return data_->addTransforms(topic, in);
        if (type == "sensor_msgs/msg/CompressedImage") return data_->addCompressed(topic, in);
        if (type == "sensor_msgs/msg/Image") return data_->addImage(topic, in);
    } catch (const FormatError& error) {
        const Diagnostic& first = error.diagnostics().front();
        if (!first.file.empty()) throw;
        throw FormatError(
            {displayName(file), 0, 0, place + ", " + std::string(topic) + ": " + first.message});
    }
}

Log RosLogBuilder::finish() {
    Data& data = *data_;
    for (auto& [child, track] : data.frames) track.finish();
    std::map<std::string, Data::OdometryTrack> odometry;
    for (std::size_t i = 0; i < data.log.odometry.size(); ++i)
        odometry[data.odometry_frames[i]].poses.push_back(&data.log.odometry[i]);
    for (auto& [frame, track] : odometry)
        std::stable_sort(track.poses.begin(), track.poses.end(),
                         [](const auto* a, const auto* b) { return a->time < b->time; });
    for (std::size_t i = 0; i < data.log.scans.size(); ++i) {
        LogScan& scan = data.log.scans[i];
        scan.poses = data.posesOf(data.scan_frames[i], scan.time, odometry);
    }
    for (std::size_t i = 0; i < data.log.clouds.size(); ++i) {
        LogCloud& cloud = data.log.clouds[i];
        cloud.poses = data.posesOf(data.cloud_frames[i], cloud.time, odometry);
    }
    Log log = std::move(data.log);
    log.name = data.name;
    log.format = "mcap";
    sortLog(log);
    std::stable_sort(log.odometry.begin(), log.odometry.end(),
                     [](const auto& a, const auto& b) { return a.time < b.time; });
    std::size_t scans = 0;
    for (LogOdometry& each : log.odometry) {
        while (scans < log.scans.size() && log.scans[scans].time < each.time) ++scans;
        each.scans_before = scans;
    }
    finishLog(log);
    return log;
}

}  // namespace ispace::reality
