// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of formats: sensors and readings of them, made up.
#pragma once

#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sense/depth.h"
#include "sense/scan.h"

namespace ispace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// Three beams, at -90, 0 and 90 degrees.
inline Sensor threeBeams() {
    Sensor sensor{"l1", Laser(), {}};
    sensor.as<Laser>().max_range = 4;
    sensor.as<Laser>().step = Angle::degrees(90);
    sensor.as<Laser>().beams = 3;
    return sensor;
}

inline Scan scanOf(const Pose3& pose, std::vector<float> ranges) {
    Scan scan;
    scan.pose = pose;
    scan.ranges = std::move(ranges);
    return scan;
}

inline Sensor smallRanger(Projection projection, int columns, int rows) {
    Sensor sensor{"r1", Ranger(), {}};
    sensor.as<Ranger>().projection = projection;
    sensor.as<Ranger>().columns = columns;
    sensor.as<Ranger>().rows = rows;
    return sensor;
}

inline Pose3 randomPose(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-10, 10), angle(-180, 180), tilt(-90, 90);
    Pose3 pose;
    pose.position = {place(random), place(random), place(random)};
    pose.heading = Angle::degrees(angle(random));
    pose.tilt = Angle::degrees(tilt(random));
    pose.roll = Angle::degrees(angle(random));
    return pose;
}

/// Ranges of 1 to 5 m, every seventh without return.
inline std::vector<float> randomRanges(std::mt19937& random, std::size_t count) {
    std::uniform_real_distribution<float> range(1, 5);
    std::vector<float> ranges(count);
    for (float& r : ranges) r = random() % 7 == 0 ? kNone : range(random);
    return ranges;
}

}  // namespace ispace
