// SPDX-License-Identifier: GPL-3.0-or-later
// The role WORLD, but for changes.
#include <chrono>
#include <string>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "net/request_parts.h"
#include "net/session.h"

namespace ispace {

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
    out_.append("OK LIST robots=").append(joined(idsOf(world().robots()), ","));
    out_.append(" lasers=").append(joined(laserIdsOf(world()), ","));
    out_.append(" people=").append(joined(idsOf(world().people()), ","));
    out_.append(" sensors=").append(joined(idsOf(world().sensors()), ",")).append("\n");
}

void Session::time(Words /*words*/) {
    out_.append("OK TIME t=").append(formatMilliseconds(world().time()));
    out_.append(" steps=").append(std::to_string(world().steps()));
    if (const auto end = state_->simulation().end())
        out_.append(" end=").append(formatMilliseconds(*end));
    out_ += '\n';
}

void Session::poses(Words /*words*/) {
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

void Session::seek(Words words) {
    Simulation& simulation = state_->simulation();
    if (!simulation.isReplay())
        return error(405, {"a run goes on: only a replay has a time to go to"});
    if (!simulation.maySeek())
        return error(405, {"this replay is recorded or judged, step by step"});
    const auto time = parseSimTime(words[1]);
    if (!time || *time < SimTime(0))
        return error(416, {excerpt(words[1]), " is no time in seconds from 0 on"});
    // What is being made is about the world as it is now.
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
