// SPDX-License-Identifier: GPL-3.0-or-later
// Keys that the records of several sensors share, and the errors of their ranges. withParameters()
// of a kind reads the device's record first and then the sensor's own, so that written keys win.
//
//     Laser laser = parametersOf<Laser>(record, deviceOf(record, devices));
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "geom/point.h"
#include "record/record.h"
#include "record/schema.h"

namespace ispace {

/// Plans lie within this distance of the origin, in metres, as in the environment.
constexpr double kMaxDistance = 1e6;

// Keys that several records have.
KeySpec idKey();
KeySpec modelKey();
/// Creates the key of an angle, 0 by default.
KeySpec angleKey(std::string name, std::string help, double lower, double upper,
                 Role role = Role::None);
KeySpec headingKey(std::string help);
/// Creates the key of a number above 0 without default.
KeySpec positiveKey(std::string name, Unit unit, std::string help, double upper);

/// More readings a second than any sensor takes.
constexpr double kMaxRate = 1e5;
/// Adds the keys of a sensor's pose, in space or in the frame of its carrier.
void addSensorPose(std::vector<KeySpec>& keys, std::string heading_help);
KeySpec rangeKey(std::string help);
KeySpec onKey();
KeySpec costKey();
/// Adds the keys of picture sensors: range, fov up to `widest` degrees, pixels and rate.
void addPictureKeys(std::vector<KeySpec>& keys, double widest);

/// Replaces both limits, or the maximum alone, by the `range` of a record if it has one. Errors are
/// added to the findings.
void applyRange(const Record& record, double& min_range, double& max_range, Diagnostics& findings);

/// Creates the key `fov` of a sensor that sees intervals of bearings and elevations, and reads it.
/// One number keeps the other angle.
KeySpec windowKey();
void applyWindow(const Record& record, Angle& across, Angle& upright, Diagnostics& findings);

/// Writes numbers for the device table: "0.06..4", and degrees with enough decimals to distinguish
/// devices.
std::string rangeText(double least, double greatest);
std::string degreesText(Angle angle);

/// Merges the parameters of a record: its explicit keys, else those of its device if there is one,
/// else of a bare one, by withParameters(Parameters, const Record&). \throws FormatError as that
template <typename Parameters>
Parameters parametersOf(const Record& record, const Record* device) {
    Parameters base;
    if (device != nullptr) {
        base = withParameters(Parameters(), *device);
        base.model = record.text("model");
    }
    return withParameters(std::move(base), record);
}

/// The errors of a range sensor. A measured distance r becomes
///
///     r + bias + N(0, s0 + s1 r + s2 r^2)
///
/// (a negative spread counts as 0), is lost with some probability, and is rounded to a multiple of
/// the resolution. The device's range limits apply to the true distance: a reading without return
/// stays without return. A measured distance beyond a limit becomes that limit.
struct RangeNoise {
    double bias = 0;                       ///< metres
    std::array<double, 3> sigma{0, 0, 0};  ///< s0 in metres, s1 in m/m, s2 in m/m^2
    Angle angle_sigma;                     ///< standard deviation of a beam's bearing
    double dropout = 0;                    ///< share of returns that is lost
    /// Angles between beam and normal: from `graze_from` to `graze_to` the share of lost returns
    /// grows to 1. Both 90 degrees: no losses by incidence.
    Angle graze_from = Angle::degrees(90), graze_to = Angle::degrees(90);
    double resolution = 0;  ///< metres; 0: exact

    [[nodiscard]] bool dropsByIncidence() const { return graze_from < Angle::degrees(90); }
    /// Returns true if readings stay exact.
    [[nodiscard]] bool isNone() const { return *this == RangeNoise(); }
    friend bool operator==(const RangeNoise&, const RangeNoise&) = default;
};

/// Standard deviation of a distance without noise, metres.
constexpr double kMinSigma = 0.001;
/// Returns the standard deviation of an error that is uniform over a width.
double uniformSigma(double width);
/// Returns the standard deviation of a distance: `sigma` and the rounding to `resolution`, at least
/// kMinSigma.
double distanceSigma(const RangeNoise& noise, double range);
/// Returns that of a direction, radians: `angle_sigma` and the rounding to beams or pixels of a
/// width.
double directionSigma(const RangeNoise& noise, double step);

/// Adds the keys `bias`, `sigma`, `angle_sigma`, `dropout`, `incidence` and `resolution`, without
/// defaults.
void addNoiseKeys(std::vector<KeySpec>& keys);

/// Replaces a device's noise parameters by those that a record writes. Errors, such as a first
/// angle of `incidence` above the second, are added to the findings.
void applyNoise(const Record& record, RangeNoise& noise, Diagnostics& findings);

}  // namespace ispace
