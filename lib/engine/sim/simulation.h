// SPDX-License-Identifier: GPL-3.0-or-later
// Drives a world: by wall time, as fast as possible or step by step, with a script, a record or a
// client.
//
// The course of the world does not depend on wall time: the clock decides when steps are taken,
// never how. Times of steps are computed from the start of the clock, so that rounding errors do
// not add up. A lag of more than a quarter of a second is forgiven.
//
// For one thread at a time. run() returns after about its budget, so that a server answers clients
// in between.
//
//     std::vector<TimedCommand> script = readScript(text, "moves.txt", world);
//     Simulation run(world, std::move(script), parseClock("real:2"), simSeconds(60));
//     while (!run.finished()) {
//         const auto next = run.run(WallTime::clock::now(), std::chrono::milliseconds(20));
//         if (next) std::this_thread::sleep_until(*next);
//     }
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sim/command.h"
#include "sim/events.h"
#include "sim/pace.h"
#include "sim/recorder.h"
#include "sim/replay.h"
#include "sim/script_lines.h"
#include "sim/track_log.h"
#include "sim/world.h"

namespace ispace {

using WallTime = std::chrono::steady_clock::time_point;

/// Relation of simulated time to wall time.
struct Clock {
    enum class Kind {
        Real,  ///< `rate` simulated seconds in a second
        Fast,  ///< as fast as possible
        Step   ///< only on request
    } kind = Kind::Real;
    double rate = 1;
};

/// Parses `real`, `real:20`, `fast`, `step`. \throws UsageError
Clock parseClock(const std::string& text);
/// Parses a rate of the clock Real: above 0, at most a million; empty for other texts.
std::optional<double> parseClockRate(std::string_view text);

/// Drives a world: script, clock, pauses, end.
///
/// Order of a step: observers before it, the step, events, the record, worlds that this one leads,
/// commands of the script for the next step, plans of days, observers after it. A step begins once
/// the one before is recorded, with its frames.
class Simulation {
  public:
    /// The last step is the first one that ends at `until` or later; without it a run ends at
    /// kMaxTime. Skips commands of the script after the end, and those to robots that were removed
    /// or can no longer do them. \pre the script is sorted by time
    Simulation(World& world, std::vector<TimedCommand> script, Clock clock,
               std::optional<SimTime> until);

    [[nodiscard]] World& world() { return *world_; }
    [[nodiscard]] const World& world() const { return *world_; }
    [[nodiscard]] const Clock& clock() const { return clock_; }
    /// Returns the clock that paces this world: its own, or that of the one that leads it.
    [[nodiscard]] const Clock& pacingClock() const {
        return leader_ == nullptr ? clock_ : leader_->clock_;
    }
    /// Changes the rate of the clock Real from now on: the share of a step that has passed stays
    /// passed, and steps that were due stay due. \pre the clock is Real; rate > 0
    void setRate(double rate, WallTime now);

    /// Returns the events, updated after every step, before it is recorded.
    [[nodiscard]] EventLog& events() { return events_; }
    [[nodiscard]] const EventLog& events() const { return events_; }

    /// Returns what programs have told of people and robots.
    [[nodiscard]] TrackLog& tracks() { return tracks_; }
    [[nodiscard]] const TrackLog& tracks() const { return tracks_; }

    /// Reports that this request changed the world; a record stores it.
    /// \param scene_text of the changed scene, which the record stores, too; "" if the request is
    /// sufficient
    void notifyChange(std::string request, const std::string& scene_text);

    /// Carries out lines of a script that extensions have read. Call it before the first step.
    /// \pre not null
    void follow(std::shared_ptr<Director> director);
    /// Returns true if a script has such lines, as the days of people: the time of day matters.
    [[nodiscard]] bool followsDays() const { return !directors_.empty(); }
    /// Keeps an open door from being shut behind people on their days until then.
    void keepOpen(const std::string& door, SimTime until);
    [[nodiscard]] bool isKeptOpen(const std::string& door) const;
    /// Returns true for a door that people on their days have opened, and that is shut behind them.
    [[nodiscard]] bool isOpenForPeople(const std::string& door) const;
    /// A change of the world that is asked for.
    struct AskedChange {
        /// Returns a request of the protocol, once those asked for before are made; "": none.
        std::function<std::string()> request;
        /// Called with the reason if the world refuses it. Null: the event `mark` tells.
        std::function<void(const std::string& reason)> refused = {};
    };
    /// Asks for a change of the world, as the script does: a request of the protocol.
    void askChange(std::string request) {
        askChange({[request = std::move(request)] { return request; }});
    }
    void askChange(AskedChange change) { due_changes_.push_back(std::move(change)); }
    /// Returns the next change of the script that is due, a request of the protocol, and removes
    /// it; "" if none is. The world must not step before it is made: see isChangeDue().
    std::string takeScriptedChange();
    /// Takes the answer to the change of takeScriptedChange() that the world refuses:
    /// `ERR 409 reason`.
    void refuseScripted(const std::string& answer);
    [[nodiscard]] bool isChangeDue() const { return !due_changes_.empty(); }

    /// Adds an observer, called after every step once it is recorded and the script's commands for
    /// the next one are given. It must stay valid until the last step.
    void onStep(std::function<void()> observer) { observers_.push_back(std::move(observer)); }

    /// Adds an observer, called before every step once the last one is recorded: it may change the
    /// world.
    void beforeStep(std::function<void()> observer) { preparers_.push_back(std::move(observer)); }

    /// Lets another simulation take a step after each of this one, before observers are called. Its
    /// own clock, pauses and end have no effect. \pre it has the same step and outlives this one's
    /// last, and takes no turns by itself
    void lead(Simulation& other) {
        followers_.push_back(&other);
        other.is_led_ = true;
        other.leader_ = this;
    }

    /// Records every step from now on. The recorder must outlive the last one.
    void recordWith(Recorder& recorder) { recorder_ = &recorder; }

    /// Takes the steps of a record instead of simulating. At its end the run ends; if `holds`, it
    /// pauses and goes on serving the last moment. If this one leads others, they have replays,
    /// too, set before, and the end is that of the last one. \pre the replay outlives the last step
    void replay(Replay& replay, bool holds);
    /// Returns null without a record.
    [[nodiscard]] const Recorder* recorder() const { return recorder_; }
    /// Records the readings of the last step, until about then. \returns true once that is done, or
    /// without a record: the world may then be changed
    bool finishRecord(WallTime until);
    /// Writes out lines of the record pending for 0.1 s, see Recorder::flushDue: for callers that
    /// do not call run().
    std::optional<WallTime> flushRecord();
    /// Returns true if movers follow a record and ignore commands.
    [[nodiscard]] bool isReplay() const { return replay_ != nullptr; }
    /// Returns true if a replay that holds has reached its end: no steps are left.
    [[nodiscard]] bool isHeld() const { return holds_ && isReplayed(); }

    /// Returns true if seek() may be called: the steps of this replay may be taken in any order.
    [[nodiscard]] bool maySeek() const;
    /// Requires the steps of the replay in order, from the first to the last.
    void keepOrder() { is_in_order_ = true; }
    /// Seeks a replay to a time in parts, see Replay::seekSome: call it until it returns true. Drop
    /// steps allowed before. \pre maySeek()
    bool seekSome(SimTime time, WallTime until);
    /// Returns the preparation that the next step of a replay, or a seek to a time, requires: see
    /// Replay::preparation. run() prepares by itself if its first step requires it.
    [[nodiscard]] std::function<void()> preparation(std::optional<SimTime> to = {}) const;
    /// \param to of preparation(). If this one leads others, adopts all changes before that time,
    /// as a mover goes from one world to another by two.
    std::shared_ptr<const void> adoptPrepared(std::optional<SimTime> to = {});
    /// Adds an observer, called after each seek, and when a replay has changed a world.
    void onReplayChange(std::function<void()> observer) {
        changers_.push_back(std::move(observer));
    }
    /// Seeks a replay to its last step at or before a time, or to its end. \pre maySeek()
    void seek(SimTime time);
    /// Reads sensors that are due, until about then. \returns true once all are read
    bool readSome(WallTime until);
    /// Returns the end of a replay, if known.
    [[nodiscard]] std::optional<SimTime> end() const {
        return replay_ == nullptr ? std::nullopt : replay_->end();
    }

    /// Always true with the clock Step.
    [[nodiscard]] bool paused() const { return paused_; }
    /// Pauses; drops steps allowed but not taken.
    void pause(WallTime now);
    /// Resumes; drops steps allowed but not taken. With the clock Real the next step is due as long
    /// after this as it was at the pause, so only the time of the pause is lost. A replay that
    /// isHeld() stays paused. \pre the clock is not Step
    void resume(WallTime now);
    /// Lets a paused world take `count` more steps; 0 if it isHeld(). \pre paused(), count >= 0
    void allow(std::int64_t count);
    /// Revokes `count` allowed steps. \pre count <= owed()
    void forgo(std::int64_t count) { owed_ -= count; }
    /// Returns the steps allowed but not taken yet.
    [[nodiscard]] std::int64_t owed() const { return owed_; }

    void finish() { finished_ = true; }
    [[nodiscard]] bool finished() const { return finished_; }

    /// Takes the steps that are due, for about `budget` of wall time (one step at least, if one is
    /// due, or a part of reading its sensors and recording them). A step begins once the one before
    /// is recorded, with its frames. With the clock Real a lag of more than a quarter of a second
    /// is forgiven: time then goes slower, instead of faster later. \returns the time of the next
    /// call; nullopt: only after allow() or resume()
    std::optional<WallTime> run(WallTime now, std::chrono::nanoseconds budget);
    /// Returns true if a step is due.
    [[nodiscard]] bool isDue(WallTime now) const;
    /// Returns the wall time of the next step by the clock Real; nullopt with other clocks, or
    /// while paused.
    [[nodiscard]] std::optional<WallTime> due() const;
    /// Punctuality of the steps by the clock Real: the greatest delay, and the number of steps that
    /// began later than one step (in wall time) after their time. `own`: the greatest part of a
    /// delay in which this thread worked since the steps before, instead of waiting for the
    /// processor.
    struct Lateness {
        std::int64_t steps = 0, late = 0;
        std::chrono::nanoseconds most{}, own{};
    };
    [[nodiscard]] const Lateness& lateness() const { return lateness_; }
    /// Returns the wall time lost so far because steps took too long.
    [[nodiscard]] std::chrono::nanoseconds lost() const { return lost_; }
    /// Returns the work for the world's time, of all worlds in lock step.
    [[nodiscard]] Pace& pace() { return leader_ == nullptr ? pace_ : leader_->pace_; }

  private:
    std::optional<WallTime> runDue(WallTime now, std::chrono::nanoseconds budget);
    bool finishStep(WallTime until);
    [[nodiscard]] bool awaitsFrames() const;
    void giveScripted();
    void notifyScripted();
    void step();
    void endIfReached();
    /// Returns true after the last moment of all records.
    [[nodiscard]] bool isReplayed() const;
    bool seekTogether(SimTime time, WallTime until);
    /// Tells of the changes that a replay has made since the last call, unless by a seek.
    void notifyReplayed(bool seeks);
    /// Aligns simulated time with wall time from here on.
    void startAt(WallTime now);
    /// As startAt(), with the next step as far ahead as it was.
    void goOnAt(WallTime now);
    /// Returns the wall time of the next step by the clock Real. \pre it is started
    [[nodiscard]] WallTime dueAt() const;
    void noteLateness();
    /// Forgives a lag that is too long.
    void forgive(WallTime now);

    World* world_;
    EventLog events_;
    TrackLog tracks_;
    std::vector<TimedCommand> script_;
    std::vector<std::string> scripted_;  // ids of the movers that the script commands by index
    std::size_t next_ = 0;               // of script_
    std::vector<std::shared_ptr<Director>> directors_;
    std::map<std::string, std::pair<SimTime, SimTime>> kept_open_;  // doors: since when, until when
    std::deque<AskedChange> due_changes_;                           // of the script
    std::function<void(const std::string& reason)> when_refused_;   // of the one taken last
    std::vector<Event> script_events_;  // of its commands, told in the next step at the latest
    Recorder* recorder_ = nullptr;
    Replay* replay_ = nullptr;
    bool holds_ = false;        // at the end of the record
    bool is_in_order_ = false;  // steps must be taken in order
    Clock clock_;
    SimTime until_;
    std::vector<std::function<void()>> observers_, preparers_, changers_;
    std::vector<Simulation*> followers_;  // in lock step
    bool is_led_ = false;
    Simulation* leader_ = nullptr;
    bool paused_ = false, finished_ = false;
    std::int64_t owed_ = 0;
    std::optional<WallTime> started_;  // wall time of start_time_
    SimTime start_time_{};
    std::optional<std::chrono::nanoseconds> ahead_;  // from a pause to the next step; negative: lag
    std::chrono::nanoseconds lost_{};
    std::chrono::nanoseconds work_{};     // of the thread until run() returned
    std::chrono::nanoseconds reading_{};  // of it, in the present run()
    Lateness lateness_;
    Pace pace_;
};

}  // namespace ispace
