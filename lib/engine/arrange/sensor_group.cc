// SPDX-License-Identifier: GPL-3.0-or-later
// Groups, classes and placements of sensors: bookkeeping between records and the search. A sensor
// keeps its id when it is placed anew; new ones get the next free ids of their rooms.
#include "arrange/sensor_group.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "record/edit.h"

namespace ispace {

namespace {

bool isArranged(const Record& record) {
    const SensorKind* kind = sensorKind(record.keyword());
    return kind != nullptr && kind->is_arranged;
}

SensorModel modelFor(const Record& record, const DeviceCatalogue& devices) {
    try {
        return sensorModelOf(record, devices);
    } catch (const FormatError& error) {
        // An error in the parameters of --sensor is a usage error.
        throw UsageError("--sensor: " + error.diagnostics().front().message);
    }
}

/// Finds the record with this id.
/// \pre a record of a room or an added one has the id
const Record& holderOf(const std::string& id, RoomScenes rooms, std::span<const SensorSpec> added) {
    for (const Scene* const scene : rooms) {
        const auto found = std::find(scene->ids.begin(), scene->ids.end(), id);
        if (found != scene->ids.end())
            return scene->records.at(static_cast<std::size_t>(found - scene->ids.begin()));
    }
    const auto is_holder = [&id](const SensorSpec& spec) { return spec.record.writtenId() == id; };
    return std::find_if(added.begin(), added.end(), is_holder)->record;
}

}  // namespace

std::vector<SensorGroup> groupsToPlace(RoomScenes rooms, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open) {
    std::vector<SensorGroup> groups;
    std::set<std::string> taken;
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        for (const PendingSensor& sensor : rooms[room]->pending) {
            groups.push_back({sensor.record, sensor.model, sensor.id, true, 1});
            if (rooms.size() > 1) groups.back().room = room;
        }
        taken.insert(rooms[room]->ids.begin(), rooms[room]->ids.end());
    }
    for (const auto& [record, count] : added) {
        for (const char* key : {"at", "heading", "on"})
            if (record.has(key))
                throw UsageError("a sensor to be arranged has no place yet: leave out `" +
                                 std::string(key) + '`');
        const std::string id = record.writtenId();
        if (!id.empty() && !taken.insert(id).second)
            throw UsageError(takenText(id, holderOf(id, rooms, added)));
        const int most = count.value_or(open && id.empty() ? kMaxOpen : 1);
        groups.push_back({record, modelFor(record, devices), id, false, most});
    }
    return groups;
}

std::vector<SensorGroup> groupsToPlace(const Scene& scene, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open) {
    const Scene* const room = &scene;
    return groupsToPlace(RoomScenes(&room, 1), added, devices, open);
}

Document withoutPlaces(const Document& layout, std::span<const std::string> fixed) {
    Document freed = layout;
    const std::vector<std::string> ids = assignIds(freed.records);
    std::vector<bool> is_used(fixed.size());
    const std::vector<Glob> globs(fixed.begin(), fixed.end());
    for (std::size_t i = 0; i < freed.records.size(); ++i) {
        Record& record = freed.records[i];
        const bool rides = record.has("on");
        if (!isArranged(record) || (!record.has("at") && !rides)) continue;
        bool stays = rides;
        for (std::size_t k = 0; k < fixed.size(); ++k) {
            if (!globs[k].matches(ids[i])) continue;
            is_used[k] = true;
            stays = true;
        }
        if (stays) continue;
        // A sensor keeps its id.
        if (record.writtenId().empty()) record.set("id", Value(ids[i]));
        record.erase("at");
        record.erase("heading");
    }
    for (std::size_t k = 0; k < fixed.size(); ++k)
        if (!is_used[k])
            throw UsageError("--fixed: no sensor of LAYOUT with a place has the id `" + fixed[k] +
                             '`');
    return freed;
}

namespace {

/// Names a kind by its first sensor. Kinds of the same name differ in parameters: a number tells
/// them apart.
std::string kindName(const SensorGroup& group, const std::vector<SensorClass>& kinds) {
    if (!group.id.empty()) return group.id;
    const std::string name =
        group.record.has("model") ? group.record.text("model") : group.record.keyword();
    const auto alike = std::count_if(kinds.begin(), kinds.end(), [&name](const SensorClass& kind) {
        return kind.id == name || kind.id.starts_with(name + '.');
    });
    return alike > 0 ? name + '.' + std::to_string(alike + 1) : name;
}

}  // namespace

std::vector<SensorClass> kindsOf(const std::vector<SensorGroup>& groups, bool apart) {
    std::vector<SensorClass> kinds;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        const SensorGroup& group = groups[i];
        const double cost = group.record.number("cost");
        const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const SensorClass& kind) {
            return !apart && kind.model == group.model && kind.whole == group.whole &&
                   kind.room == group.room && kind.cost == cost &&
                   kind.record.angle("tilt") == group.record.angle("tilt") &&
                   kind.record.angle("roll") == group.record.angle("roll");
        });
        if (same != kinds.end()) {
            same->most += group.most;
            same->groups.push_back(i);
            continue;
        }
        for (int n = 0; n < (apart ? group.most : 1); ++n)
            kinds.push_back({group.model,
                             group.record,
                             kindName(group, kinds),
                             cost,
                             apart ? 1 : group.most,
                             {i},
                             group.whole,
                             group.room});
    }
    return kinds;
}

std::vector<Placement> sensorsToPlace(const std::vector<SensorGroup>& groups,
                                      const std::vector<SensorClass>& kinds) {
    std::vector<Placement> sensors;
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (std::size_t k = 0; k < kinds.size(); ++k)
            if (std::binary_search(kinds[k].groups.begin(), kinds[k].groups.end(), g))
                for (int n = 0; n < std::min(kinds[k].most, groups[g].most); ++n)
                    sensors.push_back({g, k});
    return sensors;
}

std::vector<Placement> placementsOf(RoomScenes rooms, const std::vector<SensorGroup>& groups,
                                    const std::vector<SensorClass>& kinds,
                                    const std::vector<std::vector<RoomPose>>& poses) {
    std::vector<std::size_t> used(kinds.size());
    std::vector<Placement> placements;
    std::vector<std::vector<Record>> records;                   // by room
    std::vector<std::vector<std::size_t>> added(rooms.size());  // sensors without an id
    for (const Scene* const scene : rooms)
        records.push_back(scene != nullptr ? scene->records : std::vector<Record>());
    for (Placement& sensor : sensorsToPlace(groups, kinds)) {
        const SensorGroup& group = groups[sensor.group];
        if (used[sensor.kind] == poses[sensor.kind].size()) continue;
        sensor.sensor = group.id;
        const RoomPose& pose = poses[sensor.kind][used[sensor.kind]++];
        sensor.room = pose.room;
        sensor.pose = pose.pose;
        if (!group.is_pending) {
            records[sensor.room].push_back(group.record);
            added[sensor.room].push_back(placements.size());
        }
        placements.push_back(std::move(sensor));
    }
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        if (added[room].empty()) continue;
        const std::vector<std::string> ids = assignIds(records[room]);
        for (std::size_t i = 0; i < added[room].size(); ++i)
            placements[added[room][i]].sensor = ids[rooms[room]->records.size() + i];
    }
    return placements;
}

Sensor sensorOf(const std::vector<SensorGroup>& groups, const Placement& placement) {
    return {placement.sensor, groups[placement.group].model, placement.pose};
}

Record placedRecord(const SensorGroup& group, const Placement& placement) {
    Record record = group.record;
    const Point3& p = placement.pose.position;
    record.set("id", Value(placement.sensor));
    record.set("at", Value(Tuple{p.x, p.y, p.z}));
    record.set("heading", Value(placement.pose.heading.degrees()));
    if (!(record.angle("tilt") == placement.pose.tilt))
        record.set("tilt", Value(placement.pose.tilt.degrees()));
    return record;
}

Scene withPlaced(const Scene& scene, const std::vector<SensorGroup>& groups,
                 const std::vector<Placement>& placements, std::size_t room) {
    Scene whole = scene;
    for (const Placement& placement : placements)
        if (placement.room == room) whole.sensors.push_back(sensorOf(groups, placement));
    return whole;
}

}  // namespace ispace
