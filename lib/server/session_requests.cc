// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of the roles ROBOT, PERSON and WORLD; changes of the world.
#include "server/session_requests.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "scene/findings/findings.h"
#include "scene/placement_schemas.h"
#include "scene/scene.h"
#include "server/session.h"
#include "sim/command.h"
#include "sim/state_watch.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

/// Reason why a change is rejected.
struct Refusal {
    int code = 400;
    std::string message;
};

/// The error's text, without names of options, and without positions unless in a file.
std::string messageOf(const FormatError& error, std::string_view verb) {
    constexpr std::size_t kMost = 3;
    const auto& findings = error.diagnostics();
    std::string text;
    for (std::size_t i = 0; i < std::min(kMost, findings.size()); ++i) {
        if (i > 0) text += "; ";
        std::string_view message = findings[i].message;
        const std::size_t space = message.find(' ');
        if (message.starts_with("--") && space != std::string_view::npos)
            text.append(verb).append(message.substr(space));
        else
            text += message;
    }
    if (findings.size() > kMost)
        text.append("; and ").append(std::to_string(findings.size() - kMost)).append(" more");
    return text;
}

/// Globs of one request, and bytes of each: all ids are compared with them.
void checkGlobs(const std::vector<Edit>& edits) {
    constexpr std::ptrdiff_t kMost = 8;
    constexpr std::size_t kMostBytes = 256;
    for (const Edit& edit : edits)
        if (edit.ids.isPattern() && edit.ids.text().size() > kMostBytes)
            throw Refusal{400, excerpt(edit.ids.text()) + " has more than " +
                                   std::to_string(kMostBytes) + " bytes, which a glob may have"};
    if (std::count_if(edits.begin(), edits.end(),
                      [](const Edit& edit) { return edit.ids.isPattern(); }) > kMost)
        throw Refusal{400, "a request has at most " + std::to_string(kMost) + " globs"};
}

/// True for records that do not belong to a world.
bool isMeta(std::string_view keyword) {
    const Schema* const schema = sceneSchemas().find(keyword);
    return schema != nullptr && schema->type == RecordType::Meta;
}

/// The edits that a request asks for.
std::vector<Edit> editsOf(std::span<const std::string_view> words, std::string_view rest) {
    try {
        if (words[0] == "ADD") {
            if (isMeta(words[1]))
                throw Refusal{400, "a record `" + std::string(words[1]) +
                                       "` tells of a file: a running world has none"};
            return {parseEdit(Edit::Kind::Add, rest)};
        }
        std::vector<Edit> edits;
        if (words[0] == "SET")
            edits.push_back(parseEdit(Edit::Kind::Set, rest));
        else
            for (const std::string_view id : words.subspan(1))
                edits.push_back(parseEdit(Edit::Kind::Delete, id));
        checkGlobs(edits);
        return edits;
    } catch (const UsageError& error) {
        throw Refusal{400, error.what()};
    } catch (const FormatError& error) {
        throw Refusal{400, messageOf(error, words[0])};
    }
}

/// The findings about the movers of a change, in one line.
std::string warningOf(const World& world, const std::vector<std::string>& movers) {
    constexpr std::size_t kMost = 3;
    if (movers.empty()) return "";
    std::vector<std::string> warnings;
    const auto is_moved = [&movers](const std::string& id) {
        return std::find(movers.begin(), movers.end(), id) != movers.end();
    };
    for (const Finding& finding :
         checkScene(world.scene(), {.checks = {"outside", "paths"}, .ids = is_moved}))
        warnings.push_back(finding.message);
    for (const std::string& id : movers)
        for (std::string& warning : startWarnings(world, id))
            warnings.push_back(std::move(warning));
    if (warnings.size() > kMost) {
        warnings.resize(kMost);
        warnings.emplace_back("and more");
    }
    return joined(warnings, "; ");
}

/// A pending change request.
class Changing {
  public:
    Changing(ServerState& state, const std::string& line, const std::string& verb)
        : state_(&state), line_(line), verb_(verb) {
        for (const Piece& piece : wordsOf(line_)) words_.push_back(piece.text);
    }
    Changing(const Changing&) = delete;
    Changing& operator=(const Changing&) = delete;

    /// \throws Refusal
    WorldChange begin();
    /// Call after the change succeeded or failed: informs all sessions. \returns the answer
    std::string end(const std::exception_ptr& failure);

  private:
    [[nodiscard]] const World& world() const { return state_->simulation().world(); }
    [[nodiscard]] bool is(std::string_view verb) const { return words_[0] == verb; }
    [[nodiscard]] WorldChange change() const;
    [[nodiscard]] std::string done() const;

    ServerState* state_;
    std::string line_, verb_;
    std::vector<std::string_view> words_;  // of it
    std::shared_ptr<const ChangeNews> news_;
};

WorldChange Changing::begin() {
    WorldChange change = this->change();
    news_ = change.news;
    return change;
}

WorldChange Changing::change() const {
    WorldEditor& editor = state_->editor();
    if (is("RESET")) return editor.reset();
    if (is("LOAD")) {
        for (const std::string_view name : words_)
            if (printable(name) != name)
                throw Refusal{400, "the name of a file holds no control characters"};
        return editor.load(std::string(words_[1]), words_.size() > 2 ? std::string(words_[2]) : "");
    }
    const auto rest = static_cast<std::size_t>(words_[1].data() - line_.data());
    return editor.edit(editsOf(words_, std::string_view(line_).substr(rest)));
}

std::string Changing::done() const {
    const std::string added =
        is("ADD") && !world().scene().ids.empty() ? world().scene().ids.back() : "";
    state_->simulation().tellChange(printable(line_), news_->scene_text);
    std::string out = "OK ";
    out += verb_.empty() ? words_[0] : verb_;
    if (!added.empty()) out.append(" id=").append(added);
    out.append(" t=").append(formatMilliseconds(world().time()));
    const std::vector<std::string> movers =
        added.empty() ? news_->movers : std::vector<std::string>{added};
    if (const std::string warning = warningOf(world(), movers); !warning.empty())
        out.append(" warning=").append(warning);
    return out += '\n';
}

std::string Changing::end(const std::exception_ptr& failure) {
    try {
        if (failure) std::rethrow_exception(failure);
        return done();
    } catch (const Refusal& refusal) {
        return errorLine(refusal.code, {refusal.message});
    } catch (const UnknownRecord& unknown) {
        return errorLine(404, {unknownThing("record", unknown.id, world().scene().ids)});
    } catch (const BadEdit& bad) {
        return errorLine(400, {messageOf(bad, words_[0])});
    } catch (const FormatError& bad) {
        return errorLine(409, {is("LOAD") ? bad.what() : messageOf(bad, words_[0])});
    } catch (const UsageError& bad) {
        return errorLine(400, {bad.what()});
    } catch (const std::system_error& bad) {
        return errorLine(404, {bad.what()});
    } catch (const std::bad_alloc&) {
        return errorLineOf(std::current_exception());
    } catch (const std::length_error&) {
        return errorLineOf(std::current_exception());
    }
}

}  // namespace

std::shared_ptr<const ServerState::Asked> changeWorld(ServerState& state, const std::string& line,
                                                      const std::string& verb) {
    const auto changing = std::make_shared<Changing>(state, line, verb);
    const auto asked = std::make_shared<ServerState::Asked>();
    const auto end = [changing, asked](const std::exception_ptr& failure) {
        asked->bytes = std::make_shared<const std::string>(changing->end(failure));
    };
    const WallTime began = std::chrono::steady_clock::now();
    try {
        state.change(changing->begin(), end);
    } catch (const Refusal&) {
        end(std::current_exception());
        state.changes().spend(began, std::chrono::steady_clock::now());
    }
    return asked;
}

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
    const ParsedCommand parsed = parseCommand(textOf(words));
    if (!parsed.command) {
        const bool range = parsed.error.kind == CommandError::Kind::Range;
        return error(range ? 416 : 400, {parsed.error.message});
    }
    if (state_->simulation().isReplay())
        return error(405,
                     {"this run is a replay: robots and people go as recorded; take STATUS and "
                      "SCAN, or run the scene without --replay"});
    const std::string refusal = world().refusal(subject_, *parsed.command);
    if (!refusal.empty()) return error(416, {refusal});
    if (rooms() != nullptr) {
        const bool stops = parsed.command->verb == Verb::Stop;
        const std::string busy =
            rooms()->worlds->endTrip(id_, stops ? Outcome::Stopped : Outcome::Replaced);
        if (!busy.empty()) return error(409, {busy});
    }
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
        out_.append(" ").append(name).append("=").append(formatDouble(value));
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
    if (rooms() != nullptr) state_ = rooms()->states.front();
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
    if (rooms() != nullptr) {
        std::vector<std::string> ids;
        for (const JoinedRoom& room : rooms()->worlds->rooms()) ids.push_back(room.id);
        out_.append(" rooms=").append(joined(ids, ","));
    }
    out_ += '\n';
}

void Session::states(Words words) {
    std::vector<RoomState> states = statesOf(world());
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

void Session::time(Words /*words*/) {
    out_.append("OK TIME t=").append(formatMilliseconds(world().time()));
    out_.append(" steps=").append(std::to_string(world().steps()));
    if (const auto end = state_->simulation().end())
        out_.append(" end=").append(formatMilliseconds(*end));
    out_ += '\n';
}

void Session::poses(Words /*words*/) {
    if (rooms() != nullptr) return posesOfAll();
    const auto movers = world().movers();
    const std::size_t robots = world().robots().size();
    out_.append("OK POSES t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(robots)).append(" poses=");
    for (std::size_t i = 0; i < movers.size(); ++i) {
        const Pose2 pose = world().status(i).pose;
        if (i == robots) out_ += " people=";
        if (i != 0 && i != robots) out_ += ';';
        out_.append(movers[i].id).append(",").append(measured(pose.position.x));
        out_.append(",").append(measured(pose.position.y));
        out_.append(",").append(headingText(pose.heading));
    }
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
