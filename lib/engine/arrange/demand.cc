// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/demand.h"

#include "env/level.h"

namespace ispace {

std::string Demand::finding(std::span<const ServedDemand> /*rooms*/, double /*bound*/) const {
    return "";
}

CellSet Demand::servedBy(const Sensor& sensor, const RayScenes& worlds) const {
    const Point3 place = sensor.pose.position;
    if (!isServedBy(sensor) || worlds.environment().level(place.z)->isInsideSolid(place.onFloor()))
        return CellSet(weights().size());
    return servedBy(sensor, sightOf(sensor, worlds));
}

}  // namespace ispace
