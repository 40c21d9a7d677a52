// SPDX-License-Identifier: GPL-3.0-or-later
// The sensors of several rooms in one run.
//
// Sensors of all rooms are numbered one room after another, so that formats and runs know one list;
// SensorRoom tells where a room's part ends.
//
//     const SiteSensors site = sensorsOf(scenes, ids, {"ground/l*"});
//     const std::size_t room = roomOf(site.rooms, 3);  // of site.sensors.read[3]
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "scene/scene.h"
#include "sense/selection.h"

namespace ispace {

/// A room, whose sensors follow those of the room before it in Sensors.
struct SensorRoom {
    std::string id;                               ///< of its frame; "" of a room alone
    const Scene* scene = nullptr;                 ///< by itself
    std::size_t read_end = 0, receivers_end = 0;  ///< of its sensors in both lists
    /// Its frame in that of the site, level, if all readings share that; empty: readings have the
    /// frame of their room.
    std::optional<Pose3> site_from_room = {};
};

/// Returns the index of a sensor's room; 0 without rooms. O(log rooms)
std::size_t roomOf(std::span<const SensorRoom> rooms, std::size_t sensor);
/// Returns the receivers in a room; all without rooms.
std::span<const Sensor> receiversIn(std::span<const SensorRoom> rooms, std::size_t room,
                                    const Sensors& sensors);

/// The sensors of several rooms as one list, and the rooms.
struct SiteSensors {
    Sensors sensors;
    std::vector<SensorRoom> rooms;  ///< at least one
};

/// Returns sensorsOf() each room. \param ids of the rooms, which stand before those of the sensors:
/// "ground/l1"; "" of a room alone \throws UsageError for a glob that matches no sensor of any room
/// \pre the result holds pointers to the scenes
SiteSensors sensorsOf(std::span<const std::shared_ptr<const Scene>> scenes,
                      std::span<const std::string> ids, const std::vector<std::string>& globs);

/// Converts a pose of the outer frame to an inner one. Headings are differences of degrees, not
/// reduced to a turn. \param outer_from_inner level
Pose3 toInner(const Pose3& outer_from_inner, const Pose3& pose);
/// Converts a pose of an inner frame to the outer one.
Pose3 toOuter(const Pose3& outer_from_inner, const Pose3& pose);

}  // namespace ispace
