// SPDX-License-Identifier: GPL-3.0-or-later
// Trips of robots and people through a building.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/message.h"
#include "base/number.h"
#include "passage/building_run.h"
#include "passage/building_run_data.h"

namespace ispace {

namespace {

/// A step of a trip that fails is repeated as often.
constexpr int kMostAttempts = 5;
/// Metres between two movers on a flight, and between one that leaves a landing and the next.
constexpr double kFlightGap = 0.2, kClearLanding = 0.3;
/// Metres from a landing at which a mover that gets no nearer joins the queue.
constexpr double kCrowd = 3;
/// A mover goes straight on to a point to which it turns by less, in degrees, or that is nearer.
constexpr double kTurned = 0.5, kStraight = 1e-3;
/// Seconds that a mover expects to wait for each one before it.
constexpr double kTurnWait = 15;

}  // namespace

/// Returns the seconds for which a mover that comes now would wait for each passage.
std::vector<double> BuildingRun::Data::waits() const {
    std::vector<double> waits(passages.size());
    for (std::size_t i = 0; i < passages.size(); ++i) {
        for (const Stop& stop : stops[i])
            waits[i] += kTurnWait * static_cast<double>(stop.queue.size());
        waits[i] += kTurnWait * static_cast<double>(riders[i].size());
    }
    // Those on the way to one.
    for (const auto& [id, trip] : trips)
        if (trip.state == TripState::Walking && trip.leg < trip.legs.size())
            waits[trip.legs[trip.leg].passage] += kTurnWait;
    return waits;
}

std::optional<Route> BuildingRun::Data::routeFrom(const Traveller& who, std::size_t storey,
                                                  Point2 at, const BuildingTrip& trip,
                                                  std::size_t goal) const {
    const StoreyWays& all = waysOf(who);
    MoverAbility ability = who.ability;
    if (trip.speed > 0) ability.speed = trip.speed;
    return all.route(storey, at, trip.goals[goal].room, trip.goals[goal].at, ability, waits(),
                     trip.only);
}

TripAnswer BuildingRun::Data::begin(const std::string& mover, BuildingTrip trip) {
    Traveller& who = travellers.find(mover)->second;
    const auto& storey = rooms[who.room].storey;
    if (!storey)
        return {.refusal =
                    mover + " is in " + rooms[who.room].id + ": it first goes on to a storey"};
    TripAnswer answer;
    std::size_t from = *storey;
    Point2 at = statusOf(who).pose.position;
    const auto text_of = [this](const RoomPoint& goal) {
        return rooms[goal.room].id + '/' + formatDouble(goal.at.x) + ',' + formatDouble(goal.at.y);
    };
    for (const RoomPoint& goal : trip.goals) {
        const std::string& room = rooms[goal.room].id;
        if (!rooms[goal.room].storey)
            return {.refusal = room + " is no storey: RIDE leads by a lift"};
        const Scene& scene = rooms[goal.room].world->scene();
        if (const auto element = waysOf(who).obstacles(goal.room).overlap(goal.at, who.size.radius))
            return {.refusal = std::string(mover)
                                   .append(" has no room at ")
                                   .append(text_of(goal))
                                   .append(": ")
                                   .append(scene.environment.elements()[*element].id)
                                   .append(" stands there")};
    }
    for (std::size_t i = 0; i < trip.goals.size(); ++i) {
        const auto route = routeFrom(who, from, at, trip, i);
        if (!route) {
            std::string text = "no way for " + mover + " to " + text_of(trip.goals[i]);
            for (std::size_t k = 0; k < passages.size(); ++k)
                if (const std::string why = waysOf(who).refusal(passages[k], who.ability);
                    !why.empty() && (!trip.only || trip.only == k))
                    text += "; " + passages[k].id + ": " + why;
            return {.refusal = text};
        }
        answer.length += route->length;
        for (const Leg& leg : route->legs)
            answer.via += (answer.via.empty() ? "" : ",") + passages[leg.passage].id;
        if (i == 0) trip.legs = route->legs;
        from = trip.goals[i].room;
        at = trip.goals[i].at;
    }
    World& world = worldOf(who);
    const std::size_t index = world.moverNamed(mover).value();
    finish(mover, Outcome::Replaced);
    trip.command = answer.id = world.issueId(index);
    // Ends the command under way as replaced; the trip begins before the next step.
    MotionPlan here;
    here.path = {world.status(index).pose.position};
    world.command(index, pathCommand(std::move(here)));
    trips.insert_or_assign(mover, std::move(trip));
    return answer;
}

void BuildingRun::Data::finish(const std::string& id, Outcome outcome) {
    const auto found = trips.find(id);
    if (found == trips.end()) return;
    release(id);
    new_ends.push_back({id, found->second.command, outcome, rooms.front().world->time()});
    trips.erase(found);
}

/// Gives up all turns of a mover.
void BuildingRun::Data::release(const std::string& id) {
    for (auto& of_passage : stops)
        for (Stop& stop : of_passage) {
            std::erase(stop.queue, id);
            if (stop.holder == id) stop.holder.clear();
        }
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

void BuildingRun::Data::send(Traveller& who, BuildingTrip& trip, std::vector<Point2> way,
                             double speed) {
    World& world = worldOf(who);
    MotionPlan plan;
    plan.path = std::move(way);
    trip.running = world.command(world.moverNamed(who.id).value(),
                                 pathCommand(std::move(plan), std::min(speed, who.max_speed)));
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
    releaseHolders();
    std::vector<std::string> ids;
    for (const auto& [id, trip] : trips) ids.push_back(id);
    for (const std::string& id : ids)
        if (const auto found = trips.find(id); found != trips.end()) advanceTrip(id, found->second);
    ends.insert(ends.end(), new_ends.begin(), new_ends.end());
    new_ends.clear();
}

/// Returns true if a mover is about to use the open door.
bool BuildingRun::Data::mayHoldOpen(std::size_t lift) const {
    const std::size_t stop = lifts[lift].stop();
    if (!lifts[lift].isOpenAt(stop)) return false;
    for (const Rider& rider : riders[lift])
        if (rider.stop == stop) return true;
    const Stop& here = stops[lift][stop];
    if (!here.holder.empty()) {
        const auto trip = trips.find(here.holder);
        const bool comes = trip != trips.end() && (trip->second.state == TripState::Nearing ||
                                                   trip->second.state == TripState::Entering);
        if (comes) return true;
    }
    if (here.queue.empty()) return false;
    const Traveller& first = travellers.find(here.queue.front())->second;
    return slotIn(passages[lift].cabin, riders[lift],
                  {.id = first.id,
                   .at = {},
                   .radius = first.size.radius,
                   .mass = first.ability.mass,
                   .stop = trips.find(first.id)->second.legs[trips.find(first.id)->second.leg].to})
        .has_value();
}

void BuildingRun::Data::advanceLifts() {
    const SimTime time = rooms.front().world->time();
    for (std::size_t i = 0; i < passages.size(); ++i)
        if (passages[i].is_lift) lifts[i].advance(time, mayHoldOpen(i));
}

/// A mover that has left a passage keeps its turn until it has gone from the landing.
void BuildingRun::Data::releaseHolders() {
    for (std::size_t i = 0; i < passages.size(); ++i)
        for (std::size_t k = 0; k < stops[i].size(); ++k) {
            std::string& holder = stops[i][k].holder;
            if (holder.empty()) continue;
            const Traveller& who = travellers.find(holder)->second;
            const auto trip = trips.find(holder);
            const bool uses = trip != trips.end() && (trip->second.state == TripState::Nearing ||
                                                      trip->second.state == TripState::Entering ||
                                                      trip->second.state == TripState::Leaving ||
                                                      trip->second.state == TripState::AtEnd);
            if (uses) continue;
            const Landing* const landing = waysOf(who).landing(i, k);
            const double clear = 2 * who.size.radius + kClearLanding;
            // One that stays there lets the next ones try.
            const bool stays = trip == trips.end();
            if (stays || who.room != landing->storey ||
                distance(statusOf(who).pose.position, landing->at.position) > clear)
                holder.clear();
        }
}

void BuildingRun::Data::advanceTrip(const std::string& id, BuildingTrip& trip) {
    Traveller& who = travellers.find(id)->second;
    switch (trip.state) {
        case TripState::Setting:
            return setOut(who, trip);
        case TripState::Walking:
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
    }
}

/// Sends a mover to where it waits for the next passage, or to its goal.
void BuildingRun::Data::setOut(Traveller& who, BuildingTrip& trip) {
    const StoreyWays& all = waysOf(who);
    const Point2 at = statusOf(who).pose.position;
    const std::size_t storey = *rooms[who.room].storey;
    Point2 to = trip.goals[trip.goal].at;
    trip.state = TripState::Walking;
    trip.spot.reset();
    if (trip.leg < trip.legs.size()) {
        const Leg& leg = trip.legs[trip.leg];
        const Landing& landing = *all.landing(leg.passage, leg.from);
        for (const Point2 spot : landing.spots) {
            const bool is_taken = std::any_of(trips.begin(), trips.end(), [&](const auto& other) {
                const Traveller& its = travellers.find(other.first)->second;
                return other.first != who.id && other.second.spot && its.room == who.room &&
                       distance(*other.second.spot, spot) <
                           its.size.radius + who.size.radius + kFlightGap;
            });
            if (is_taken) continue;
            trip.spot = spot;
            break;
        }
        if (!trip.spot) return queueUp(who, trip);
        to = *trip.spot;
    }
    const std::vector<Point2> way = all.finder(storey).wayBetween(at, to);
    if (way.empty()) return finish(who.id, Outcome::Unreached);
    send(who, trip, way, trip.speed > 0 ? trip.speed : who.ability.speed);
}

/// After a command that came to its end.
void BuildingRun::Data::step(Traveller& who, BuildingTrip& trip) {
    trip.attempts = 0;
    switch (trip.state) {
        case TripState::Walking:
            if (trip.leg < trip.legs.size()) return queueUp(who, trip);
            if (++trip.goal == trip.goals.size()) return finish(who.id, Outcome::Done);
            if (const auto route = routeFrom(who, *rooms[who.room].storey,
                                             statusOf(who).pose.position, trip, trip.goal)) {
                trip.legs = route->legs;
                trip.leg = 0;
                trip.state = TripState::Setting;
                return;
            }
            return finish(who.id, Outcome::Unreached);
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

void BuildingRun::Data::queueUp(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    stops[leg.passage][leg.from].queue.push_back(who.id);
    trip.state = TripState::Queueing;
}

/// Returns true if a mover may enter a flight of stairs at that end.
bool BuildingRun::Data::mayPass(const Traveller& who, const StoreyLink& passage, std::size_t room,
                                bool is_up) const {
    const World& world = *rooms[room].world;
    const double radius = who.size.radius;
    for (const Mover& mover : world.movers()) {
        const double room_for_two = 2 * (radius + mover.model.radius) + 2 * kFlightGap;
        const auto trip = trips.find(mover.id);
        const bool goes_up = trip != trips.end() && trip->second.legs[trip->second.leg].to >
                                                        trip->second.legs[trip->second.leg].from;
        if (goes_up != is_up && passage.width < room_for_two) return false;
    }
    return true;
}

/// Goes to the landing once it is the mover's turn.
void BuildingRun::Data::waitTurn(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    Stop& stop = stops[leg.passage][leg.from];
    if (stop.queue.front() != who.id) return;
    if (passage.is_lift) {
        Lift& lift = lifts[leg.passage];
        if (!lift.isOpenAt(leg.from)) return lift.call(leg.from);
        for (const Rider& rider : riders[leg.passage])
            if (rider.stop == leg.from) return;
        const Rider rider{who.id, {}, who.size.radius, who.ability.mass, leg.to};
        if (!slotIn(passage.cabin, riders[leg.passage], rider)) return;
    } else {
        const bool is_up = leg.to > leg.from;
        const std::size_t flight = is_up ? leg.from : leg.from - 1;
        if (!mayPass(who, passage, first_room[leg.passage] + flight, is_up)) return;
    }
    if (!stop.holder.empty()) return;
    const StoreyWays& all = waysOf(who);
    const Landing& landing = *all.landing(leg.passage, leg.from);
    const std::size_t storey = *rooms[who.room].storey;
    const WayFinder& finder = all.finder(storey);
    const Point2 at = statusOf(who).pose.position;
    const std::vector<Point2> way = finder.wayBetween(at, landing.at.position);
    if (way.empty()) return finish(who.id, Outcome::Unreached);
    stop.holder = who.id;
    trip.state = TripState::Nearing;
    send(who, trip, way, trip.speed > 0 ? trip.speed : who.ability.speed);
}

void BuildingRun::Data::enter(Traveller& who, BuildingTrip& trip) {
    std::erase(stops[trip.legs[trip.leg].passage][trip.legs[trip.leg].from].queue, who.id);
    trip.spot.reset();
    if (passages[trip.legs[trip.leg].passage].is_lift)
        enterCabin(who, trip);
    else
        enterFlight(who, trip);
}

void BuildingRun::Data::enterCabin(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.from);
    Rider rider{who.id, {}, who.size.radius, who.ability.mass, leg.to};
    const auto slot = slotIn(passage.cabin, riders[leg.passage], rider);
    const Storey& storey = building.document.storeys[landing.storey];
    const Pose2 pose = placedIn(storey.building_from_storey, statusOf(who).pose);
    if (!slot || !lifts[leg.passage].isOpenAt(leg.from) ||
        !move(who, first_room[leg.passage], pose)) {
        stops[leg.passage][leg.from].holder.clear();
        return queueUp(who, trip);
    }
    rider.at = *slot;
    riders[leg.passage].push_back(rider);
    trip.state = TripState::Entering;
    const Point2 door = thresholdOf(passage.cabin, who.size.radius);
    sendStraight(who, trip, {passage.frame * door, passage.frame * *slot});
}

void BuildingRun::Data::enterFlight(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const bool is_up = leg.to > leg.from;
    const std::size_t room = first_room[leg.passage] + (is_up ? leg.from : leg.from - 1);
    // On the right, where two can pass.
    const double aside = passage.width < 4 * who.size.radius + 2 * kFlightGap
                             ? 0
                             : (is_up ? -1 : 1) * passage.width / 4;
    const Pose2 begin{{is_up ? 0 : passage.length, aside}, Angle::degrees(is_up ? 0 : 180)};
    const Pose2 pose = placedIn(passage.frame, begin);
    if (!mayPass(who, passage, room, is_up) || !move(who, room, pose)) {
        // It is still at the landing: tries again.
        stops[leg.passage][leg.from].queue.push_front(who.id);
        stops[leg.passage][leg.from].holder.clear();
        trip.state = TripState::Queueing;
        return;
    }
    stops[leg.passage][leg.from].holder.clear();
    trip.state = TripState::Climbing;
    climb(who, trip);
}

/// After a command that failed: another mover may have been in the way.
void BuildingRun::Data::tryAgain(Traveller& who, BuildingTrip& trip, Outcome outcome) {
    trip.steps.clear();
    const bool is_on_storey = rooms[who.room].storey.has_value();
    if (is_on_storey && ++trip.attempts > kMostAttempts) return finish(who.id, outcome);
    const bool has_leg = trip.leg < trip.legs.size();
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

/// Walks on to the end of a flight.
void BuildingRun::Data::climb(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const bool is_up = leg.to > leg.from;
    const Point2 at = seenFrom(passage.frame, statusOf(who).pose).position;
    send(who, trip, {passage.frame * Point2{is_up ? passage.length : 0, at.y}},
         is_up ? kSpeedUp : kSpeedDown);
}

/// Leaves the cabin at its stop.
void BuildingRun::Data::leaveCabin(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    auto& inside = riders[leg.passage];
    const auto self = std::find_if(inside.begin(), inside.end(),
                                   [&](const Rider& rider) { return rider.id == who.id; });
    if (trip.state == TripState::Riding) {
        Stop& stop = stops[leg.passage][leg.to];
        if (!lifts[leg.passage].isOpenAt(leg.to)) return lifts[leg.passage].call(leg.to);
        if (!stop.holder.empty()) return;
        // The nearest to the door leaves first.
        for (const Rider& other : inside)
            if (other.stop == leg.to && other.at.x > self->at.x) return;
        stop.holder = who.id;
        trip.state = TripState::Leaving;
    }
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.to);
    const Point2 door = thresholdOf(passage.cabin, who.size.radius);
    const Point2 out{passage.cabin.length / 2 + landing.lane, 0};
    sendStraight(who, trip, {passage.frame * door, passage.frame * out});
}

/// Goes on to the storey once the landing is free.
void BuildingRun::Data::arrive(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.to);
    Stop& stop = stops[leg.passage][leg.to];
    if (!stop.holder.empty() && stop.holder != who.id) return;
    Pose2 pose = landing.at;
    if (passage.is_lift) {
        const Storey& storey = building.document.storeys[landing.storey];
        pose = seenFrom(storey.building_from_storey, statusOf(who).pose);
    } else {
        pose.heading = pose.heading + Angle::degrees(180);
    }
    if (!move(who, landing.storey, pose)) return;
    stop.holder = who.id;
    std::erase_if(riders[leg.passage], [&](const Rider& rider) { return rider.id == who.id; });
    ++trip.leg;
    trip.state = TripState::Setting;
}

}  // namespace ispace
