// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/doorcounters: time-of-flight sensors above doors that count passing people.
// Uses sense and below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor.h"

namespace ispace::doorcounters {

/// A time-of-flight sensor that looks down on a door from above. A line across its view divides it
/// into two zones; `in` is the direction of its heading. Its defaults are those of a small sensor
/// with 8 x 8 zones and a wide lens.
struct DoorCounter {
    std::string model;  ///< "" for the bare sensor
    std::string door;   ///< id, "" for one with a position
    double min_range = 0.02, max_range = 4;
    Angle fov_across = Angle::degrees(60);  ///< full angle, across the heading
    Angle fov_along = Angle::degrees(60);   ///< along it
    double height = 1.1;                    ///< lower people and robots are not counted, metres
    double rate = 15;                       ///< readings a second

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 1; }
    [[nodiscard]] static bool isNoisy() { return false; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    static const SensorKind kKind;
    friend bool operator==(const DoorCounter&, const DoorCounter&) = default;
};

/// Returns `base` with the parameters that a `doorcounter` record writes; the model stays.
/// \throws FormatError with all findings
DoorCounter withParameters(DoorCounter base, const Record& record);

/// Returns the field of view at a pose, without occlusion: a pyramid that looks down if the pose is
/// level, with its upright side along the heading.
FieldOfView fieldOfView(const DoorCounter& counter, const Pose3& pose);

/// A person or a tall robot in view.
struct CountedTrack {
    std::uint32_t owner = 0;  ///< as MovingBody::owner
    int from = 0;             ///< zone in which it was seen first: -1 outside, 1 inside
    int at = 0;               ///< zone in which it was seen last; 0: on the line since it came
    friend bool operator==(const CountedTrack&, const CountedTrack&) = default;
};

/// Passages since the first reading.
struct DoorCount {
    std::int64_t entered = 0, left = 0;
    std::vector<CountedTrack> tracks = {};  ///< those in view, by owner
    friend bool operator==(const DoorCount&, const DoorCount&) = default;
};

/// Takes the reading of a counter that has seen none before: its counts are 0.
///
/// The counter sees a mover where the ray to the centre of one of its bodies meets it
/// (sightingsOf()); of its bodies the nearest counts. It counts a mover that is seen there at
/// `height` or above.
DoorCount countAt(const Moment& now);

/// Adds the passages of the readings before: a mover that leaves the view has passed if it was seen
/// first in one zone and last in the other. One that turns back, or stands in the door, has not.
void addPassages(const DoorCount& before, DoorCount& now);

/// Adds the kind, for the program.
void addDoorCounters();

}  // namespace ispace::doorcounters
