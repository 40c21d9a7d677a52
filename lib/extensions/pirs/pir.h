// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/pirs: passive infrared sensors, which detect people who move. Uses sense and
// below.
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::pirs {

/// A passive infrared sensor, which detects people who move. Robots are as cool as the room.
struct Pir {
    std::string model;  ///< "" for the bare sensor
    double min_range = 0, max_range = 7;
    Angle fov_x = Angle::degrees(110), fov_y = Angle::degrees(80);  ///< full angles
    double rate = 10;                                               ///< readings a second
    double hold = 2;          ///< seconds for which the output stays on after a detection
    double min_speed = 0.1;   ///< m/s over the floor, in any direction: slower people are unseen
    double dropout = 0;       ///< share of the detections that is lost, with noise
    double false_alarms = 0;  ///< an hour, with noise

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 1; }
    [[nodiscard]] bool isNoisy() const { return dropout > 0 || false_alarms > 0; }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return fov_x >= Angle::degrees(360) && mount.isLevel();
    }
    static const SensorKind kKind;
    friend bool operator==(const Pir&, const Pir&) = default;
};

/// Returns `base` with the parameters that a `pir` record writes; the model stays. One number in
/// `fov` keeps the other angle. \throws FormatError with all findings
Pir withParameters(Pir base, const Record& record);

/// Returns the field of view at a pose, without occlusion: intervals of bearings and elevations.
FieldOfView fieldOfView(const Pir& pir, const Pose3& pose);

/// Returns true if it detects a person in view with this velocity, m/s over the floor.
bool senses(const Pir& pir, Vec2 velocity);

/// Adds the kind, for the program.
void addPirs();

}  // namespace ispace::pirs
