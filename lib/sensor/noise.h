// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geom/point.h"
#include "record/record.h"

namespace ispace {

/// How a range sensor errs. A measured distance r becomes
///
///     r + bias + N(0, s0 + s1 r + s2 r^2)
///
/// (a negative spread counts as 0), is lost with some probability, and is given in whole multiples
/// of the resolution. The device's range limits are about the true distance: what is out of range,
/// or never returned, stays no return. What is measured beyond a limit is given as that limit.
struct RangeNoise {
    double bias = 0;                       ///< metres
    std::array<double, 3> sigma{0, 0, 0};  ///< s0 in metres, s1 in m/m, s2 in m/m^2
    Angle angle_sigma;                     ///< standard deviation of a beam's bearing
    double dropout = 0;                    ///< share of all returns that is lost
    /// Angles between beam and normal: from `graze_from` on returns get lost, the more the larger
    /// the angle, from `graze_to` on all do. Both 90 degrees: none is lost by incidence.
    Angle graze_from = Angle::degrees(90), graze_to = Angle::degrees(90);
    double resolution = 0;  ///< metres; 0: none

    [[nodiscard]] bool dropsByIncidence() const { return graze_from < Angle::degrees(90); }
    /// Nothing to do.
    [[nodiscard]] bool isNone() const { return *this == RangeNoise(); }
    friend bool operator==(const RangeNoise&, const RangeNoise&) = default;
};

/// The keys `bias`, `sigma`, `angle_sigma`, `dropout`, `incidence` and `resolution`, none with a
/// default.
void addNoiseKeys(std::vector<KeySpec>& keys);

/// Puts the figures written in a record in place of a device's. Adds what is wrong with them to the
/// findings: a first angle of `incidence` above the second.
void applyNoise(const Record& record, RangeNoise& noise, Diagnostics& findings);

}  // namespace ispace
