// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests of this folder: what placed sensors read.
#pragma once

#include <string>
#include <vector>

#include "layout/test_layout.h"
#include "sense/bodies.h"
#include "sense/reading.h"

namespace ispace::testing {

/// One reading of each sensor of a scene, in order, as frame `frame`.
inline std::vector<Reading> readings(const Scene& scene, const TakerOptions& options = {},
                                     int frame = 0) {
    const Sensors sensors = sensorsOf(scene, {});
    Worlds worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    ReadingTaker taker(sensors, worlds, bodies, options);
    std::vector<Reading> out;
    for (std::size_t i = 0; i < sensors.read.size(); ++i) {
        const ReadingJob job{i, frame, 0, sensors.read[i].pose, {}};
        taker.prepare(job);
        out.push_back(taker.take(job));
    }
    return out;
}

/// The scans of the lasers of a scene, in order.
inline std::vector<Scan> scans(const Scene& scene, const TakerOptions& options = {}) {
    std::vector<Scan> out;
    for (Reading& reading : readings(scene, options))
        if (auto* of_laser = std::get_if<std::vector<Scan>>(&reading))
            out.insert(out.end(), of_laser->begin(), of_laser->end());
    return out;
}

/// What one sensor reads in a scene without anything in the way.
inline Scan scan(const Scene& scene, const Sensor& sensor) {
    Worlds worlds(scene.environment);
    worlds.prepare(sensor.pose);
    const MovingBodies nobody;
    Scan out;
    out.pose = sensor.pose;
    LaserCaster(worlds, nobody, sensor, false, {}).cast(out);
    return out;
}

}  // namespace ispace::testing
