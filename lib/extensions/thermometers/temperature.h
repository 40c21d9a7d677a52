// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of thermometers: a pure function of the room and the time, or of the reading before.
// Thread-safe; O(moving bodies).
//
//     Temperature now = readingOf(thermometer, moment);  // as if the room had always been so
//     goOn(before, 10, now);                             // 10 s after another reading
#pragma once

#include "extensions/thermometers/thermometer.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::thermometers {

/// A reading of a thermometer.
struct Temperature {
    double celsius = 0;       ///< as measured
    double truth = 0;         ///< of the zone, without errors
    double steady = 0;        ///< of the zone in the end, if all stays as it is
    double constant = 0;      ///< seconds: time in which the difference falls to 1/e
    double error = 0;         ///< kelvin, constant for a sensor
    double resolution = 0;    ///< kelvin; 0: exact
    double min = 0, max = 0;  ///< limits of the measured value

    static const ReadingKind kKind;
};

/// Solves the equation of ZoneHeat, as if the room had been as now
/// since time 0:
///
///     T(t) = steady + (start - steady) exp(-t / constant)
Temperature readingOf(const Thermometer& thermometer, const Moment& now);

/// Continues from an earlier reading: the room has been as now since then. \param passed seconds
void goOn(const Temperature& before, double passed, Temperature& now);

}  // namespace ispace::thermometers
