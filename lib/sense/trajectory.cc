// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

double dot(const Quaternion& a, const Quaternion& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}

Quaternion sum(double s, const Quaternion& a, double t, const Quaternion& b) {
    return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z, s * a.w + t * b.w};
}

Quaternion normalized(const Quaternion& q) {
    const double size = std::sqrt(dot(q, q));
    return {q.x / size, q.y / size, q.z / size, q.w / size};
}

constexpr std::string_view kBlanks = " \t\r";

/// The next word of a line, which loses it; empty at its end.
std::string_view nextWord(std::string_view& line) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return line = {};
    const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

[[noreturn]] void fail(int column, const std::string& message) {
    throw FormatError({"", 0, column, message});
}

/// Plans lie within this of the origin, in metres.
constexpr double kFarthest = 1e6;

}  // namespace

Quaternion quaternionOf(const Pose3& pose) {
    const CosSin h = cosSin(0.5 * pose.heading), t = cosSin(-0.5 * pose.tilt),
                 r = cosSin(0.5 * pose.roll);
    // Rz(heading) Ry(-tilt) Rx(roll).
    return {h.cos * t.cos * r.sin - h.sin * t.sin * r.cos,
            h.cos * t.sin * r.cos + h.sin * t.cos * r.sin,
            h.sin * t.cos * r.cos - h.cos * t.sin * r.sin,
            h.cos * t.cos * r.cos + h.sin * t.sin * r.sin};
}

Pose3 poseOf(Point3 position, const Quaternion& rotation) {
    const Quaternion q = normalized(rotation);
    if (q.x == 0 && q.y == 0)
        return {position, wrapped(Angle::radians(2 * std::atan2(q.z, q.w))), {}, {}};
    const double up = 2 * (q.x * q.z - q.w * q.y);  // of the forward axis
    const Angle tilt = Angle::radians(std::asin(std::clamp(up, -1.0, 1.0)));
    // Straight up or down heading and roll turn about the same axis: all is heading then.
    constexpr double kStraight = 1 - 1e-12;
    if (std::fabs(up) >= kStraight) {
        const double left_x = 2 * (q.x * q.y - q.w * q.z);
        const double left_y = 1 - 2 * (q.x * q.x + q.z * q.z);
        return {position, directionOf(left_y, -left_x), Angle::degrees(up > 0 ? 90 : -90), {}};
    }
    const double forward_x = 1 - 2 * (q.y * q.y + q.z * q.z);
    const double forward_y = 2 * (q.x * q.y + q.w * q.z);
    const double left_z = 2 * (q.y * q.z + q.w * q.x);
    const double top_z = 1 - 2 * (q.x * q.x + q.y * q.y);
    return {position, directionOf(forward_x, forward_y), tilt, directionOf(top_z, left_z)};
}

std::optional<TimedPose> parseTumLine(std::string_view line) {
    constexpr std::array kNames = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
    std::array<double, kNames.size()> values{};
    std::size_t count = 0;
    std::array<int, kNames.size()> columns{};
    const char* const begin = line.data();
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
        const int column = static_cast<int>(word.data() - begin) + 1;
        if (count == 0 && word.front() == '#') return std::nullopt;
        if (count == values.size())
            fail(column, "more than 8 columns; a pose is `t x y z qx qy qz qw`");
        const std::optional<double> value = parseDouble(word);
        if (!value || !std::isfinite(*value))
            fail(column,
                 std::string(kNames[count]) + " `" + std::string(word) + "` is not a number");
        columns[count] = column;
        values[count++] = *value;
    }
    if (count == 0) return std::nullopt;
    if (count < values.size())
        fail(0, std::to_string(count) + " columns; a pose is `t x y z qx qy qz qw`");
    const auto [t, x, y, z, qx, qy, qz, qw] = values;
    if (std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) > kFarthest)
        fail(columns[1], "the place is more than 1000 km away");
    // What nanoseconds in 64 bits can count.
    constexpr double kLongest = 9e9;
    if (std::fabs(t) > kLongest) fail(columns[0], "t is more than 285 years away");
    const double size = std::max({std::fabs(qx), std::fabs(qy), std::fabs(qz), std::fabs(qw)});
    if (size == 0) fail(columns[4], "the quaternion is 0, which is no rotation");
    const Quaternion rotation{qx / size, qy / size, qz / size, qw / size};
    return TimedPose{t, poseOf({x, y, z}, rotation)};
}

Pose3 between(const Pose3& a, const Pose3& b, double share) {
    const Point3 position = a.position + share * (b.position - a.position);
    if (a.isLevel() && b.isLevel())
        return {position, wrapped(a.heading + share * wrapped(b.heading - a.heading)), {}, {}};
    const Quaternion from = quaternionOf(a);
    Quaternion to = quaternionOf(b);
    double cosine = dot(from, to);
    if (cosine < 0) {
        to = sum(-1, to, 0, to);
        cosine = -cosine;
    }
    // Nearly equal: the straight way is as good, and has no small divisor.
    constexpr double kNear = 1 - 1e-9;
    if (cosine > kNear) return poseOf(position, sum(1 - share, from, share, to));
    const double angle = std::acos(cosine);
    return poseOf(position, sum(std::sin((1 - share) * angle), from, std::sin(share * angle), to));
}

Pose3 poseAlong(std::span<const TimedPose> way, double time) {
    const auto after =
        std::upper_bound(way.begin(), way.end(), time,
                         [](double t, const TimedPose& timed) { return t < timed.time; });
    if (after == way.begin()) return way.front().pose;
    if (after == way.end()) return way.back().pose;
    const TimedPose &a = *(after - 1), &b = *after;
    return between(a.pose, b.pose, (time - a.time) / (b.time - a.time));
}

}  // namespace ispace
