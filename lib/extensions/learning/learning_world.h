// SPDX-License-Identifier: GPL-3.0-or-later
// One world of a learner: robots, people and their goals in a shared room, step by step.
//
// A world moves as World does for the same commands, with the same functions, and its robots
// measure the same ranges: an episode that is written as a scene and a script repeats in simrun. An
// episode depends on its seed and the actions alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "extensions/learning/learning_room.h"
#include "sim/navigator.h"
#include "trace/moving_bodies.h"

namespace ispace::learning {

/// The rooms of a batch and their task.
struct LearningSetting {
    LearningTask task;
    std::vector<std::unique_ptr<const LearningRoom>> rooms;

    [[nodiscard]] std::size_t robots() const { return rooms.front()->robots(); }
    /// Numbers of an observation: the ranges of the beams in metres, the maximum range without a
    /// return; distance and bearing of the goal; speed and rate of turning; with a dock also the
    /// angle to its heading.
    [[nodiscard]] std::size_t observation() const {
        constexpr std::size_t kGoalAndMotion = 4;
        return rooms.front()->beams() + kGoalAndMotion +
               (task.kind == LearningTask::Kind::Dock ? 1 : 0);
    }
};

/// Memory of a thread that steps worlds.
struct LearningScratch {
    std::vector<Motion> next;
    std::vector<Move> moves;
    std::vector<MotionLimits> limits;
    std::vector<std::optional<std::size_t>> blocked;
    std::vector<double> x, y, reach;  // of each move: its start, and how far it comes
    std::vector<std::uint8_t> meets;  // 1: it may come as far as another
    std::vector<MovingBody> bodies;
    MovingBodies moving;
    Vicinity vicinity;  // outside of the shared ones
    FewMovers few;
    std::map<std::pair<const LearningRoom*, std::size_t>, Traffic> traffic;
};

/// The last step of a robot.
struct RobotOutcome {
    double reward = 0;
    bool terminated = false, truncated = false;
    bool success = false, collided = false;
};

class LearningWorld {
  public:
    /// Number of actions of a robot: speed and rate of turning, each in [-1, 1] of its maximum.
    static constexpr std::size_t kActions = 2;

    /// Sets the seed of the next episodes.
    void seed(std::uint64_t seed) {
        seed_ = seed;
        episode_ = 0;
    }
    /// Begins the next episode of the seed.
    void start(const LearningSetting& setting);
    /// Advances by a step. \pre started, not over; actions of all robots, finite
    void step(const LearningSetting& setting, std::span<const float> actions,
              LearningScratch& scratch);
    /// Asks the processor for the memory with which the next step begins.
    void prefetch() const;
    /// Writes what a robot observes, and stores the ranges' minimum for the signals.
    void observe(const LearningSetting& setting, std::size_t robot, std::span<float> out,
                 LearningScratch& scratch);
    /// Computes the outcome of the last step. \pre observe() was called for all robots since
    void judge(const LearningSetting& setting);

    /// Returns true before the first episode.
    [[nodiscard]] bool isFresh() const { return in_ == nullptr; }
    [[nodiscard]] bool isOver() const { return is_over_; }
    [[nodiscard]] const RobotOutcome& outcome(std::size_t robot) const {
        return robots_[robot].outcome;
    }
    [[nodiscard]] std::int64_t steps() const { return steps_; }
    [[nodiscard]] std::size_t room() const { return room_; }
    [[nodiscard]] std::uint64_t runSeed() const { return run_seed_; }
    [[nodiscard]] std::size_t people() const { return motions_.size() - robots_.size(); }
    [[nodiscard]] const Pose2& pose(std::size_t mover) const { return motions_[mover].pose; }
    /// Sum of the episode's rewards.
    [[nodiscard]] double sum(std::size_t robot) const { return robots_[robot].sum; }
    /// Returns the goal of a robot, or the person whom it follows.
    [[nodiscard]] Point2 goal(const LearningSetting& setting, std::size_t robot) const;
    /// Bytes that the world holds by itself.
    [[nodiscard]] std::size_t bytes() const;

    /// The episode so far as files for simrun.
    struct Episode {
        std::string room, layout, script;
        std::string options;  ///< of simrun: "--dt 0.1 --seed 7 --until 12.3"
    };
    [[nodiscard]] Episode episode(const LearningSetting& setting) const;

  private:
    struct Robot {
        MotionLimits limits;
        double max_speed = 0;
        Angle max_rotspeed;
        std::size_t goal = 0;  // index of the room's goals, or of patrol points
        double distance = 0;   // to the goal
        std::optional<double> way;
        double nearest = 0;    // range
        double new_floor = 0;  // square metres in the last step
        bool has_collided = false;
        bool is_measured = false;  // distance and way are those of the last step
        std::array<float, kActions> action{}, last_action{};
        double sum = 0;
        RobotOutcome outcome;
    };

    void place(const LearningSetting& setting);
    void chooseGoal(const LearningSetting& setting, std::size_t robot);
    void propose(const LearningSetting& setting, LearningScratch& scratch);
    void settle(LearningScratch& scratch);
    void patrol(const LearningSetting& setting);
    [[nodiscard]] std::array<double, kTaskSignals> signalsOf(const LearningSetting& setting,
                                                             std::size_t robot);
    [[nodiscard]] bool isFreeAt(Point2 p, double radius, double apart) const;

    std::uint64_t seed_ = 0, episode_ = 0, run_seed_ = 0;
    EpisodeRandom random_;
    std::size_t room_ = 0;
    std::int64_t steps_ = 0;
    bool is_over_ = true;
    const LearningRoom* in_ = nullptr;  // of room_
    std::vector<Motion> motions_;       // robots, then people
    std::vector<double> clearances_;
    std::vector<Navigator> pilots_;         // of people
    std::vector<SteeringMemory> memories_;  // of people
    std::vector<Gait> gaits_;
    std::vector<Robot> robots_;
    std::vector<std::uint64_t> patrolled_;  // bits of patrol points
    std::size_t patrol_count_ = 0;
    double speed_factor_ = 1, accel_factor_ = 1;
    RangeNoise noise_;
    std::vector<Pose2> starts_;       // robots, then people
    std::vector<std::size_t> goals_;  // drawn with the robots' starts
    std::vector<float> actions_;      // of all steps so far
};

}  // namespace ispace::learning
