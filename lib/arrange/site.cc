// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/site.h"

#include "arrange/sensor_group.h"

namespace ispace {

bool RoomGoals::isPlain() const {
    return weights.isUniform() && counts && takes_sensors && keep_out.empty() && keep_in.empty() &&
           privacy.empty() && facing.empty() && forbidden.empty() && places.empty();
}

Point3 SiteRoom::inSite(Point3 point) const {
    const Point2 at = Pose2{origin.onFloor(), turn} * point.onFloor();
    return {at.x, at.y, origin.z + point.z};
}

std::string wholeId(const ArrangeSite& site, const Placement& placement) {
    const std::string& room = site.rooms[placement.room].id;
    return room.empty() ? placement.sensor : room + '/' + placement.sensor;
}

}  // namespace ispace
