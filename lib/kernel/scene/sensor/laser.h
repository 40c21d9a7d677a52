// SPDX-License-Identifier: GPL-3.0-or-later
// Planar laser range finders: the angles and times of their beams. Bearings are in the sensor's
// frame, counter-clockwise. Counts of steps allow for kStepTolerance, so that 180 degrees by 0.1
// are 1801 beams. Values and pure functions, O(1).
//
//     Laser laser;                                    // 181 beams over 180 degrees
//     const Angle ahead = laser.bearing(90);          // 0
//     laser.spin = 10;                                // turns a second
//     const double last = laser.timeOf(180);          // 0.05 s behind beam 0
#pragma once

#include <cstddef>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

struct SensorKind;

/// Maximum number of beams of a scan: no scanner has more, but a mistaken unit may ask for more.
constexpr int kMaxBeams = 1'000'000;
/// Maximum number of beams of a whole sweep, which is one reading.
constexpr double kMaxSwept = 1e8;

/// The angle of a laser's pose that changes from scan to scan of a sweep.
enum class SweepAxis {
    None,
    Heading,  ///< it turns about the vertical
    Tilt,     ///< it nods
    Roll,     ///< it turns about the direction it faces
};

/// A planar laser range finder: beam k (0 .. beams-1) has bearing `first + k * step` in the
/// sensor's frame. Without model it is the thesis' panel of fig. 3.9 (5 m, 180 degrees, 1 degree).
struct Laser {
    std::string model;  ///< "" for the bare laser
    double min_range = 0, max_range = 5;
    Angle first = Angle::degrees(-90), step = Angle::degrees(1);
    int beams = 181;
    double rate = 10;  ///< scans a second
    /// Turns a second of its beam, which give each beam its own time. Counter-clockwise, beam 0
    /// comes first; clockwise (below 0), the last one. 0: all beams at once.
    double spin = 0;
    /// A sweep is `scans()` scans; scan j adds j * sweep_step to the angle of the axis: from 0 to
    /// sweep_span, without its end if that is a full turn.
    SweepAxis sweep = SweepAxis::None;
    Angle sweep_span = Angle::degrees(360), sweep_step = Angle::degrees(1);
    RangeNoise noise;

    [[nodiscard]] Angle bearing(int beam) const { return first + static_cast<double>(beam) * step; }
    [[nodiscard]] Angle last() const { return bearing(beams - 1); }
    /// Returns the sector of a scan, counter-clockwise from `first` to the last beam, or a full
    /// turn if the beams close the circle: if beams * step is 360 degrees or more, within a
    /// hundredth of a step, so that last and first beam are neighbours. Two beams never do.
    [[nodiscard]] Angle span() const;
    /// Returns the sector that a level laser covers with its sweep of headings; at most a full
    /// turn.
    [[nodiscard]] Angle sweptSpan() const;
    /// Returns true if a level laser covers all directions, so that its heading does not matter;
    /// false if it nods or rolls.
    [[nodiscard]] bool seesAround() const;
    /// Returns true if a direction at `bearing` (any turn) lies in the sector of a scan, ends
    /// included (within 1e-9 degrees).
    [[nodiscard]] bool sees(Angle bearing) const;
    /// Returns the number of scans of a sweep; 1 without.
    [[nodiscard]] int scans() const;
    /// Returns the seconds from the first measurement of a scan to that of a beam.
    [[nodiscard]] double timeOf(int beam) const;
    [[nodiscard]] double duration() const;
    /// Readings a second, duration and rays of one; a reading is a sweep or else a scan.
    [[nodiscard]] double readingRate() const { return rate / scans(); }
    [[nodiscard]] double readingTime() const { return duration() + (scans() - 1) / rate; }
    [[nodiscard]] std::size_t rays() const {
        return static_cast<std::size_t>(beams) * static_cast<std::size_t>(scans());
    }
    [[nodiscard]] bool isNoisy() const { return !noise.isNone(); }
    [[nodiscard]] bool isOmnidirectional(const Pose3& mount) const {
        return mount.isLevel() && seesAround();
    }
    static const SensorKind kKind;
    friend bool operator==(const Laser&, const Laser&) = default;
};

/// Computes the pose of a laser `scans` scans (whole or not) into its sweep.
Pose3 sweptPose(const Laser& laser, Pose3 pose, double scans);

/// Returns `base` with the parameters that a `laser` record writes; the model stays. An explicit
/// `fov` recomputes the beams: from -fov/2 (or an explicit `first`) on, floor(fov/step) + 1 of
/// them, or explicit `beams` spread over it; an explicit `step` alone keeps the model's first beam
/// and span (or full turn); `first` alone keeps number and step; `beams` alone keeps first beam and
/// step. One number in `range` is the maximum. An explicit `rate` alone scales the spin of a
/// model's beam. \throws FormatError with all findings: an unknown model (with the nearest name),
/// min above max, a fraction of a beam, too many, more than a full turn, `fov` and `beams` that
/// disagree, a scan that takes longer than its period
Laser withParameters(Laser base, const Record& record);

}  // namespace ispace
