// SPDX-License-Identifier: GPL-3.0-or-later
// Sight between the storeys of a running building.
#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "building/building_sight.h"
#include "sense/scan.h"

namespace ispace {

bool looksAround(const Sensor& sensor) {
    return kindOf(sensor.model).stopped_by == Surfaces::Opaque &&
           (!sensor.is<Laser>() || !scansSlice(sensor));
}

RoomsAround::RoomsAround(const BuildingScene& building, double plane)
    : building_(building),
      plane_(plane),
      openings_(floorOpenings(building)),
      latest_(building.scenes.size()) {}

std::shared_ptr<const SurroundedRoom> RoomsAround::room(std::size_t storey, const Scene& scene) {
    std::shared_ptr<const Known> known;
    {
        const std::lock_guard lock(mutex_);
        known = latest_[storey];
    }
    const auto changes =
        known == nullptr ? std::nullopt : scene.environment.changesSince(known->storey);
    if (!changes || changes->size() > 0) {
        BuildingScene now = building_;
        now.scenes[storey] = std::make_shared<const Scene>(scene);
        auto room = roomWithSurroundings(now, openings_, storey, false);
        known = std::make_shared<const Known>(
            Known{scene.environment,
                  room ? std::make_shared<const SurroundedRoom>(*std::move(room)) : nullptr});
        const std::lock_guard lock(mutex_);
        latest_[storey] = known;
    }
    return known->room;
}

std::shared_ptr<const SurroundedRoom> RoomsAround::around(std::size_t storey, const Scene& scene) {
    const bool is_seen = std::any_of(scene.sensors.begin(), scene.sensors.end(), looksAround);
    return openings_.empty() || !is_seen ? nullptr : room(storey, scene);
}

std::vector<std::vector<Sensor>> RoomsAround::sensorsOutside() const {
    CoverageOptions options;
    options.plane = plane_;
    std::vector<std::vector<Sensor>> sensors;
    for (const auto& views : viewsBetweenStoreys(building_, options)) {
        std::vector<Sensor>& seeing = sensors.emplace_back();
        for (const StoreyView& one : views) {
            const Scene& scene = *building_.scenes[one.storey];
            const std::string& id = one.view->sensor.id;
            // Those on robots and people move with them.
            const bool is_fixed =
                std::any_of(scene.sensors.begin(), scene.sensors.end(), [&](const Sensor& sensor) {
                    return sensor.id == id && !sensor.mount && !sensor.person;
                });
            if (is_fixed) seeing.push_back(one.view->sensor);
        }
    }
    return sensors;
}

OutsideWatch RoomsAround::outside(std::size_t storey, const Scene& scene) {
    if (openings_.empty()) return {};
    const std::vector<Sensor>& sensors = outside_.get([this] { return sensorsOutside(); })[storey];
    if (sensors.empty()) return {};
    auto around = room(storey, scene);
    if (around == nullptr) return {};
    return {std::move(around), sensors};
}

}  // namespace ispace
