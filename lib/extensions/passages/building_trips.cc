// SPDX-License-Identifier: GPL-3.0-or-later
// Trips of robots and people through a building: their goals, legs and commands.
//
// Before each step every trip looks at the end of its mover's command and gives the next one. A
// step that fails is tried again, round movers that stand, up to five times, or ten if those that
// wait were asked to step aside. Then the trip is given up, but not on a landing: the mover clears
// it first, for those behind.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "env/body_shapes.h"
#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"
#include "scene/bodies.h"

namespace ispace::passages {

namespace {

/// A step of a trip that fails is repeated as often.
constexpr int kMaxAttempts = 5;
/// Metres from a landing at which a mover that gets no nearer joins the queue.
constexpr double kCrowd = 3;
/// A mover goes straight on to a point to which it turns by less, in degrees, or that is nearer.
constexpr double kTurned = 0.5, kStraight = 1e-3;
/// Degrees: a smaller turn at the goal is none.
constexpr double kLeastTurn = 1e-9;

}  // namespace

std::optional<Route> BuildingRun::Data::routeFrom(const Traveller& who, std::size_t storey,
                                                  Point2 at, const BuildingTrip& trip,
                                                  std::size_t goal) const {
    const StoreyPaths& all = waysOf(who);
    MoverAbility ability = who.ability;
    if (trip.plan.speed > 0) ability.speed = trip.plan.speed;
    const RoomPoint& to = trip.plan.points[goal];
    return all.route(storey, at, to.room, to.at, ability, waits(), trip.only);
}

/// Checks the ways to all goals before anything changes: a trip that is refused leaves the command
/// under way as it was. Later goals are checked from the one before, with the queues of now.
TripAnswer BuildingRun::Data::begin(const std::string& mover, BuildingTrip trip) {
    Traveller& who = travellers.find(mover)->second;
    const auto& storey = rooms[who.room].storey;
    if (!storey)
        return {.refusal =
                    mover + " is in " + rooms[who.room].id + ": it first goes on to a storey"};
    World& world = worldOf(who);
    const std::size_t index = world.moverNamed(mover).value();
    if (!world.movers()[index].rest().empty())
        return {.refusal = world.refusal(index, {.verb = Verb::Forward, .value = 1})};
    TripAnswer answer;
    std::size_t from = *storey;
    Point2 at = statusOf(who).pose.position;
    const auto text_of = [this](const RoomPoint& goal) {
        return rooms[goal.room].id + '/' + formatDouble(goal.at.x) + ',' + formatDouble(goal.at.y);
    };
    for (const RoomPoint& goal : trip.plan.points) {
        const std::string& room = rooms[goal.room].id;
        if (!rooms[goal.room].storey)
            return {.refusal = room + " is no storey: RIDE leads by a lift"};
        if (std::string fault = noFloorText(goal.room, goal.at, who); !fault.empty())
            return {.refusal = std::move(fault), .unreached = goal};
    }
    const std::vector<RoomPoint>& points = trip.plan.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto route = routeFrom(who, from, at, trip, i);
        if (!route) {
            std::string text = "no way for " + mover + " to " + text_of(points[i]);
            for (std::size_t k = 0; k < passages.size(); ++k)
                if (const std::string why = waysOf(who).refusal(passages[k], who.ability);
                    !why.empty() && (!trip.only || trip.only == k))
                    text += "; " + passages[k].id + ": " + why;
            return {.refusal = text, .unreached = points[i]};
        }
        if (std::string fault = loadText(who); !route->legs.empty() && !fault.empty())
            return {.refusal = std::move(fault), .unreached = points[i]};
        answer.length += route->length;
        for (const Leg& leg : route->legs)
            answer.via += (answer.via.empty() ? "" : ",") + passages[leg.passage].id;
        if (i == 0) trip.legs = route->legs;
        from = points[i].room;
        at = points[i].at;
    }
    finish(mover, Outcome::Replaced);
    trip.command = answer.id = world.issueId(index);
    // Ends the command under way as replaced; the trip begins before the next step.
    MotionPlan here;
    here.path = {world.status(index).pose.position};
    world.command(index, pathCommand(std::move(here)));
    trips.insert_or_assign(mover, std::move(trip));
    return answer;
}

std::string BuildingRun::Data::loadOf(const Scene& scene, const std::string& person) {
    for (std::size_t i = 0; i < scene.records.size(); ++i)
        if (personWith(scene.records[i]) == person) return scene.ids[i];
    return "";
}

/// Returns the reason why a mover that carries a thing stays on its storey: another room has a
/// thing of that name. "" if it may go.
std::string BuildingRun::Data::loadText(const Traveller& who) const {
    const World& world = *rooms[who.room].world;
    if (!who.is_person) return "";
    const auto& figure =
        world.people()[world.moverNamed(who.id).value() - world.robots().size()].figure;
    if (figure == nullptr || figure->load_parts == 0) return "";
    const std::string load = loadOf(world.scene(), who.id);
    const auto other = std::find_if(rooms.begin(), rooms.end(), [&](const Room& room) {
        const std::vector<std::string>& ids = room.world->scene().ids;
        return &room != &rooms[who.room] && std::find(ids.begin(), ids.end(), load) != ids.end();
    });
    if (other == rooms.end()) return "";
    return who.id + " carries " + load + ", and " + other->id + " has another " + load +
           ": it first sets it down";
}

void BuildingRun::Data::finish(const std::string& id, Outcome outcome, const std::string& reason) {
    const auto found = trips.find(id);
    if (found == trips.end()) return;
    release(id);
    const int command = found->second.command;
    if (outcome == Outcome::Unreached || outcome == Outcome::Stall)
        notifyUnreached(travellers.find(id)->second, found->second, reason);
    new_ends.push_back({id, command, outcome, rooms.front().world->time()});
    trips.erase(found);
    wanderOn(id, command, outcome);
}

/// Raises the event of a trip that is given up, unless it is one to a random point.
void BuildingRun::Data::notifyUnreached(const Traveller& who, const BuildingTrip& trip,
                                        const std::string& reason) {
    const auto wanderer = wanderers.find(who.id);
    if (wanderer != wanderers.end() && wanderer->second.trip == trip.command) return;
    const RoomPoint goal = trip.given_up.value_or(trip.plan.points[trip.goal]);
    rooms[who.room].simulation->events().notify({.kind = EventKind::Unreached,
                                                 .id = who.id,
                                                 .other = rooms[goal.room].id,
                                                 .place = goal.at,
                                                 .text = reason});
}

std::string BuildingRun::endTrip(const std::string& mover, Outcome outcome) {
    const auto found = data_->travellers.find(mover);
    const Data::Room& room = data_->rooms[found->second.room];
    if (!room.storey) return mover + " is in " + room.id + ": it first goes on to a storey";
    data_->finish(mover, outcome);
    data_->ends.insert(data_->ends.end(), data_->new_ends.begin(), data_->new_ends.end());
    data_->new_ends.clear();
    return "";
}

void BuildingRun::abandonTrip(const std::string& mover) {
    if (endTrip(mover, Outcome::Stopped).empty()) return;
    const auto found = data_->trips.find(mover);
    if (found != data_->trips.end()) found->second.ending = Outcome::Stopped;
}

void BuildingRun::Data::send(Traveller& who, BuildingTrip& trip, std::vector<Point2> way,
                             double speed) {
    World& world = worldOf(who);
    MotionPlan plan;
    plan.path = std::move(way);
    Command command = pathCommand(std::move(plan), std::min(speed, who.max_speed));
    command.is_attempt = true;
    trip.running = world.command(world.moverNamed(who.id).value(), command);
}

void BuildingRun::Data::sendStraight(Traveller& who, BuildingTrip& trip, std::deque<Point2> way) {
    trip.steps = std::move(way);
    goOn(who, trip);
}

void BuildingRun::Data::goOn(Traveller& who, BuildingTrip& trip) {
    World& world = worldOf(who);
    const std::size_t index = world.moverNamed(who.id).value();
    const Pose2 pose = world.status(index).pose;
    const Point2 local = seenFrom(pose, {trip.steps.front(), Angle()}).position;
    const double turn = Angle::radians(std::atan2(local.y, local.x)).degrees();
    const double way = std::hypot(local.x, local.y);
    Command command{Verb::Forward, way};
    if (way > kStraight && std::abs(turn) > kTurned)
        command = {turn > 0 ? Verb::Left : Verb::Right, std::abs(turn)};
    else
        trip.steps.pop_front();
    trip.running = world.command(index, command);
}

std::optional<Outcome> BuildingRun::Data::ended(const Traveller& who, BuildingTrip& trip) const {
    const World& world = *rooms[who.room].world;
    const auto index = world.moverNamed(who.id);
    for (const CommandEnd& end : world.ends())
        if (end.robot == index && end.id == trip.running) return end.outcome;
    return std::nullopt;
}

/// Before each step.
void BuildingRun::Data::advance() {
    ends = std::exchange(new_ends, {});
    advanceLifts();
    notifyLifts();
    releaseHolders();
    advanceWanderers();
    std::vector<std::string> ids;
    for (const auto& [id, trip] : trips) ids.push_back(id);
    for (const std::string& id : ids)
        if (const auto found = trips.find(id); found != trips.end()) advanceTrip(id, found->second);
    ends.insert(ends.end(), new_ends.begin(), new_ends.end());
    new_ends.clear();
}

/// Called between steps. A person that rests ends the trip as stopped; one that carries what
/// passages do not take, as unreached.
void BuildingRun::Data::advanceTrip(const std::string& id, BuildingTrip& trip) {
    Traveller& who = travellers.find(id)->second;
    if (who.is_person && rooms[who.room].storey) {
        const World& world = worldOf(who);
        if (!world.movers()[world.moverNamed(id).value()].rest().empty())
            return finish(id, Outcome::Stopped);
        if (trip.leg < trip.legs.size())
            if (const std::string fault = loadText(who); !fault.empty()) {
                worldOf(who).command(world.moverNamed(id).value(), {Verb::Stop, 0});
                return finish(id, Outcome::Unreached, fault);
            }
    }
    switch (trip.state) {
        case TripState::Setting:
            return setOut(who, trip);
        case TripState::Walking:
        case TripState::Turning:
        case TripState::Nearing:
        case TripState::Entering:
        case TripState::Climbing:
        case TripState::Leaving:
            if (const auto outcome = ended(who, trip)) {
                if (*outcome != Outcome::Done)
                    tryAgain(who, trip, *outcome);
                else if (!trip.steps.empty())
                    goOn(who, trip);
                else
                    step(who, trip);
            }
            return;
        case TripState::Queueing:
            return waitTurn(who, trip);
        case TripState::Riding:
            return leaveCabin(who, trip);
        case TripState::AtEnd:
            return arrive(who, trip);
        case TripState::Pausing:
            if (rooms.front().world->time() >= trip.pause_until) goToNextGoal(who, trip);
            return;
    }
}

/// Sends a mover to where it waits for the next passage, or to its goal.
void BuildingRun::Data::setOut(Traveller& who, BuildingTrip& trip) {
    const StoreyPaths& all = waysOf(who);
    const Point2 at = statusOf(who).pose.position;
    Point2 to = trip.plan.points[trip.goal].at;
    trip.state = TripState::Walking;
    trip.spot.reset();
    if (trip.ending) return clearLanding(who, trip);
    if (trip.leg < trip.legs.size()) {
        const Leg& leg = trip.legs[trip.leg];
        const Landing& landing = *all.landing(leg.passage, leg.from);
        trip.spot = freeSpot(who, landing.spots);
        // It leaves the landing to others.
        if (!trip.spot && landingUnder(who) != nullptr)
            trip.spot = spotAside(who, at, {}, clearanceOf(who));
        if (!trip.spot) return queueUp(who, trip);
        to = *trip.spot;
    }
    const std::vector<Point2> way = wayTo(who, trip, to);
    if (way.empty()) return giveUp(who, trip, Outcome::Unreached);
    send(who, trip, way, trip.plan.speed > 0 ? trip.plan.speed : who.ability.speed);
}

std::optional<Point2> BuildingRun::Data::freeSpot(const Traveller& who,
                                                  const std::vector<Point2>& spots) const {
    for (const Point2 spot : spots) {
        const bool is_taken = std::any_of(trips.begin(), trips.end(), [&](const auto& other) {
            const Traveller& its = travellers.find(other.first)->second;
            return other.first != who.id && other.second.spot && its.room == who.room &&
                   distance(*other.second.spot, spot) <
                       its.size.radius + who.size.radius + kFlightGap;
        });
        if (!is_taken) return spot;
    }
    return std::nullopt;
}

const Landing* BuildingRun::Data::landingUnder(const Traveller& who) const {
    const Point2 at = statusOf(who).pose.position;
    for (std::size_t i = 0; i < passages.size(); ++i)
        for (std::size_t k = 0; k < passages[i].storeys.size(); ++k) {
            const Landing* const landing = waysOf(who).landing(i, k);
            if (landing != nullptr && landing->storey == rooms[who.room].storey &&
                distance(at, landing->at.position) < clearanceOf(who))
                return landing;
        }
    return nullptr;
}

/// Ends a trip that cannot go on, off the landings, where it would block those behind it.
void BuildingRun::Data::giveUp(Traveller& who, BuildingTrip& trip, Outcome outcome) {
    if (trip.ending || landingUnder(who) == nullptr)
        return finish(who.id, trip.ending.value_or(outcome));
    release(who.id);
    trip.ending = outcome;
    trip.attempts = 0;
    trip.state = TripState::Setting;
}

/// Goes from the landing to a spot of those that wait, where the trip ends.
void BuildingRun::Data::clearLanding(Traveller& who, BuildingTrip& trip) {
    const Landing* const landing = landingUnder(who);
    trip.legs.clear();
    trip.leg = 0;
    if (landing != nullptr) {
        std::vector<Point2> spots = landing->spots;
        std::erase_if(spots, [&](Point2 spot) { return !isFree(who.room, spot, who); });
        trip.spot = freeSpot(who, spots);
    }
    const std::vector<Point2> way = trip.spot
                                        ? waysOf(who)
                                              .finder(landing->storey)
                                              .wayBetween(statusOf(who).pose.position, *trip.spot)
                                        : std::vector<Point2>();
    if (way.empty()) return finish(who.id, *trip.ending);
    if (!trip.given_up) trip.given_up = trip.plan.points[trip.goal];
    trip.plan = {.points = {{landing->storey, *trip.spot}}};
    trip.goal = 0;
    send(who, trip, way, who.ability.speed);
}

void BuildingRun::Data::arriveAtGoal(Traveller& who, BuildingTrip& trip) {
    const bool is_last = trip.goal + 1 == trip.plan.points.size() && !trip.plan.loop;
    if (is_last && !trip.ending && trip.state != TripState::Turning && turnAtGoal(who, trip))
        return;
    if (is_last) return finish(who.id, trip.ending.value_or(Outcome::Done));
    trip.state = TripState::Pausing;
    trip.pause_until = rooms.front().world->time() + simSeconds(trip.plan.pause);
    if (!(trip.plan.pause > 0)) goToNextGoal(who, trip);
}

/// Turns to the heading of the plan. \returns false if it has none, or the mover heads there
bool BuildingRun::Data::turnAtGoal(Traveller& who, BuildingTrip& trip) {
    if (!trip.plan.heading) return false;
    const double turn = wrapped(*trip.plan.heading - statusOf(who).pose.heading).degrees();
    if (std::abs(turn) < kLeastTurn) return false;
    World& world = worldOf(who);
    trip.state = TripState::Turning;
    trip.running = world.command(world.moverNamed(who.id).value(),
                                 {turn > 0 ? Verb::Left : Verb::Right, std::abs(turn)});
    return true;
}

void BuildingRun::Data::goToNextGoal(Traveller& who, BuildingTrip& trip) {
    trip.goal = (trip.goal + 1) % trip.plan.points.size();
    const auto route =
        routeFrom(who, *rooms[who.room].storey, statusOf(who).pose.position, trip, trip.goal);
    if (!route) return giveUp(who, trip, Outcome::Unreached);
    trip.legs = route->legs;
    trip.leg = 0;
    trip.state = TripState::Setting;
}

const std::vector<StoreySection>& BuildingRun::Data::sectionsOf(const Traveller& who,
                                                                BuildingTrip& trip) const {
    if (trip.planned_goal == trip.goal && trip.planned_legs == trip.legs) return trip.planned;
    trip.planned_goal = trip.goal;
    trip.planned_legs = trip.legs;
    trip.planned.clear();
    const StoreyPaths& all = waysOf(who);
    for (std::size_t i = 0; i < trip.legs.size(); ++i) {
        const Leg& leg = trip.legs[i];
        const Landing& from = *all.landing(leg.passage, leg.to);
        const bool is_last = i + 1 == trip.legs.size();
        const Point2 to =
            is_last ? trip.plan.points[trip.goal].at
                    : all.landing(trip.legs[i + 1].passage, trip.legs[i + 1].from)->at.position;
        StoreySection& section = trip.planned.emplace_back();
        section.storey = from.storey;
        section.points = all.finder(from.storey).way(from.ways, to);
        section.points.insert(section.points.begin(), from.at.position);
    }
    return trip.planned;
}

std::vector<PlannedPath> BuildingRun::plannedPaths(std::size_t room) const {
    std::vector<PlannedPath> found;
    const std::optional<std::size_t> storey = data_->rooms[room].storey;
    if (!storey) return found;
    for (auto& [id, trip] : data_->trips) {
        if (trip.ending || trip.leg >= trip.legs.size()) continue;
        const auto& sections = data_->sectionsOf(data_->travellers.find(id)->second, trip);
        for (std::size_t i = trip.leg; i < sections.size(); ++i)
            if (sections[i].storey == *storey) found.push_back({id, sections[i].points});
    }
    return found;
}

/// After a command that came to its end.
void BuildingRun::Data::step(Traveller& who, BuildingTrip& trip) {
    trip.attempts = 0;
    switch (trip.state) {
        case TripState::Walking:
            if (trip.leg < trip.legs.size()) return queueUp(who, trip);
            return arriveAtGoal(who, trip);
        case TripState::Turning:
            return arriveAtGoal(who, trip);
        case TripState::Nearing:
            return enter(who, trip);
        case TripState::Entering: {
            const Leg& leg = trip.legs[trip.leg];
            stops[leg.passage][leg.from].holder.clear();
            lifts[leg.passage].call(leg.to);
            trip.state = TripState::Riding;
            return;
        }
        default:
            trip.state = TripState::AtEnd;
            return arrive(who, trip);
    }
}

/// After a command that failed: another mover may have been in the way.
void BuildingRun::Data::tryAgain(Traveller& who, BuildingTrip& trip, Outcome outcome) {
    if (trip.state == TripState::Turning) return finish(who.id, outcome);
    trip.steps.clear();
    const bool has_leg = trip.leg < trip.legs.size();
    if (const auto& storey = rooms[who.room].storey) {
        const Point2 at = statusOf(who).pose.position;
        const Point2 to = trip.spot ? *trip.spot
                          : has_leg
                              ? waysOf(who)
                                    .landing(trip.legs[trip.leg].passage, trip.legs[trip.leg].from)
                                    ->at.position
                              : trip.plan.points[trip.goal].at;
        const std::vector<Point2> way = waysOf(who).finder(*storey).wayBetween(at, to);
        const bool is_heard = askAside(*storey, who.size.radius, at, way);
        if (++trip.attempts > (is_heard ? 2 : 1) * kMaxAttempts) return giveUp(who, trip, outcome);
    }
    switch (trip.state) {
        case TripState::Walking:
            // Others crowd about the landing: it waits where it is.
            if (has_leg && isNearLanding(who, trip)) return queueUp(who, trip);
            trip.state = TripState::Setting;
            return;
        case TripState::Nearing: {
            const Leg& leg = trip.legs[trip.leg];
            stops[leg.passage][leg.from].holder.clear();
            std::erase(stops[leg.passage][leg.from].queue, who.id);
            return queueUp(who, trip);
        }
        case TripState::Entering: {
            const Leg& leg = trip.legs[trip.leg];
            const StoreyLink& passage = passages[leg.passage];
            for (const Rider& rider : riders[leg.passage])
                if (rider.id == who.id)
                    sendStraight(who, trip,
                                 {passage.frame * thresholdOf(passage.cabin, who.size.radius),
                                  passage.frame * rider.at});
            return;
        }
        case TripState::Climbing:
            return climb(who, trip);
        default:
            return leaveCabin(who, trip);
    }
}

bool BuildingRun::Data::isNearLanding(const Traveller& who, const BuildingTrip& trip) const {
    const Leg& leg = trip.legs[trip.leg];
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.from);
    return distance(statusOf(who).pose.position, landing.at.position) < kCrowd;
}

}  // namespace ispace::passages
