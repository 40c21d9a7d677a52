// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geom/pose.h"
#include "layout/devices.h"
#include "record/record.h"

namespace ispace {

/// More beams than this are refused: no scanner has them, and a slip of the unit may ask for them.
constexpr int kMostBeams = 1'000'000;

/// A planar laser range finder: beam k (0 .. beams-1) has bearing `first + k * step` in the
/// sensor's frame. Without model it is the thesis' panel of fig. 3.9 (5 m, 180 degrees, 1 degree).
struct Laser {
    std::string model;  ///< "" for the bare laser
    double min_range = 0, max_range = 5;
    Angle first = Angle::degrees(-90), step = Angle::degrees(1);
    int beams = 181;

    [[nodiscard]] Angle bearing(int beam) const { return first + static_cast<double>(beam) * step; }
    [[nodiscard]] Angle last() const { return bearing(beams - 1); }
    /// True if a direction at `bearing` (any turn) lies between first and last beam, ends included
    /// (within 1e-9 degrees).
    [[nodiscard]] bool sees(Angle bearing) const;
    friend bool operator==(const Laser&, const Laser&) = default;
};

/// A laser at its place.
struct PlacedLaser {
    std::string id;
    Laser laser;
    Pose3 pose;
};

/// Figures of a `laser` record: its explicit keys, else its model's, else the bare laser's. An
/// explicit `fov` lays the beams anew: from -fov/2 (or an explicit `first`) on, floor(fov/step) + 1
/// of them; an explicit `step` alone keeps the model's first beam and span; `first` alone keeps
/// number and step; `beams` alone keeps first beam and step. One number in `range` is the maximum.
/// \throws FormatError with all findings: an unknown model (with the nearest name), min above max,
///         a fraction of a beam, too many, more than a full turn, `fov` and `beams` that disagree
Laser laserOf(const Record& record, const DeviceCatalogue& devices);

/// `base` with the figures written in a record put in place of its own; the model stays.
/// \throws FormatError as laserOf
Laser withFigures(Laser base, const Record& record);

/// Pose of a `laser` record with `at`; without z it stands at kScanHeight.
Pose3 poseOf(const Record& record);

}  // namespace ispace
