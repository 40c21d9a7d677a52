// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/camerarules/layout_privacy.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "arrange/sensor_group.h"
#include "coverage/target.h"
#include "env/zone.h"
#include "scene/sensor/camera.h"

namespace ispace::camerarules {

namespace {

/// A camera of another room, and what it sees of a private zone, m2 by cells.
struct CameraBeyond {
    std::size_t room = 0;
    std::string id;
    double seen = 0;
};

/// Finds the cameras of other rooms that see a zone.
std::vector<CameraBeyond> camerasBeyond(const ArrangeSite& site,
                                        const std::vector<SensorGroup>& groups,
                                        const Arrangement& found, std::size_t to,
                                        const std::string& zone, double density) {
    std::vector<CameraBeyond> cameras;
    if (site.sight == nullptr || !site.sight->joinsRooms()) return cameras;
    const Environment& room = site.rooms[to].scene->environment;
    const Target target = makeTarget(room, RoomCells(), kScanHeight);
    const std::vector<double> inside =
        weightsOfCells(target, {.targets = {readZone(zone, room)}, .weights = {}});
    const double cell = target.grid.limits.width() * target.grid.limits.depth() /
                        static_cast<double>(target.grid.size());
    for (std::size_t from = 0; from < site.rooms.size(); ++from) {
        if (from == to) continue;
        for (Sensor sensor :
             withPlaced(*site.rooms[from].scene, groups, found.sensors, from).sensors) {
            auto* const camera = std::get_if<Camera>(&sensor.model);
            if (camera == nullptr) continue;
            *camera = withDensity(*camera, density);
            if (!site.sight->maySee(from, sensor, to)) continue;
            CellParts parts;
            site.sight->look(from, {&sensor, 1}, to, target.grid, parts);
            CameraBeyond beyond{from, sensor.id};
            for (const CellRun& run : parts.runs)
                for (std::size_t i = run.first; i < run.end; ++i)
                    if (inside[i] > 0) beyond.seen += cell;
            if (beyond.seen > 0) cameras.push_back(std::move(beyond));
        }
    }
    return cameras;
}

}  // namespace

LayoutPrivacy measurePrivacy(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                             const Arrangement& found, double plane,
                             std::span<const std::vector<PrivacyRule>> rules) {
    LayoutPrivacy all;
    for (std::size_t i = 0; i < site.rooms.size(); ++i) {
        const SiteRoom& room = site.rooms[i];
        if (rules[i].empty()) continue;
        std::vector<PrivacyResult> results =
            measurePrivacy(withPlaced(*room.scene, groups, found.sensors, i), plane, rules[i]);
        std::set<std::string> seeing;
        for (PrivacyResult& result : results) {
            if (!isMet(result)) seeing.insert(result.cameras.begin(), result.cameras.end());
            const auto beyond = camerasBeyond(site, groups, found, i, result.zone, result.density);
            if (!room.id.empty()) {
                result.zone.insert(0, room.id + '/');
                for (std::string& camera : result.cameras) camera.insert(0, room.id + '/');
            }
            for (const CameraBeyond& camera : beyond) {
                if (result.seen) result.seen = std::min(*result.seen + camera.seen, result.area);
                result.cameras.push_back(site.rooms[camera.room].id + '/' + camera.id);
                for (const Placement& placement : found.sensors)
                    if (placement.room == camera.room && placement.sensor == camera.id)
                        all.seeing.push_back({camera.room, placement.pose});
            }
            all.results.push_back(std::move(result));
        }
        for (const Placement& placement : found.sensors)
            if (placement.room == i && seeing.count(placement.sensor) > 0)
                all.seeing.push_back({i, placement.pose});
    }
    return all;
}

UnseenFloor unseenFloor(const PrivacyRule& rule, const Environment& environment) {
    UnseenFloor floor{.option = "--privacy", .density = rule.density};
    for (const std::string& zone : privateZones(rule, environment))
        floor.zones.push_back(readZone(zone, environment));
    return floor;
}

void askPrivacy(const std::vector<std::vector<PrivacyRule>>& rules,
                std::span<const Environment* const> rooms, ArrangeOptions& options,
                std::span<RoomGoals> goals) {
    for (std::size_t i = 0; i < rules.size(); ++i)
        for (const PrivacyRule& rule : rules[i]) {
            goals[i].unseen.push_back(unseenFloor(rule, *rooms[i]));
            options.unseen.push_back(goals[i].unseen.back());
        }
    if (options.unseen.empty()) return;
    // Cells may miss what the exact regions see.
    options.rejected = [rules, plane = options.plane](const ArrangeSite& site,
                                                      const std::vector<SensorGroup>& groups,
                                                      const Arrangement& found) {
        return measurePrivacy(site, groups, found, plane, rules).seeing;
    };
}

}  // namespace ispace::camerarules
