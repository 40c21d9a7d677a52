// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/number.h"
#include "geom/rotation.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

namespace {

constexpr std::string_view kBlanks = " \t\r";

/// Removes the next word of a line and returns it; empty at its end.
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

}  // namespace

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
    if (std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) > kMaxDistance)
        fail(columns[1], "the place is more than 1000 km away");
    // Limit of nanoseconds in 64 bits.
    constexpr double kMaxTime = 9e9;
    if (std::fabs(t) > kMaxTime) fail(columns[0], "t is more than 285 years away");
    const double size = std::max({std::fabs(qx), std::fabs(qy), std::fabs(qz), std::fabs(qw)});
    if (size == 0) fail(columns[4], "the quaternion is 0, which is no rotation");
    const Eigen::Quaterniond rotation(qw / size, qx / size, qy / size, qz / size);
    return TimedPose{t, poseOf({x, y, z}, rotation)};
}

Pose3 between(const Pose3& a, const Pose3& b, double share) {
    const Point3 position = a.position + share * (b.position - a.position);
    if (a.isLevel() && b.isLevel())
        return {position, wrapped(a.heading + share * wrapped(b.heading - a.heading)), {}, {}};
    return poseOf(position, quaternionOf(a).slerp(share, quaternionOf(b)));
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
