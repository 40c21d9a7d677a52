// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "sense/moment.h"

namespace ispace {

struct ReadingKind;

/// A reading of an inertial measurement unit, in its own axes.
struct Inertia {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;
    Vec3 rates;          ///< radians a second
    Vec3 accelerations;  ///< m/s^2, with gravity: +9.80665 along z at rest
    Vec2 velocity;       ///< true, of the unit over the floor, m/s; for the next reading

    static const ReadingKind kKind;
};

/// Reads the rates of turning of the carrier at this time; accelerations as at rest.
///
/// With noise, each axis has a constant error that depends on seed and sensor alone, and white
/// noise with the standard deviation density * sqrt(rate / 2).
Inertia readingOf(const Imu& imu, const Moment& now);

/// Adds the mean acceleration since an earlier reading, as a unit that integrates reports it.
void follow(const Inertia& before, Inertia& now);

}  // namespace ispace
