// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/warnings.h"

#include "base/number.h"
#include "env/level.h"
#include "env/point_location.h"
#include "sensor/kind.h"

namespace ispace {

namespace {

/// For so many places an index takes longer than it saves.
constexpr std::size_t kFewPlaces = 4;

}  // namespace

bool BurialTest::isBuried(Point3 place) {
    constexpr std::size_t kMaxHeights = 64;
    auto known = levels_.find(place.z);
    if (known == levels_.end()) {
        if (levels_.size() == kMaxHeights) return false;
        known = levels_.emplace(place.z, Known{environment_.level(place.z)}).first;
    }
    auto& [level, asked] = known->second;
    if (asked++ < kFewPlaces) return isDeepIn(level->slice().solids, place.onFloor(), kRayEpsilon);
    return level->isBuried(place.onFloor());
}

std::vector<std::string> sensorWarnings(const Scene& scene, const Sensors& sensors,
                                        const std::vector<std::string>& globs,
                                        bool with_receivers) {
    std::vector<std::string> warnings;
    for (std::size_t i = 0; i < scene.records.size(); ++i) {
        const Record& record = scene.records[i];
        const SensorKind* kind = sensorKind(record.keyword());
        if (kind == nullptr || !kind->is_read || record.has("at") || record.has("on") ||
            !isSelected(scene.ids[i], globs))
            continue;
        warnings.push_back(scene.ids[i] + " has no place and is left out: give it `at` or `on`" +
                           (record.keyword() == "laser" ? ", or let arrange place it" : ""));
    }
    BurialTest burial(scene.environment);
    const bool are_few = sensors.read.size() + sensors.receivers.size() <= kFewPlaces;
    const auto is_outside = [&](Point2 p) {
        const Side side = are_few ? scene.environment.indoor().locate(p)
                                  : scene.environment.indoorIndex().locate(p);
        return side == Side::Outside;
    };
    bool listens = with_receivers;
    const auto check = [&](const Sensor& sensor) {
        const Point3 place = sensor.pose.position;
        const bool inside = burial.isBuried(place);
        if (!inside && place.z >= 0 && !is_outside(place.onFloor())) return;
        std::string phrase = sensor.id;
        phrase.append(inside ? " stands inside something solid at "
                             : " stands outside the room at ");
        for (const double part : {place.x, place.y, place.z})
            phrase.append(formatDouble(part)).append(",");
        phrase.pop_back();
        warnings.push_back(std::move(phrase));
    };
    for (const Sensor& sensor : sensors.read) {
        check(sensor);
        listens = listens || sensor.is<Tag>();
    }
    if (listens)
        for (const Sensor& receiver : sensors.receivers) check(receiver);
    return warnings;
}

}  // namespace ispace
