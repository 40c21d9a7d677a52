// SPDX-License-Identifier: GPL-3.0-or-later
// Readings of inertial measurement units: a pure function of pose, motion, frame and seed.
//
//     const Inertia at_rest = readingOf(Imu(), moment);  // accelerations {0, 0, 9.80665}
#pragma once

#include "extensions/imus/imu.h"
#include "sense/added_reading.h"

namespace ispace {

struct ReadingKind;

}  // namespace ispace

namespace ispace::imus {

/// A reading of an inertial measurement unit, in its own axes.
struct Inertia {
    Vec3 rates;          ///< radians a second
    Vec3 accelerations;  ///< m/s^2, with gravity: +9.80665 along z at rest

    static const ReadingKind kKind;
};

/// Reads the mean rates and accelerations of the carrier since the last reading (Moment::mean), or
/// the rates at this time and the accelerations as at rest.
///
/// With noise, each axis has a constant error that depends on seed and sensor alone, and white
/// noise with the standard deviation density * sqrt(rate / 2): the density is one-sided, the
/// bandwidth half the rate.
Inertia readingOf(const Imu& imu, const Moment& now);

}  // namespace ispace::imus
