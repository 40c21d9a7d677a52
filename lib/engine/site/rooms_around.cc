// SPDX-License-Identifier: GPL-3.0-or-later
// Sight between the storeys of a running building.
#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coverage/outside_view.h"
#include "sense/scan.h"
#include "site/site_sight.h"

namespace ispace {

bool seesOtherStoreys(const Sensor& sensor) {
    return kindOf(sensor.model).stopped_by == Surfaces::Opaque &&
           (!sensor.is<Laser>() || !scansSlice(sensor));
}

namespace {

/// Those on robots and people move with them.
bool isFixed(const Sensor& sensor) { return !sensor.mount && !sensor.person; }

std::vector<const Sensor*> fixedLookers(const Scene& scene) {
    std::vector<const Sensor*> sensors;
    for (const Sensor& sensor : scene.sensors)
        if (isFixed(sensor) && seesOutside(sensor)) sensors.push_back(&sensor);
    return sensors;
}

}  // namespace

bool looksOtherwise(const Scene& before, const Scene& now) {
    const auto was = fixedLookers(before), is = fixedLookers(now);
    return !std::equal(was.begin(), was.end(), is.begin(), is.end(),
                       [](const Sensor* a, const Sensor* b) {
                           return a->id == b->id && a->pose == b->pose && a->model == b->model;
                       });
}

RoomsAround::RoomsAround(const SiteScene& building, double plane)
    : building_(building),
      plane_(plane),
      has_openings_(!floorOpenings(building).empty()),
      watching_(std::make_shared<const SiteScene>(building)),
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
        SiteScene now = building_;
        now.scenes[storey] = std::make_shared<const Scene>(scene);
        const Coupling coupling(now);
        known = std::make_shared<const Known>(Known{
            scene.environment, coupling.isAlone(storey) ? nullptr
                                                        : std::make_shared<const SurroundedRoom>(
                                                              *coupling.surroundings(storey))});
        const std::lock_guard lock(mutex_);
        latest_[storey] = known;
    }
    return known->room;
}

std::shared_ptr<const SurroundedRoom> RoomsAround::around(std::size_t storey, const Scene& scene) {
    const bool has_sonar =
        std::any_of(scene.robots.begin(), scene.robots.end(),
                    [](const PlacedRobot& robot) { return !robot.model.sonar.places.empty(); });
    return has_sonar || !scene.sensors.empty() ? room(storey, scene) : nullptr;
}

RoomsAround::SensorsByStorey RoomsAround::sensorsOutside(const SiteScene& building) const {
    CoverageOptions options;
    options.plane = plane_;
    SensorsByStorey sensors;
    for (const auto& views : viewsBetweenStoreys(Coupling(building), options)) {
        std::vector<Sensor>& seeing = sensors.emplace_back();
        for (const StoreyView& one : views) {
            const Scene& scene = *building.scenes[one.storey];
            const std::string& id = one.view->sensor.id;
            const bool is_fixed = std::any_of(
                scene.sensors.begin(), scene.sensors.end(),
                [&](const Sensor& sensor) { return sensor.id == id && isFixed(sensor); });
            if (is_fixed) seeing.push_back(one.view->sensor);
        }
    }
    return sensors;
}

void RoomsAround::setSensors(std::size_t storey, const Scene& scene) {
    const std::lock_guard lock(mutex_);
    auto now = std::make_shared<Scene>(*watching_->scenes[storey]);
    now->sensors = scene.sensors;
    auto building = std::make_shared<SiteScene>(*watching_);
    building->scenes[storey] = std::move(now);
    watching_ = std::move(building);
    outside_ = std::make_shared<Lazy<SensorsByStorey>>();
}

OutsideWatch RoomsAround::outside(std::size_t storey, const Scene& scene) {
    if (!has_openings_) {
        const Coupling coupling(building_);
        const auto is_in_slab = [&](const Sensor& sensor) {
            return coupling.slabAround(storey, sensor.pose.position).has_value();
        };
        if (std::none_of(scene.sensors.begin(), scene.sensors.end(), is_in_slab)) return {};
        return {room(storey, scene), {}};
    }
    std::shared_ptr<Lazy<SensorsByStorey>> known;
    std::shared_ptr<const SiteScene> building;
    {
        const std::lock_guard lock(mutex_);
        known = outside_;
        building = watching_;
    }
    const std::vector<Sensor>& sensors =
        known->get([&] { return sensorsOutside(*building); })[storey];
    auto seen = room(storey, scene);
    if (seen == nullptr) return {};
    return {std::move(seen), sensors};
}

}  // namespace ispace
