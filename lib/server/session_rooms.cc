// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of runs with several worlds: trips, lifts, and the names of things across the worlds.
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

/// Returns the simulation of a room of several; null for other names.
Simulation* Session::simulationOf(std::string_view room) const {
    for (const JoinedRoom& each : rooms()->worlds->rooms())
        if (each.id == room) return each.simulation;
    return nullptr;
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

namespace {

/// A request about a thing of one room, with its plain id, or the reason why it is none.
struct RoomRequest {
    std::size_t room = 0;
    std::string id, line;
    int code = 0;  // 0: none
    std::string fault = {};
};

/// Returns the position of a thing's id in a word of a request; npos for other words.
std::size_t idIn(std::string_view verb, std::size_t index, std::string_view word) {
    if (verb == "ADD") return word.starts_with("id=") ? 3 : std::string_view::npos;
    const bool is_id = verb == "DELETE" ? index > 0 : index == 1;
    return is_id ? 0 : std::string_view::npos;
}

/// Returns true for an order that a mover carries a sensor, whose trips would leave it behind.
bool mountsOn(const World& world, std::string_view word) {
    constexpr std::string_view kOn = "on=";
    const std::size_t at = word.find(kOn);
    if (at == std::string_view::npos || (at > 0 && word[at - 1] != '.')) return false;
    std::string carrier(word.substr(at + kOn.size()));
    std::erase(carrier, '"');
    return world.moverNamed(carrier).has_value();
}

/// True if a word of SET gives a thing an id of another room: "upper/f.id=ground/r1".
bool namesOtherRoom(std::string_view word) {
    constexpr std::string_view kNewId = ".id=";
    const std::size_t at = word.find(kNewId);
    return at != std::string_view::npos && word.find('/', at) != std::string_view::npos;
}

/// Finds the room of a request SET, ADD, DELETE or ACT.
RoomRequest roomRequest(const JoinedWorlds& worlds, std::span<const std::string_view> words) {
    RoomRequest out;
    const auto fail = [&out](int code, std::string fault) {
        out.code = code;
        out.fault = std::move(fault);
        return out;
    };
    const std::string_view verb = words[0];
    if (verb != "SET" && verb != "ADD" && verb != "DELETE" && verb != "ACT")
        return fail(
            403,
            "LOAD replaces one room, and a building has storeys, lifts and records of each: "
            "RESET begins anew, SET, ADD and DELETE change things, and another building is "
            "another run");
    if (verb == "ADD" && (words[1] == "robot" || words[1] == "human"))
        return fail(403, "robots and people come to a building at its start");
    const auto rooms = worlds.rooms();
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < words.size(); ++i) {
        std::string word(words[i]);
        for (const JoinedRoom& room : rooms)
            if (mountsOn(room.simulation->world(), word))
                return fail(403, "robots and people of a building keep their sensors");
        if (const std::size_t at = idIn(verb, i, word); at != std::string::npos) {
            const std::size_t slash = word.find('/', at);
            std::size_t room = 0;
            while (room < rooms.size() &&
                   (slash == std::string::npos || word.substr(at, slash - at) != rooms[room].id ||
                    !worlds.frameOf(room).is_storey))
                ++room;
            if (room == rooms.size())
                return fail(404, excerpt(word.substr(at)) + " names no storey, as in " +
                                     rooms.front().id + "/desk1");
            if (found && *found != room) return fail(400, "a request is about one storey");
            const std::string whole = word.substr(at, word.find('.', slash) - at);
            if (whole.find_first_of("*?[") != std::string::npos)
                return fail(400, "in a building ids are without globs");
            const std::string_view in_room = std::string_view(whole).substr(slash + 1 - at);
            if (in_room.empty() || in_room.find('/') != std::string_view::npos ||
                namesOtherRoom(word))
                return fail(400, "an id is that of its storey and one in it, as in " +
                                     rooms.front().id + "/desk1");
            for (const JoinedRoom& other : rooms) {
                const World& world = other.simulation->world();
                const bool is_mover = world.moverNamed(whole).has_value();
                if (is_mover && verb == "SET" && words.size() > 2)
                    return fail(400, "a request sets one key of " + whole + ", at or heading");
                if (is_mover) {
                    const bool is_person = world.movers()[*world.moverNamed(whole)].is_person;
                    return fail(403, verb != "SET" ? whole + " stays in the building"
                                     : is_person
                                         ? "of " + whole + " at, heading and states can be set"
                                         : "of " + whole + " at and heading can be set");
                }
                if (verb == "ADD" && world.sensorNamed(whole))
                    return fail(400, "the id " + whole + " is taken");
            }
            found = room;
            out.id = word.substr(slash + 1);
            word.erase(at, slash + 1 - at);
        }
        out.line += (out.line.empty() ? "" : " ") + word;
    }
    if (!found)
        return fail(
            400, "the record has no id with its storey, as in id=" + rooms.front().id + "/desk1");
    out.room = *found;
    return out;
}

}  // namespace

namespace {

/// The mover and the value of a request SET MOVER.at=VALUE or SET MOVER.heading=VALUE.
struct PlaceRequest {
    std::string mover;
    std::string_view value;
    bool is_point = false;
};

std::optional<PlaceRequest> placeRequest(const JoinedWorlds& worlds,
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
    JoinedWorlds& worlds = *rooms()->worlds;
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
    changeRooms(*rooms(), [&] { refusal = worlds.place(request->mover, at, heading); });
    if (!refusal.empty()) return fail(409, refusal);
    const std::size_t room = *worlds.roomOf(request->mover);
    const World& world = rooms()->states[room]->simulation().world();
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
    const JoinedWorlds& worlds = *rooms()->worlds;
    const std::string_view left = words[1].substr(0, words[1].find('='));
    const std::size_t dot = sets ? left.rfind('.') : left.size();
    if (dot == std::string_view::npos) return false;
    const std::string id(left.substr(0, dot));
    const auto room = worlds.roomOf(id);
    if (!room) return false;
    const JoinedRoom& in = worlds.rooms()[*room];
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
        wanted_ = changeWorld(*rooms()->states[*room], request, std::string(words[0]));
    } catch (const UsageError& bad) {
        error(400, {bad.what()});
        return true;
    }
    receiveAsked();
    return true;
}

/// Changes a thing of a building that stands in a room, or its state, the position of a robot or a
/// person, or restarts the whole.
void Session::changeRoom(Words words) {
    if (!state_->mayChange()) return error(403, {"clients may not change the world of this run"});
    if (!mayMove() || placeMover(words) || changeBody(words)) return;
    if (words[0] == "RESET") {
        if (!mayChange()) return hold(words, &Session::mayChange);
        changeRooms(*rooms(), [this] { rooms()->worlds->restart(); });
        out_.append("OK RESET t=").append(formatMilliseconds(world().time())).append("\n");
        return;
    }
    const RoomRequest request = roomRequest(*rooms()->worlds, words);
    if (request.code != 0) return error(request.code, {request.fault});
    ServerState& state = *rooms()->states[request.room];
    if (!mayChange()) return hold(words, &Session::mayChange);
    if (words[0] != "ACT") {
        wanted_ =
            changeWorld(state, request.line, "", rooms()->worlds->rooms()[request.room].id + '/');
        return receiveAsked();
    }
    const Scene& scene = state.simulation().world().scene();
    if (std::find(scene.ids.begin(), scene.ids.end(), request.id) == scene.ids.end())
        return error(404, {unknownThing("record", request.id, scene.ids)});
    try {
        wanted_ = changeWorld(state, stateChange(scene, request.id, words.subspan(2)), "ACT");
    } catch (const UsageError& bad) {
        return error(400, {bad.what()});
    }
    receiveAsked();
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
    if (rooms() == nullptr) return command(words);
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
