// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// What counts as seen.
struct WatchOptions {
    double plane = 0;    ///< height at which rangers, cameras and ultrasound look for somebody
    double density = 0;  ///< pixels a metre that a camera needs; 0: any
};

/// Where everybody is at a moment. What is not given is where it starts.
struct WatchMoment {
    std::span<const Pose2> robots = {};  ///< as Scene::robots
    std::span<const Pose2> people = {};  ///< in the order of the scene
};

/// Which sensors see robots and people.
///
/// Somebody is seen by a sensor if its place on the floor (centre of rotation, middle of a person)
/// lies in what `coverage` calls the region of the sensor: for a laser that scans a slice, in that
/// slice; for a tilted or nodding one where its scans pass over the floor; for rangers, cameras and
/// ultrasound on one plane. Walls and things hide, robots and people do not. All ultrasonic
/// receivers count as one sensor, which sees where kMinReceivers of them hear. Sensors that ride on
/// a robot or a person are taken where that is, and do not see their carrier.
class DetectionMonitor {
  public:
    /// The scene must outlive it.
    explicit DetectionMonitor(const Scene& scene, const WatchOptions& options = {});
    ~DetectionMonitor();
    DetectionMonitor(DetectionMonitor&&) noexcept;
    DetectionMonitor& operator=(DetectionMonitor&&) noexcept;

    /// How many sensors could see somebody: all receivers count as one.
    [[nodiscard]] std::size_t sensors() const;
    /// True if some ride on robots or people, so that what is seen changes with those.
    [[nodiscard]] bool rides() const;

    /// Somebody; `owner` as carrierOf() names it.
    struct Target {
        Point2 place;
        std::uint32_t owner = MovingBodies::kNoOwner;
    };
    /// By how many sensors this target is seen now. Thread-safe.
    [[nodiscard]] std::size_t seenBy(const Target& target, const WatchMoment& moment = {}) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
