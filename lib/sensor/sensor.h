// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sensor: the kinds of sensors, each a row and a source: keyword, keys, parameters, body, field
// of view. Uses env and below.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "sensor/camera.h"
#include "sensor/laser.h"
#include "sensor/ranger.h"
#include "sensor/ultrasound.h"

namespace ispace {

/// Parameters of a sensor of any simulated kind. Code tells kinds apart here, in their own sources
/// and where readings differ by nature, nowhere else.
using SensorModel = std::variant<Laser, Ranger, Receiver, Tag, Camera>;

/// What carries a sensor that moves.
struct Mount {
    std::size_t robot = 0;    ///< index in Scene::robots
    Pose3 robot_from_sensor;  ///< z counts from the floor, as the robot's frame lies there
};

/// A placed sensor; one on a robot or a person is where that starts.
struct Sensor {
    std::string id;
    SensorModel model;
    Pose3 pose;
    std::optional<Mount> mount = {};
    std::optional<std::size_t> person = {};  ///< who carries it: index among the scene's people

    template <typename Model>
    [[nodiscard]] bool is() const {
        return std::holds_alternative<Model>(model);
    }
    /// \pre is<Model>()
    template <typename Model>
    [[nodiscard]] const Model& as() const {
        return std::get<Model>(model);
    }
    template <typename Model>
    [[nodiscard]] Model& as() {
        return std::get<Model>(model);
    }
};

/// Name of the device, "" for a bare sensor.
const std::string& deviceName(const SensorModel& model);
/// Greatest distance at which it sees or hears, metres; +infinity for a tag.
double maxRange(const SensorModel& model);
/// Readings a second: of a swept laser, whole sweeps.
double readingRate(const SensorModel& model);
/// Duration of one reading in seconds; 0 if everything is measured at once.
double readingTime(const SensorModel& model);
/// Rays of one reading, roughly: what it costs to simulate.
std::size_t raysOf(const SensorModel& model);
/// True if, mounted with this tilt and roll, it sees the same whatever its heading.
bool looksAround(const SensorModel& model, const Pose3& mount);

/// What it perceives if nothing is in the way; nothing for lasers, which scan a plane, and for
/// tags.
std::optional<FieldOfView> fieldOfView(const Sensor& sensor);

/// The pose that a sensor's record gives: 0,0 without `at`, kScanHeight without z. With `on` it is
/// a pose in the frame of the carrier.
Pose3 poseOf(const Record& record);

/// World pose of a sensor on a robot, with its heading in (-180, 180].
Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor);

}  // namespace ispace
