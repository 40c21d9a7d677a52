// SPDX-License-Identifier: GPL-3.0-or-later
// Lifts and stairs: turns at their landings, and the ways in, through and out.
//
// A stop has a queue and one holder of its landing. The first of the queue goes to the landing once
// the lift is open, those that leave are out, and there is a slot for it; or once no mover comes
// toward it on stairs where two cannot pass. Those in a lift or on stairs that find their landing
// occupied ask others to step aside after 3 s, and turn back after 30 s, so that others can use the
// passage.
#include <algorithm>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "extensions/passages/building_run.h"
#include "extensions/passages/building_run_data.h"

namespace ispace::passages {

namespace {

/// Metres between one that leaves a landing and the next.
constexpr double kClearLanding = 0.3;
/// Seconds that a mover expects to wait for each one before it.
constexpr double kTurnWait = 15;
/// Time for which a mover in a lift or on stairs waits at an occupied landing before it turns back.
constexpr SimTime kPatience = std::chrono::seconds(30);
/// Time after which it asks those that wait there to step aside.
constexpr SimTime kPolite = std::chrono::seconds(3);

}  // namespace

double BuildingRun::Data::clearanceOf(const Traveller& who) {
    return 2 * who.size.radius + kClearLanding;
}

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

void BuildingRun::Data::advanceLifts() {
    const SimTime time = rooms.front().world->time();
    for (std::size_t i = 0; i < passages.size(); ++i)
        if (passages[i].is_lift) lifts[i].advance(time, mayHoldOpen(i));
}

/// Returns true if a mover is about to use the open door.
bool BuildingRun::Data::mayHoldOpen(std::size_t lift) const {
    const std::size_t stop = lifts[lift].stop();
    if (!lifts[lift].isOpenAt(stop)) return false;
    for (const Rider& rider : riders[lift])
        if (rider.stop == stop && canLeave(passages[lift].cabin, riders[lift], rider)) return true;
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
            // One that stays there lets the next ones try.
            const bool stays = trip == trips.end();
            if (stays || who.room != landing->storey ||
                distance(statusOf(who).pose.position, landing->at.position) > clearanceOf(who))
                holder.clear();
        }
}

/// Gives up all turns of a mover.
void BuildingRun::Data::release(const std::string& id) {
    for (auto& of_passage : stops)
        for (Stop& stop : of_passage) {
            std::erase(stop.queue, id);
            if (stop.holder == id) stop.holder.clear();
        }
}

void BuildingRun::Data::queueUp(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    Stop& stop = stops[leg.passage][leg.from];
    // One that stands on the landing keeps others from it.
    if (stop.holder == who.id)
        stop.queue.push_front(who.id);
    else
        stop.queue.push_back(who.id);
    trip.queued = rooms.front().world->time();
    trip.state = TripState::Queueing;
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
        if (!mayPass(who, trip)) return;
    }
    if (!stop.holder.empty() && stop.holder != who.id) return;
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.from);
    const std::vector<Point2> way = wayTo(who, trip, landing.at.position);
    if (way.empty()) return finish(who.id, Outcome::Unreached);
    stop.holder = who.id;
    trip.state = TripState::Nearing;
    if (landing.is_tight) return sendStraight(who, trip, {way.begin(), way.end()});
    send(who, trip, way, trip.plan.speed > 0 ? trip.plan.speed : who.ability.speed);
}

/// Returns the offset from the middle of the stairs at which a mover walks: on the right where two
/// can pass.
double BuildingRun::Data::laneOf(const Traveller& who, const StoreyLink& passage, bool is_up) {
    const bool is_narrow = passage.width < 4 * who.size.radius + 2 * kFlightGap;
    return is_narrow ? 0 : (is_up ? -1 : 1) * passage.width / 4;
}

/// Returns true if a mover may enter its flight of stairs. Where two cannot pass, those of one
/// direction follow each other until one waits at the other end for longer.
bool BuildingRun::Data::mayPass(const Traveller& who, const BuildingTrip& trip) const {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const auto goes_up = [](const BuildingTrip& one) {
        return one.legs[one.leg].to > one.legs[one.leg].from;
    };
    const bool is_up = goes_up(trip);
    const std::size_t other_end = is_up ? leg.from + 1 : leg.from - 1;
    const World& world = *rooms[first_room[leg.passage] + std::min(leg.from, other_end)].world;
    const auto room_for_two = [&](const MoverSize& other) {
        return passage.width >= 2 * (who.size.radius + other.radius) + 2 * kFlightGap;
    };
    for (const Mover& mover : world.movers()) {
        const auto other = trips.find(mover.id);
        const bool meets = other == trips.end() || goes_up(other->second) != is_up;
        if (meets && !room_for_two({mover.model.radius, 0})) return false;
    }
    if (world.movers().empty()) return true;
    const std::deque<std::string>& queue = stops[leg.passage][other_end].queue;
    return std::none_of(queue.begin(), queue.end(), [&](const std::string& id) {
        const BuildingTrip& other = trips.find(id)->second;
        return goes_up(other) != is_up && other.queued < trip.queued &&
               !room_for_two(travellers.find(id)->second.size);
    });
}

void BuildingRun::Data::enter(Traveller& who, BuildingTrip& trip) {
    std::erase(stops[trip.legs[trip.leg].passage][trip.legs[trip.leg].from].queue, who.id);
    trip.spot.reset();
    if (passages[trip.legs[trip.leg].passage].is_lift)
        enterCabin(who, trip);
    else
        enterFlight(who, trip);
}

/// Without a free place, an open door and room in the cabin it sets out again.
void BuildingRun::Data::enterCabin(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const Landing& landing = *waysOf(who).landing(leg.passage, leg.from);
    Rider rider{who.id, {}, who.size.radius, who.ability.mass, leg.to};
    const auto slot = slotIn(passage.cabin, riders[leg.passage], rider);
    const Storey& storey = building.document.storeys[landing.storey];
    const Pose2 pose = placedIn(storey.building_from_storey, statusOf(who).pose);
    if (!slot || !lifts[leg.passage].isOpenAt(leg.from) ||
        !move(who, first_room[leg.passage], pose).empty()) {
        // Back to where movers wait; it holds its turn until it has left the landing to others.
        trip.state = TripState::Setting;
        return;
    }
    rider.at = *slot;
    riders[leg.passage].push_back(rider);
    trip.state = TripState::Entering;
    const Point2 door = thresholdOf(passage.cabin, who.size.radius);
    sendStraight(who, trip, {passage.frame * door, passage.frame * *slot});
}

/// The room of a flight has its foot at x = 0; movers up and down keep apart by lanes.
void BuildingRun::Data::enterFlight(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const bool is_up = leg.to > leg.from;
    const std::size_t room = first_room[leg.passage] + (is_up ? leg.from : leg.from - 1);
    const Pose2 begin{{is_up ? 0 : passage.length, laneOf(who, passage, is_up)},
                      Angle::degrees(is_up ? 0 : 180)};
    const Pose2 pose = placedIn(passage.frame, begin);
    if (!mayPass(who, trip) || !move(who, room, pose).empty()) {
        trip.state = TripState::Setting;
        return;
    }
    stops[leg.passage][leg.from].holder.clear();
    trip.state = TripState::Climbing;
    climb(who, trip);
}

/// Walks on to the end of a flight.
void BuildingRun::Data::climb(Traveller& who, BuildingTrip& trip) {
    const Leg& leg = trip.legs[trip.leg];
    const StoreyLink& passage = passages[leg.passage];
    const bool is_up = leg.to > leg.from;
    const Point2 end{is_up ? passage.length : 0, laneOf(who, passage, is_up)};
    send(who, trip, {passage.frame * end}, is_up ? kSpeedUp : kSpeedDown);
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
        if (!canLeave(passage.cabin, inside, *self)) return;
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
    const SimTime now = rooms.front().world->time();
    if (!trip.blocked) trip.blocked = now;
    if (now - *trip.blocked > kPatience) return turnBack(who, trip);
    if (now - *trip.blocked > kPolite && (!trip.asked || now - *trip.asked > kPolite)) {
        trip.asked = now;
        askAside(landing.storey, who.size.radius, landing.at.position, {});
    }
    if (!stop.holder.empty() && stop.holder != who.id) return;
    Pose2 pose = landing.at;
    if (passage.is_lift) {
        const Storey& storey = building.document.storeys[landing.storey];
        pose = seenFrom(storey.building_from_storey, statusOf(who).pose);
    } else {
        pose.heading = pose.heading + Angle::degrees(180);
    }
    if (!move(who, landing.storey, pose).empty()) return;
    stop.holder = who.id;
    std::erase_if(riders[leg.passage], [&](const Rider& rider) { return rider.id == who.id; });
    trip.blocked.reset();
    trip.asked.reset();
    ++trip.leg;
    trip.state = TripState::Setting;
}

/// Goes back to where it came from, to give up there: lifts and stairs serve others. On stairs that
/// are too narrow to pass, all behind it turn back, too.
void BuildingRun::Data::turnBack(Traveller& who, BuildingTrip& trip) {
    const StoreyLink& passage = passages[trip.legs[trip.leg].passage];
    if (!passage.is_lift) {
        const bool may_pass = laneOf(who, passage, true) != 0;
        for (auto& [id, other] : trips) {
            Traveller& its = travellers.find(id)->second;
            if (its.room != who.room || (may_pass && id != who.id)) continue;
            reverse(other);
            other.state = TripState::Climbing;
            climb(its, other);
        }
        return;
    }
    reverse(trip);
    const Leg& leg = trip.legs[trip.leg];
    for (Rider& rider : riders[leg.passage]) {
        if (rider.id != who.id) continue;
        rider.stop = leg.to;
        trip.state = TripState::Entering;
        sendStraight(who, trip,
                     {passage.frame * thresholdOf(passage.cabin, who.size.radius),
                      passage.frame * rider.at});
    }
}

/// Leads a trip back through its passage, to end as unreached unless it ends otherwise anyway.
void BuildingRun::Data::reverse(BuildingTrip& trip) {
    Leg& leg = trip.legs[trip.leg];
    std::swap(leg.from, leg.to);
    trip.blocked.reset();
    trip.attempts = 0;
    if (!trip.ending) trip.ending = Outcome::Unreached;
}

}  // namespace ispace::passages
