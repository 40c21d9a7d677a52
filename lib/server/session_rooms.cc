// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of runs with several worlds: trips, lifts, and the names of things across the worlds.
#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "server/session.h"
#include "sim/joined_worlds.h"

namespace ispace {

std::string_view Session::enter(std::string_view id) {
    const auto [state, own_id, is_known] = state_->find(id);
    state_ = state;
    if (rooms() != nullptr) changes_ = world().changes();
    return own_id;
}

/// Goes to the world in which the client's robot, person or carried sensor is now.
void Session::followRoom() {
    if (rooms() == nullptr || id_.find('/') == std::string::npos) return;
    ServerState* next = state_;
    if (role_ == Role::Robot || role_ == Role::Person) {
        if (const auto room = rooms()->worlds->roomOf(id_)) next = rooms()->states[*room];
    } else if (role_ == Role::Laser || role_ == Role::Sensor) {
        for (ServerState* const each : rooms()->states)
            if (each->simulation().world().sensorNamed(id_)) next = each;
    }
    if (next == state_) return;
    state_ = next;
    changes_ = -1;  // looked up again
    coming_.reset();
    seq_ = 0;
}

std::vector<std::string> Session::idsOfAll(Role role) const {
    const auto of_world = [role](const World& world) {
        return role == Role::Robot    ? idsOf(world.robots())
               : role == Role::Person ? idsOf(world.people())
               : role == Role::Laser  ? laserIdsOf(world)
                                      : idsOf(world.sensors());
    };
    std::vector<std::string> ids;
    for (const auto& [room, world] : state_->worlds())
        for (const std::string& id : of_world(*world)) ids.push_back(nameAcross(room, id));
    return ids;
}

std::string Session::whereText() const {
    if (rooms() == nullptr) return "";
    const auto& states = rooms()->states;
    const auto room = std::find(states.begin(), states.end(), state_) - states.begin();
    return ' ' + rooms()->worlds->whereText(static_cast<std::size_t>(room));
}

void Session::posesOfAll() {
    std::string robots, people, rooms_of_robots, rooms_of_people;
    std::size_t count = 0;
    for (const JoinedRoom& room : rooms()->worlds->rooms()) {
        const World& one = room.simulation->world();
        for (std::size_t i = 0; i < one.movers().size(); ++i) {
            const bool is_robot = i < one.robots().size();
            if (is_robot) ++count;
            std::string& out = is_robot ? robots : people;
            std::string& where = is_robot ? rooms_of_robots : rooms_of_people;
            const Pose2 pose = one.status(i).pose;
            if (!out.empty()) out += ';';
            if (!where.empty()) where += ',';
            where += room.id;
            out.append(one.movers()[i].id).append(",").append(measured(pose.position.x));
            out.append(",").append(measured(pose.position.y));
            out.append(",").append(headingText(pose.heading));
        }
    }
    out_.append("OK POSES t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(count)).append(" poses=").append(robots);
    if (!people.empty()) out_.append(" people=").append(people);
    const bool has_both = !robots.empty() && !people.empty();
    out_.append(" rooms=").append(rooms_of_robots).append(has_both ? "," : "");
    out_.append(rooms_of_people).append("\n");
}

/// True for a PATH with points of storeys.
bool Session::isTrip(Words words) const {
    return rooms() != nullptr && words.size() > 1 && words[0] == "PATH" &&
           words[1].find('/') != std::string_view::npos;
}

/// Answers with an error if movers and lifts follow a record.
bool Session::mayMove() {
    if (!state_->simulation().isReplay()) return true;
    error(405, {"this run is a replay: robots and people go as recorded; take STATUS and "
                "SCAN, or run the scene without --replay"});
    return false;
}

void Session::goTo(Words words) {
    if (rooms() == nullptr)
        return error(405, {words[0], " is for the runs of buildings: PATH leads over points"});
    startTrip(words);
}

void Session::startTrip(Words words) {
    if (!mayMove()) return;
    JoinedWorlds& worlds = *rooms()->worlds;
    const auto& states = rooms()->states;
    const auto room = std::find(states.begin(), states.end(), state_) - states.begin();
    ParsedTrip trip = parseTrip(words, worlds.rooms(), static_cast<std::size_t>(room));
    if (!trip.fault.empty()) return error(400, {trip.fault});
    const double most = world().movers()[subject_].model.max_speed;
    if (trip.plan.speed > most)
        return error(416, {id_, " goes at most ", formatDouble(most), " m/s"});
    const TripAnswer answer = worlds.travel(id_, std::move(trip.plan));
    answerTrip(words[0], answer);
}

void Session::answerTrip(std::string_view verb, const TripAnswer& answer) {
    if (!answer.refusal.empty()) return error(409, {answer.refusal});
    running_.push_back(answer.id);
    out_.append("OK ").append(verb).append(" id=").append(std::to_string(answer.id));
    out_.append(" length=").append(measured(answer.length));
    if (!answer.via.empty()) out_.append(" via=").append(answer.via);
    out_ += '\n';
}

void Session::ride(Words words) {
    if (rooms() == nullptr) return error(405, {"RIDE is for the runs of buildings"});
    if (!mayMove()) return;
    answerTrip(words[0], rooms()->worlds->ride(id_, words[1], words[2]));
}

void Session::call(Words words) {
    if (rooms() == nullptr) return error(405, {"CALL is for the runs of buildings"});
    if (!mayMove()) return;
    const std::string refusal = rooms()->worlds->call(words[1], words[2]);
    if (!refusal.empty()) return error(404, {refusal});
    out_.append("OK CALL t=").append(formatMilliseconds(world().time())).append("\n");
}

/// Position, doors, riders and calls of all lifts.
void Session::lifts(Words /*words*/) {
    if (rooms() == nullptr) return error(405, {"LIFTS is for the runs of buildings"});
    const std::vector<LiftState> all = rooms()->worlds->lifts();
    out_.append("OK LIFTS t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(all.size())).append(" lifts=");
    std::string_view separator;
    for (const LiftState& lift : all) {
        out_.append(separator).append(lift.id).append(",").append(lift.storey);
        out_.append(",").append(measured(lift.height)).append(",").append(measured(lift.door));
        out_.append(",").append(joined(lift.riders, "+"));
        out_.append(",").append(joined(lift.calls, "+"));
        separator = ";";
    }
    out_ += '\n';
}

}  // namespace ispace
