// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of the roles ROBOT, PERSON and WORLD.
#include <algorithm>
#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "record/text.h"
#include "scene/scene.h"
#include "server/session.h"
#include "sim/command.h"

namespace ispace {

namespace {

/// Formats default and maximum speeds of commands, on a floor without friction.
std::string speedsText(const RobotModel& model) {
    std::string text;
    const auto add = [&text](std::string_view key, double value) {
        text.append(" ").append(key).append("=").append(formatDouble(value));
    };
    add("speed", model.speed);
    add("rotspeed", model.rotspeed.degrees());
    add("max_speed", model.max_speed);
    add("max_rotspeed", model.max_rotspeed.degrees());
    add("max_sidespeed", model.max_sidespeed);
    add("accel", model.accel);
    add("rotaccel", model.rotaccel.degrees());
    return text;
}

/// Formats the points of a way, without the start.
std::string wayText(const Command& command) {
    std::string text;
    for (const Point2 point : command.course.path) {
        text.append(text.empty() ? "" : ";").append(measured(point.x));
        text.append(",").append(measured(point.y));
    }
    return text;
}

/// Writes a record of a scene with its id, also where the file leaves it to the reader.
std::string recordText(const Scene& scene, std::size_t record) {
    std::string text = formatRecord(scene.records[record]);
    const std::string& id = scene.ids[record];
    if (!id.empty() && !scene.records[record].has("id"))
        text.insert(scene.records[record].keyword().size(), " id=" + id);
    return text;
}

}  // namespace

void Session::acquireRobot(Words words) {
    const std::string_view id = enter(words[1]);
    const auto robot = world().robotNamed(id);
    if (!robot) return error(404, {unknownThing("robot", words[1], idsOfAll(Role::Robot))});
    if (!seize(Role::Robot, id, *robot)) return;
    const RobotModel& model = world().robots()[*robot].model;
    out_.append("OK ROBOT ").append(words[1]);
    out_.append(" model=").append(model.model.empty() ? "-" : model.model);
    out_.append(" radius=").append(formatDouble(model.radius));
    out_.append(speedsText(model)).append("\n");
}

void Session::takePerson(Words words) {
    const std::string_view id = enter(words[1]);
    const auto person = world().personNamed(id);
    if (!person) return error(404, {unknownThing("person", words[1], idsOfAll(Role::Person))});
    if (!seize(Role::Person, id, *person)) return;
    const Mover& mover = world().movers()[*person];
    out_.append("OK PERSON ").append(words[1]);
    out_.append(" height=").append(formatDouble(mover.model.height));
    out_.append(" radius=").append(formatDouble(mover.model.radius));
    out_.append(speedsText(mover.model)).append("\n");
}

/// Holds a mover, or answers that another client has it.
bool Session::seize(Role role, std::string_view id, std::size_t mover) {
    const auto hold = state_->hold(id);
    if (!hold) {
        error(409, {role == Role::Robot ? "robot " : "person ", id, " is held by another client"});
        return false;
    }
    role_ = role;
    id_ = id;
    hold_ = *hold;
    subject_ = mover;
    return true;
}

void Session::command(Words words) {
    if (isTrip(words)) return startTrip(words);
    ParsedCommand parsed = parseCommand(textOf(words));
    if (!parsed.command) {
        const bool range = parsed.error.kind == CommandError::Kind::Range;
        return error(range ? 416 : 400, {parsed.error.message});
    }
    if (!mayMove()) return;
    const std::string refusal = world().refusal(subject_, *parsed.command);
    if (!refusal.empty()) return error(416, {refusal});
    const bool stops = parsed.command->verb == Verb::Stop;
    const std::string busy = worlds().endTrip(id_, stops ? Outcome::Stopped : Outcome::Replaced);
    if (!busy.empty()) return error(409, {busy});
    if (parsed.command->verb == Verb::Goto)
        if (const std::string none = world().findPath(subject_, *parsed.command); !none.empty())
            return error(409, {none});
    double value = parsed.command->value;
    if (parsed.command->verb == Verb::Path)  // the whole path, from here
        value +=
            distance(world().status(subject_).pose.position, parsed.command->course.path.front());
    const int id = world().command(subject_, *parsed.command);
    out_.append("OK ").append(words.front());
    if (id != 0) {
        running_.push_back(id);
        out_.append(" id=").append(std::to_string(id));
    }
    if (const std::string_view name = valueNameOf(parsed.command->verb); !name.empty())
        out_.append(" ").append(name).append("=").append(
            parsed.command->verb == Verb::Goto ? measured(value) : formatDouble(value));
    if (parsed.command->verb == Verb::Goto) out_.append(" way=").append(wayText(*parsed.command));
    out_ += '\n';
}

void Session::status(Words /*words*/) {
    const RobotStatus status = world().status(subject_);
    out_.append("OK STATUS t=").append(formatMilliseconds(world().time()));
    out_.append(" x=").append(measured(status.pose.position.x));
    out_.append(" y=").append(measured(status.pose.position.y));
    out_.append(" heading=").append(headingText(status.pose.heading));
    out_.append(" speed=").append(measured(status.speed));
    out_.append(" rotspeed=").append(measured(status.rotspeed.degrees()));
    out_.append(" accel=").append(formatDouble(status.accel));
    out_.append(" rotaccel=").append(formatDouble(status.rotaccel.degrees()));
    out_.append(" stall=").append(status.stall ? "1" : "0");
    out_.append(whereText()).append("\n");
}

void Session::odometry(Words /*words*/) {
    const Odometry odometry = world().odometry(subject_);
    out_.append("OK ODOMETRY t=").append(formatMilliseconds(world().time()));
    out_.append(" x=").append(measured(odometry.pose.position.x));
    out_.append(" y=").append(measured(odometry.pose.position.y));
    out_.append(" heading=").append(headingText(odometry.pose.heading));
    out_.append(" speed=").append(measured(odometry.speed));
    out_.append(" rotspeed=").append(measured(odometry.rotspeed.degrees())).append("\n");
}

void Session::takeWorld(Words /*words*/) {
    role_ = Role::World;
    const Clock& clock = state_->simulation().clock();
    out_.append("OK WORLD t=").append(formatMilliseconds(world().time()));
    out_.append(" dt=").append(formatSimTime(world().stepLength())).append(" clock=");
    switch (clock.kind) {
        case Clock::Kind::Real:
            out_.append("real rate=").append(formatDouble(clock.rate));
            break;
        case Clock::Kind::Fast:
            out_ += "fast";
            break;
        case Clock::Kind::Step:
            out_ += "step";
            break;
    }
    out_ += '\n';
}

void Session::list(Words /*words*/) {
    out_.append("OK LIST robots=").append(joined(idsOfAll(Role::Robot), ","));
    out_.append(" lasers=").append(joined(idsOfAll(Role::Laser), ","));
    out_.append(" people=").append(joined(idsOfAll(Role::Person), ","));
    out_.append(" sensors=").append(joined(idsOfAll(Role::Sensor), ","));
    std::vector<std::string> ids;
    for (const RunRoom& room : worlds().rooms()) ids.push_back(room.id);
    if (const std::string names = joined(ids, ","); !names.empty())
        out_.append(" rooms=").append(names);
    out_ += '\n';
}

void Session::states(Words words) {
    std::vector<RoomState> states = state_->statesOfAll();
    if (words.size() > 1) {
        std::erase_if(states, [&](const RoomState& state) { return state.id != words[1]; });
        if (states.empty())
            return error(404, {"no sensor or actuator ", excerpt(words[1]), " has a state"});
    }
    out_.append("OK STATE t=").append(formatMilliseconds(world().time()));
    for (const RoomState& state : states)
        out_.append(" ").append(state.id).append(".").append(state.key).append("=").append(
            state.value);
    out_ += '\n';
}

void Session::records(Words words) {
    const auto all = worlds().rooms();
    const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const RunRoom& room) { return room.id == name; });
    if (found == all.end() && all.front().id.empty())
        return error(400, {"this run is of one room: RECORDS has no argument"});
    if (found == all.end())
        return error(404, {"RECORDS wants a room of the building, as in RECORDS ", all.front().id});
    const Scene* const scene = &found->simulation->world().scene();
    // The records of the room, then those placed in it.
    std::array<std::string, 2> texts;
    std::array<std::size_t, 2> counts{};
    for (std::size_t i = 0; i < scene->records.size(); ++i) {
        const std::size_t part = scene->records[i].schema().isEnvironment() ? 0 : 1;
        texts[part].append(recordText(*scene, i)).append("\n");
        ++counts[part];
    }
    if (const std::size_t bytes = texts[0].size() + texts[1].size();
        bytes > state_->limits().pending)
        return error(409, {"the records have ", std::to_string(bytes), " bytes, more than the ",
                           std::to_string(state_->limits().pending), " of an answer"});
    out_.append("OK RECORDS t=").append(formatMilliseconds(world().time()));
    out_.append(" room=").append(std::to_string(counts[0]));
    out_.append(" placed=").append(std::to_string(counts[1]));
    out_.append(" bytes=").append(std::to_string(texts[0].size() + texts[1].size())).append("\n");
    out_.append(texts[0]).append(texts[1]);
}

void Session::time(Words /*words*/) {
    out_.append("OK TIME t=").append(formatMilliseconds(world().time()));
    out_.append(" steps=").append(std::to_string(world().steps()));
    if (const auto end = state_->simulation().end())
        out_.append(" end=").append(formatMilliseconds(*end));
    out_ += '\n';
}

/// Answers with an error if the rate limit is exceeded. A pause may interrupt other clients'
/// requests; a pair without time between them costs the world no more than that.
bool Session::mayAskFor(std::string_view verb) {
    const auto now = std::chrono::steady_clock::now();
    TokenBucket& all = state_->pauses();
    if (pauses_.has(now)) {
        TokenBucket* const from = all.has(now) ? &all : &spare_pauses_;
        if (from->has(now)) {
            from->take();
            pauses_.take();
            return true;
        }
    }
    const ServerLimits& limits = state_->limits();
    error(429, {verb, " comes too often: a client has ", formatDouble(limits.pauses.rate),
                " a second, all together ", formatDouble(limits.all_pauses.rate)});
    return false;
}

void Session::pause(Words words) {
    if (!mayAskFor(words.front())) return;
    // Also ends a STEP under way: otherwise one with too many steps could not be stopped.
    state_->steps().cut();
    state_->simulation().pause(std::chrono::steady_clock::now());
    out_.append("OK PAUSE t=").append(formatMilliseconds(world().time())).append("\n");
}

void Session::resume(Words words) {
    Simulation& simulation = state_->simulation();
    if (simulation.clock().kind == Clock::Kind::Step)
        return error(405, {"the clock is `step`: use STEP n"});
    // A pause can always be ended.
    if (!simulation.paused()) {
        if (!mayAskFor(words.front())) return;
    } else {
        state_->steps().cut();
        simulation.resume(std::chrono::steady_clock::now());
    }
    out_.append("OK RESUME t=").append(formatMilliseconds(world().time())).append("\n");
}

void Session::rate(Words words) {
    Simulation& simulation = state_->simulation();
    if (simulation.clock().kind != Clock::Kind::Real)
        return error(405, {"only the clock `real` has a rate"});
    constexpr double kSlowest = 1e-6;
    const auto rate = parseClockRate(words[1]);
    if (!rate || *rate < kSlowest)
        return error(416, {excerpt(words[1]),
                           " is no number of simulated seconds in a second, from 0.000001 to "
                           "1000000"});
    if (!mayAskFor(words.front())) return;
    simulation.setRate(*rate, std::chrono::steady_clock::now());
    out_.append("OK RATE t=").append(formatMilliseconds(world().time()));
    out_.append(" rate=").append(formatDouble(*rate)).append("\n");
}

void Session::seek(Words words) {
    Simulation& simulation = state_->simulation();
    if (!simulation.isReplay())
        return error(405, {"a run goes on: only a replay has a time to go to"});
    if (!simulation.maySeek())
        return error(405, {"this replay is recorded or judged, step by step"});
    const auto time = parseSimTime(words[1]);
    if (!time || *time < SimTime(0))
        return error(416, {excerpt(words[1]), " is no time in seconds from 0 on"});
    // Pending readings and changes refer to the current world.
    if (!maySeek()) return hold(words, &Session::maySeek);
    if (!mayAskFor(words.front())) return;
    state_->steps().cut();
    simulation.forgo(simulation.owed());
    seek_ = state_->seek(*time);
    sync();
    if (seek_->is_over) answerSeek();
}

void Session::step(Words words) {
    std::int64_t steps = 1;
    if (words.size() > 1) {
        const Count count = parseCount(words[1], "the number of steps");
        if (count.code != 0) return error(count.code, {count.message});
        steps = count.value;
    }
    if (!state_->simulation().paused())
        return error(405, {"the world is running: PAUSE comes before STEP"});
    steps_ = state_->steps().ask(steps);
}

void Session::shutdown(Words /*words*/) {
    if (!state_->limits().shutdown)
        return error(403, {"clients may not end this run: it has --no-shutdown"});
    out_.append("OK SHUTDOWN t=").append(formatMilliseconds(world().time())).append("\n");
    state_->simulation().finish();
    leave();
    closing_ = true;
}

}  // namespace ispace
