// SPDX-License-Identifier: GPL-3.0-or-later
// lib/sensor: kinds of sensors, a row and a source each: keyword, keys, figures, body, field of
// view. Uses env and below.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "sensor/laser.h"
#include "sensor/ranger.h"
#include "sensor/ultrasound.h"

namespace ispace {

/// The figures of a sensor of any kind that is simulated. A kind is told apart here, in its own
/// source and where readings differ by nature, nowhere else.
using SensorModel = std::variant<Laser, Ranger, Receiver, Tag>;

/// What carries a sensor that moves.
struct Mount {
    std::size_t robot = 0;    ///< index in Scene::robots
    Pose3 robot_from_sensor;  ///< z counts from the floor, as the robot's frame lies there
};

/// A sensor at its place; one on a robot where the robot starts.
struct Sensor {
    std::string id;
    SensorModel model;
    Pose3 pose;
    std::optional<Mount> mount = {};

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
/// How long one reading takes, in seconds; 0 for all at once.
double readingTime(const SensorModel& model);
/// Rays of one reading, roughly: what it costs to simulate.
std::size_t raysOf(const SensorModel& model);
/// True if turning about the vertical changes nothing of what it sees, mounted with this tilt and
/// roll.
bool looksAround(const SensorModel& model, const Pose3& mount);

/// All that it perceives if nothing stands in its way; nothing for what scans a plane (lasers) and
/// for tags.
std::optional<FieldOfView> fieldOfView(const Sensor& sensor);

/// Pose that the record of a sensor writes; without `at` at 0,0, without z at kScanHeight. With
/// `on` it is a pose in the frame of what carries the sensor.
Pose3 poseOf(const Record& record);

/// World pose of a sensor on a robot, its heading within (-180, 180].
Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor);

}  // namespace ispace
