// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/goal_ways.h"

#include <algorithm>
#include <optional>

#include "env/body.h"
#include "geom/polygon.h"
#include "record/edit.h"

namespace ispace {

namespace {

/// Room besides the radius and WayFinder::kMargin, so that a walk does not brush along walls.
constexpr double kWideSpare = 0.1;

/// Room between people who stand beside each other, so that one can steer there.
constexpr double kApart = 0.2;

/// Returns the middle of an element, of which a person may stand in front.
std::optional<Point2> middleOf(const Element& element) {
    if (element.record.keyword() != "zone") return placeOf(element.record);
    const Box2 box = bounds(zoneOutline(element.record));
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
    : radius_(radius),
      environment_(scene.environment),
      obstacles_(environment_, height, nullptr),
      wide_(obstacles_, bounds(environment_.indoor()), radius + kWideSpare),
      narrow_(obstacles_, bounds(environment_.indoor()), radius) {}

std::vector<Point2> GoalWays::way(Point2 from, const std::string& id,
                                  std::span<const Spot> others) const {
    for (const Element& element : environment_.elements()) {
        const auto middle = element.id == id ? middleOf(element) : std::nullopt;
        if (!middle) continue;
        const bool is_zone = element.record.keyword() == "zone";
        const Polygon zone = is_zone ? zoneOutline(element.record) : Polygon();
        const auto is_taken = [&](Point2 p) {
            return std::any_of(others.begin(), others.end(), [&](const Spot& other) {
                return distance(p, other.center) < radius_ + other.radius + kApart;
            });
        };
        const auto is_suitable = [&](Point2 p) {
            return !(is_zone && locate(zone, p) == Side::Outside) && !is_taken(p);
        };
        // Before others rather than behind them.
        const double share = kApart / std::max(kApart, distance(from, *middle));
        const Point2 aim = is_taken(*middle) ? *middle + share * (from - *middle) : *middle;
        for (const WayFinder* finder : {&wide_, &narrow_}) {
            const WayFinder::Field field = finder->waysFrom(from);
            if (const auto goal = finder->nearestReached(field, aim, is_suitable))
                return finder->way(field, *goal);
        }
    }
    return {};
}

bool GoalWays::isIn(Point2 p, const std::string& id) const {
    return std::any_of(environment_.elements().begin(), environment_.elements().end(),
                       [&](const Element& element) {
                           return element.id == id && element.record.keyword() == "zone" &&
                                  locate(zoneOutline(element.record), p) != Side::Outside;
                       });
}

}  // namespace ispace
