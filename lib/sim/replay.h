// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/run/run_changes.h"
#include "scene/run/run_reader.h"
#include "sim/motion.h"
#include "sim/sim_time.h"
#include "sim/world.h"

namespace ispace {

/// A recorded run as the steps of a world: robots and people go where the record says, whatever
/// they are told, and sensors read what they see there. In the scene of the record these are the
/// readings of then; in another, what other sensors would have read.
class Replay {
  public:
    /// Opens the record in a folder and reads its first moment.
    /// \throws std::system_error, FormatError as RunReader, and if it holds nothing
    explicit Replay(const std::string& folder);

    /// From one moment to the next.
    [[nodiscard]] SimTime stepLength() const { return step_; }
    /// Seed and noise of the readings of then.
    [[nodiscard]] const RunInfo& info() const { return info_; }
    /// True if the record has odometry.
    [[nodiscard]] bool hasOdometry() const { return reader_.hasOdometry(); }
    /// Puts everybody where the record begins. \throws FormatError for who is not in the scene
    void placeAtStart(Scene& scene) const;
    /// True if step() takes no more.
    [[nodiscard]] bool atEnd() const { return !is_ahead_; }
    /// Collisions are those of events.csv; without it, who begins to stall has run into
    /// "something". Takes the next step of a world that has taken as many steps; false, and nothing
    /// done, at the end of the record. Who is not in the world is passed over, who is not in the
    /// record stays; when nobody was in the world, for which the record has no moments, all stay.
    /// \throws FormatError as RunReader, and for a moment that is not one step after the last,
    /// unless the run had changed its world
    bool step(World& world);
    /// From now on the changes that clients made to the world of the run are made again, each
    /// after the step after which it was made.
    void makeChanges(RunChanges changes) { run_changes_.emplace(std::move(changes)); }
    /// What became of the first change that could not be made; "" if all could.
    [[nodiscard]] std::string failure() const {
        return run_changes_ ? run_changes_->failure() : "";
    }
    /// Takes the world to its last step at or before a time, back or forth, or to the end of the
    /// record. Sensors are read as if all steps had been taken one by one. \throws as step()
    void seek(World& world, SimTime time);

    /// What takes long before the next step, or on the way to a time: a change of the world, or its
    /// beginning. For any thread, while the world takes no step and is changed by no other; adopt()
    /// then completes it. Null where there is none. step() and seek() prepare by themselves.
    [[nodiscard]] std::function<void()> preparation(const World& world,
                                                    std::optional<SimTime> to = {});
    /// \returns what the world was, to be ended by somebody with time for it
    std::shared_ptr<const void> adopt(World& world);
    /// seek() in parts: until that moment, or until there is something to prepare.
    /// \returns true if the world is there
    bool seekSome(World& world, SimTime time, std::chrono::steady_clock::time_point until);
    /// When the record ends, as far as that is known.
    [[nodiscard]] std::optional<SimTime> end() const;
    /// When clients first changed the world of the run.
    [[nodiscard]] const std::optional<SimTime>& changedAt() const { return changed_; }
    /// True if the record ends with a moment that is not whole; known at its end.
    [[nodiscard]] bool isCut() const { return reader_.isCut(); }

  private:
    bool step(World& world, bool reads);
    /// A scene that is ready to be adopted.
    struct Prepared {
        bool rewinds;
        std::optional<RunChanges::Step> step;  // without its scene; nothing: it cannot be made
        NextScene next;
    };
    std::shared_ptr<const void> rewind(World& world, const NextScene& beginning);
    void prepareAll(World& world, std::optional<SimTime> to);
    void find(const World& world);
    void collide(const World& world);
    [[nodiscard]] bool isEmptyAt(SimTime time) const;

    std::string folder_;
    RunReader reader_;
    RunInfo info_;
    SimTime step_{};
    std::optional<SimTime> changed_;
    std::optional<RunChanges> run_changes_;
    std::optional<Prepared> prepared_;
    std::vector<RunState> start_;
    bool is_late_ = false;                          // it has no moment of the start
    bool is_ahead_ = false;                         // the reader's moment is that of the next step
    std::vector<RobotStatus> states_;               // of all movers of the world
    std::vector<std::optional<Pose2>> odometries_;  // of all its robots
    std::vector<Collision> collisions_;
    std::vector<RunCollision> recorded_;              // what they name
    std::vector<std::optional<std::size_t>> movers_;  // of each in the record
    std::int64_t changes_ = -1;                       // of the world, when they were found
};

/// Of somebody with this status, who is to do nothing.
Motion motionOf(const RobotStatus& status);

}  // namespace ispace
