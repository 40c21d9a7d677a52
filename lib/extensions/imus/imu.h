// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/imus: inertial measurement units, which report the turns and accelerations of
// robots and people. Uses sense and below.
//
// The sums of all readings of a run are the motion of the carrier, whatever the rate of the unit
// and the step of the run are (sim/mean_motions.h). A reading casts no ray and is O(1).
//
//     addImus();                                   // before the first scene is read
//     Imu imu;                                     // 100 readings a second, exact
//     imu.gyro = {.bias = 0.5, .density = 0.005};  // as of MEMS units, with --noise
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace {

struct SensorKind;

}  // namespace ispace

namespace ispace::imus {

/// Errors of three axes: a constant one of each, and white noise.
struct InertialNoise {
    double bias = 0;     ///< standard deviation of the constant error
    double density = 0;  ///< of the white noise, a square root of Hz

    [[nodiscard]] bool isNone() const { return bias == 0 && density == 0; }
    friend bool operator==(const InertialNoise&, const InertialNoise&) = default;
};

/// An inertial measurement unit: the rates of turning of a robot or a person, and the accelerations
/// with gravity.
struct Imu {
    std::string model;     ///< "" for the bare unit
    InertialNoise gyro;    ///< degrees a second
    InertialNoise accel;   ///< m/s^2
    double rate = 100;     ///< readings a second
    double max_range = 0;  ///< it covers no floor

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 0; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    [[nodiscard]] bool isNoisy() const { return !gyro.isNone() || !accel.isNone(); }
    static const SensorKind kKind;
    friend bool operator==(const Imu&, const Imu&) = default;
};

/// Returns `base` with the parameters that an `imu` record writes; the model stays.
Imu withParameters(Imu base, const Record& record);

/// Adds the kind, for the program.
void addImus();

}  // namespace ispace::imus
