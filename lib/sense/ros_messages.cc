// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/ros_messages.h"

#include <array>
#include <cmath>
#include <limits>

#include "geom/rotation.h"
#include "sense/reading_picture.h"

namespace ispace {

namespace {

/// Common Data Representation, version 1: numbers stand at multiples of their size, counted from
/// behind the four bytes that name the encoding.
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
    /// As many as the type says.
    template <typename Number>
    CdrWriter& array(std::span<const Number> values) {
        align(sizeof(Number));
        out_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return *this;
    }
    /// As many as there are.
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
    // All of the picture: no binning, no part of it.
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

std::string pointCloudMessage(const RosHeader& header, const PointCloud& cloud) {
    constexpr std::uint8_t kFloat32 = 7;
    constexpr std::size_t kPoint = 3 * sizeof(float);
    CdrWriter out;
    out.put(header).count(cloud.height).count(cloud.width).count(3);
    std::uint32_t offset = 0;
    for (const char* const name : {"x", "y", "z"}) {
        out.put(name).put(offset).put(kFloat32).count(1);
        offset += sizeof(float);
    }
    out.put(false).count(kPoint).count(kPoint * cloud.width);  // not big-endian
    out.bytes({reinterpret_cast<const char*>(cloud.xyz.data()), cloud.xyz.size() * sizeof(float)});
    return out.put(false).take();  // some points may be missing
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

}  // namespace ispace
