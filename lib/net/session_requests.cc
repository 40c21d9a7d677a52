// SPDX-License-Identifier: GPL-3.0-or-later
// What clients that have a role can ask for.
#include <chrono>
#include <initializer_list>

#include "base/message.h"
#include "base/number.h"
#include "net/request_parts.h"
#include "net/server_state.h"
#include "net/session.h"

namespace ispace {

namespace {

std::string measured(double value) { return formatFixed(value, 3); }

/// Of an angle within (-180, 180], still so when rounded.
std::string headingText(Angle heading) {
    std::string text = measured(heading.degrees());
    if (text == "-180.000") text.erase(0, 1);
    return text;
}

}  // namespace

// The role ROBOT.

void Session::command(Words words) {
    const char* const begin = words.front().data();
    const char* const end = words.back().data() + words.back().size();
    const ParsedCommand parsed =
        parseCommand(std::string_view(begin, static_cast<std::size_t>(end - begin)));
    if (!parsed.command) {
        const bool range = parsed.error.kind == CommandError::Kind::Range;
        return error(range ? 416 : 400, {parsed.error.message});
    }
    if (state_->simulation().isReplay())
        return error(405, {"this run is a replay: robots and people go as recorded; take STATUS and "
                           "SCAN, or run the scene without --replay"});
    const std::string refusal = world().refusal(subject_, *parsed.command);
    if (!refusal.empty()) return error(416, {refusal});
    const int id = world().command(subject_, *parsed.command);
    out_.append("OK ").append(words.front());
    if (id != 0) {
        running_.push_back(id);
        out_.append(" id=").append(std::to_string(id));
    }
    if (const std::string_view name = valueNameOf(parsed.command->verb); !name.empty())
        out_.append(" ").append(name).append("=").append(formatDouble(parsed.command->value));
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
    out_.append(" stall=").append(status.stall ? "1" : "0").append("\n");
}

// The role WORLD.

void Session::list(Words /*words*/) {
    out_.append("OK LIST robots=").append(joined(idsOf(world().robots()), ","));
    out_.append(" lasers=").append(joined(laserIdsOf(world()), ",")).append("\n");
}

void Session::time(Words /*words*/) {
    out_.append("OK TIME t=").append(formatMilliseconds(world().time()));
    out_.append(" steps=").append(std::to_string(world().steps())).append("\n");
}

void Session::poses(Words /*words*/) {
    const auto robots = world().robots();
    out_.append("OK POSES t=").append(formatMilliseconds(world().time()));
    out_.append(" n=").append(std::to_string(robots.size())).append(" poses=");
    for (std::size_t i = 0; i < robots.size(); ++i) {
        const Pose2 pose = world().status(i).pose;
        if (i > 0) out_ += ';';
        out_.append(robots[i].id).append(",").append(measured(pose.position.x));
        out_.append(",").append(measured(pose.position.y));
        out_.append(",").append(headingText(pose.heading));
    }
    out_ += '\n';
}

/// Answers, if it is not so. Each pause may cut short what others have asked for; two of them with
/// no time between cost the world nothing else.
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
    // A STEP under way ends here too, or nobody could end one of too many steps.
    state_->steps().cut();
    state_->simulation().pause(std::chrono::steady_clock::now());
    out_.append("OK PAUSE t=").append(formatMilliseconds(world().time())).append("\n");
}

void Session::resume(Words words) {
    Simulation& simulation = state_->simulation();
    if (simulation.clock().kind == Clock::Kind::Step)
        return error(405, {"the clock is `step`: use STEP n"});
    // What PAUSE began can always be ended.
    if (!simulation.paused()) {
        if (!mayAskFor(words.front())) return;
    } else {
        state_->steps().cut();
        simulation.resume(std::chrono::steady_clock::now());
    }
    out_.append("OK RESUME t=").append(formatMilliseconds(world().time())).append("\n");
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
