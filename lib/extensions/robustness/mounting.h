// SPDX-License-Identifier: GPL-3.0-or-later
// Errors with which sensors are mounted, drawn at random.
//
// Random numbers are keyed by seed, sample and sensor (base/random.h): mounting k of a sensor is
// the same whatever was drawn before, on any number of threads.
//
//     const MountingTolerance tolerance = parseTolerance("5cm,3deg");
//     sensor.pose = mountedPose(scene.environment, sensor, tolerance, {.seed = 7, .frame = k});
#pragma once

#include <string_view>

#include "base/random.h"
#include "scene/scene.h"

namespace ispace::robustness {

/// The largest error with which sensors are mounted.
struct MountingTolerance {
    double distance = 0;  ///< in the plan, metres
    Angle angle;          ///< of the heading, and of the tilt of sensors that scan no slice
};

/// Parses `5cm,3deg`. \throws UsageError for negative numbers, more than a metre or 180 degrees
MountingTolerance parseTolerance(std::string_view text);

/// Returns the pose of a sensor mounted with a random error: heading, and tilt unless the sensor
/// scans a slice, uniform within the angle; position uniform in the disc about the planned one.
/// Displacements across a wall or a body, into one, or out of the room are drawn again, eight times
/// at most; then the sensor keeps its position. Sensors on robots and people keep their poses.
/// \param key its `sensor` is ignored
Pose3 mountedPose(const Environment& environment, const Sensor& sensor,
                  const MountingTolerance& tolerance, RandomKey key);

}  // namespace ispace::robustness
