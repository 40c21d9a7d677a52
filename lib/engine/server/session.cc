// SPDX-License-Identifier: GPL-3.0-or-later
// A request finds the row of its verb for the present role; the row checks token and number of
// arguments. Requests that cannot be answered yet are held with the condition for which they wait,
// and later ones queue behind them: answers come in the order of requests. Ends of motions, events
// and scans are sent between, each as a whole.
#include "server/session.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <initializer_list>
#include <limits>
#include <new>
#include <stdexcept>

#include "base/message.h"
#include "base/number.h"
#include "server/server_state.h"
#include "sim/command.h"

namespace ispace {

namespace {

std::string_view reasonOf(Outcome outcome) {
    switch (outcome) {
        case Outcome::Done:
            return "done";
        case Outcome::Stall:
            return "stall";
        case Outcome::Unreached:
            return "unreached";
        case Outcome::Replaced:
            return "replaced";
        case Outcome::Stopped:
            return "stopped";
    }
    return "";
}

}  // namespace

/// A request of the protocol. A verb may have several rows with different roles; the row of the
/// present role is found first, its token and number of arguments are checked, then it answers.
struct Session::Request {
    std::string_view verb;
    std::string_view arguments;  // for humans
    std::optional<Role> role;    // required role; empty: any
    std::size_t least, most;     // number of arguments
    void (Session::*answer)(Words words);
    bool needs_token = false;          // if the run has a token
    std::optional<bool> coupled = {};  // worlds of which it is, see areCoupled(); empty: any
};

std::span<const Session::Request> Session::requests() {
    using C = Session;
    // Commands are checked by parseCommand.
    constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
    static constexpr auto kRequests = std::to_array<Request>({
        {"TOKEN", "x", std::nullopt, 1, 1, &C::token},
        {"ROBOT", "id", Role::None, 1, 1, &C::acquireRobot},
        {"PERSON", "id", Role::None, 1, 1, &C::takePerson},
        {"LASER", "id", Role::None, 1, 1, &C::takeLaser},
        {"SENSOR", "id", Role::None, 1, 1, &C::takeSensor},
        {"WORLD", "", Role::None, 0, 0, &C::takeWorld},
        {"FORWARD", "m", Role::Robot, 0, kAny, &C::command},
        {"BACKWARD", "m", Role::Robot, 0, kAny, &C::command},
        {"LEFT", "deg", Role::Robot, 0, kAny, &C::command},
        {"RIGHT", "deg", Role::Robot, 0, kAny, &C::command},
        {"SPEED", "m/s", Role::Robot, 0, kAny, &C::command},
        {"ROTSPEED", "deg/s", Role::Robot, 0, kAny, &C::command},
        {"SIDESPEED", "m/s", Role::Robot, 0, kAny, &C::command},
        {"PATH", "x,y;... [speed=v] [pause=s] [loop=yes]", Role::Robot, 0, kAny, &C::command},
        {"GOTO", "[storey/]x,y[,heading] [speed=v]", Role::Robot, 1, 2, &C::command},
        {"RIDE", "lift storey", Role::Robot, 2, 2, &C::ride, false, true},
        {"STOP", "", Role::Robot, 0, kAny, &C::command},
        {"STATUS", "", Role::Robot, 0, 0, &C::status},
        {"ODOMETRY", "", Role::Robot, 0, 0, &C::odometry},
        {"SCAN", "id", Role::Robot, 1, 1, &C::scanOfRobot},
        {"SONAR", "", Role::Robot, 0, 0, &C::sonar},
        {"BUMPER", "", Role::Robot, 0, 0, &C::bumper},
        {"FORWARD", "m", Role::Person, 0, kAny, &C::command},
        {"BACKWARD", "m", Role::Person, 0, kAny, &C::command},
        {"LEFT", "deg", Role::Person, 0, kAny, &C::command},
        {"RIGHT", "deg", Role::Person, 0, kAny, &C::command},
        {"SPEED", "m/s", Role::Person, 0, kAny, &C::command},
        {"ROTSPEED", "deg/s", Role::Person, 0, kAny, &C::command},
        {"SIDESPEED", "m/s", Role::Person, 0, kAny, &C::command},
        {"PATH", "x,y;... [speed=v] [pause=s] [loop=yes]", Role::Person, 0, kAny, &C::command},
        {"GOTO", "[storey/]x,y[,heading] [speed=v]", Role::Person, 1, 2, &C::command},
        {"RIDE", "lift storey", Role::Person, 2, 2, &C::ride, false, true},
        {"STOP", "", Role::Person, 0, kAny, &C::command},
        {"STATUS", "", Role::Person, 0, 0, &C::status},
        {"SCAN", "", Role::Laser, 0, 0, &C::scan},
        {"STREAM", "[every=k]", Role::Laser, 0, 1, &C::stream},
        {"STOP", "", Role::Laser, 0, 0, &C::stopStream},
        {"BINARY", "on|off", Role::Laser, 1, 1, &C::binary},
        {"SCAN", "", Role::Sensor, 0, 0, &C::scan},
        {"STREAM", "[every=k]", Role::Sensor, 0, 1, &C::stream},
        {"STOP", "", Role::Sensor, 0, 0, &C::stopStream},
        {"BINARY", "on|off", Role::Sensor, 1, 1, &C::binary},
        {"FORMAT", "name", Role::Sensor, 1, 1, &C::format},
        {"LIST", "", Role::World, 0, 0, &C::list},
        {"TIME", "", Role::World, 0, 0, &C::time},
        {"POSES", "", Role::World, 0, 0, &C::poses},
        {"LIFTS", "", Role::World, 0, 0, &C::lifts, false, true},
        {"CALL", "lift storey", Role::World, 2, 2, &C::call, false, true},
        {"HOLD", "lift [storey]", Role::World, 1, 2, &C::call, false, true},
        {"PAUSE", "", Role::World, 0, 0, &C::pause},
        {"RESUME", "", Role::World, 0, 0, &C::resume},
        {"RATE", "x", Role::World, 1, 1, &C::rate},
        {"STEP", "[n]", Role::World, 0, 1, &C::step},
        {"SEEK", "t", Role::World, 1, 1, &C::seek},
        {"RESET", "", Role::World, 0, 0, &C::change, true},
        {"SET", "id.key=value", Role::World, 1, kAny, &C::change, true},
        {"STATE", "[id]", Role::World, 0, 1, &C::states},
        {"ACT", "id key=value...", Role::World, 2, kAny, &C::change, true},
        {"ADD", "record", Role::World, 1, kAny, &C::change, true},
        {"DELETE", "id...", Role::World, 1, kAny, &C::change, true},
        {"LOAD", "env [layout]", Role::World, 1, 2, &C::change, true, false},
        {"RECORDS", "[room]", Role::World, 0, 1, &C::records},
        {"EVENTS", "[kinds|off]", Role::World, 0, kAny, &C::events},
        {"MARK", "text", Role::World, 1, kAny, &C::mark},
        {"TRACK", "id [storey/]x,y [t=s] [kind=person|robot]", Role::World, 2, 4, &C::track},
        {"SCAN", "id", Role::Guest, 1, 1, &C::scanOfGuest},
        {"STREAM", "id [every=k]", Role::Guest, 1, 2, &C::streamOfGuest},
        {"STOP", "[id]", Role::Guest, 0, 1, &C::stopOfGuest},
        {"TRACK", "id [storey/]x,y [t=s] [kind=person|robot]", Role::Guest, 2, 4, &C::track},
        {"SHUTDOWN", "", Role::World, 0, 0, &C::shutdown, true},
        {"HELP", "", std::nullopt, 0, 0, &C::help},
        {"QUIT", "", std::nullopt, 0, 0, &C::quit},
    });
    return kRequests;
}

Session::Session(ServerState& state, std::string peer)
    : state_(&state),
      changes_(state.simulation().world().changes()),
      peer_(std::move(peer)),
      pauses_(state.limits().pauses),
      spare_pauses_(state.limits().spare_pauses, std::chrono::steady_clock::now()) {}

Session::~Session() { leave(); }

std::string Session::greeting() { return "ISPACE 1\n"; }

void Session::request(std::string_view line) {
    std::vector<std::string_view> words;
    for (const Piece& piece : wordsOf(line)) words.push_back(piece.text);
    if (words.empty()) return;
    sync();
    notifyEvents();  // earlier events are sent before the answer
    const bool first = std::exchange(first_, false);
    // A web page can make a browser send requests to ports of its machine: lines of them might pass
    // for those of a client.
    if (role_ == Role::None && words.back().starts_with("HTTP/")) {
        closing_ = true;
        return error(400, {"this is no web server, see ispace-protocol(7)"});
    }
    const std::size_t before = out_.size();
    try {
        answer(words, first);
    } catch (const std::bad_alloc&) {
        out_.resize(before);
        out_ += errorLineOf(std::current_exception());
    }
    // A role that was refused leaves it in no room.
    if (role_ == Role::None) state_ = rooms().states.front();
    sendCompletions();
}

void Session::answer(Words words, bool first) {
    const auto all = requests();
    const auto found = std::find_if(all.begin(), all.end(), [&](const Request& request) {
        return request.verb == words.front() && isOfRole(request);
    });
    if (found == all.end()) {
        RoleService* const service = role_ == Role::None ? serviceOf(words.front()) : nullptr;
        if (service != nullptr && !mayLook())
            return error(401,
                         {words.front(), " needs the token of this run: TOKEN x comes before it"});
        if (service != nullptr) return takeGuestRole(*service, words);
        if (role_ == Role::Guest && guestRequest(words)) return;
        return refuse(words.front(), first);
    }
    if (!mayUse(*found)) return;
    const std::size_t arguments = words.size() - 1;
    if (arguments < found->least)
        return error(400,
                     {found->verb, " wants an argument: ", found->verb, " ", found->arguments});
    if (arguments > found->most)
        return error(400, {"unexpected ", excerpt(words[found->most + 1]), " behind ", found->verb,
                           found->most == 0 ? "" : " ", found->most == 0 ? "" : found->arguments});
    if (found->coupled == true && !worlds().areCoupled())
        return error(405, {found->verb, " is for the runs of buildings"});
    (this->*found->answer)(words);
}

void Session::tooLong(std::size_t limit) {
    error(413, {"a request has at most ", std::to_string(limit), " bytes before its end of line"});
    leave();
    closing_ = true;
}

void Session::stepped(bool has_room) {
    sync();
    receiveAsked();
    sendCompletions();
    if (has_room) notifyEvents();
    if (every_ > 0) streamSensor();
    if (guest_) stepGuest(has_room);
    if (seek_ && seek_->is_over) answerSeek();
    if (steps_) {
        state_->steps().settle();
        if (steps_->over) answerStep();
    }
}

void Session::proceed() {
    stepped();
    goOn();
}

/// Keeps a request that cannot be answered now.
void Session::hold(Words words, Condition until) {
    held_ = textOf(words);
    may_go_on_ = until;
}

void Session::goOn() {
    if (!held_.empty()) {
        if (!(this->*may_go_on_)()) return;
        may_go_on_ = nullptr;
        request(std::exchange(held_, {}));
    }
    while (!backlog_.empty() && held_.empty() && !wanted_) {
        const std::string next = std::move(backlog_.front());
        backlog_.pop_front();
        request(next);
    }
}

/// Answers with an error the requests that the end of the run leaves open.
void Session::abandonRequests() {
    std::size_t open = backlog_.size();
    if (wanted_ || seek_ || !held_.empty()) open += std::max<std::size_t>(1, joined_.size());
    for (std::size_t i = 0; i < open; ++i) error(405, {"the run has ended"});
    wanted_.reset();
    seek_.reset();
    held_.clear();
    backlog_.clear();
    joined_.clear();
    may_go_on_ = nullptr;
}

void Session::silent() {
    sync();
    if (!drives()) return;
    worlds().abandonTrip(id_);
    world().command(subject_, {Verb::Stop, 0});
    sendCompletions();
}

void Session::finish() {
    sync();
    if (!running_.empty()) world().command(subject_, {Verb::Stop, 0});
    if (role_ == Role::World || (role_ == Role::Guest && !held_.empty())) abandonRequests();
    // Now it may wait: for frames due before the request, and for the requested one.
    while (wanted_ || coming_) {
        if (!state_->await()) {
            if (wanted_ || !held_.empty()) error(405, {"the run has ended"});
            coming_.reset();
            wanted_.reset();
            held_.clear();
            break;
        }
        proceed();
    }
    stepped();
}

std::string_view Session::verbOf(Role role) const {
    switch (role) {
        case Role::None:
            break;
        case Role::Robot:
            return "ROBOT";
        case Role::Person:
            return "PERSON";
        case Role::Laser:
            return "LASER";
        case Role::Sensor:
            return "SENSOR";
        case Role::World:
            return "WORLD";
        case Role::Guest:
            return guest_verb_;
    }
    return "";
}

std::string Session::roleText() const {
    if (role_ == Role::None) return "no role";
    std::string text = "the role ";
    text.append(verbOf(role_));
    return role_ == Role::World ? text : text.append(" ").append(id_);
}

void Session::error(int code, std::initializer_list<std::string_view> text) {
    out_ += errorLine(code, text);
}

/// Explains why a verb is unknown, or invalid now.
void Session::refuse(std::string_view verb, bool first) {
    std::vector<std::string> verbs;
    verbs.reserve(requests().size());
    std::string roles;
    for (const Request& request : requests()) {
        verbs.emplace_back(request.verb);
        if (request.verb != verb) continue;
        const auto add_role = [&roles](std::string_view role) {
            roles.append(roles.empty() ? "" : " or ").append(role);
        };
        if (request.role == Role::Guest)
            for (const RoleService* const each : state_->roleServices()) {
                if (each->verb() != guest_verb_) add_role(each->verb());
            }
        else
            add_role(request.role ? verbOf(*request.role) : "");
    }
    for (const RoleService* const each : state_->roleServices()) verbs.emplace_back(each->verb());
    if (guest_)
        for (const RoleRequest& row : guest_->requests()) verbs.emplace_back(row.verb);
    if (std::find(verbs.begin(), verbs.end(), verb) == verbs.end()) {
        const std::string hint = didYouMean(upperCase(verb), verbs);
        closing_ = first;
        return error(400, {"unknown request ", excerpt(verb), hint, hint.empty() ? ";" : "",
                           " HELP lists what there is",
                           first ? "; a first line that is no request ends the connection" : ""});
    }
    std::string more;
    for (const RoleService* const each : state_->roleServices())
        more.append(each->verb()).append(" id, ");
    if (role_ == Role::None)
        return error(405, {"take a role first: ROBOT id, PERSON id, LASER id, ", more,
                           "SENSOR id or WORLD"});
    if (roles.empty())
        return error(405, {"this connection has ", roleText(), ": open another one for ", verb});
    error(405, {verb, " is for the role ", roles, ", this connection has ", roleText(),
                ": open another one"});
}

/// Answers with an error unless the request is permitted.
bool Session::mayUse(const Request& request) {
    const ServerLimits& limits = state_->limits();
    const bool needs = request.needs_token || (limits.token_first && request.role);
    if (needs && !limits.token.empty() && !has_token_) {
        error(401, {request.verb, " needs the token of this run: TOKEN x comes before it"});
        return false;
    }
    if (is_gone_ && request.role) {
        error(404, {id_, " is no more: open another connection"});
        return false;
    }
    return true;
}

/// After changes of the world, the client's robot or sensor may have another index, or be gone.
void Session::sync() {
    followRoom();
    state_->sync();
    if (changes_ == world().changes()) return;
    changes_ = world().changes();
    const auto found = [this]() -> std::optional<std::size_t> {
        if (role_ == Role::Laser || role_ == Role::Sensor) {
            const auto sensor = world().sensorNamed(id_);
            const bool is_same =
                sensor && kindOf(world().sensors()[*sensor].model).keyword == keyword_;
            return is_same ? sensor : std::nullopt;
        }
        return state_->holds(id_, hold_) ? world().moverNamed(id_) : std::nullopt;
    };
    if (role_ == Role::None || role_ == Role::World || role_ == Role::Guest) return;
    if (const auto index = found()) {
        subject_ = *index;
        is_gone_ = false;
    } else if (!is_gone_) {
        lose();
    }
}

/// Handles the removal of the client's robot or sensor.
void Session::lose() {
    const std::string time = formatMilliseconds(world().time());
    for (const int id : running_) {
        out_.append("FAIL id=").append(std::to_string(id));
        out_.append(" reason=deleted t=").append(time).append("\n");
    }
    out_.append("EVENT gone t=").append(time).append(" id=").append(id_).append("\n");
    is_gone_ = true;
    running_.clear();
    every_ = 0;
    scan_.reset();
    coming_.reset();
}

/// Releases the client's robot or person.
void Session::leave() {
    if (drives()) {
        worlds().abandonTrip(id_);
        state_->release(id_, hold_);
    }
    state_->steps().drop(std::exchange(steps_, nullptr));
    forEachLog([this](EventLog& log) { log.unwant(events_); });
    events_.clear();
    seek_.reset();
    held_.clear();
    backlog_.clear();
    joined_.clear();
    may_go_on_ = nullptr;
    guest_.reset();
    guest_streams_.clear();
    role_ = Role::None;
    running_.clear();
    every_ = 0;
    scan_.reset();
    wanted_.reset();
    coming_.reset();
}

void Session::sendCompletions() {
    if (running_.empty()) return;
    const auto send = [this](int id, Outcome outcome, SimTime time) {
        if (std::erase(running_, id) == 0) return;
        const bool done = outcome == Outcome::Done;
        out_.append(done ? "DONE id=" : "FAIL id=").append(std::to_string(id));
        if (!done) out_.append(" reason=").append(reasonOf(outcome));
        out_.append(" t=").append(formatMilliseconds(time)).append("\n");
    };
    for (const CommandEnd& end : world().ends())
        if (end.robot == subject_) send(end.id, end.outcome, end.time);
    for (const TripEnd& end : worlds().tripEnds())
        if (end.mover == id_) send(end.id, end.outcome, end.time);
}

void Session::answerStep() {
    out_.append("OK STEP n=").append(std::to_string(steps_->count - steps_->left));
    out_.append(" t=").append(formatMilliseconds(world().time())).append("\n");
    steps_.reset();
}

void Session::answerSeek() {
    const std::string failure = std::exchange(seek_, nullptr)->failure;
    if (!failure.empty()) return error(409, {failure});
    out_.append("OK SEEK t=").append(formatMilliseconds(world().time())).append("\n");
}

/// Roles of extensions share the requests about sensors if they read some.
bool Session::isOfRole(const Request& request) const {
    const bool reads = request.answer == &Session::scanOfGuest ||
                       request.answer == &Session::streamOfGuest ||
                       request.answer == &Session::stopOfGuest;
    return request.role.value_or(role_) == role_ &&
           (!reads || (guest_ && !guest_->sensors().empty()));
}

void Session::help(Words /*words*/) {
    std::string_view separator = " ";
    out_ += "OK HELP";
    for (const Request& request : requests()) {
        if (!isOfRole(request)) continue;
        if (request.answer == &Session::shutdown && !state_->limits().shutdown) continue;
        if (request.answer == &Session::change && !state_->mayChange()) continue;
        if (request.answer == &Session::rate &&
            state_->simulation().clock().kind != Clock::Kind::Real)
            continue;
        if (request.answer == &Session::seek && !state_->simulation().maySeek()) continue;
        if (request.coupled && *request.coupled != worlds().areCoupled()) continue;
        if (request.answer == &Session::token && state_->limits().token.empty()) continue;
        out_.append(separator).append(request.verb);
        if (!request.arguments.empty()) out_.append(" ").append(request.arguments);
        separator = " | ";
    }
    const auto add = [&](std::string_view verb, std::string_view arguments) {
        out_.append(separator).append(verb);
        if (!arguments.empty()) out_.append(" ").append(arguments);
        separator = " | ";
    };
    if (role_ == Role::None)
        for (const RoleService* const each : state_->roleServices()) add(each->verb(), "id");
    if (guest_)
        for (const RoleRequest& row : guest_->requests()) add(row.verb, row.arguments);
    out_ += '\n';
}

void Session::quit(Words /*words*/) {
    out_ += "OK QUIT\n";
    leave();
    closing_ = true;
}

}  // namespace ispace
