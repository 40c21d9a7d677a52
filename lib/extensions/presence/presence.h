// SPDX-License-Identifier: GPL-3.0-or-later
// Presence: the share of people's ways on which sensors of motion detect them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/cell_set.h"
#include "extensions/presence/people_paths.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace::presence {

/// A person counts as detected on a piece of way if a sensor detects the person at its beginning or
/// within this time after it, seconds.
constexpr double kPresenceDelay = 1;

/// The ways of people, as sensors of motion see them.
///
/// A sensor detects a person at the beginning of a piece if that point, on a level plane, lies in
/// its region as `coverage` defines it and the piece's velocity is one that its kind detects. No
/// noise; people do not hide each other. Sensors on movers detect no people.
class PresenceView {
  public:
    /// Stores the reference.
    PresenceView(const PeoplePaths& ways, double plane);

    [[nodiscard]] const PeoplePaths& ways() const { return ways_; }
    /// Finds the pieces in range whose beginnings no surface hides from a sensor's position: 1 for
    /// each of them. O(pieces + pieces in range * ray) \param mesh surfaces that stop its rays
    [[nodiscard]] std::vector<std::uint8_t> unhidden(const RayWorld& mesh,
                                                     const Sensor& sensor) const;
    /// Computes the pieces on which a sensor there detects the person within kPresenceDelay, by
    /// index. O(pieces)
    /// \pre detectsMotion(sensor.model), and `unhidden` is that of its position
    [[nodiscard]] CellSet detected(const Sensor& sensor,
                                   const std::vector<std::uint8_t>& unhidden) const;
    /// Likewise for any sensor of a scene; empty unless it detects motion and stands outside
    /// solids. \pre worlds has the mesh for the sensor's kind
    [[nodiscard]] CellSet detected(const Sensor& sensor, const RayScenes& worlds) const;

  private:
    const PeoplePaths& ways_;
    std::vector<Point3> places_;       // of the pieces, on the plane
    std::vector<std::size_t> firsts_;  // pieces by person
};

/// How a person, or all together, were detected.
struct PresenceFigures {
    std::string id = {};     ///< "" for all together
    double length = 0;       ///< of the way, metres
    double share = 0;        ///< of it, detected within kPresenceDelay; 0 without a way
    double longest_gap = 0;  ///< metres of way in one go on which the person is not detected
};

/// The part of one sensor.
struct SensorPresence {
    std::string id;
    double share = 0;     ///< of the ways that it detects alone, were it the only one
    double marginal = 0;  ///< of the ways that no other sensor detects
};

struct Presence {
    std::vector<PresenceFigures> people;
    PresenceFigures all;
    std::vector<SensorPresence> sensors;  ///< those that detect motion, in order
};

/// Measures the presence that the sensors of a scene report. Doors and furniture are those of the
/// scene. O(pieces * sensors); deterministic for any number of threads.
Presence measurePresence(const Scene& scene, const PeoplePaths& ways, double plane);

}  // namespace ispace::presence
