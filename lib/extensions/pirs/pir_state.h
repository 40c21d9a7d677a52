// SPDX-License-Identifier: GPL-3.0-or-later
// The output of passive infrared sensors: on while people move in sight, and for a hold time after.
// Thread-safe; noise depends on its key alone, never on the order of calls.
#pragma once

#include <cstdint>
#include <optional>

#include "extensions/pirs/pir.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::pirs {

/// One reading of a passive infrared sensor.
struct PirState {
    bool motion = false;  ///< its output
    double held = 0;      ///< seconds for which the output stays on from its time
    static const ReadingKind kKind;
};

/// Detects people who move in the sight of the PIR sensor `sensor` at `pose`: sightingsOf()
/// (sense/sighting.h) finds those in sight. The speed that counts is that of the person over the
/// floor: a turn on the spot has none.
///
/// Noise, if a seed is given, depends on seed, sensor, frame and person alone: detections drop out,
/// and a reading has a false alarm with the probability false_alarms / 3600 / rate.
/// \param mesh surfaces that stop its rays; not a slice
PirState castPir(const RayWorld& mesh, const MovingBodies& bodies,
                 const MoverVelocities& velocities, const Sensor& sensor, const Pose3& pose,
                 int frame, std::optional<std::uint64_t> noise_seed);

PirState readingOf(const Pir& pir, const Moment& now);

/// Keeps the output on for the rest of the hold time of a reading `passed` seconds earlier.
void keepOn(const PirState& before, double passed, PirState& now);

}  // namespace ispace::pirs
