// SPDX-License-Identifier: GPL-3.0-or-later
// Goto: ways of movers of a world to a point, round bodies and movers that stand.
//
// A way is found once, from where the mover is, and handed to its pilot as a path. If the pilot
// gives up, a new way is sought round those that stand, up to twice; if there is none, one that
// ignores them is tried, as they may leave. Reasons for failure name a body, a door, or the nearest
// point with a way.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/number.h"
#include "sim/shut_doors.h"
#include "sim/world.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// A way that fails is tried anew as often; each failure takes Navigator::kPatience.
constexpr int kMaxAttempts = 2;
/// Metres per second below which a mover stands.
constexpr double kStands = 0.02;
/// Degrees: a smaller turn at the goal is none.
constexpr double kTurned = 1e-9;
/// A mover that stands farther from its goal, in metres, as its way was bent there and it went
/// past, returns as often.
constexpr double kNear = 0.02;
constexpr int kMaxReturns = 3;

double lengthOf(Point2 from, const std::vector<Point2>& way) {
    double sum = 0;
    for (const Point2 to : way) {
        sum += distance(from, to);
        from = to;
    }
    return sum;
}

}  // namespace

const PathFinder& World::Data::finderOf(std::size_t mover) {
    const double radius = movers[mover].model.radius;
    const Obstacles& bodies = *states[mover].obstacles;
    const auto found = finders.find({&bodies, radius});
    if (found != finders.end()) return found->second;
    return finders
        .try_emplace({&bodies, radius}, bodies, bounds(scene->environment.indoor()), radius)
        .first->second;
}

std::vector<PathFinder::Spot> World::Data::standingBeside(std::size_t mover) const {
    std::vector<PathFinder::Spot> standing;
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const Motion& motion = motions[i];
        if (i != mover && std::abs(motion.drive.speed) + std::abs(motion.side.speed) < kStands)
            standing.push_back({motion.pose.position, movers[i].model.radius});
        if (movers[mover].is_person) continue;
        for (const BodyDisc& disc : states[i].body)
            if (disc.bottom < movers[mover].model.height)
                standing.push_back({disc.center, disc.radius});
    }
    return standing;
}

std::vector<PathFinder::Spot> World::standingBeside(std::size_t mover) const {
    return data_->standingBeside(mover);
}

std::optional<Point2> World::Data::nearestRoom(std::size_t mover, Point2 goal) {
    constexpr double kPerMetre = 10;   // points of a lattice
    constexpr int kReach = 20;         // of its steps
    constexpr std::size_t kTries = 4;  // ways
    const Obstacles& bodies = *states[mover].obstacles;
    const double radius = movers[mover].model.radius;
    std::vector<std::pair<double, Point2>> points;
    const double column = std::round(goal.x * kPerMetre), row = std::round(goal.y * kPerMetre);
    for (int i = -kReach; i <= kReach; ++i)
        for (int k = -kReach; k <= kReach; ++k) {
            const Point2 p{(column + i) / kPerMetre, (row + k) / kPerMetre};
            if (distance(p, goal) * kPerMetre <= kReach) points.emplace_back(distance(p, goal), p);
        }
    std::stable_sort(points.begin(), points.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::size_t tries = 0;
    for (const auto& [off, p] : points) {
        if (scene->environment.indoor().locate(p) != Side::Inside || bodies.overlap(p, radius))
            continue;
        if (!finderOf(mover).wayBetween(motions[mover].pose.position, p).empty()) return p;
        if (++tries == kTries) break;
    }
    return std::nullopt;
}

std::string World::Data::doorsBetween(std::size_t mover, Point2 goal) const {
    const std::vector<ShutDoor> doors = shutDoorsOf(*scene);
    if (doors.empty()) return "";
    const Environment opened = withOpen(*scene, doors);
    const Obstacles bodies(opened, movers[mover].model.height, nullptr);
    const PathFinder finder(bodies, bounds(opened.indoor()), movers[mover].model.radius);
    const Point2 at = motions[mover].pose.position;
    return barriersText(at, finder.wayBetween(at, goal), doors);
}

std::string World::findPath(std::size_t mover, Command& command) {
    assert(command.verb == Verb::Goto && !command.course.path.empty());
    Data& data = *data_;
    const Point2 goal = command.course.path.back();
    const auto text_of = [](Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); };
    const Mover& who = data.movers[mover];
    const Point2 at = data.motions[mover].pose.position;
    if (const auto body = data.states[mover].obstacles->overlap(goal, who.model.radius)) {
        const auto near = data.nearestRoom(mover, goal);
        return who.id + " has no room at " + text_of(goal) + ": " + data.elements()[*body].id +
               " stands there" + (near ? "; the nearest point with room is " + text_of(*near) : "");
    }
    std::vector<Point2> way = data.finderOf(mover).wayBetween(at, goal);
    if (way.empty()) {
        const bool is_inside = data.scene->environment.indoor().locate(goal) != Side::Outside;
        const auto near = data.nearestRoom(mover, goal);
        const std::string doors = data.doorsBetween(mover, goal);
        std::string reason =
            is_inside ? "walls or bodies are between" : "it is outside of the room";
        if (!doors.empty()) reason = doors;
        return "no way for " + who.id + " to " + text_of(goal) + ": " + reason +
               (near ? "; the nearest point with a way is " + text_of(*near) : "");
    }
    command.value = lengthOf(at, way);
    command.course.path = std::move(way);
    return "";
}

/// A way ends done and at rest, done but rolling, past the goal, stalled, or given up. Past the
/// goal or stalled the mover returns to it, up to kMaxReturns times; then the command ends as the
/// way did, where the mover stands. A heading is turned to last.
bool World::Data::continueTrip(std::size_t mover, Outcome outcome) {
    GotoState& trip = *states[mover].trip;
    Motion& motion = motions[mover];
    const auto go = [&](std::vector<Point2> way) {
        MotionPlan plan;
        plan.path = std::move(way);
        pilots[mover].follow(plan, trip.speed, true, true);
        return true;
    };
    if (outcome == Outcome::Done && !motion.arrived()) {
        motion.command({Verb::Stop, 0});  // finish() reports that it stands
        return true;
    }
    const bool is_past = distance(motion.pose.position, trip.goal.at) > kNear;
    if ((outcome == Outcome::Done && is_past) || outcome == Outcome::Stall) {
        if (trip.returns++ < kMaxReturns) {
            states[mover].stall = false;
            return go({trip.goal.at});
        }
    }
    if (outcome == Outcome::Done && trip.goal.heading) {
        const double turn = wrapped(*trip.goal.heading - motion.pose.heading).degrees();
        states[mover].trip.reset();
        if (std::abs(turn) < kTurned) return false;
        motion.command({turn > 0 ? Verb::Left : Verb::Right, std::abs(turn)});
        return true;
    }
    if (outcome == Outcome::Unreached) {
        if (trip.attempts++ < kMaxAttempts) {
            const PathFinder& finder = finderOf(mover);
            const Point2 at = motion.pose.position;
            std::vector<Point2> way =
                finder.around(standingBeside(mover)).wayBetween(at, trip.goal.at);
            // Those in the way may leave it.
            if (way.empty()) way = finder.wayBetween(at, trip.goal.at);
            if (!way.empty()) return go(std::move(way));
        }
        unreached.push_back({mover, trip.goal.at});
    }
    states[mover].trip.reset();
    return false;
}

/// Keeps the present way if it is still free, so that a change elsewhere does not disturb movers,
/// and if there is no other.
void World::Data::avoidChange(std::size_t mover) {
    // Half of the margin by which ways keep away from bodies, as the mover strays from its way.
    const double reach = movers[mover].model.radius + PathFinder::kMargin / 2;
    const Obstacles& bodies = *states[mover].obstacles;
    const Point2 at = motions[mover].pose.position;
    Point2 from = at;
    bool is_blocked = false;
    for (const Point2 to : pilots[mover].ahead()) {
        is_blocked = is_blocked || bodies.near({from, to}, reach);
        from = to;
    }
    if (!is_blocked) return;
    const GotoState& trip = *states[mover].trip;
    MotionPlan plan;
    plan.path = finderOf(mover).wayBetween(at, trip.goal.at);
    if (!plan.path.empty()) pilots[mover].follow(plan, trip.speed, true, true);
}

}  // namespace ispace
