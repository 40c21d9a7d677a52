// SPDX-License-Identifier: GPL-3.0-or-later
// Reachability of storeys, and boxes projected from the eye to the plane.
#include "site/opening_bounds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geom/visibility/visibility.h"

namespace ispace {

OpeningBounds::OpeningBounds(const SiteScene& building, std::span<const FloorOpening> openings)
    : building_(building),
      above_(storeysAbove(building.scenes.size(), openings)),
      boxes_(building.scenes.size()) {
    for (const FloorOpening& opening : openings)
        for (const Point2 corner : opening.outline) boxes_[opening.above].add(corner);
}

std::vector<std::size_t> OpeningBounds::between(std::size_t from, std::size_t to) const {
    const std::size_t low = std::min(from, to), high = std::max(from, to);
    if (low == high || !above_[low][high]) return {};
    std::vector<std::size_t> storeys = {low};
    for (std::size_t i = low + 1; i < high; ++i)
        if (above_[low][i] && above_[i][high]) storeys.push_back(i);
    storeys.push_back(high);
    return storeys;
}

bool OpeningBounds::maySee(std::span<const std::size_t> between, std::size_t from, std::size_t to,
                           const Sensor& sensor, double above_floor) const {
    const double eye = floorOf(from) + sensor.pose.position.z;
    const double plane = floorOf(to) + above_floor;
    const double range = std::min(maxRange(sensor.model), kSightBetweenStoreys);
    if (std::fabs(plane - eye) >= range) return false;
    const bool is_up = floorOf(to) > floorOf(from);
    const Point2 foot =
        building_.document.storeys[from].building_from_storey * sensor.pose.position.onFloor();
    std::map<double, Box2> floors;  // bounds of the openings in the floors that sight passes
    for (const std::size_t storey : between) {
        if (floorOf(storey) == std::min(floorOf(from), floorOf(to))) continue;
        const Box2& own = boxes_[storey];
        Box2& box = floors[floorOf(storey)];
        if (own.empty()) continue;
        box.add(own.low);
        box.add(own.high);
    }
    if (floors.size() > kSightThroughFloors) return false;
    Box2 seen{{-range, -range}, {range, range}};  // on the plane, about the foot
    for (const auto& [height, box] : floors) {
        const double share = (plane - eye) / (height - eye);
        const bool is_passed = is_up ? eye < height - kRayEpsilon && height < plane - kRayEpsilon
                                     : eye > height + kRayEpsilon && height > plane + kRayEpsilon;
        if (!is_passed || box.empty()) return false;
        const Vec2 low = share * (box.low - foot), high = share * (box.high - foot);
        seen = common(seen, {{low.x, low.y}, {high.x, high.y}});
        if (seen.empty()) return false;
    }
    return true;
}

}  // namespace ispace
