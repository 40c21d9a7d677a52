// SPDX-License-Identifier: GPL-3.0-or-later
// Landings, spots to wait, and routes.
//
// A landing is the first free point before a door, or the free point nearest to the end of a flight
// that no wall parts from it (any, if all are parted). Spots are points of a raster, nearest by way
// first, off the floor before doors and off the ways to other landings; where there are none,
// movers wait in the way (waits_in_way), which landing_check.h reports. Dijkstra's algorithm over
// the landings is quadratic in them, without a heap: there are few.
#include "extensions/passages/storey_paths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>

#include "env/walls.h"
#include "sim/collision.h"
#include "site/site_sight.h"

namespace ispace::passages {

namespace {

/// Width that a mover needs besides its own.
constexpr double kRoom = 0.1;
/// Landings lie at most this far from a door or from the end of a flight, in metres.
constexpr double kMaxLanding = 1.5, kLandingStep = 0.05;
/// Waiting movers stand at most this far from the landing, on a grid of this step.
constexpr double kMaxSpot = 4, kSpotStep = 0.5;
constexpr std::size_t kMaxSpots = 8;
/// Landings of a storey to which the ways from one are kept free, the nearest: with more of them,
/// ways to farther ones pass these.
constexpr std::size_t kMaxPathsOut = 32;
/// The floor before a door that waiting movers leave free, metres ahead.
constexpr double kLeftFree = 2.5;

/// Fills in what a record leaves out: a door of 0.9 m, at most as wide as the cabin, and a top
/// straight ahead.
StoreyLink passageOf(const SiteScene& building, const StoreyPassage& from) {
    StoreyLink passage{.id = from.id, .storeys = from.storeys};
    const Record& record = from.record;
    const Tuple& size = record.tuple("size");
    passage.is_lift = record.keyword() == "lift";
    passage.frame = {pointOf(record.tuple("at")), record.angle("heading")};
    if (passage.is_lift) {
        constexpr double kDoor = 0.9;
        passage.cabin = {
            .width = size[0],
            .length = size[1],
            .door = std::min(size[0], record.has("door") ? record.number("door") : kDoor),
            .capacity = from.capacity};
        passage.lift = {.floors = {}, .speed = record.number("speed"), .door = passage.cabin.door};
        for (const std::size_t storey : from.storeys)
            passage.lift.floors.push_back(building.document.storeys[storey].floor);
        return passage;
    }
    passage.width = size[0];
    const Point2 ahead = passage.frame * Point2{size[1], 0};
    passage.top = record.has("top") ? pointOf(record.tuple("top")) : ahead;
    // Ahead to the end of the steps, and from there to the top: stairs may turn.
    passage.length = size[1] + distance(ahead, passage.top);
    return passage;
}

Pose2 inFrameOf(const Storey& storey, const Pose2& building_pose) {
    return seenFrom(storey.building_from_storey, building_pose);
}

}  // namespace

std::vector<StoreyLink> passagesOf(const SiteScene& building) {
    std::vector<StoreyLink> passages;
    for (const StoreyPassage& one : building.document.passages)
        if (one.storeys.size() > 1 && one.record.keyword() != "shaft")
            passages.push_back(passageOf(building, one));
    return passages;
}

StoreyPaths::StoreyPaths(const SiteScene& building, const std::vector<StoreyLink>& passages,
                         const MoverSize& size)
    : passages_(&passages), size_(size) {
    // Movers climb the steps in the openings of stairs.
    std::vector<std::vector<Polygon>> holes(building.scenes.size());
    for (const FloorOpening& opening : floorOpenings(building)) {
        if (!opening.flight.empty()) continue;
        Polygon& hole = holes[opening.above].emplace_back(opening.outline);
        for (Point2& corner : hole)
            corner = inStorey(building.document.storeys[opening.above], corner);
    }
    obstacles_.reserve(building.scenes.size());
    finders_.reserve(building.scenes.size());
    for (std::size_t i = 0; i < building.scenes.size(); ++i) {
        const Environment& room = building.scenes[i]->environment;
        const Obstacles& obstacles = obstacles_.emplace_back(room, size.height, nullptr);
        finders_.emplace_back(obstacles, bounds(room.indoor()), size.radius, holes[i]);
    }
    for (std::size_t i = 0; i < passages.size(); ++i)
        if (passages[i].is_lift)
            addLift(building, i);
        else
            addStairs(building, i);
    for (Landing& landing : landings_) addSpots(landing);
}

/// The landing is the free point nearest to the door, straight before it; a stop without one is not
/// used.
void StoreyPaths::addLift(const SiteScene& building, std::size_t index) {
    const StoreyLink& passage = (*passages_)[index];
    for (std::size_t stop = 0; stop < passage.storeys.size(); ++stop) {
        const std::size_t storey = passage.storeys[stop];
        for (double lane = size_.radius + kRoom; lane <= kMaxLanding + size_.radius;
             lane += kLandingStep) {
            // About to enter, a mover faces the door.
            const Pose2 before{{passage.cabin.length / 2 + lane, 0}, Angle::degrees(180)};
            const Pose2 at =
                inFrameOf(building.document.storeys[storey], placedIn(passage.frame, before));
            if (!finders_[storey].isFree(at.position)) continue;
            landings_.push_back({.passage = index,
                                 .stop = stop,
                                 .storey = storey,
                                 .at = at,
                                 .lane = lane,
                                 .spots = {},
                                 .ways = finders_[storey].waysFrom(at.position)});
            break;
        }
    }
}

void StoreyPaths::addStairs(const SiteScene& building, std::size_t index) {
    const StoreyLink& passage = (*passages_)[index];
    const auto add = [&](std::size_t stop, const Pose2& end) {
        const std::size_t storey = passage.storeys[stop];
        const Pose2 from = inFrameOf(building.document.storeys[storey], end);
        const auto p = freeBefore(storey, from);
        if (!p) return;
        const double room = widthToWalk(size_.radius) / 2;
        landings_.push_back({.passage = index,
                             .stop = stop,
                             .storey = storey,
                             .at = {*p, from.heading},
                             .lane = 0,
                             .is_tight = obstacles_[storey].overlap(*p, room).has_value(),
                             .spots = {},
                             .ways = finders_[storey].waysFrom(*p)});
    };
    // Inner storeys of stairs have a foot and a top; movers come and go at the foot.
    for (std::size_t stop = 0; stop < passage.storeys.size(); ++stop) {
        const bool is_top = stop + 1 == passage.storeys.size();
        const Angle back = passage.frame.heading + Angle::degrees(180);
        add(stop, is_top ? Pose2{passage.top, back} : passage.frame);
    }
}

/// Finds the free point nearest to an end of a flight that no wall parts from it; if there is none,
/// the nearest one at all. \param end heads to the steps
std::optional<Point2> StoreyPaths::freeBefore(std::size_t storey, const Pose2& end) const {
    constexpr double kThin = 0.01;
    constexpr int kDirections = 16;
    const Obstacles& bodies = obstacles_[storey];
    const auto is_before = [&](Point2 p) {
        // A body that stands for the steps may contain the end.
        const double length = distance(end.position, p);
        Point2 from = end.position;
        for (double way = kLandingStep; way < length && bodies.overlap(from, kThin);
             way += kLandingStep)
            from = end.position + way / length * (p - end.position);
        return !bodies.near({from, p}, kThin);
    };
    std::optional<Point2> beyond;
    for (double way = 0; way <= kMaxLanding; way += kLandingStep)
        for (int k = 0; k < kDirections; ++k) {
            // First straight away from the steps, then to the sides.
            const int aside = (k + 1) / 2;
            const double turn = 180 + (k % 2 == 0 ? 1 : -1) * aside * 360.0 / kDirections;
            const Point2 p =
                Pose2{end.position, end.heading + Angle::degrees(turn)} * Point2{way, 0};
            if (!finders_[storey].isFree(p)) continue;
            if (is_before(p)) return p;
            if (!beyond) beyond = p;
        }
    return beyond;
}

const Landing* StoreyPaths::landing(std::size_t passage, std::size_t stop) const {
    for (const Landing& landing : landings_)
        if (landing.passage == passage && landing.stop == stop) return &landing;
    return nullptr;
}

/// Returns the ways from a landing to the nearest others of its storey and to the point farthest
/// away.
std::vector<Segment2> StoreyPaths::waysOut(const Landing& landing) const {
    const PathFinder& finder = finders_[landing.storey];
    std::vector<Segment2> out;
    const auto add = [&](const std::vector<Point2>& way) {
        Point2 from = landing.at.position;
        for (const Point2 to : way) {
            out.push_back({from, to});
            from = to;
        }
    };
    std::vector<std::pair<double, Point2>> others;
    for (const Landing& other : landings_)
        if (&other != &landing && other.storey == landing.storey)
            others.emplace_back(distance(other.at.position, landing.at.position),
                                other.at.position);
    const auto end =
        others.begin() + static_cast<std::ptrdiff_t>(std::min(others.size(), kMaxPathsOut));
    std::partial_sort(others.begin(), end, others.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    std::for_each(others.begin(), end,
                  [&](const auto& other) { add(finder.way(landing.ways, other.second)); });
    if (const auto farthest = finder.farthestReached(landing.ways))
        add(finder.way(landing.ways, *farthest));
    return out;
}

double StoreyPaths::widthToWalk(double radius) {
    return 2 * (radius + PathFinder::kMargin + kRoom);
}

double StoreyPaths::widthToPass(double radius) { return widthToWalk(radius) + 4 * radius; }

/// Returns the length of the way over a passage from the landing to its far end, and its width.
Vec2 StoreyPaths::sizeOf(const Landing& landing) const {
    const StoreyLink& passage = (*passages_)[landing.passage];
    return {landing.lane + (passage.is_lift ? passage.cabin.length : passage.length),
            passage.is_lift ? passage.cabin.width : passage.width};
}

/// Returns the landings of its storey, itself among them, whose passages, and the floor that is
/// left free before them, may have points at most this far from the landing.
std::vector<const Landing*> StoreyPaths::landingsNear(const Landing& landing, double far) const {
    const double free = kLeftFree + 2 * (2 * size_.radius + kRoom);
    std::vector<const Landing*> near;
    for (const Landing& other : landings_) {
        if (other.storey != landing.storey) continue;
        const Vec2 size = sizeOf(other);
        const double reach = std::max(free, size.x + size.y + 2 * size_.radius);
        if (distance(other.at.position, landing.at.position) <= far + reach) near.push_back(&other);
    }
    return near;
}

/// Finds points near a landing that leave the way to the passages free.
void StoreyPaths::addSpots(Landing& landing) const {
    const PathFinder& finder = finders_[landing.storey];
    const double wide = 2 * size_.radius;
    // The floor before the door of a lift is left free anyway.
    const std::vector<Segment2> ways_out =
        (*passages_)[landing.passage].is_lift ? std::vector<Segment2>() : waysOut(landing);
    std::vector<std::tuple<double, double, double>> found, in_ways;
    const int reach = static_cast<int>(kMaxSpot / kSpotStep);
    const std::vector<const Landing*> near = landingsNear(landing, std::numbers::sqrt2 * kMaxSpot);
    for (int i = -reach; i <= reach; ++i)
        for (int k = -reach; k <= reach; ++k) {
            const Point2 p = landing.at.position + Vec2{i * kSpotStep, k * kSpotStep};
            const bool is_in_way = std::any_of(near.begin(), near.end(), [&](const Landing* other) {
                const Point2 local = seenFrom(other->at, {p, Angle()}).position;
                const bool is_before =
                    local.x < 0 && local.x > -kLeftFree - wide && std::abs(local.y) < wide + kRoom;
                const Vec2 size = sizeOf(*other);
                const bool is_within = local.x >= 0 && local.x < size.x + size_.radius &&
                                       std::abs(local.y) < size.y / 2 + size_.radius;
                return is_before || is_within || distance(p, other->at.position) < wide + 4 * kRoom;
            });
            if (is_in_way || !finder.isFree(p)) continue;
            const auto way = finder.length(landing.ways, p);
            if (!way || *way > 2 * kMaxSpot) continue;
            const bool is_in_way_out =
                std::any_of(ways_out.begin(), ways_out.end(),
                            [&](const Segment2& out) { return distance(p, out) < wide + kRoom; });
            (is_in_way_out ? in_ways : found).emplace_back(*way, p.x, p.y);
        }
    if (found.empty()) {
        landing.waits_in_way = true;
        found = std::move(in_ways);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [way, x, y] : found) {
        const Point2 p{x, y};
        const bool is_apart =
            std::all_of(landing.spots.begin(), landing.spots.end(),
                        [&](Point2 other) { return distance(p, other) >= wide + 3 * kRoom; });
        if (is_apart) landing.spots.push_back(p);
        if (landing.spots.size() == kMaxSpots) break;
    }
}

std::string StoreyPaths::refusal(const StoreyLink& passage, const MoverAbility& ability) const {
    const double wide = 2 * size_.radius + kRoom;
    if (!passage.is_lift) {
        if (!ability.climbs) return "it does not climb stairs";
        return passage.width < wide ? passage.id + " is too narrow for it" : "";
    }
    if (passage.cabin.door < wide) return "the door of " + passage.id + " is too narrow for it";
    const Rider alone{.id = "", .at = {}, .radius = size_.radius, .mass = ability.mass};
    if (ability.mass > passage.cabin.capacity) return "it is too heavy for " + passage.id;
    return slotIn(passage.cabin, {}, alone) ? "" : passage.id + " is too small for it";
}

std::optional<Route> StoreyPaths::route(std::size_t from_storey, Point2 from, std::size_t to_storey,
                                        Point2 to, const MoverAbility& ability,
                                        const std::vector<double>& wait,
                                        std::optional<std::size_t> only) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    struct Node {
        double seconds = kInfinity, length = 0;
        std::optional<std::size_t> before = {};
        bool is_done = false;
    };
    // Dijkstra over landings; the last node is the goal.
    const std::size_t goal = landings_.size();
    std::vector<Node> nodes(goal + 1);
    const auto improve = [&](std::size_t node, double seconds, double length,
                             std::optional<std::size_t> before) {
        if (!(seconds < nodes[node].seconds)) return;
        nodes[node] = {seconds, length, before, false};
    };
    const auto reach = [&](std::optional<std::size_t> before, std::size_t node,
                           std::optional<double> way) {
        const Node start = before ? nodes[*before] : Node{.seconds = 0};
        if (way) improve(node, start.seconds + *way / ability.speed, start.length + *way, before);
    };
    const auto walk = [&](std::size_t before) {
        const Landing& here = landings_[before];
        const auto length_to = [&](Point2 p) { return finders_[here.storey].length(here.ways, p); };
        for (std::size_t i = 0; i < goal; ++i)
            if (landings_[i].storey == here.storey && i != before)
                reach(before, i, length_to(landings_[i].at.position));
        if (here.storey == to_storey) reach(before, goal, length_to(to));
    };
    // Ways are as long back: those of the landings hold that from the start.
    for (std::size_t i = 0; i < goal; ++i)
        if (landings_[i].storey == from_storey)
            reach(std::nullopt, i, finders_[from_storey].length(landings_[i].ways, from));
    if (from_storey == to_storey) {
        const std::vector<Point2> way = finders_[to_storey].wayBetween(from, to);
        double length = 0;
        for (std::size_t i = 0; i < way.size(); ++i)
            length += distance(i == 0 ? from : way[i - 1], way[i]);
        if (!way.empty()) reach(std::nullopt, goal, length);
    }
    for (;;) {
        std::size_t next = goal + 1;
        for (std::size_t i = 0; i <= goal; ++i)
            if (!nodes[i].is_done && nodes[i].seconds < kInfinity &&
                (next > goal || nodes[i].seconds < nodes[next].seconds))
                next = i;
        if (next > goal) return std::nullopt;
        nodes[next].is_done = true;
        if (next == goal) break;
        const Landing& here = landings_[next];
        const StoreyLink& passage = (*passages_)[here.passage];
        walk(next);
        if ((only && *only != here.passage) || !refusal(passage, ability).empty()) continue;
        for (std::size_t i = 0; i < goal; ++i) {
            const Landing& there = landings_[i];
            if (there.passage != here.passage || there.stop == here.stop) continue;
            if (passage.is_lift) {
                const double rise =
                    std::abs(passage.lift.floors[there.stop] - passage.lift.floors[here.stop]);
                const double doors = 4 * doorTime(passage.cabin.door) + seconds(Lift::kDwell);
                improve(i,
                        nodes[next].seconds + wait[here.passage] + doors +
                            liftRide(rise, passage.lift.speed),
                        nodes[next].length, next);
            } else {
                // One flight after the other.
                const bool is_next = there.stop + 1 == here.stop || here.stop + 1 == there.stop;
                const double pace = there.stop > here.stop ? kSpeedUp : kSpeedDown;
                if (is_next)
                    improve(i,
                            nodes[next].seconds + wait[here.passage] +
                                passage.length / std::min(pace, ability.speed),
                            nodes[next].length + passage.length, next);
            }
        }
    }
    Route route{{}, nodes[goal].length, nodes[goal].seconds};
    for (std::size_t i = goal; nodes[i].before; i = *nodes[i].before) {
        if (i == goal) continue;
        const Landing& to_landing = landings_[i];
        const Landing& from_landing = landings_[*nodes[i].before];
        if (to_landing.passage == from_landing.passage && to_landing.stop != from_landing.stop)
            route.legs.insert(route.legs.begin(),
                              Leg{to_landing.passage, from_landing.stop, to_landing.stop});
    }
    return route;
}

}  // namespace ispace::passages
