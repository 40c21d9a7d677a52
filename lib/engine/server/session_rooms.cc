// SPDX-License-Identifier: GPL-3.0-or-later
// Names of things and positions across the worlds of a run, trips between them, and lifts.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/room_state.h"
#include "scene/thing_kind.h"
#include "server/change_request.h"
#include "server/session.h"
#include "sim/worlds.h"

namespace ispace {

std::string_view Session::enter(std::string_view id) {
    const auto [state, own_id, is_known] = state_->find(id);
    state_ = state;
    changes_ = world().changes();
    return own_id;
}

/// Goes to the world in which the client's robot, person or carried sensor is now.
void Session::followRoom() {
    if (id_.find('/') == std::string::npos) return;
    ServerState* next = state_;
    if (role_ == Role::Robot || role_ == Role::Person) {
        if (const auto room = worlds().roomOf(id_)) next = rooms().states[*room];
    } else if (role_ == Role::Laser || role_ == Role::Sensor) {
        for (ServerState* const each : rooms().states)
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
    const std::string where = worlds().whereText(room());
    return where.empty() ? "" : ' ' + where;
}

/// Returns the index of the room in which the client is.
std::size_t Session::room() const {
    const auto& states = rooms().states;
    return static_cast<std::size_t>(std::find(states.begin(), states.end(), state_) -
                                    states.begin());
}

void Session::poses(Words /*words*/) {
    std::string robots, people, rooms_of_robots, rooms_of_people;
    std::size_t count = 0;
    for (const RunRoom& room : worlds().rooms()) {
        const World& one = room.simulation->world();
        for (std::size_t i = 0; i < one.movers().size(); ++i) {
            const bool is_robot = i < one.robots().size();
            if (is_robot) ++count;
            std::string& out = is_robot ? robots : people;
            std::string& where = is_robot ? rooms_of_robots : rooms_of_people;
            const Pose2 pose = one.status(i).pose;
            if (!out.empty()) out += ';';
            where.append(where.empty() ? "" : ",").append(room.id);
            out.append(one.movers()[i].id).append(",").append(measured(pose.position.x));
            out.append(",").append(measured(pose.position.y));
            out.append(",").append(headingText(pose.heading));
        }
    }
    out_.append("OK POSES t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(count)).append(" poses=").append(robots);
    if (!people.empty()) out_.append(" people=").append(people);
    const bool has_both = !robots.empty() && !people.empty();
    if (!worlds().rooms().front().id.empty())
        out_.append(" rooms=")
            .append(rooms_of_robots)
            .append(has_both ? "," : "")
            .append(rooms_of_people);
    out_ += '\n';
}

namespace {

/// The mover and the value of a request SET MOVER.at=VALUE or SET MOVER.heading=VALUE.
struct PlaceRequest {
    std::string mover;
    std::string_view value;
    bool is_point = false;
};

std::optional<PlaceRequest> placeRequest(const Worlds& worlds,
                                         std::span<const std::string_view> words) {
    if (words.size() != 2 || words[0] != "SET") return std::nullopt;
    const std::string_view word = words[1];
    const std::size_t equal = word.find('=');
    const std::size_t dot = word.substr(0, equal).rfind('.');
    if (equal == std::string_view::npos || dot == std::string_view::npos) return std::nullopt;
    const std::string_view key = word.substr(dot + 1, equal - dot - 1);
    PlaceRequest request{std::string(word.substr(0, dot)), word.substr(equal + 1), key == "at"};
    const bool is_pose = (request.is_point || key == "heading") && worlds.roomOf(request.mover);
    return is_pose ? std::optional(std::move(request)) : std::nullopt;
}

/// Returns the reason why the record of a mover takes no such value, or "".
std::string faultOf(const Scene& scene, const std::string& mover, std::string_view key,
                    Value value) {
    const auto own = std::find(scene.ids.begin(), scene.ids.end(), mover) - scene.ids.begin();
    try {
        Record record = scene.records[static_cast<std::size_t>(own)];
        record.set(key, std::move(value));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

}  // namespace

/// Puts a robot or a person elsewhere. \returns false for other requests
bool Session::placeMover(Words words) {
    Worlds& worlds = this->worlds();
    const auto request = placeRequest(worlds, words);
    if (!request) return false;
    const auto fail = [this](int code, const std::string& text) {
        error(code, {text});
        return true;
    };
    std::optional<RoomPoint> at;
    std::optional<Angle> heading;
    const std::size_t from = *worlds.roomOf(request->mover);
    Value value;
    if (request->is_point) {
        const std::array<std::string_view, 2> point = {"PATH", request->value};
        const ParsedTrip parsed = parseTrip(point, worlds.rooms(), from);
        if (!parsed.fault.empty()) return fail(400, parsed.fault);
        if (parsed.plan.points.size() > 1) return fail(400, "at wants one point, as upper/1,2");
        at = parsed.plan.points.front();
        value = Tuple{at->at.x, at->at.y};
    } else {
        const auto degrees = parseDouble(request->value);
        if (!degrees) return fail(400, "heading wants degrees, not " + excerpt(request->value));
        heading = Angle::degrees(*degrees);
        value = *degrees;
    }
    const Scene& scene = worlds.rooms()[from].simulation->world().scene();
    if (const std::string fault = faultOf(scene, request->mover, at ? "at" : "heading", value);
        !fault.empty())
        return fail(400,
                    "SET " + std::string(words[1]) + ": " + excerpt(request->mover) + ": " + fault);
    if (!mayChange()) {
        hold(words, &Session::mayChange);
        return true;
    }
    std::string refusal;
    changeRooms(rooms(), [&] { refusal = worlds.place(request->mover, at, heading); });
    if (!refusal.empty()) return fail(409, refusal);
    const std::size_t room = *worlds.roomOf(request->mover);
    const World& world = rooms().states[room]->simulation().world();
    out_.append("OK SET t=").append(formatMilliseconds(world.time()));
    if (const std::string warning = warningOf(world, {request->mover}); !warning.empty())
        out_.append(" warning=").append(warning);
    out_ += '\n';
    return true;
}

/// Sets keys of a person's body, or acts on its states, where it is. \returns false for other
/// requests
bool Session::changeBody(Words words) {
    const bool sets = words[0] == "SET" && words.size() == 2;
    if (!sets && (words[0] != "ACT" || words.size() < 3)) return false;
    const Worlds& worlds = this->worlds();
    const std::string_view left = words[1].substr(0, words[1].find('='));
    const std::size_t dot = sets ? left.rfind('.') : left.size();
    if (dot == std::string_view::npos) return false;
    const std::string id(left.substr(0, dot));
    const auto room = worlds.roomOf(id);
    if (!room) return false;
    const RunRoom& in = worlds.rooms()[*room];
    const Scene& scene = in.simulation->world().scene();
    const auto own = std::find(scene.ids.begin(), scene.ids.end(), id) - scene.ids.begin();
    const std::string& keyword = scene.records[static_cast<std::size_t>(own)].keyword();
    std::vector<std::string> keys = stateKeysOf(keyword);
    if (keys.empty()) return false;
    if (const ThingKind* const kind = thingKind(keyword))
        keys.insert(keys.end(), kind->body_keys.begin(), kind->body_keys.end());
    if (sets && std::find(keys.begin(), keys.end(), left.substr(dot + 1)) == keys.end())
        return false;
    if (!worlds.frameOf(*room).is_storey) {
        error(409, {id, " is in ", in.id, ": it first goes on to a storey"});
        return true;
    }
    if (!mayChange()) {
        hold(words, &Session::mayChange);
        return true;
    }
    try {
        const std::string request =
            sets ? std::string(textOf(words)) : stateChange(scene, id, words.subspan(2));
        wanted_ = changeWorld(*rooms().states[*room], request, std::string(words[0]));
    } catch (const UsageError& bad) {
        error(400, {bad.what()});
        return true;
    }
    receiveAsked();
    return true;
}

/// True for the way of a mover that goes between rooms: GOTO, and PATH with points of storeys.
bool Session::isTrip(Words words) const {
    const bool is_trip = words[0] == "GOTO" || (words[0] == "PATH" && words.size() > 1 &&
                                                words[1].find('/') != std::string_view::npos);
    return is_trip && worlds().roomOf(id_);
}

/// Answers with an error if movers and lifts follow a record.
bool Session::mayMove() {
    if (!state_->simulation().isReplay()) return true;
    error(405, {"this run is a replay: robots and people go as recorded; take STATUS and "
                "SCAN, or run the scene without --replay"});
    return false;
}

void Session::startTrip(Words words) {
    if (!mayMove()) return;
    ParsedTrip trip = parseTrip(words, worlds().rooms(), room());
    if (!trip.fault.empty()) return error(400, {trip.fault});
    const double most = world().movers()[subject_].model.max_speed;
    if (trip.plan.speed > most)
        return error(416, {id_, " goes at most ", formatDouble(most), " m/s"});
    answerTrip(words[0], worlds().travel(id_, std::move(trip.plan)));
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
    if (!mayMove()) return;
    answerTrip(words[0], worlds().ride(id_, words[1], words[2]));
}

/// CALL and HOLD.
void Session::call(Words words) {
    if (!mayMove()) return;
    const std::string_view verb = words[0], storey = words.size() > 2 ? words[2] : "";
    const std::string refusal =
        verb == "CALL" ? worlds().call(words[1], storey) : worlds().hold(words[1], storey);
    if (!refusal.empty()) return error(404, {refusal});
    out_.append("OK ").append(verb).append(" t=").append(formatMilliseconds(world().time()));
    out_ += '\n';
}

/// Position, doors, riders and calls of all lifts.
void Session::lifts(Words /*words*/) {
    const std::vector<LiftState> all = worlds().lifts();
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
