// SPDX-License-Identifier: GPL-3.0-or-later
// What topics show of a room besides its movers and sensors.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "sense/formats/ros_messages.h"

namespace ispace::ros {

class RosSource;

/// Data about the room for clients of ROS topics, computed in background threads.
struct RosScenery {
    std::function<RosGrid(const Scene& scene)> map = {};       ///< null: there is no map
    std::function<std::string(const Scene& scene)> room = {};  ///< a mesh as GLB; null: none
    /// Describes a robot and the sensors on it in URDF; null: none does. \param frame of the
    /// robot \param wheels frames of its left and right one, "" without \param sensors frames of
    /// all sensors, "" without
    std::function<std::string(const Scene& scene, std::size_t robot, const std::string& frame,
                              std::span<const std::string> wheels,
                              std::span<const std::string> sensors)>
        robot_model = {};
    /// Id of the robot whose topics have names without a prefix, too; "": the only one.
    std::string robot = {};
    std::vector<std::shared_ptr<RosSource>> sources = {};  ///< of further topics
};

/// Returns the topics by which Open-RMF runs lifts, doors and fleets, see ispace-ros(7).
std::shared_ptr<RosSource> rmfTopics();

}  // namespace ispace::ros
