// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/sensors.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace ispace {

bool isSelected(const std::string& id, const std::vector<std::string>& globs) {
    return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
               return fnmatch(glob.c_str(), id.c_str(), 0) == 0;
           });
}

bool isReadable(std::string_view keyword) {
    return keyword == "laser" || keyword == "ranger" || keyword == "tag" || keyword == "ultrasound";
}

namespace {

/// Copies the sensors of one kind that are wanted.
template <typename Sensor>
std::vector<Sensor> chosen(const std::vector<Sensor>& all, const std::vector<std::string>& globs) {
    std::vector<Sensor> out;
    for (const Sensor& sensor : all)
        if (isSelected(sensor.id, globs)) out.push_back(sensor);
    return out;
}

void checkGlobs(const Scene& scene, const std::vector<std::string>& globs) {
    for (const std::string& glob : globs) {
        bool known = false;
        std::string ids;
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            if (!isReadable(scene.records[i].keyword())) continue;
            known = known || isSelected(scene.ids[i], {glob});
            ids.append(ids.empty() ? "" : ", ").append(scene.ids[i]);
        }
        if (!known)
            throw UsageError("no sensor matches `" + glob + "`" +
                             (ids.empty() ? "" : " (there are " + ids + ")"));
    }
}

}  // namespace

const std::string& Sensors::id(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser:
            return lasers[entry.index].id;
        case SensorKind::Ranger:
            return rangers[entry.index].id;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].id;
}

const Pose3& Sensors::pose(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser:
            return lasers[entry.index].pose;
        case SensorKind::Ranger:
            return rangers[entry.index].pose;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].pose;
}

double Sensors::rate(const Entry& entry) const {
    switch (entry.kind) {
        case SensorKind::Laser: {
            const Laser& laser = lasers[entry.index].laser;
            return laser.rate / laser.scans();
        }
        case SensorKind::Ranger:
            return rangers[entry.index].ranger.rate;
        case SensorKind::Tag:
            break;
    }
    return tags[entry.index].tag.rate;
}

Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs) {
    checkGlobs(scene, globs);
    Sensors sensors;
    sensors.lasers = chosen(scene.lasers, globs);
    sensors.rangers = chosen(scene.rangers, globs);
    sensors.tags = chosen(scene.tags, globs);
    sensors.receivers = chosen(scene.receivers, globs);
    // A choice of tags alone is not a choice of receivers.
    if (sensors.receivers.empty()) sensors.receivers = scene.receivers;
    Sensors::Entry laser{SensorKind::Laser, 0}, ranger{SensorKind::Ranger, 0},
        tag{SensorKind::Tag, 0};
    for (const Placed& placed : scene.placed) {
        if (!isSelected(scene.ids[placed.record], globs)) continue;
        const std::string& keyword = scene.records[placed.record].keyword();
        Sensors::Entry* const next = keyword == "laser"    ? &laser
                                     : keyword == "ranger" ? &ranger
                                     : keyword == "tag"    ? &tag
                                                           : nullptr;
        if (next == nullptr) continue;
        sensors.order.push_back(*next);
        ++next->index;
    }
    return sensors;
}

std::vector<std::size_t> sensorRecords(const Scene& scene, std::span<const std::string_view> kinds,
                                       const std::vector<std::string>& globs) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (std::find(kinds.begin(), kinds.end(), scene.records[i].keyword()) != kinds.end() &&
            isSelected(scene.ids[i], globs))
            found.push_back(i);
    return found;
}

double wholeNanoseconds(double seconds) {
    constexpr double kNano = 1e9, kMost = 9e6;  // whole numbers of doubles end at 9e15
    return std::fabs(seconds) < kMost ? std::round(seconds * kNano) / kNano : seconds;
}

double durationOf(const Sensors& sensors, const Sensors::Entry& entry) {
    if (entry.kind != SensorKind::Laser) return 0;
    const Laser& laser = sensors.lasers[entry.index].laser;
    return laser.duration() + (laser.scans() - 1) / laser.rate;
}

}  // namespace ispace
