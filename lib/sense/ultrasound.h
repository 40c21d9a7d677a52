// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sensor/sensor.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

/// Metres a second in dry air: 331.3 + 0.606 T for T degrees Celsius.
double speedOfSound(double celsius);

/// One receiver's measurement of one burst.
struct TimeOfFlight {
    std::size_t receiver = 0;  ///< index of those given
    double time = 0;           ///< seconds
    double distance = 0;       ///< metres: time times the speed of sound
};

/// A place from distances, by least squares.
struct Fix {
    Point3 position;
    double residual = 0;  ///< root mean square of measured less computed distances, metres
    /// Dilution of precision: how many times the error of a distance becomes that of the place, in
    /// space, across the floor and upright; sqrt of the trace of (J^T J)^-1 and of its parts. Where
    /// the distances leave two places (mirror images), with the way to the other one over what
    /// distances to the two differ by, squared and added: +infinity where they do not differ.
    double pdop = 0, hdop = 0, vdop = 0;
};

/// What a receiver knows that heard a burst.
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
/// Nothing with fewer than kMinReceivers, where they do not fix a place (in one line), where no
/// place is left, or where two are and the axes point along the plane. A place in the plane of the
/// receivers has a dilution of precision beyond all bounds across that plane, which may be
/// +infinity. \pre distances are finite
std::optional<Fix> locate(std::span<const Hearing> heard);

/// One burst of a tag.
struct Burst {
    double time = 0;  ///< seconds
    int frame = 0;
    Pose3 pose;                       ///< the tag's true one
    std::vector<TimeOfFlight> heard;  ///< in the order of receivers; whatever locates the tag
    std::optional<Fix> fix;           ///< of a tag located by times of flight
    std::optional<Point2> simple;     ///< of one located by the simple model
};

struct UltrasoundOptions {
    double celsius = 20;
    std::optional<std::uint64_t> noise_seed = {};  ///< empty: no noise
};

/// What is heard of a tag's burst, and where that puts it. A receiver hears a tag within its range
/// (ends included, as float32) and its cone and the tag's cone, in sight of it: neither the mesh
/// nor a moving body is between them but those of the robots that carry the two. `environment` is
/// that of the mesh.
///
/// Noise changes nothing about who hears, but for drop-outs: what is measured beyond the range is
/// given as its limit. Noise of a distance depends on seed, tag, receiver and frame alone, not on
/// what else hears; the angle that incidence is about is that between the sound and the receiver's
/// axis.
Burst castBurst(const RayWorld& environment, const MovingBodies& bodies, const Sensor& tag,
                std::span<const Sensor> receivers, int frame, double time,
                const UltrasoundOptions& options);

}  // namespace ispace
