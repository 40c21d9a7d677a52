// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/arranged_sensor.h"

namespace ispace {

std::vector<ArrangedSensor> arrangedSensors(const Scene& scene,
                                            const std::vector<SensorGroup>& groups,
                                            const std::vector<SensorClass>& kinds,
                                            const std::vector<std::vector<Pose3>>& places) {
    std::vector<std::size_t> used(kinds.size());
    std::vector<ArrangedSensor> sensors;
    std::vector<Record> records = scene.records;
    std::vector<std::size_t> added;  // sensors without an id
    for (std::size_t g = 0; g < groups.size(); ++g) {
        const std::size_t kind = kindOf(kinds, g);
        for (int i = 0; i < groups[g].most && used[kind] < places[kind].size(); ++i) {
            sensors.push_back({g, groups[g].id, places[kind][used[kind]++]});
            if (groups[g].is_pending) continue;
            records.push_back(groups[g].record);
            added.push_back(sensors.size() - 1);
        }
    }
    const std::vector<std::string> ids = assignIds(records);
    for (std::size_t i = 0; i < added.size(); ++i)
        sensors[added[i]].id = ids[scene.records.size() + i];
    return sensors;
}

Record placedRecord(const SensorGroup& group, const ArrangedSensor& sensor) {
    Record record = group.record;
    const Point3& p = sensor.pose.position;
    record.set("id", Value(sensor.id));
    record.set("at", Value(Tuple{p.x, p.y, p.z}));
    record.set("heading", Value(sensor.pose.heading.degrees()));
    if (!(record.angle("tilt") == sensor.pose.tilt))
        record.set("tilt", Value(sensor.pose.tilt.degrees()));
    return record;
}

Scene withArranged(const Scene& scene, const std::vector<SensorGroup>& groups,
                   const std::vector<ArrangedSensor>& sensors) {
    Scene whole = scene;
    for (const auto& [group, id, pose] : sensors)
        whole.sensors.push_back({id, groups[group].model, pose});
    return whole;
}

}  // namespace ispace
