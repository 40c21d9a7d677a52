// SPDX-License-Identifier: GPL-3.0-or-later
// Depth frames and pictures, which a SensorReader takes on request. A request keeps the poses of
// its moment, so that the world may go on while another thread takes the frame.
#include <algorithm>
#include <utility>

#include "scene/sensor/sensor.h"
#include "sim/sensor_scheduler.h"
#include "sim/world_state.h"

namespace ispace {

/// Poses of all bodies that pictures show.
struct SensorReader::Stage {
    std::vector<Pose3> poses;  // of Scene::placed
    std::vector<Angle> swings;
};

/// The same stage until a body moves: pictures of one moment share it, and the photographer places
/// bodies once.
std::shared_ptr<const SensorReader::Stage> SensorReader::stage(const Movers& movers) {
    if (!std::exchange(pictures_moved_, false)) return stage_;
    std::vector<Pose3> poses;
    poses.reserve(scene_->placed.size());
    std::size_t person = 0;
    for (const PlacedRecord& placed : scene_->placed) {
        const std::string& keyword = scene_->records[placed.record].keyword();
        Pose3 pose = placed.pose;
        if (sensorKind(keyword) != nullptr) {
            pose = poseOf(scene_->sensors[placed.index], movers);
        } else if (keyword == "robot" || keyword == "human") {
            const Motion& motion =
                keyword == "robot" ? movers.robots[placed.index] : movers.people[person++];
            pose.position.x = motion.pose.position.x;
            pose.position.y = motion.pose.position.y;
            pose.heading = motion.pose.heading;
        } else if (placed.mount) {
            pose = mountedPose(movers.robots[placed.mount->robot].pose,
                               placed.mount->robot_from_sensor);
        }
        poses.push_back(pose);
    }
    stage_ = std::make_shared<const Stage>(
        Stage{std::move(poses), {movers.swings.begin(), movers.swings.end()}});
    return stage_;
}

SensorReading SensorReader::begun(std::size_t sensor, SimTime time, const Movers& movers) const {
    SensorReading reading;
    reading.time = time;
    reading.seq = periods_[sensor].newest(time);
    reading.pose = poseOf(sensors_[sensor], movers);
    return reading;
}

/// Several threads may take pictures; they are taken one after another.
void SensorReader::photograph(const Sensor& camera, const std::shared_ptr<const Stage>& stage,
                              SensorReading& reading) {
    const std::lock_guard lock(photographing_);
    if (photographed_ != stage) photographer_->moveTo(stage->poses, stage->swings);
    photographed_ = stage;
    Photo photo = photographer_->take(camera, reading.pose, frameOf(reading.seq));
    photo.time = seconds(reading.time);
    reading.value = std::move(photo);
}

void SensorReader::captureNow(std::size_t sensor, SimTime time, const Movers& movers) {
    if (isCaptured(sensor, time)) return;
    const Sensor& taken = sensors_[sensor];
    SensorReading reading = begun(sensor, time, movers);
    if (taken.is<Camera>()) {
        photograph(taken, stage(movers), reading);
    } else {
        worlds_->prepareMesh();
        updateBodies(movers);
        readNow(taken, bodies_, reading);
    }
    storeCapture(sensor, std::move(reading));
    // Read in this step like the others.
    latest_.insert(std::upper_bound(latest_.begin(), latest_.end(), sensor), sensor);
}

std::function<SensorReading()> SensorReader::captureLater(std::size_t sensor, SimTime time,
                                                          const Movers& movers) {
    const Sensor& taken = sensors_[sensor];
    const SensorReading begun = this->begun(sensor, time, movers);
    if (taken.is<Camera>())
        return [this, &taken, begun, stage = stage(movers)] {
            SensorReading reading = begun;
            photograph(taken, stage, reading);
            return reading;
        };
    worlds_->prepareMesh();
    updateBodies(movers);
    if (!kept_bodies_) kept_bodies_ = std::make_shared<const MovingBodies>(bodies_);
    return [this, &taken, begun, bodies = kept_bodies_] {
        SensorReading reading = begun;
        readNow(taken, *bodies, reading);
        return reading;
    };
}

void SensorReader::storeCapture(std::size_t sensor, SensorReading reading) {
    due_[sensor] = periods_[sensor].begin(reading.seq + 1);
    readings_[sensor] = std::move(reading);
}

}  // namespace ispace
