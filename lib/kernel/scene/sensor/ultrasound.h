// SPDX-License-Identifier: GPL-3.0-or-later
// Ultrasonic receivers and the tags that they hear: parameters, and the cone of hearing.
// sense/ultrasound_burst.h simulates their bursts, sense/locate.h computes positions from them.
//
//     const Receiver receiver = withParameters(Receiver(), record);
//     const bool hears = fieldOfView(receiver, pose).holds({2, 1, 0.8});
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "geom/pose.h"
#include "record/record.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

struct SensorKind;

/// Receivers needed to locate a tag (thesis 3.4.3): floor is covered where this many hear.
constexpr std::size_t kMinReceivers = 4;

/// An ultrasonic receiver: hears a tag within its range and the cone about its axis, in line of
/// sight.
struct Receiver {
    std::string model;  ///< "" for the bare receiver
    double min_range = 0, max_range = 8;
    Angle fov = Angle::degrees(120);  ///< full angle of the cone
    double rate = 10;                 ///< measurements a second
    RangeNoise noise;                 ///< of the distance computed from the time of flight

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 1; }
    [[nodiscard]] bool isNoisy() const { return !noise.isNone(); }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& mount);
    static const SensorKind kKind;
    friend bool operator==(const Receiver&, const Receiver&) = default;
};

/// An ultrasonic emitter.
struct Tag {
    std::string model;                ///< "" for the bare tag
    double rate = 10;                 ///< bursts a second
    Angle fov = Angle::degrees(360);  ///< full angle of the cone into which it emits
    /// If true, a position fix by the thesis' simple model, eq. (3.7)-(3.10): the true x and y with
    /// independent noise of this standard deviation. Else from times of flight.
    bool is_simple = false;
    double simple_sigma = 0.1;

    /// Receivers have a range; a tag's is unlimited.
    double max_range = std::numeric_limits<double>::infinity();

    [[nodiscard]] double readingRate() const { return rate; }
    [[nodiscard]] static double readingTime() { return 0; }
    [[nodiscard]] static std::size_t rays() { return 64; }  ///< one for each of some receivers
    [[nodiscard]] bool isNoisy() const { return is_simple; }
    [[nodiscard]] static bool isOmnidirectional(const Pose3& /*mount*/) { return false; }
    static const SensorKind kKind;
    friend bool operator==(const Tag&, const Tag&) = default;
};

/// Returns `base` with the parameters that an `ultrasound` record writes; the model stays. \throws
/// FormatError with all findings
Receiver withParameters(Receiver base, const Record& record);
/// The same for a `tag` record.
Tag withParameters(Tag base, const Record& record);

/// Returns the cone of hearing at a pose, without occlusion.
FieldOfView fieldOfView(const Receiver& receiver, const Pose3& pose);

}  // namespace ispace
