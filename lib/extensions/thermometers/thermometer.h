// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/thermometers: thermometers of zones, which heaters, lamps, people and the sun
// warm. Uses sense and below.
//
// The temperature of a zone follows Newton's law of cooling. It is solved in closed form, so that
// the steps of a run do not change it as long as the heat stays the same. The heat of all zones is
// computed once for a room, in O(zones * (windows + heaters + lamps)).
//
//     addThermometers();                                         // before the first scene is read
//     const Sensor sensor = sensorsOf<Thermometer>(scene).front();
//     const double power = sensor.as<Thermometer>().heat.power;  // W, without people
#pragma once

#include <cstddef>
#include <string>

#include "geom/polygon.h"
#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::thermometers {

/// The heat of a zone as one body of air and walls with one temperature T:
///
///     storage dT/dt = loss (outside - T) + power + 75 W for each person in the zone
struct ZoneHeat {
    Polygon outline;      ///< of the zone, counter-clockwise
    double start = 20;    ///< degrees Celsius, at time 0
    double outside = 10;  ///< degrees Celsius
    double storage = 1;   ///< J/K
    double loss = 1;      ///< W/K, through walls, windows and gaps
    double power = 0;     ///< W, of heaters, lamps and the sun
    friend bool operator==(const ZoneHeat&, const ZoneHeat&) = default;
};

/// A thermometer, which reports the temperature of a zone. It has no rays.
struct Thermometer {
    std::string model;      ///< "" for the bare thermometer
    std::string zone;       ///< id
    double min = -40;       ///< degrees Celsius: least value that it reports
    double max = 125;       ///< greatest value that it reports
    double resolution = 0;  ///< kelvin, with noise; 0: exact
    double error = 0;       ///< kelvin: spread of its constant error, with noise
    double rate = 0.1;      ///< readings a second
    double max_range = 0;   ///< it covers no floor
    ZoneHeat heat;          ///< of the zone in the scene

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 0; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] bool isNoisy() const { return resolution > 0 || error > 0; }
    static const SensorKind kKind;
    friend bool operator==(const Thermometer&, const Thermometer&) = default;
};

/// Returns `base` with the parameters that a `thermometer` record writes, without the heat of its
/// zone; the model stays. \throws FormatError if its limits are not apart
Thermometer withParameters(Thermometer base, const Record& record);

/// Adds the kind, for the program.
void addThermometers();

}  // namespace ispace::thermometers
