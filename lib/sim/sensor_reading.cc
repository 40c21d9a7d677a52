// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sensor_reading.h"

#include "sensor/kind.h"

namespace ispace {

std::string_view RunSensor::keyword() const {
    if (const Sensor* placed = sensor()) return kindOf(placed->model).keyword;
    return std::holds_alternative<Mat>(what) ? "mat" : "gate";
}

double RunSensor::rate() const {
    if (const auto* laser = model<Laser>()) return laser->rate;
    if (const Sensor* placed = sensor()) return readingRate(placed->model);
    if (const auto* mat = std::get_if<Mat>(&what)) return mat->rate;
    return std::get<Gate>(what).rate;
}

bool RunSensor::isHeavy() const { return model<Ranger>() != nullptr || model<Camera>() != nullptr; }

Pose3 RunSensor::floorPose() const {
    const auto* mat = std::get_if<Mat>(&what);
    const Pose2& pose = mat != nullptr ? mat->pose : std::get<Gate>(what).pose;
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

bool RunSensor::isOn(std::size_t robot) const {
    return sensor() != nullptr && sensor()->mount && sensor()->mount->robot == robot;
}

}  // namespace ispace
