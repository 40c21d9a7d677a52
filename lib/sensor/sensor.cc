// SPDX-License-Identifier: GPL-3.0-or-later
#include "sensor/sensor.h"

#include "env/environment.h"

namespace ispace {

const std::string& deviceName(const SensorModel& model) {
    return std::visit([](const auto& one) -> const std::string& { return one.model; }, model);
}

double maxRange(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.max_range; }, model);
}

double readingRate(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.readingRate(); }, model);
}

double readingTime(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.readingTime(); }, model);
}

std::size_t raysOf(const SensorModel& model) {
    return std::visit([](const auto& one) { return one.rays(); }, model);
}

bool looksAround(const SensorModel& model, const Pose3& mount) {
    return std::visit([&](const auto& one) { return one.looksAround(mount); }, model);
}

std::optional<FieldOfView> fieldOfView(const Sensor& sensor) {
    if (sensor.is<Ranger>()) return fieldOfView(sensor.as<Ranger>(), sensor.pose);
    if (sensor.is<Camera>()) return fieldOfView(sensor.as<Camera>(), sensor.pose);
    if (sensor.is<Receiver>()) return fieldOfView(sensor.as<Receiver>(), sensor.pose);
    return std::nullopt;
}

Pose3 poseOf(const Record& record) {
    const bool placed = record.has("at");
    const Tuple at = placed ? record.tuple("at") : Tuple{0, 0};
    return {{at[0], at[1], at.size() > 2 ? at[2] : kScanHeight},
            record.angle("heading"),
            record.angle("tilt"),
            record.angle("roll")};
}

Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor) {
    const Point2 place = world_from_robot * robot_from_sensor.position.onFloor();
    // Adding 0 makes -0 plain 0.
    const Angle heading = wrapped(world_from_robot.heading + robot_from_sensor.heading) + Angle();
    return {{place.x, place.y, robot_from_sensor.position.z},
            heading,
            robot_from_sensor.tilt,
            robot_from_sensor.roll};
}

}  // namespace ispace
