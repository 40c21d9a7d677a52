// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/warnings.h"

#include <map>

#include "base/number.h"
#include "env/level.h"
#include "env/point_location.h"
#include "env/solid_tree.h"
#include "sensor/kind.h"
#include "trace/ray_world.h"

namespace ispace {

struct SolidJudge::Data {
    const Environment& environment;
    std::map<double, SolidTree> levels = {};

    /// The solids of one height.
    const SolidTree* at(double height) {
        constexpr std::size_t kMaxLevels = 64;
        const auto known = levels.find(height);
        if (known != levels.end()) return &known->second;
        if (levels.size() == kMaxLevels) return nullptr;
        return &levels.emplace(height, environment.slice(height).solids).first->second;
    }
};

SolidJudge::SolidJudge(const Environment& environment)
    : data_(std::make_unique<Data>(Data{environment})) {}
SolidJudge::~SolidJudge() = default;

bool SolidJudge::isInside(Point3 place) {
    const SolidTree* const level = data_->at(place.z);
    return level != nullptr && level->isInside(place.onFloor(), kRayEpsilon);
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
    bool listens = with_receivers;
    const auto check = [&](const Sensor& sensor) {
        const Point3 place = sensor.pose.position;
        const bool inside = scene.environment.level(place.z)->isBuried(place.onFloor());
        if (!inside && place.z >= 0 &&
            scene.environment.indoorIndex().locate(place.onFloor()) != Side::Outside)
            return;
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
