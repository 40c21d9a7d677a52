// SPDX-License-Identifier: GPL-3.0-or-later
// Bursts of tags, and the receivers that hear them in line of sight. Sound takes the straight way:
// no echoes, no wind. O(receivers) rays; thread-safe.
//
//     const RayWorld& walls = worlds.mesh(Surfaces::Solid);  // glass stops sound
//     const Burst burst = castBurst(walls, bodies, tag, receivers, 0, 0, {.celsius = 22});
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sense/locate.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

struct ReadingKind;

/// Returns the speed of sound in dry air in m/s: 331.3 + 0.606 T for T degrees Celsius, within 0.3
/// % of that of an ideal gas, 331.3 sqrt(1 + T / 273.15), from -20 to 40 degrees.
double speedOfSound(double celsius);

/// One receiver's measurement of one burst.
struct TimeOfFlight {
    std::size_t receiver = 0;  ///< index in the given receivers
    double time = 0;           ///< seconds
    double distance = 0;       ///< metres: time times the speed of sound
};

/// One burst of a tag.
struct Burst {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;                       ///< true pose of the tag
    std::vector<TimeOfFlight> heard;  ///< sorted as the receivers
    std::optional<PositionFix> fix;   ///< of a tag located by times of flight
    std::optional<Point2> simple;     ///< of a tag located by the simple model
    static const ReadingKind kKind;
};

/// Signal of one tag at a receiver.
struct HeardTag {
    std::string tag;
    std::optional<double> time_of_flight;  ///< seconds; empty: not heard
};

/// Signals at a receiver: all tags, in the order of the scene.
struct Hearings {
    std::vector<HeardTag> tags;
    static const ReadingKind kKind;
};

/// Air and errors of a burst.
struct UltrasoundOptions {
    double celsius = 20;
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Simulates a burst of a tag and locates the tag from it. A receiver hears a tag within its range
/// (ends included, as float32), its cone and the tag's cone if neither the mesh nor a moving body
/// blocks the line; robots that carry one of the two do not block it. \pre `environment` is a mesh,
/// not a slice
///
/// Noise does not change the set of receivers, except for drop-outs: a measured distance beyond the
/// range is clamped to it. It depends on seed, tag, receiver and frame alone, not on other
/// receivers. Its angle of incidence is that between the sound and the receiver's axis.
Burst castBurst(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
                std::span<const Sensor> receivers, int frame, double time,
                const UltrasoundOptions& options);

}  // namespace ispace
