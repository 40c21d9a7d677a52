// SPDX-License-Identifier: GPL-3.0-or-later
// The loop that takes steps, and its clock.
//
// A step is due at the start of the clock plus simulated time over the rate, rounded up to
// nanoseconds. A pause keeps the time to the next step; a change of the rate scales it. Budgets are
// checked between steps and between parts of a step, never within a move.
#include "sim/simulation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

constexpr double kFastestRate = 1e6;
/// 64 bits hold every nanosecond, and a slow clock may have its next step beyond all of them.
constexpr long double kMaxAhead = 3e18L;  // 95 years
constexpr nanoseconds kMaxLag = std::chrono::milliseconds(250);
constexpr std::string_view kReal = "real:";

double parseRate(std::string_view text) {
    const auto rate = parseClockRate(text);
    if (!rate) {
        throw UsageError(excerpt(text) +
                         " is no rate of the clock, wanted simulated seconds in a "
                         "second, above 0 and at most " +
                         formatDouble(kFastestRate) + ", like real:20");
    }
    return *rate;
}

}  // namespace

std::optional<double> parseClockRate(std::string_view text) {
    const auto rate = parseDouble(text);
    return rate && *rate > 0 && *rate <= kFastestRate ? rate : std::nullopt;
}

Clock parseClock(const std::string& text) {
    if (text == "real") return {Clock::Kind::Real, 1};
    if (text == "fast") return {Clock::Kind::Fast, 1};
    if (text == "step") return {Clock::Kind::Step, 1};
    if (text.starts_with(kReal))
        return {Clock::Kind::Real, parseRate(std::string_view(text).substr(kReal.size()))};
    const std::string hint = didYouMean(text, {"real", "fast", "step"});
    throw UsageError("unknown clock " + excerpt(text) +
                     (hint.empty() ? ", wanted real, real:RATE, fast or step" : hint));
}

Simulation::Simulation(World& world, std::vector<TimedCommand> script, Clock clock,
                       std::optional<SimTime> until)
    : world_(&world),
      events_(world),
      script_(std::move(script)),
      clock_(clock),
      until_(std::min(until.value_or(kMaxTime), kMaxTime)),
      paused_(clock.kind == Clock::Kind::Step) {
    if (!script_.empty())
        for (const Mover& mover : world.movers()) scripted_.push_back(mover.id);
    endIfReached();
    if (!finished_) giveScripted();
}

void Simulation::pause(WallTime now) {
    owed_ = 0;
    if (std::exchange(paused_, true)) return;
    if (started_) ahead_ = dueAt() - now;
}

void Simulation::resume(WallTime now) {
    assert(clock_.kind != Clock::Kind::Step);
    if (isHeld()) return;
    paused_ = false;
    owed_ = 0;
    goOnAt(now);
}

void Simulation::goOnAt(WallTime now) {
    startAt(now);
    // Otherwise pauses in quick succession would stop the world.
    if (ahead_) started_.value() -= dueAt() - now - *std::exchange(ahead_, std::nullopt);
}

void Simulation::setRate(double rate, WallTime now) {
    assert(clock_.kind == Clock::Kind::Real && rate > 0);
    if (started_ && !paused_) ahead_ = dueAt() - now;
    if (ahead_) {
        // What is due stays due, as far as a lag is made up for at all.
        const long double wall = static_cast<long double>(ahead_->count()) * clock_.rate /
                                 static_cast<long double>(rate);
        const long double lag = -static_cast<long double>(kMaxLag.count());
        ahead_ = nanoseconds(static_cast<std::int64_t>(std::clamp(wall, lag, kMaxAhead)));
    }
    clock_.rate = rate;
    if (started_ && !paused_) goOnAt(now);
}

void Simulation::allow(std::int64_t count) {
    assert(paused_ && count >= 0);
    if (isHeld()) return;
    // A client that allows the maximum number of steps may allow more later.
    owed_ += std::min(count, std::numeric_limits<std::int64_t>::max() - owed_);
}

void Simulation::endIfReached() {
    if (world_->time() >= until_) finished_ = true;
    if (is_led_ || !isReplayed()) return;
    owed_ = 0;
    (holds_ ? paused_ : finished_) = true;
}

/// Gives the commands of the script that are due; those that cannot be carried out become events.
void Simulation::giveScripted() {
    for (; next_ < script_.size() && script_[next_].time <= world_->time(); ++next_) {
        const TimedCommand& timed = script_[next_];
        if (!timed.change.empty()) {
            askChange(timed.change);
            continue;
        }
        const auto mover = world_->changes() == 0 ? std::optional(timed.robot)
                                                  : world_->moverNamed(scripted_[timed.robot]);
        if (!mover || !world_->refusal(*mover, timed.command).empty()) continue;
        Command command = timed.command;
        if (command.verb == Verb::Goto) {
            if (std::string none = world_->findPath(*mover, command); !none.empty()) {
                script_events_.push_back({.kind = EventKind::Unreached,
                                          .id = world_->movers()[*mover].id,
                                          .place = command.course.path.back(),
                                          .text = std::move(none)});
                continue;
            }
        }
        world_->command(*mover, command);
    }
}

/// Tells of the commands of the script that could not be carried out.
void Simulation::notifyScripted() {
    for (Event& event : std::exchange(script_events_, {})) {
        events_.add(EventKind::Mark, "script: " + event.text, event.id);
        events_.notify(std::move(event));
    }
}

void Simulation::follow(std::shared_ptr<Director> director) {
    directors_.push_back(std::move(director));
}

void Simulation::keepOpen(const std::string& door, SimTime until) {
    kept_open_[door] = {world_->time(), until};
}

bool Simulation::isKeptOpen(const std::string& door) const {
    const auto found = kept_open_.find(door);
    // A reset of the world turns its time back.
    return found != kept_open_.end() && world_->time() >= found->second.first &&
           world_->time() < found->second.second;
}

bool Simulation::isOpenForPeople(const std::string& door) const {
    return std::any_of(directors_.begin(), directors_.end(),
                       [&](const auto& director) { return director->hasOpened(door); });
}

std::string Simulation::takeScriptedChange() {
    while (!due_changes_.empty()) {
        AskedChange change = std::move(due_changes_.front());
        due_changes_.pop_front();
        std::string request = change.request();
        if (request.empty()) continue;
        when_refused_ = std::move(change.refused);
        return request;
    }
    return "";
}

void Simulation::refuseScripted(const std::string& answer) {
    if (when_refused_ == nullptr) return events_.add(EventKind::Mark, "script: " + answer);
    // Behind ERR and the code.
    std::size_t begin = 0;
    for (int word = 0; word < 2; ++word) begin = answer.find(' ', begin) + 1;
    std::exchange(when_refused_, nullptr)(answer.substr(begin));
}

void Simulation::notifyChange(std::string request, const std::string& scene_text) {
    std::string scene;
    if (!scene_text.empty() && recorder_ != nullptr) scene = recorder_->recordScene(scene_text);
    events_.add(EventKind::Change, std::move(request), std::move(scene));
}

void Simulation::notifyReplayed(bool seeks) {
    for (const RunChange& change : replay_->takeMade()) {
        if (seeks) continue;
        const bool needs_scene = !change.scene.empty() && recorder_ != nullptr;
        const auto write = needs_scene ? recorder_->options().scene_text : nullptr;
        notifyChange(change.text, write ? write(world_->scene()) : "");
    }
}

void Simulation::replay(Replay& replay, bool holds) {
    replay_ = &replay;
    holds_ = holds;
    endIfReached();
}

bool Simulation::isReplayed() const {
    return replay_ != nullptr && replay_->atEnd() &&
           std::all_of(followers_.begin(), followers_.end(),
                       [](const Simulation* other) { return other->isReplayed(); });
}

bool Simulation::maySeek() const {
    const auto may_seek = [](const Simulation* one) {
        return one->replay_ != nullptr && one->recorder_ == nullptr && !one->is_in_order_;
    };
    return may_seek(this) && std::all_of(followers_.begin(), followers_.end(), may_seek);
}

std::function<void()> Simulation::preparation(std::optional<SimTime> to) const {
    if (replay_ == nullptr) return nullptr;
    if (to) to = std::min(*to, until_);
    if (followers_.empty()) return replay_->preparation(*world_, to);
    std::vector<std::function<void()>> parts;
    const auto add = [&](const Simulation* one) {
        if (auto part = one->replay_->preparation(*one->world_, to))
            parts.push_back(std::move(part));
    };
    add(this);
    std::for_each(followers_.begin(), followers_.end(), add);
    if (parts.empty()) return nullptr;
    return [parts = std::move(parts)] {
        for (const auto& part : parts) part();
    };
}

std::shared_ptr<const void> Simulation::adoptPrepared(std::optional<SimTime> to) {
    if (followers_.empty()) {
        auto before = replay_->adopt(*world_);
        notifyReplayed(to.has_value());
        return before;
    }
    auto old = std::make_shared<std::vector<std::shared_ptr<const void>>>();
    for (auto work = std::function<void()>([] {}); work; work = preparation(to)) {
        work();
        old->clear();  // thousands of changes of a moment would keep as many worlds
        old->push_back(replay_->adopt(*world_));
        notifyReplayed(to.has_value());
        for (Simulation* const other : followers_) {
            old->push_back(other->replay_->adopt(*other->world_));
            other->notifyReplayed(to.has_value());
        }
    }
    for (const auto& changer : changers_) changer();
    return old;
}

void Simulation::seek(SimTime time) {
    do {
        while (const auto work = preparation(time)) {
            work();
            adoptPrepared(time);
        }
    } while (!seekSome(time, WallTime::max()));
}

/// Steps all worlds forward together: none can be sought by itself, as movers go from one to
/// another.
bool Simulation::seekTogether(SimTime time, WallTime until) {
    if (time < world_->time()) return false;
    while (world_->time() + world_->stepLength() <= time && !isReplayed()) {
        if (preparation() != nullptr) return false;
        replay_->stepTowards(*world_, time);
        for (Simulation* const other : followers_)
            other->replay_->stepTowards(*other->world_, time);
        if (steady_clock::now() >= until) return false;
    }
    return true;
}

bool Simulation::seekSome(SimTime time, WallTime until) {
    assert(maySeek());
    time = std::min(time, until_);
    if (!(followers_.empty() ? replay_->seekSome(*world_, time, until) : seekTogether(time, until)))
        return false;
    events_.stepped();
    for (Simulation* const other : followers_) other->events_.stepped();
    endIfReached();
    ahead_.reset();
    if (started_) startAt(steady_clock::now());
    for (const auto& changer : changers_) changer();
    return true;
}

/// Takes one step of this world and of those that it leads.
void Simulation::step() {
    notifyScripted();  // those of the start, before there were subscribers
    for (const auto& preparer : preparers_) preparer();
    if (replay_ != nullptr) {
        replay_->prepareAll(*world_, {}, [this] { notifyReplayed(false); });
        replay_->step(*world_);
    } else {
        world_->stepDeferred();
    }
    events_.stepped();
    if (replay_ != nullptr)
        for (const RunUnreached& target : replay_->unreached())
            events_.notify({.kind = EventKind::Unreached,
                            .id = target.id,
                            .other = target.to,
                            .place = target.at,
                            .text = target.text});
    // Before the next commands: one of motion would clear the stall flag of this step.
    if (recorder_ != nullptr) recorder_->record(*world_);
    for (Simulation* const other : followers_) other->step();
    endIfReached();
    if (!finished_) giveScripted();
    notifyScripted();
    if (!finished_)
        for (const std::shared_ptr<Director>& director : directors_) director->stepped(*this);
    for (const auto& observer : observers_) observer();
}

void Simulation::startAt(WallTime now) {
    started_ = now;
    start_time_ = world_->time();
}

WallTime Simulation::dueAt() const {
    // Computed from the start each time, so that rounding errors do not add up.
    const auto simulated = (world_->time() - start_time_ + world_->stepLength()).count();
    const long double wall =
        std::ceil(static_cast<long double>(simulated) / static_cast<long double>(clock_.rate));
    return started_.value() + nanoseconds(static_cast<std::int64_t>(std::min(wall, kMaxAhead)));
}

std::optional<WallTime> Simulation::due() const {
    const bool follows = clock_.kind == Clock::Kind::Real && started_ && !paused_ && !finished_;
    return follows ? std::optional(dueAt()) : std::nullopt;
}

void Simulation::noteLateness() {
    const nanoseconds late = steady_clock::now() - dueAt();
    ++lateness_.steps;
    lateness_.most = std::max(lateness_.most, late);
    lateness_.own = std::max(lateness_.own, std::min(late, threadTime() - work_));
    const auto step = static_cast<double>(world_->stepLength().count());
    if (static_cast<double>(late.count()) > step / clock_.rate) ++lateness_.late;
}

void Simulation::forgive(WallTime now) {
    const auto lag = now - dueAt();
    if (lag <= kMaxLag) return;
    started_.value() += lag;
    lost_ += lag;
}

bool Simulation::isDue(WallTime now) const {
    if (finished_) return false;
    if (paused_) return owed_ > 0;
    return clock_.kind != Clock::Kind::Real || (started_ && dueAt() <= now);
}

bool Simulation::finishRecord(WallTime until) {
    if (recorder_ != nullptr && !recorder_->finishStep(*world_, until)) return false;
    return std::all_of(followers_.begin(), followers_.end(),
                       [until](Simulation* other) { return other->finishRecord(until); });
}

bool Simulation::awaitsFrames() const {
    return (recorder_ != nullptr && recorder_->awaitsFrames()) ||
           std::any_of(followers_.begin(), followers_.end(),
                       [](const Simulation* other) { return other->awaitsFrames(); });
}

std::optional<WallTime> Simulation::flushRecord() {
    auto next = recorder_ == nullptr ? std::nullopt : recorder_->flushDue(steady_clock::now());
    for (Simulation* const other : followers_)
        if (const auto its = other->flushRecord()) next = std::min(next.value_or(*its), *its);
    return next;
}

bool Simulation::readSome(WallTime until) {
    const nanoseconds begun = threadTime();
    const bool are_all_read =
        world_->readSome(until) &&
        std::all_of(followers_.begin(), followers_.end(),
                    [until](Simulation* other) { return other->readSome(until); });
    reading_ += threadTime() - begun;
    return are_all_read;
}

bool Simulation::finishStep(WallTime until) { return readSome(until) && finishRecord(until); }

std::optional<WallTime> Simulation::run(WallTime now, nanoseconds budget) {
    const nanoseconds begun = threadTime();
    const SimTime before = world_->time();
    const bool was_running = !paused_ || owed_ > 0;
    reading_ = {};
    const auto next = runDue(now, budget);
    work_ = threadTime();
    // In a pause only what was added is read.
    if (was_running) pace_.worked({work_ - begun, reading_, world_->time() - before}, now);
    return next;
}

/// Takes the steps that are due, until the budget is used up, a change has to be made, or a record
/// waits for its frames. \returns the time of the next call
std::optional<WallTime> Simulation::runDue(WallTime now, nanoseconds budget) {
    if (finished_) return std::nullopt;
    const bool follows = clock_.kind == Clock::Kind::Real;
    if (follows && !started_) startAt(now);
    if (follows && !paused_) forgive(now);
    const auto end = steady_clock::now() + budget;
    const auto next_part = [&] { return awaitsFrames() ? flushRecord() : std::optional(now); };
    // Finishes the last step first, even if the next one is due.
    if (!finishStep(end)) return next_part();
    while (isDue(now)) {
        if (paused_)
            --owed_;
        else if (follows)
            noteLateness();
        step();
        if (finished_) break;
        if (!finishStep(end)) return next_part();
        const bool is_change_due =
            isChangeDue() ||
            std::any_of(followers_.begin(), followers_.end(),
                        [](const Simulation* other) { return other->isChangeDue(); });
        if (preparation() || is_change_due) break;
        if (steady_clock::now() >= end) break;
    }
    if (isDue(now)) return now;
    if (finished_) return std::nullopt;
    const auto flush = flushRecord();
    if (paused_) return flush;
    return std::min(dueAt(), flush.value_or(WallTime::max()));
}

}  // namespace ispace
