// SPDX-License-Identifier: GPL-3.0-or-later
// Slots by trial: row by row from the back to the door, in each from the sides to the middle. A way
// out is a capsule about the line to the door; a slot is free if its way meets no rider, and it
// stands in no way of those that leave elsewhere.
#include "extensions/passages/cabin.h"

#include <algorithm>
#include <cmath>

#include "geom/tolerance.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "sim/collision.h"
#include "sim/odometry.h"

namespace ispace::passages {

namespace {

/// Metres between riders and to the walls.
constexpr double kGap = 0.05;
constexpr double kSlotStep = 0.05;
/// Metres by which the room of a flight is longer at each end.
constexpr double kFlightEnd = 1;

Document roomAround(const Polygon& outline, Point2 inside, const Pose2& frame) {
    Document room;
    Record fence(*sceneSchemas().find("fence"));
    TupleList path;
    for (const Point2 corner : outline) {
        const Point2 p = frame * corner;
        path.push_back({p.x, p.y});
    }
    fence.set("id", std::string("walls"));
    fence.set("path", path);
    fence.set("closed", true);
    Record point(*sceneSchemas().find("inside"));
    const Point2 p = frame * inside;
    point.set("at", Tuple{p.x, p.y});
    room.records = {std::move(fence), std::move(point)};
    return room;
}

}  // namespace

Pose2 placedIn(const Pose2& outer, const Pose2& inner) { return composed(outer, inner); }

Pose2 seenFrom(const Pose2& inner, const Pose2& outer) { return relativePose(inner, outer); }

Point2 thresholdOf(const Cabin& cabin, double radius) {
    return {cabin.length / 2 - radius - kGap, 0};
}

std::optional<Point2> slotIn(const Cabin& cabin, const std::vector<Rider>& riders,
                             const Rider& rider) {
    double load = rider.mass;
    for (const Rider& other : riders) load += other.mass;
    if (load > cabin.capacity) return std::nullopt;
    const double across = cabin.width / 2 - rider.radius - kGap;
    const double along = cabin.length / 2 - rider.radius - kGap;
    if (across < 0 || along < 0) return std::nullopt;
    const Point2 door = thresholdOf(cabin, rider.radius);
    const auto is_free = [&](Point2 p) {
        return std::all_of(riders.begin(), riders.end(), [&](const Rider& other) {
            const double apart = rider.radius + other.radius + kGap;
            if (squaredDistance(other.at, {door, p}) < apart * apart) return false;
            if (other.stop == rider.stop) return true;
            const Segment2 way{other.at, thresholdOf(cabin, other.radius)};
            return squaredDistance(p, way) >= apart * apart;
        });
    };
    const auto columns = static_cast<int>(2 * along / kSlotStep);
    const auto rows = static_cast<int>(across / kSlotStep);
    for (int i = 0; i <= columns; ++i)
        for (int k = 0; k <= 2 * rows + 1; ++k) {
            // From the corners to the middle, right and left by turns.
            const int pair = k / 2;
            const double aside = across - pair * kSlotStep;
            const Point2 p{-along + i * kSlotStep, k % 2 == 0 ? -aside : aside};
            if (is_free(p)) return p;
        }
    return std::nullopt;
}

bool canLeave(const Cabin& cabin, const std::vector<Rider>& riders, const Rider& rider) {
    // Less than when they came: riders stand where they stopped, up to rounding.
    constexpr double kPassing = kGap / 2;
    const Segment2 way{rider.at, thresholdOf(cabin, rider.radius)};
    return std::all_of(riders.begin(), riders.end(), [&](const Rider& other) {
        const double apart = rider.radius + other.radius + kPassing;
        return other.id == rider.id || squaredDistance(other.at, way) >= apart * apart;
    });
}

Document cabinRoom(const Cabin& cabin, const Pose2& building_from_cabin, double lane) {
    const double x = cabin.length / 2, y = cabin.width / 2, end = x + lane;
    const double half = std::min(cabin.door, cabin.width) / 2;
    Polygon outline = {{-x, -y}, {x, -y}};
    if (half < y) outline.insert(outline.end(), {{x, -half}, {end, -half}, {end, half}, {x, half}});
    if (half >= y) outline = {{-x, -y}, {end, -y}, {end, y}};
    if (half < y) outline.push_back({x, y});
    outline.push_back({-x, y});
    return roomAround(outline, {0, 0}, building_from_cabin);
}

Document flightRoom(double width, double length, const Pose2& building_from_flight) {
    const double y = width / 2, begin = -kFlightEnd, end = length + kFlightEnd;
    return roomAround({{begin, -y}, {end, -y}, {end, y}, {begin, y}}, {length / 2, 0},
                      building_from_flight);
}

}  // namespace ispace::passages
