// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sense/moment.h"

namespace ispace {

struct ReadingKind;

/// A reading of a thermometer.
struct Temperature {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;
    double celsius = 0;       ///< as measured
    double truth = 0;         ///< of the zone, without errors
    double steady = 0;        ///< of the zone in the end, if all stays as it is
    double constant = 0;      ///< seconds: time in which the difference falls to 1/e
    double error = 0;         ///< kelvin, constant for a sensor
    double resolution = 0;    ///< kelvin; 0: exact
    double min = 0, max = 0;  ///< limits of the measured value

    static const ReadingKind kKind;
};

/// Solves the equation of ZoneHeat (scene/sensor/thermometer.h), as if the room had been as now
/// since time 0:
///
///     T(t) = steady + (start - steady) exp(-t / constant)
Temperature readingOf(const Thermometer& thermometer, const Moment& now);

/// Continues from an earlier reading: the room has been as now since then.
void follow(const Temperature& before, Temperature& now);

}  // namespace ispace
