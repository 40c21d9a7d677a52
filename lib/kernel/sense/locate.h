// SPDX-License-Identifier: GPL-3.0-or-later
// Positions from distances to known points (multilateration), as of ultrasonic receivers and UWB
// anchors.
//
// Least squares on each side of the plane of the receivers, by at most 200 steps of the method of
// Levenberg and Marquardt from two or three starts: each candidate is a local minimum, whose
// rounding error is taken as 1e-6 of the distances. Dilution of precision is that of satellite
// navigation (R. B. Langley, Dilution of precision, 1999). Pure function, O(receivers); metres.
//
//     const std::optional<PositionFix> fix = locate(heard);  // a std::vector<Hearing>
//     if (fix && fix->pdop < 5) place = fix->position;
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "geom/pose.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

/// A position computed from distances by least squares.
struct PositionFix {
    Point3 position;
    double residual = 0;  ///< root mean square of measured minus computed distances, metres
    /// Dilution of precision: the factor from the error of a distance to that of the position, in
    /// space, horizontally and vertically; sqrt of the trace of (J^T J)^-1 and of its parts. If the
    /// distances fit two positions (mirror images), the square of the distance between the two
    /// divided by the difference of their distances is added: +infinity if that difference is 0.
    double pdop = 0, hdop = 0, vdop = 0;
    /// The distances fit a second position as well, which was not taken: a mirror image.
    bool is_one_of_two = false;
};

/// A burst as one receiver heard it.
struct Hearing {
    Point3 place;         ///< position of the receiver
    Vec3 axis;            ///< of the cone in which it hears, unit vector
    Angle fov;            ///< full angle of the cone
    double distance = 0;  ///< measured
    double error = 0;     ///< standard deviation of the distance; 0: exact
};

/// Demands on a position.
struct PositionLimits {
    std::size_t receivers = kMinReceivers;  ///< that measured it, at least; 3 determine a position
    /// Heights between which it lies, metres; a candidate outside counts as one outside a cone.
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    /// If set, decides between two candidates: whether one within a distance of `place` is
    /// possible, e.g. on the plan. Ignored if it rejects both.
    std::function<bool(Point3 place, double distance)> admits = {};
};

/// Computes the position that fits the distances to the receivers best: Gauss-Newton
/// (Levenberg-Marquardt) from the linear solution, on each side of the best-fitting plane of the
/// receivers. Receivers near one plane (a ceiling) leave two mirror images as candidates:
/// - a candidate outside a receiver's cone, by more than five times its standard deviation, is
///   rejected;
/// - a candidate that fits worse, by more than five standard deviations, is rejected;
/// - a candidate within all cones is preferred to one that is not;
/// - a candidate that PositionLimits::admits rejects, within five times its standard deviation, is
///   rejected if the other is admitted;
/// - if both remain, the one on the side to which the receivers' axes point on average is returned,
///   and the dilution of precision includes the ambiguity (PositionFix::is_one_of_two).
///
/// Empty with fewer receivers than `limits` demand, if they do not determine a position (all on one
/// line), if no candidate is left, or if two are and the axes point along the plane. For a position
/// in the receivers' plane, the dilution of precision across it is unbounded and may be +infinity.
/// \pre distances are finite
std::optional<PositionFix> locate(std::span<const Hearing> heard,
                                  const PositionLimits& limits = {});

}  // namespace ispace
