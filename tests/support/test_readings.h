// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of lib/kernel/sense: readings of placed sensors, and invented ones for the formats.
#pragma once

#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "sense/depth.h"
#include "sense/reading.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace::testing {

/// Returns one reading of each sensor of a scene, in order, as frame `frame`.
inline std::vector<Reading> readings(const Scene& scene, const TakerOptions& options = {},
                                     int frame = 0) {
    const Sensors sensors = sensorsOf(scene, {});
    RayScenes worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    ReadingSampler taker(sensors, worlds, bodies, options);
    std::vector<Reading> out;
    for (std::size_t i = 0; i < sensors.read.size(); ++i) {
        const ReadingJob job{i, frame, 0, sensors.read[i].pose, {}};
        taker.prepare(job);
        out.push_back(taker.take(job));
    }
    return out;
}

/// Returns the scans of the lasers of a scene, in order.
inline std::vector<Scan> scans(const Scene& scene, const TakerOptions& options = {}) {
    std::vector<Scan> out;
    for (Reading& reading : readings(scene, options))
        if (auto* of_laser = std::get_if<std::vector<Scan>>(&reading))
            out.insert(out.end(), of_laser->begin(), of_laser->end());
    return out;
}

/// Returns the reading of one sensor in an unobstructed scene.
inline Scan scan(const Scene& scene, const Sensor& sensor) {
    RayScenes worlds(scene.environment);
    worlds.prepare(sensor.pose);
    const MovingBodies nobody;
    Scan out;
    out.pose = sensor.pose;
    LaserCaster(worlds, nobody, sensor, false, {}).cast(out);
    return out;
}

}  // namespace ispace::testing

namespace ispace {

constexpr float kNone = std::numeric_limits<float>::infinity();

/// Creates a laser with three beams, at -90, 0 and 90 degrees.
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

/// Returns ranges of 1 to 5 m, every seventh without return.
inline std::vector<float> randomRanges(std::mt19937& random, std::size_t count) {
    std::uniform_real_distribution<float> range(1, 5);
    std::vector<float> ranges(count);
    for (float& r : ranges) r = random() % 7 == 0 ? kNone : range(random);
    return ranges;
}

}  // namespace ispace
