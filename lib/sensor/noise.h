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
/// (a negative spread counts as 0), is lost with some probability, and is rounded to a multiple of
/// the resolution. The device's range limits apply to the true distance: what is out of range, or
/// never returned, stays no return. A measured distance beyond a limit becomes that limit.
struct RangeNoise {
    double bias = 0;                       ///< metres
    std::array<double, 3> sigma{0, 0, 0};  ///< s0 in metres, s1 in m/m, s2 in m/m^2
    Angle angle_sigma;                     ///< standard deviation of a beam's bearing
    double dropout = 0;                    ///< share of returns that is lost
    /// Angles between beam and normal: from `graze_from` to `graze_to` the share of lost returns
    /// grows to 1. Both 90 degrees: none is lost by incidence.
    Angle graze_from = Angle::degrees(90), graze_to = Angle::degrees(90);
    double resolution = 0;  ///< metres; 0: none

    [[nodiscard]] bool dropsByIncidence() const { return graze_from < Angle::degrees(90); }
    /// True if readings stay as they are.
    [[nodiscard]] bool isNone() const { return *this == RangeNoise(); }
    friend bool operator==(const RangeNoise&, const RangeNoise&) = default;
};

/// The keys `bias`, `sigma`, `angle_sigma`, `dropout`, `incidence` and `resolution`, none with a
/// default.
void addNoiseKeys(std::vector<KeySpec>& keys);

/// Replaces a device's noise parameters by those written in a record. Errors, such as a first angle
/// of `incidence` above the second, are added to the findings.
void applyNoise(const Record& record, RangeNoise& noise, Diagnostics& findings);

}  // namespace ispace
