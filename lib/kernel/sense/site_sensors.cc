// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/site_sensors.h"

#include <algorithm>

#include "base/error.h"
#include "scene/sensor/sensor.h"

namespace ispace {

std::size_t roomOf(std::span<const SensorRoom> rooms, std::size_t sensor) {
    const auto found = std::upper_bound(
        rooms.begin(), rooms.end(), sensor,
        [](std::size_t index, const SensorRoom& room) { return index < room.read_end; });
    return static_cast<std::size_t>(found - rooms.begin());
}

std::span<const Sensor> receiversIn(std::span<const SensorRoom> rooms, std::size_t room,
                                    const Sensors& sensors) {
    if (rooms.empty()) return sensors.receivers;
    const std::size_t begin = room == 0 ? 0 : rooms[room - 1].receivers_end;
    return std::span(sensors.receivers).subspan(begin, rooms[room].receivers_end - begin);
}

namespace {

/// A room, and the text before the ids of its sensors.
struct NamedScene {
    const Scene* scene = nullptr;
    std::string prefix = {};
};

bool isRead(const Record& record) {
    const SensorKind* kind = sensorKind(record.keyword());
    return kind != nullptr && kind->is_read;
}

void checkGlobs(std::span<const NamedScene> rooms, const std::vector<std::string>& globs) {
    for (const std::string& glob : globs) {
        bool known = false;
        std::string ids;
        for (const auto& [scene, prefix] : rooms)
            for (std::size_t i = 0; i < scene->records.size(); ++i) {
                if (!isRead(scene->records[i])) continue;
                known = known || isSelected(prefix + scene->ids[i], {glob});
                ids.append(ids.empty() ? "" : ", ").append(prefix).append(scene->ids[i]);
            }
        if (!known)
            throw UsageError("no sensor matches `" + glob + "`" +
                             (ids.empty() ? "" : " (there are " + ids + ")"));
    }
}

/// Appends the sensors of a room.
void addSensors(const NamedScene& room, const std::vector<std::string>& globs, Sensors& sensors) {
    const std::size_t first = sensors.receivers.size();
    const auto add = [&](const Sensor& sensor) {
        std::vector<Sensor>& list = sensor.is<Receiver>() ? sensors.receivers : sensors.read;
        list.push_back(sensor);
        list.back().id.insert(0, room.prefix);
        list.back().room = room.prefix.size();
    };
    for (const Sensor& sensor : room.scene->sensors)
        if (kindOf(sensor.model).is_read && isSelected(room.prefix + sensor.id, globs)) add(sensor);
    // Globs that match only tags do not select receivers.
    if (sensors.receivers.size() > first) return;
    for (const Sensor& sensor : room.scene->sensors)
        if (sensor.is<Receiver>()) add(sensor);
}

}  // namespace

Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs) {
    const NamedScene room{&scene};
    checkGlobs({&room, 1}, globs);
    Sensors sensors;
    addSensors(room, globs, sensors);
    return sensors;
}

SiteSensors sensorsOf(std::span<const std::shared_ptr<const Scene>> scenes,
                      std::span<const std::string> ids, const std::vector<std::string>& globs) {
    std::vector<NamedScene> named;
    named.reserve(scenes.size());
    for (std::size_t i = 0; i < scenes.size(); ++i)
        named.push_back({scenes[i].get(), ids[i].empty() ? "" : ids[i] + '/'});
    checkGlobs(named, globs);
    SiteSensors all;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        addSensors(named[i], globs, all.sensors);
        all.rooms.push_back(
            {ids[i], scenes[i].get(), all.sensors.read.size(), all.sensors.receivers.size()});
    }
    return all;
}

Pose3 toInner(const Pose3& outer_from_inner, const Pose3& pose) {
    const Vec3 local = Frame3(outer_from_inner).toLocal(pose.position);
    return {
        {local.x, local.y, local.z}, pose.heading - outer_from_inner.heading, pose.tilt, pose.roll};
}

Pose3 toOuter(const Pose3& outer_from_inner, const Pose3& pose) {
    const Vec3 own{pose.position.x, pose.position.y, pose.position.z};
    return {outer_from_inner.position + Frame3(outer_from_inner) * own,
            pose.heading + outer_from_inner.heading, pose.tilt, pose.roll};
}

}  // namespace ispace
