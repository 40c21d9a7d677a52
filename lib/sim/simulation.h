// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/command.h"
#include "sim/events.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "sim/world.h"

namespace ispace {

using WallTime = std::chrono::steady_clock::time_point;

/// How simulated time follows wall time.
struct Clock {
    enum class Kind {
        Real,  ///< `rate` simulated seconds in a second
        Fast,  ///< as fast as possible
        Step   ///< only when told to
    } kind = Kind::Real;
    double rate = 1;
};

/// `real`, `real:20`, `fast`, `step`. \throws UsageError
Clock parseClock(const std::string& text);

/// Drives a world: script, clock, pauses, end.
class Simulation {
  public:
    /// The last step is the first one that ends at `until` or later; without it a run ends at
    /// kMaxTime. Later commands of the script are never given, nor are those to robots that the
    /// world has lost since, or that cannot do them any more. \pre the script is in order of time
    Simulation(World& world, std::vector<TimedCommand> script, Clock clock,
               std::optional<SimTime> until);

    [[nodiscard]] World& world() { return *world_; }
    [[nodiscard]] const World& world() const { return *world_; }
    [[nodiscard]] const Clock& clock() const { return clock_; }

    /// What happened; looked for after every step, before it is recorded.
    [[nodiscard]] EventLog& events() { return events_; }
    [[nodiscard]] const EventLog& events() const { return events_; }

    /// Says that the world was changed by this request, which a record holds.
    /// \param with_scene it does not say all: the record gets the scene, too
    void tellChange(std::string request, bool with_scene);

    /// Adds an observer, called after every step once it is recorded and the script's commands for
    /// the next one are given. It must stay valid until the last step.
    void onStep(std::function<void()> observer) { observers_.push_back(std::move(observer)); }

    /// Records every step from now on. The recorder must outlive the last one.
    void recordWith(Recorder& recorder) { recorder_ = &recorder; }

    /// Takes the steps of a record instead of simulating. At its end the run ends; or, if it is to
    /// hold, it pauses and goes on serving the last moment. \pre the replay outlives the last step
    void replay(Replay& replay, bool holds);
    /// Null: nothing is recorded.
    [[nodiscard]] const Recorder* recorder() const { return recorder_; }
    /// Records what sensors read in the last step, until about then. \returns true once that is
    /// done, or nothing is recorded: the world may then be changed
    bool finishRecord(WallTime until) {
        return recorder_ == nullptr || recorder_->finishStep(*world_, until);
    }
    /// Writes out what of the record has been pending for 0.1 s, see Recorder::flushDue: for those
    /// who do not call run().
    std::optional<WallTime> flushRecord();
    /// True if robots and people go as recorded, whatever they are told.
    [[nodiscard]] bool isReplay() const { return replay_ != nullptr; }
    /// True if a record that is to hold has come to its end: there are no more steps.
    [[nodiscard]] bool isHeld() const { return holds_ && replay_ != nullptr && replay_->atEnd(); }

    /// True if seek() may be called: the steps of this replay may be taken in any order.
    [[nodiscard]] bool maySeek() const {
        return replay_ != nullptr && recorder_ == nullptr && !is_in_order_;
    }
    /// Somebody needs the steps of a replay from the first to the last.
    void keepOrder() { is_in_order_ = true; }
    /// Takes a replay to a time in parts, see Replay::seekSome: call it until it returns true.
    /// Steps allowed before are to be dropped. \pre maySeek()
    bool seekSome(SimTime time, WallTime until);
    /// What is to be prepared before the next step of a replay, or on the way to a time: see
    /// Replay::preparation. run() prepares by itself where its first step needs it.
    [[nodiscard]] std::function<void()> preparation(std::optional<SimTime> to = {}) const {
        if (to) to = std::min(*to, until_);
        return replay_ == nullptr ? nullptr : replay_->preparation(*world_, to);
    }
    std::shared_ptr<const void> adoptPrepared() { return replay_->adopt(*world_); }
    /// When a replay ends, as far as that is known.
    [[nodiscard]] std::optional<SimTime> end() const {
        return replay_ == nullptr ? std::nullopt : replay_->end();
    }

    /// Always true with the clock Step.
    [[nodiscard]] bool paused() const { return paused_; }
    /// Pauses; drops steps allowed but not taken.
    void pause(WallTime now);
    /// Resumes; drops steps allowed but not taken. With the clock Real the next step is due as long
    /// after this as it was at the pause, so only the time of the pause is lost.
    /// One that isHeld() stays paused. \pre the clock is not Step
    void resume(WallTime now);
    /// Lets a paused world take `count` more steps; none if it isHeld(). \pre paused(), count >= 0
    void allow(std::int64_t count);
    /// Takes back `count` allowed steps. \pre count <= owed()
    void forgo(std::int64_t count) { owed_ -= count; }
    /// Steps allowed but not taken yet.
    [[nodiscard]] std::int64_t owed() const { return owed_; }

    void finish() { finished_ = true; }
    [[nodiscard]] bool finished() const { return finished_; }

    /// Takes the steps that are due, for about `budget` of wall time (one step at least, if one is
    /// due, or a part of reading its sensors and recording them). A step begins once the one before
    /// is recorded, with its frames. With the clock Real a lag of more than a quarter of
    /// a second is forgiven: time then goes slower, instead of faster later. \returns when to call
    /// again; nothing: only once told to step or resume
    std::optional<WallTime> run(WallTime now, std::chrono::nanoseconds budget);
    /// True if a step is to be taken now.
    [[nodiscard]] bool isDue(WallTime now) const;
    /// When the next step is due by the clock Real; nothing with others, or while paused.
    [[nodiscard]] std::optional<WallTime> due() const;
    /// How punctual the steps were that were due by the clock Real: the latest of them, and how
    /// many began later than a step after their time (as a step lasts in wall time). `own`: the
    /// most of that for which this thread was at work since the steps before it, instead of waiting
    /// for the processor.
    struct Lateness {
        std::int64_t steps = 0, late = 0;
        std::chrono::nanoseconds most{}, own{};
    };
    [[nodiscard]] const Lateness& lateness() const { return lateness_; }
    /// Wall time lost so far because steps took too long.
    [[nodiscard]] std::chrono::nanoseconds lost() const { return lost_; }

  private:
    std::optional<WallTime> runDue(WallTime now, std::chrono::nanoseconds budget);
    bool finishStep(WallTime until);
    void giveScripted();
    void step();
    void endIfReached();
    /// Lets simulated time follow wall time from here on.
    void startAt(WallTime now);
    /// When the next step is due by the clock Real. \pre it is started
    [[nodiscard]] WallTime dueAt() const;
    void noteLateness();
    /// Gives up a lag that is too long.
    void forgive(WallTime now);

    World* world_;
    EventLog events_;
    std::vector<TimedCommand> script_;
    std::vector<std::string> scripted_;  // ids of those whom the script commands, as it has indices
    std::size_t next_ = 0;               // of script_
    Recorder* recorder_ = nullptr;
    Replay* replay_ = nullptr;
    bool holds_ = false;        // at the end of the record
    bool is_in_order_ = false;  // it is taken step by step
    Clock clock_;
    SimTime until_;
    std::vector<std::function<void()>> observers_;
    bool paused_ = false, finished_ = false;
    std::int64_t owed_ = 0;
    std::optional<WallTime> started_;  // wall time of start_time_
    SimTime start_time_{};
    std::optional<std::chrono::nanoseconds>
        ahead_;  // of a pause to the next step; less than 0: lag
    std::chrono::nanoseconds lost_{};
    std::chrono::nanoseconds work_{};  // of the thread until run() returned
    Lateness lateness_;
};

}  // namespace ispace
