// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded runs as worlds that move: for viewers, judges and sensors that the run did not have. The
// same record and scene give the same readings, whichever way seek() comes to a moment. A replay
// holds one moment of the record and reads on; seeking back reads it from the beginning. For one
// thread at a time, except preparation().
//
//     Replay replay("run1");
//     replay.placeAtStart(scene);
//     World world(scene, replay.stepLength());
//     while (replay.step(world)) draw(world.status(0).pose);
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "sim/motion.h"
#include "sim/sim_time.h"
#include "sim/world.h"

namespace ispace {

/// Replays a recorded run as the steps of a world: robots and people follow the record and ignore
/// commands, and sensors are read along the way. In the scene of the record this reproduces its
/// readings; in another scene, it computes those of other sensors. A thinned record (see
/// RecordForm::every) is replayed in steps from one of its moments to the next.
class Replay {
  public:
    /// Opens the record in a folder and reads its first moment.
    /// \throws std::system_error, FormatError as RunReader, and if it is empty
    explicit Replay(const std::string& folder);
    /// Opens the record of one of several worlds in lock step, between which movers go: it may lack
    /// moments, also all, and step() goes on after its last one. \param step of a record without
    /// info.csv \throws likewise
    Replay(const std::string& folder, SimTime step);

    /// Returns the time from one moment to the next.
    [[nodiscard]] SimTime stepLength() const { return step_; }
    /// Returns the seed and noise of the recorded readings.
    [[nodiscard]] const RunInfo& info() const { return info_; }
    /// Returns true if the record has odometry.
    [[nodiscard]] bool hasOdometry() const { return reader_.hasOdometry(); }
    /// Sets all movers to the first poses of the record. \throws FormatError for a mover that the
    /// scene lacks
    void placeAtStart(Scene& scene) const;
    /// Returns true after the last moment of the record. A world that had no movers, or lost them
    /// by a change, has moments no more: it goes on to the time at which info.csv says that the run
    /// ended.
    [[nodiscard]] bool atEnd() const { return !is_ahead_ && !is_still_; }
    /// Takes the next step of a world that has taken as many steps; false, without a step, at the
    /// end of the record. Collisions are those of events.csv; without it, a mover that begins to
    /// stall has run into "something". Skips recorded movers that the world lacks; movers that are
    /// not in the record stand still, and all do while the world had no movers, for which the
    /// record has no moments.
    /// \throws FormatError as RunReader, and for a moment that is not one step after the last,
    /// unless the run had changed its world
    bool step(World& world);
    /// Repeats the changes that clients made to the world of the run, each after the same step as
    /// in the run.
    void makeChanges(RunChanges changes) { run_changes_.emplace(std::move(changes)); }
    /// Returns the message of the first change that failed; "" if all succeeded.
    [[nodiscard]] std::string failure() const {
        return run_changes_ ? run_changes_->failure() : "";
    }
    /// Returns the changes that succeeded since the last call, in order.
    std::vector<RunChange> takeMade() { return std::exchange(made_, {}); }
    /// Returns the targets of trips and activities that movers gave up in the last step.
    [[nodiscard]] std::span<const RunUnreached> unreached() const { return unreached_; }
    /// Moves the world to its last step at or before a time, back or forth, or to the end of the
    /// record. Sensors are read as if all steps had been taken one by one. \throws as step()
    void seek(World& world, SimTime time);

    /// Returns the slow part of the next step, or of a seek to a time: a change of the world, or
    /// its beginning. Call it in any thread, while the world takes no step and is not changed;
    /// adopt() then completes it. Null if there is no such part. step() and seek() prepare by
    /// themselves.
    [[nodiscard]] std::function<void()> preparation(const World& world,
                                                    std::optional<SimTime> to = {});
    /// \returns the previous state, which any thread may free later
    std::shared_ptr<const void> adopt(World& world);
    /// Makes all preparations of the next step, or of a seek. \param adopted called after each
    void prepareAll(World& world, std::optional<SimTime> to,
                    const std::function<void()>& adopted = {});
    /// seek() in parts: until that wall time, or until a preparation is required.
    /// \returns true if the world is there
    bool seekSome(World& world, SimTime time, std::chrono::steady_clock::time_point until);
    /// Takes one step of a seek to a time that is not before the next step. \pre no preparation is
    /// required \throws as step()
    bool stepTowards(World& world, SimTime time);
    /// Returns the end of the record, if known.
    [[nodiscard]] std::optional<SimTime> end() const;
    /// Returns the time of the first change that clients made to the world of the run.
    [[nodiscard]] const std::optional<SimTime>& changedAt() const { return changed_; }
    /// Returns true if the record ends with an incomplete moment; known at its end.
    [[nodiscard]] bool isCut() const { return reader_.isCut(); }

  private:
    Replay(const std::string& folder, std::optional<SimTime> joined_step);
    bool step(World& world, bool reads);
    void readNext(const World& world);
    /// A scene that is ready to be adopted.
    struct Prepared {
        bool rewinds;
        std::optional<RunChanges::Step> step;  // without its scene; empty: the change failed
        NextScene next;
    };
    std::shared_ptr<const void> rewind(World& world, const NextScene& beginning);
    void find(const World& world);
    void collide(const World& world);
    void giveUp(const World& world);
    [[nodiscard]] bool isEmptyAt(SimTime time) const;

    std::string folder_;
    bool is_joined_;  // one of several worlds
    RunReader reader_;
    RunInfo info_;
    SimTime step_{};
    std::optional<SimTime> changed_;
    std::optional<RunChanges> run_changes_;
    std::optional<Prepared> prepared_;
    std::vector<RunChange> made_;
    std::vector<RunState> start_;
    bool is_late_ = false;             // it lacks the moment of the start
    bool is_ahead_ = false;            // the reader has read the moment of the next step
    bool has_moments_ = false;         // the record had movers at some time
    bool is_still_ = false;            // it has none, for the world has no movers until the end
    std::vector<RobotStatus> states_;  // of all movers of the world
    std::vector<std::optional<EstimatedPose>> odometries_;  // of all its robots
    std::vector<Collision> collisions_;
    std::vector<RunCollision> recorded_;              // their ids
    std::vector<UnreachedPoint> points_;              // given up in the last step
    std::vector<RunUnreached> unreached_;             // likewise, the targets that are no points
    std::vector<std::optional<std::size_t>> movers_;  // index of each in the record
    std::int64_t changes_ = -1;                       // of the world, when movers_ was computed
    double settle_ = 0;  // seconds before the end of a seek from which sensors are read
    std::int64_t settled_changes_ = -1;  // of the world, when it was computed
};

/// Converts the seconds of a record.
SimTime recordedTime(double seconds);

/// Returns the motion of a mover with this status, without goals.
Motion motionOf(const RobotStatus& status);

}  // namespace ispace
