// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of arrangements in buildings.
#pragma once

#include <span>
#include <vector>

#include "arrange/arrange.h"
#include "base/error.h"
#include "scene/sensor_spec.h"
#include "site/arranged_site.h"
#include "site/site_scene.h"

namespace ispace {

inline std::vector<SensorGroup> groupsOf(const SiteScene& building,
                                         std::span<const SensorSpec> sensors, bool open = false) {
    std::vector<const Scene*> scenes;
    for (const auto& scene : building.scenes) scenes.push_back(scene.get());
    return groupsToPlace(scenes, sensors, building.devices, open);
}

/// A building with the sensors that a search placed.
struct ArrangedBuilding {
    std::vector<SensorGroup> groups;
    Arrangement found;
    std::vector<int> counts = {};  ///< by storey

    [[nodiscard]] double gap() const { return found.candidate_bound - found.candidate_value; }
};

inline ArrangedBuilding arrangedIn(const SiteScene& building,
                                   const std::vector<SensorSpec>& sensors,
                                   const ArrangeOptions& options,
                                   std::vector<RoomGoals> goals = {}) {
    SilentProgress progress;
    const BuildingSite rooms(building, options, std::move(goals));
    ArrangedBuilding result{
        groupsOf(building, sensors, options.target.has_value() || options.budget.has_value()), {}};
    result.found = arrange(rooms.site(), result.groups, options, progress);
    for (const Arrangement::InRoom& room : result.found.rooms)
        result.counts.push_back(static_cast<int>(room.sensors));
    return result;
}

/// Returns the building with the sensors of an arrangement, as read from its file.
inline SiteScene written(const SiteScene& building, const ArrangedBuilding& arranged) {
    const Document layout =
        buildingLayout({{}, "house.yaml", building.document.digest(), "grid", "exact"}, building,
                       nullptr, arranged.groups, arranged.found);
    return makeSiteScene(building.document, layoutsOf(layout, building.document), building.devices);
}

}  // namespace ispace
