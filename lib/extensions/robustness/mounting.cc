// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/mounting.h"

#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "env/level.h"
#include "geom/predicates.h"
#include "record/schema.h"
#include "sense/scan.h"

namespace ispace::robustness {

namespace {

constexpr int kAttempts = 8;

/// Returns true if the open segments cross, each with its ends strictly on both sides of the other.
bool cross(const Segment2& s, const Segment2& t) {
    const auto divides = [](const Segment2& line, const Segment2& ends) {
        const Turn a = orientation(line.a, line.b, ends.a), b = orientation(line.a, line.b, ends.b);
        return a != Turn::Straight && b != Turn::Straight && a != b;
    };
    return divides(s, t) && divides(t, s);
}

bool canShift(const Level& level, Point2 from, Point2 to) {
    if (!level.isFree(to)) return false;
    bool is_clear = true;
    const Segment2 way{from, to};
    const Box2 box = bounds(way);
    level.slice().forEachLine([&](const Segment2& line) {
        if (is_clear && box.meets(bounds(line)) && cross(way, line)) is_clear = false;
    });
    return is_clear;
}

}  // namespace

MountingTolerance parseTolerance(std::string_view text) {
    const auto number = [](std::string_view word, Unit unit, double most) {
        KeySpec key;
        key.unit = unit;
        const double value = std::get<double>(parseValue(key, std::string(word)));
        if (!(value >= 0 && value <= most))
            throw UsageError('`' + std::string(word) + "` is not from 0 to " + formatDouble(most) +
                             (unit == Unit::Angle ? " degrees" : " m"));
        return value;
    };
    const auto comma = text.find(',');
    if (comma == std::string_view::npos)
        throw UsageError('`' + std::string(text) + "` is not M,DEG, such as 5cm,3deg");
    return {number(text.substr(0, comma), Unit::Length, 1),
            Angle::degrees(number(text.substr(comma + 1), Unit::Angle, 180))};
}

Pose3 mountedPose(const Environment& environment, const Sensor& sensor,
                  const MountingTolerance& tolerance, RandomKey key) {
    Pose3 pose = sensor.pose;
    if (sensor.mount || sensor.person) return pose;
    // Element 0 turns, 1 tilts, then two for each displacement.
    std::vector<float> random(2 + 2 * kAttempts);
    key.purpose = Purpose::Mounting;
    key.sensor = hashOf(sensor.id);
    draw(key, 0, {.uniform = random});
    const auto within = [&](float share) {
        return (2 * static_cast<double>(share) - 1) * tolerance.angle;
    };
    pose.heading = wrapped(pose.heading + within(random[0]));
    if (!scansSlice(sensor)) pose.tilt = pose.tilt + within(random[1]);
    if (tolerance.distance <= 0) return pose;
    const auto level = environment.level(pose.position.z);
    for (std::size_t k = 2; k < random.size(); k += 2) {
        const double distance = tolerance.distance * std::sqrt(static_cast<double>(random[k]));
        const Angle angle = Angle::degrees(360 * static_cast<double>(random[k + 1]));
        const Point2 from = pose.position.onFloor();
        const Point2 to = from + distance * Vec2{cos(angle), sin(angle)};
        if (!canShift(*level, from, to)) continue;
        pose.position.x = to.x;
        pose.position.y = to.y;
        break;
    }
    return pose;
}

}  // namespace ispace::robustness
