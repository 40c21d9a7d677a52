// SPDX-License-Identifier: GPL-3.0-or-later
// Radars: movers by range, direction and radial speed, in the frame of the radar.
//
//     Radar radar("127.0.0.1:7001", "radar1");
//     for (const Detection& one : radar.scan().movers) track(one.range, one.bearing, one.speed);
#ifndef ISPACE_CLIENT_RADAR_H
#define ISPACE_CLIENT_RADAR_H

#include <string>
#include <vector>

#include <ispace_client/error.h>
#include <ispace_client/sensor.h>

namespace ispace {
namespace client {

/// A mover as a radar reports it, in the radar's frame.
struct Detection {
    double range = 0;                   ///< m
    double bearing = 0, elevation = 0;  ///< degrees, counter-clockwise and upwards from its axis
    double speed = 0;                   ///< m/s, radial: above 0 it moves away
};

/// The movers that a radar detects.
struct Detections : Reading {
    std::vector<Detection> movers;  ///< the nearest first

    static Detections from(const Message& message) {
        Detections reading;
        static_cast<Reading&>(reading) = Reading::from(message);
        const std::vector<double> range = reading.fields.numbers("range"),
                                  bearing = reading.fields.numbers("bearing"),
                                  elevation = reading.fields.numbers("elevation"),
                                  speed = reading.fields.numbers("speed");
        const std::size_t n = range.size();
        if (static_cast<long>(n) != reading.fields.integer("n") || bearing.size() != n ||
            elevation.size() != n || speed.size() != n)
            throw ProtocolError("a reading of " + reading.sensor + " is incomplete");
        reading.movers.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            reading.movers[i].range = range[i];
            reading.movers[i].bearing = bearing[i];
            reading.movers[i].elevation = elevation[i];
            reading.movers[i].speed = speed[i];
        }
        return reading;
    }
};

using Radar = SensorOf<Detections>;

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_RADAR_H
