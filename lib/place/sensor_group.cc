// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/sensor_group.h"

#include <fnmatch.h>

#include <algorithm>
#include <set>

#include "base/error.h"

namespace ispace {

namespace {

bool isArranged(const Record& record) {
    return std::find(std::begin(kArrangedKinds), std::end(kArrangedKinds), record.keyword()) !=
           std::end(kArrangedKinds);
}

SensorDevice deviceFor(const Record& record, const DeviceCatalogue& devices) {
    try {
        if (record.keyword() == "laser") return laserOf(record, devices);
        if (record.keyword() == "ranger") return rangerOf(record, devices);
        return receiverOf(record, devices);
    } catch (const FormatError& error) {
        // What is wrong with the figures of --sensor is wrong on the command line.
        throw UsageError(error.diagnostics().front().message);
    }
}

}  // namespace

std::vector<SensorGroup> groupsToPlace(const Scene& scene, std::span<const SensorSpec> added,
                                       const DeviceCatalogue& devices, bool open) {
    std::vector<SensorGroup> groups;
    groups.reserve(scene.pending.size() + added.size());
    for (const PendingSensor& sensor : scene.pending)
        groups.push_back({sensor.record, sensor.device, sensor.id, true, 1});
    std::set<std::string> taken(scene.ids.begin(), scene.ids.end());
    for (const auto& [record, count] : added) {
        for (const char* key : {"at", "heading", "on"})
            if (record.has(key))
                throw UsageError("a sensor to be arranged has no place yet: leave out `" +
                                 std::string(key) + '`');
        const std::string id = record.writtenId();
        if (!id.empty() && !taken.insert(id).second)
            throw UsageError("the id `" + id + "` is taken in this scene");
        const int most = count.value_or(open && id.empty() ? kMostOpen : 1);
        groups.push_back({record, deviceFor(record, devices), id, false, most});
    }
    return groups;
}

Document withoutPlaces(const Document& layout, std::span<const std::string> fixed) {
    Document freed = layout;
    const std::vector<std::string> ids = assignIds(freed.records);
    std::vector<bool> is_used(fixed.size());
    for (std::size_t i = 0; i < freed.records.size(); ++i) {
        Record& record = freed.records[i];
        const bool rides = record.has("on");
        if (!isArranged(record) || (!record.has("at") && !rides)) continue;
        bool stays = rides;
        for (std::size_t k = 0; k < fixed.size(); ++k) {
            if (::fnmatch(fixed[k].c_str(), ids[i].c_str(), 0) != 0) continue;
            is_used[k] = true;
            stays = true;
        }
        if (stays) continue;
        // A sensor keeps the id by which others know it.
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

}  // namespace ispace
