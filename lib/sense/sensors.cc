// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/sensors.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "sensor/kind.h"

namespace ispace {

bool isSelected(const std::string& id, const std::vector<std::string>& globs) {
    return globs.empty() || std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
               return fnmatch(glob.c_str(), id.c_str(), 0) == 0;
           });
}

namespace {

bool isRead(const Record& record) {
    const SensorKind* kind = sensorKind(record.keyword());
    return kind != nullptr && kind->is_read;
}

void checkGlobs(const Scene& scene, const std::vector<std::string>& globs) {
    for (const std::string& glob : globs) {
        bool known = false;
        std::string ids;
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            if (!isRead(scene.records[i])) continue;
            known = known || isSelected(scene.ids[i], {glob});
            ids.append(ids.empty() ? "" : ", ").append(scene.ids[i]);
        }
        if (!known)
            throw UsageError("no sensor matches `" + glob + "`" +
                             (ids.empty() ? "" : " (there are " + ids + ")"));
    }
}

}  // namespace

Sensors sensorsOf(const Scene& scene, const std::vector<std::string>& globs) {
    checkGlobs(scene, globs);
    Sensors sensors;
    for (const Sensor& sensor : scene.sensors)
        if (isSelected(sensor.id, globs))
            (sensor.is<Receiver>() ? sensors.receivers : sensors.read).push_back(sensor);
    // A choice of tags alone is not a choice of receivers.
    if (sensors.receivers.empty()) sensors.receivers = sensorsOf<Receiver>(scene);
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

}  // namespace ispace
