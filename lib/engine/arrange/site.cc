// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/site.h"

#include "arrange/demand.h"
#include "arrange/sensor_group.h"

namespace ispace {

bool RoomGoals::isPlain() const {
    return weights.isUniform() && counts && takes_sensors && keep_out.empty() && keep_in.empty() &&
           unseen.empty() && !cover_rule && forbidden.empty() && places.empty() &&
           demand == nullptr;
}

Point3 SiteRoom::inSite(Point3 point) const {
    const Point2 at = Pose2{origin.onFloor(), turn} * point.onFloor();
    return {at.x, at.y, origin.z + point.z};
}

SiteCase caseOf(const ArrangeSite& site) {
    SiteCase own{{}, std::shared_ptr<const RoomSight>(std::shared_ptr<void>(), site.sight)};
    for (const SiteRoom& room : site.rooms) own.rooms.push_back(room.scene);
    return own;
}

SiteCase caseOf(const ArrangeSite& site, const ChangeScene& change) {
    if (site.sight != nullptr) return site.sight->changed(change);
    SiteCase changed;
    for (std::size_t i = 0; i < site.rooms.size(); ++i)
        changed.rooms.push_back(change(i, site.rooms[i].scene));
    return changed;
}

std::vector<ServedDemand> servedByRoom(const ArrangeSite& site, const CellSet& served) {
    std::vector<ServedDemand> rooms;
    std::size_t first = 0;
    for (const SiteRoom& room : site.rooms) {
        if (!room.has_floor) continue;
        const std::size_t count = room.goals.demand->weights().size();
        ServedDemand& own =
            rooms.emplace_back(ServedDemand{room.goals.demand.get(), CellSet(count)});
        for (std::size_t i = 0; i < count; ++i)
            if (served.test(first + i)) own.served.set(i);
        first += count;
    }
    return rooms;
}

std::string wholeId(const ArrangeSite& site, std::size_t room, const std::string& id) {
    const std::string& of = site.rooms[room].id;
    return of.empty() ? id : of + '/' + id;
}

std::string wholeId(const ArrangeSite& site, const Placement& placement) {
    return wholeId(site, placement.room, placement.sensor);
}

}  // namespace ispace
