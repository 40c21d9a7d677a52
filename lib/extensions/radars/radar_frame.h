// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of radars: the movers in sight, by range, direction and radial speed.
//
//     for (const Detection& one : readingOf(sensor.as<Radar>(), moment).detections)
//         if (one.speed < 0) warn(one.range);  // it comes nearer
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "extensions/radars/radar.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::radars {

/// A mover as a radar reports it, in the radar's frame.
struct Detection {
    double range = 0;  ///< metres, along the line of sight to its surface
    Angle bearing, elevation;
    double speed = 0;  ///< m/s, radial: above 0 it moves away
};

/// One reading of a radar.
struct RadarFrame {
    std::vector<Detection> detections;  ///< the nearest first
    static const ReadingKind kKind;
};

/// Detects the movers that the radar `sensor` sees move from `pose`.
///
/// sightingsOf() (sense/sighting.h) finds the movers in sight; bodies of the radar's carrier do not
/// block it. The radial speed is the rate of change of the distance due to the mover: a radar
/// on a robot compensates its own motion. Movers below the least radial speed have no detection.
///
/// Two movers nearer to each other than all three resolutions are one detection, the nearest. Then
/// speeds are folded into [-max_speed, max_speed). Noise, if a seed is given, depends on seed,
/// sensor, frame and mover alone, and changes neither the order nor, but for drop-outs, the number.
/// \param mesh surfaces that stop its rays; not a slice
RadarFrame castRadar(const RayWorld& mesh, const MovingBodies& bodies,
                     const MoverVelocities& velocities, const Sensor& sensor, const Pose3& pose,
                     int frame, std::optional<std::uint64_t> noise_seed);

RadarFrame readingOf(const Radar& radar, const Moment& now);

}  // namespace ispace::radars
