// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/change.h"

#include <string>
#include <unordered_map>
#include <vector>

#include "layout/movement.h"
#include "record/record.h"
#include "sensor/kind.h"
#include "sensor/sensor.h"

namespace ispace {

namespace {

bool isMover(const Record& record) {
    return record.keyword() == "robot" || record.keyword() == "human";
}

bool isPlaced(const Record& record) { return record.schema().type == RecordType::Placement; }

/// True if what says where it is and where it faces is the same in both.
bool sameStart(const Record& a, const Record& b) {
    if (a.keyword() != b.keyword()) return false;
    for (const KeySpec& key : a.schema().keys) {
        if (key.role != Role::Place && key.role != Role::Heading) continue;
        const Value* const of_a = a.find(key.name);
        const Value* const of_b = b.find(key.name);
        if ((of_a == nullptr) != (of_b == nullptr)) return false;
        if (of_a != nullptr && *of_a != *of_b) return false;
    }
    return true;
}

}  // namespace

std::unordered_set<std::string_view> stayersOf(const Scene& before, const Scene& next) {
    std::unordered_map<std::string_view, std::size_t> records;
    for (std::size_t i = 0; i < before.records.size(); ++i)
        if (isPlaced(before.records[i])) records.emplace(before.ids[i], i);
    std::unordered_set<std::string_view> stayers;
    for (std::size_t i = 0; i < next.records.size(); ++i) {
        if (!isPlaced(next.records[i])) continue;
        const auto old = records.find(next.ids[i]);
        if (old == records.end()) continue;
        const Record& was = before.records[old->second];
        const Record& is = next.records[i];
        if (isMover(is) ? sameStart(was, is) : was == is) stayers.insert(old->first);
    }
    return stayers;
}

void keepInPlace(Scene& next, const std::unordered_set<std::string_view>& stayers,
                 const std::unordered_map<std::string_view, Pose2>& places) {
    std::vector<Pose2> people_before, people;
    for (Placed& placed : next.placed) {
        const Record& record = next.records[placed.record];
        if (!isMover(record)) continue;
        const std::string& id = next.ids[placed.record];
        const bool is_robot = record.keyword() == "robot";
        Pose2& start = is_robot ? next.robots[placed.index].pose : next.people[placed.index].pose;
        const Pose2 pose = stayers.contains(id) ? places.at(id) : start;
        placed.pose.position = {pose.position.x, pose.position.y, 0};
        placed.pose.heading = pose.heading;
        if (!is_robot) {
            people_before.push_back(start);
            people.push_back(pose);
        }
        start = pose;
    }
    for (Placed& placed : next.placed) {
        if (sensorKind(next.records[placed.record].keyword()) == nullptr) continue;
        Sensor& sensor = next.sensors[placed.index];
        if (sensor.mount)
            sensor.pose =
                mountedPose(next.robots[sensor.mount->robot].pose, sensor.mount->robot_from_sensor);
        else if (sensor.person)
            sensor.pose = mountedPose(people[*sensor.person],
                                      poseOn(people_before[*sensor.person], sensor.pose));
        placed.pose = sensor.pose;
    }
}

}  // namespace ispace
