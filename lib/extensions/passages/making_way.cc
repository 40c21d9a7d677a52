// SPDX-License-Identifier: GPL-3.0-or-later
// Ways round movers that stand, and those that wait make way.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"
#include "geom/predicates.h"

namespace ispace::passages {

namespace {

/// Metres ahead in which a mover that is stuck asks others to step aside, and within which they
/// find a place to wait.
constexpr double kAskAhead = 3, kMostAside = 8;

/// Returns the distance of a point from a way that begins at `from`.
double distanceToPath(Point2 p, Point2 from, const std::vector<Point2>& way) {
    double least = distance(from, p);
    for (const Point2 next : way) {
        least = std::min(least, distance(p, {from, next}));
        from = next;
    }
    return least;
}

}  // namespace

std::vector<Point2> BuildingRun::Data::wayTo(const Traveller& who, const BuildingTrip& trip,
                                             Point2 to) const {
    const World& world = *rooms[who.room].world;
    const PathFinder& finder = waysOf(who).finder(*rooms[who.room].storey);
    const Point2 at = statusOf(who).pose.position;
    if (trip.attempts == 0) return finder.wayBetween(at, to);
    std::vector<Point2> way =
        finder.around(world.standingBeside(world.moverNamed(who.id).value())).wayBetween(at, to);
    return way.empty() ? finder.wayBetween(at, to) : way;
}

bool BuildingRun::Data::askAside(std::size_t storey, double radius, Point2 at,
                                 const std::vector<Point2>& way) {
    bool is_heard = false;
    for (auto& [id, other] : trips) {
        if (other.state != TripState::Queueing && other.state != TripState::Pausing) continue;
        Traveller& its = travellers.find(id)->second;
        if (its.room != storey) continue;
        const RobotStatus status = statusOf(its);
        const double apart = radius + its.size.radius + kFlightGap;
        if (distance(status.pose.position, at) > kAskAhead ||
            distanceToPath(status.pose.position, at, way) > apart)
            continue;
        const auto aside = spotAside(its, at, way, apart);
        if (!aside) continue;
        other.spot = *aside;
        send(its, other, waysOf(its).finder(storey).wayBetween(status.pose.position, *aside),
             its.ability.speed);
        is_heard = true;
    }
    return is_heard;
}

std::optional<Point2> BuildingRun::Data::spotAside(const Traveller& who, Point2 from,
                                                   const std::vector<Point2>& way, double apart) {
    const std::size_t storey = *rooms[who.room].storey;
    const StoreyPaths& all = waysOf(who);
    const PathFinder& finder = all.finder(storey);
    const Point2 at = statusOf(who).pose.position;
    const auto suits = [&](Point2 p) {
        if (distance(at, p) > kMostAside || distanceToPath(p, from, way) < apart) return false;
        const bool is_on_landing =
            std::any_of(all.landings().begin(), all.landings().end(), [&](const Landing& landing) {
                return landing.storey == storey &&
                       distance(landing.at.position, p) < clearanceOf(who);
            });
        return !is_on_landing && openingAt(storey, p) == nullptr && isFree(storey, p, who) &&
               freeSpot(who, {p});
    };
    const Vec2 most{kMostAside, kMostAside};
    return finder.approach(at, at, {at - most, at + most}, suits).goal;
}

}  // namespace ispace::passages
