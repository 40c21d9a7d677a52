// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/goal_ways.h"

#include "env/body.h"
#include "geom/polygon.h"
#include "record/edit.h"

namespace ispace {

namespace {

/// Room besides the radius and WayFinder::kMargin, so that a walk does not brush along walls.
constexpr double kWideSpare = 0.1;

/// Returns the middle of an element, of which a person may stand in front.
std::optional<Point2> middleOf(const Element& element) {
    if (element.record.keyword() != "zone") return placeOf(element.record);
    Box2 box;
    for (const Point2 corner : zoneOutline(element.record)) box.add(corner);
    return Point2{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2};
}

}  // namespace

std::vector<std::string> goalIds(const Scene& scene) {
    std::vector<std::string> ids;
    for (const Element& element : scene.environment.elements())
        if (middleOf(element)) ids.push_back(element.id);
    return ids;
}

GoalWays::GoalWays(const Scene& scene, double radius, double height)
    : environment_(scene.environment),
      obstacles_(environment_, height, nullptr),
      wide_(obstacles_, bounds(environment_.indoor()), radius + kWideSpare),
      narrow_(obstacles_, bounds(environment_.indoor()), radius) {}

std::vector<Point2> GoalWays::way(Point2 from, const std::string& id) const {
    for (const Element& element : environment_.elements()) {
        const auto middle = element.id == id ? middleOf(element) : std::nullopt;
        if (!middle) continue;
        const bool is_zone = element.record.keyword() == "zone";
        const Polygon zone = is_zone ? zoneOutline(element.record) : Polygon();
        for (const WayFinder* finder : {&wide_, &narrow_}) {
            const WayFinder::Field field = finder->waysFrom(from);
            if (const auto goal = finder->nearestReached(field, *middle, zone))
                return finder->way(field, *goal);
        }
    }
    return {};
}

}  // namespace ispace
