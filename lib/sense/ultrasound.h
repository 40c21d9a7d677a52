// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

struct ReadingKind;

/// Returns the speed of sound in dry air in m/s: 331.3 + 0.606 T for T degrees Celsius.
double speedOfSound(double celsius);

/// One receiver's measurement of one burst.
struct TimeOfFlight {
    std::size_t receiver = 0;  ///< index in the given receivers
    double time = 0;           ///< seconds
    double distance = 0;       ///< metres: time times the speed of sound
};

/// A position computed from distances by least squares.
struct PositionFix {
    Point3 position;
    double residual = 0;  ///< root mean square of measured minus computed distances, metres
    /// Dilution of precision: the factor from the error of a distance to that of the position, in
    /// space, horizontally and vertically; sqrt of the trace of (J^T J)^-1 and of its parts. If the
    /// distances fit two positions (mirror images), the square of the distance between the two
    /// divided by the difference of their distances is added: +infinity if that difference is 0.
    double pdop = 0, hdop = 0, vdop = 0;
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
};

/// Computes the position that fits the distances to the receivers best: Gauss-Newton
/// (Levenberg-Marquardt) from the linear solution, on each side of the best-fitting plane of the
/// receivers. Receivers near one plane (a ceiling) leave two mirror images as candidates:
/// - a candidate outside a receiver's cone, by more than five times its standard deviation, is
///   rejected;
/// - a candidate that fits worse, by more than five standard deviations, is rejected;
/// - a candidate within all cones is preferred to one that is not;
/// - if both remain, the one on the side to which the receivers' axes point on average is returned,
///   and the dilution of precision includes the ambiguity.
///
/// Empty with fewer receivers than `limits` demand, if they do not determine a position (all on one
/// line), if no candidate is left, or if two are and the axes point along the plane. For a position
/// in the receivers' plane, the dilution of precision across it is unbounded and may be +infinity.
/// \pre distances are finite
std::optional<PositionFix> locate(std::span<const Hearing> heard,
                                  const PositionLimits& limits = {});

/// One burst of a tag.
struct Burst {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;                       ///< true pose of the tag
    std::vector<TimeOfFlight> heard;  ///< sorted as the receivers
    std::optional<PositionFix> fix;   ///< of a tag located by times of flight
    std::optional<Point2> simple;     ///< of a tag located by the simple model
    static const ReadingKind kKind;
};

/// Signal of one tag at a receiver.
struct HeardTag {
    std::string tag;
    std::optional<double> time_of_flight;  ///< seconds; empty: not heard
};

/// Signals at a receiver: all tags, in the order of the scene.
struct Hearings {
    std::vector<HeardTag> tags;
    static const ReadingKind kKind;
};

struct UltrasoundOptions {
    double celsius = 20;
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Simulates a burst of a tag and locates the tag from it. A receiver hears a tag within its range
/// (ends included, as float32), its cone and the tag's cone if neither the mesh nor a moving body
/// blocks the line; robots that carry one of the two do not block it. \pre `environment` is a mesh,
/// not a slice
///
/// Noise does not change the set of receivers, except for drop-outs: a measured distance beyond the
/// range is clamped to it. It depends on seed, tag, receiver and frame alone, not on other
/// receivers. Its angle of incidence is that between the sound and the receiver's axis.
Burst castBurst(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
                std::span<const Sensor> receivers, int frame, double time,
                const UltrasoundOptions& options);

}  // namespace ispace
