// SPDX-License-Identifier: GPL-3.0-or-later
// A building as the site of a search: floors with their surroundings, sight, and figures by the
// functions of `coverage`.
#include "site/arranged_site.h"

#include <algorithm>
#include <utility>

#include "site/site_coverage.h"

namespace ispace {

namespace {

/// Returns the height up to which candidates see floor: of the highest site, and of the plane.
double highestSite(const SiteScene& building, const ArrangeOptions& options) {
    double highest = options.plane;
    for (const double height : options.mount.heights) highest = std::max(highest, height);
    if (!options.mount.heights.empty()) return highest;
    for (const auto& scene : building.scenes)
        highest = std::max(highest, scene->environment.height());
    return highest;
}

}  // namespace

BuildingSite::BuildingSite(const SiteScene& building, const ArrangeOptions& options,
                           std::vector<RoomGoals> goals)
    : building_(building),
      plane_(options.plane),
      highest_(highestSite(building_, options)),
      coupling_(building_),
      sight_(coupling_, options.plane) {
    goals.resize(building_.scenes.size());
    const auto floors = coupling_.floors(highest_);
    for (std::size_t i = 0; i < floors.size(); ++i) {
        const Storey& storey = building_.document.storeys[i];
        const Point2 at = storey.building_from_storey.position;
        site_.rooms.push_back({storey.id,
                               floors[i],
                               std::move(goals[i]),
                               {at.x, at.y, storey.floor},
                               storey.building_from_storey.heading,
                               hasFloor(*floors[i])});
    }
    site_.sight = this;
}

namespace {

/// A building with other scenes, and the sight between its storeys.
struct ChangedBuilding {
    ChangedBuilding(SiteScene scene, double plane)
        : building(std::move(scene)), coupling(building), sight(coupling, plane) {}
    ChangedBuilding(const ChangedBuilding&) = delete;
    ChangedBuilding& operator=(const ChangedBuilding&) = delete;

    SiteScene building;
    Coupling coupling;
    StoreySight sight;
};

}  // namespace

SiteCase BuildingSite::changed(const ChangeScene& change) const {
    SiteScene changed = building_;
    for (std::size_t i = 0; i < changed.scenes.size(); ++i)
        changed.scenes[i] = change(i, building_.scenes[i]);
    const auto all = std::make_shared<ChangedBuilding>(std::move(changed), plane_);
    return {all->coupling.floors(highest_), std::shared_ptr<const RoomSight>(all, &all->sight)};
}

SiteFigures BuildingSite::measure(std::span<const std::vector<Sensor>> added,
                                  const CoverageOptions& options) const {
    SiteScene placed = building_;
    for (std::size_t i = 0; i < placed.scenes.size(); ++i) {
        if (added[i].empty()) continue;  // equal storeys share a scene
        Scene scene = *building_.scenes[i];
        scene.sensors.insert(scene.sensors.end(), added[i].begin(), added[i].end());
        placed.scenes[i] = std::make_shared<const Scene>(std::move(scene));
    }
    const SiteCoverage coverage = measureSite(placed, options);
    SiteFigures figures{coverage.coverage,
                        coverage.total_effective_area,
                        coverage.indoor_area,
                        coverage.free_area,
                        {}};
    for (const Coverage& storey : coverage.storeys) figures.rooms.push_back(storey.report.coverage);
    return figures;
}

Document buildingLayout(LayoutParts parts, const SiteScene& building, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement) {
    parts.whole = [&building](std::size_t storey, Record record, const std::string& id) {
        return inBuilding(building.document.storeys[storey], std::move(record), id);
    };
    return layoutDocument(parts, before, groups, arrangement);
}

}  // namespace ispace
