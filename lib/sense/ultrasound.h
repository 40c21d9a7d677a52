// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "scene/sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

/// Speed of sound in dry air in m/s: 331.3 + 0.606 T for T degrees Celsius.
double speedOfSound(double celsius);

/// One receiver's measurement of one burst.
struct TimeOfFlight {
    std::size_t receiver = 0;  ///< index of those given
    double time = 0;           ///< seconds
    double distance = 0;       ///< metres: time times the speed of sound
};

/// A position computed from distances by least squares.
struct PositionFix {
    Point3 position;
    double residual = 0;  ///< root mean square of measured less computed distances, metres
    /// Dilution of precision: the factor from the error of a distance to that of the position, in
    /// space, horizontally and vertically; sqrt of the trace of (J^T J)^-1 and of its parts. If the
    /// distances leave two positions (mirror images), the square of the distance between the two
    /// over the difference of their distances is added: +infinity if those do not differ.
    double pdop = 0, hdop = 0, vdop = 0;
};

/// What is known from one receiver that heard a burst.
struct Hearing {
    Point3 place;         ///< of the receiver
    Vec3 axis;            ///< of the cone in which it hears, of unit length
    Angle fov;            ///< full angle of the cone
    double distance = 0;  ///< measured
    double error = 0;     ///< standard deviation of that; 0: exact
};

/// The place whose distances to the receivers fit best: Gauss-Newton (Levenberg-Marquardt) from the
/// linear solution, on each side of the plane that fits the receivers best. Receivers near one
/// plane (a ceiling) leave two mirror images. Of the two places
/// - one that lies outside of a receiver's cone, by more than five times its own error, is none;
/// - one that fits clearly worse, by more than five standard deviations, is none;
/// - one within all cones goes before one that is not;
/// - and if both are, that on the side to which the axes of the receivers point on average is
///   taken, and the dilution of precision tells that there is another.
///
/// Nothing with fewer than kMinReceivers, if they do not determine a place (all in one line), if no
/// place is left, or if two are and the axes point along the plane. Across the plane of the
/// receivers the dilution of precision of a place in it is unbounded and may be +infinity. \pre
/// distances are finite
std::optional<PositionFix> locate(std::span<const Hearing> heard);

/// One burst of a tag.
struct Burst {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;                       ///< the tag's true one
    std::vector<TimeOfFlight> heard;  ///< in the order of receivers
    std::optional<PositionFix> fix;   ///< of a tag located by times of flight
    std::optional<Point2> simple;     ///< of one located by the simple model
};

struct UltrasoundOptions {
    double celsius = 20;
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// Simulates a burst of a tag and locates the tag from it. A receiver hears a tag within its range
/// (ends included, as float32), its cone and the tag's cone if neither the mesh nor a moving body
/// is in between; robots that carry the two do not count. \pre `environment` is a mesh, not a slice
///
/// Noise does not change who hears, except for drop-outs: a distance measured beyond the range
/// becomes its limit. It depends on seed, tag, receiver and frame alone, not on other receivers.
/// Its angle of incidence is that between the sound and the receiver's axis.
Burst castBurst(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
                std::span<const Sensor> receivers, int frame, double time,
                const UltrasoundOptions& options);

}  // namespace ispace
