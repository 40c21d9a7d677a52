// SPDX-License-Identifier: GPL-3.0-or-later
// Movers that sensors see at one moment: the same regions as those of `coverage`, asked point by
// point with a ray each.
//
//     const DetectionMonitor monitor(scene, {.plane = 1.2});
//     const std::size_t sensors = monitor.seenBy({.place = {2, 1}});
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"
#include "trace/moving_bodies.h"

namespace ispace {

class SurroundedRoom;

/// Sensors beyond a room that see into it through openings.
struct OutsideWatch {
    std::shared_ptr<const SurroundedRoom> room;  ///< with those around it; null: the room alone
    std::vector<Sensor> sensors;                 ///< fixed, with a field of view; in its frame
};

/// Conditions of a detection.
struct WatchOptions {
    double plane = 0;    ///< height at which all sensors but level lasers detect movers
    double density = 0;  ///< pixels a metre that a camera requires; 0: any
    /// Returns the sensors beyond a scene; empty: there are none.
    std::function<OutsideWatch(const Scene&)> outside = {};
};

/// Poses of all movers at a moment; empty spans mean the start.
struct WatchMoment {
    std::span<const Pose2> robots = {};  ///< as Scene::robots
    std::span<const Pose2> people = {};  ///< in the order of the scene
};

/// Counts the sensors that see robots and people.
///
/// A sensor sees a mover if the mover's point on the floor (centre of rotation, middle of a person)
/// lies in the sensor's region as `coverage` defines it: for a laser that scans a slice, in that
/// slice; for a tilted or nodding one the floor that its scans cross; for rangers, cameras and
/// ultrasound, on one plane. Walls and objects block sight, robots and people do not. All
/// ultrasonic receivers count as one sensor, which detects a mover heard by kMinReceivers of them.
/// Sensors mounted on a mover move with it and do not see it.
class DetectionMonitor {
  public:
    /// Prepares the sensors, and the slices and meshes that their rays need. The scene must outlive
    /// it. \throws as RayWorld::ofEnvironment()
    explicit DetectionMonitor(const Scene& scene, const WatchOptions& options = {});
    ~DetectionMonitor();
    DetectionMonitor(DetectionMonitor&&) noexcept;
    DetectionMonitor& operator=(DetectionMonitor&&) noexcept;

    /// Returns the number of sensors; all receivers count as one.
    [[nodiscard]] std::size_t sensors() const;
    /// True if sensors are mounted on movers, so that detections depend on the movers' poses.
    [[nodiscard]] bool rides() const;

    /// A mover to be detected; `owner` as carrierOf() returns it.
    struct Target {
        Point2 place;
        std::uint32_t owner = MovingBodies::kNoOwner;
    };
    /// Returns the number of sensors that see the target now. Thread-safe.
    [[nodiscard]] std::size_t seenBy(const Target& target, const WatchMoment& moment = {}) const;
    /// The same for each target, in parallel: much faster for many than one after another. A ray
    /// for each sensor in whose range and field of view the target lies. Thread-safe.
    [[nodiscard]] std::vector<std::size_t> seenBy(std::span<const Target> targets,
                                                  const WatchMoment& moment = {}) const;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace
