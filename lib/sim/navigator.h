// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/sim: those who go by themselves.
#pragma once

#include <cstddef>
#include <cstdint>

#include "scene/robot.h"
#include "sim/motion.h"
#include "sim/sim_time.h"
#include "sim/steering.h"

namespace ispace {

/// Takes a mover along a path or lets it wander, by setting the goals of its motion ten times a
/// second and whenever they are reached. It goes where the way is free for two seconds, or for as
/// long as it takes to brake; who is faster than the room allows goes at a half, a quarter … of
/// its speed. Where no way is free it waits, and after a while tries a way aside. Whose step was
/// cancelled turns in place before it goes on. All that is random depends on the seed, the id and
/// how often it was drawn.
///
/// On a path it comes to rest at the last place and at those where it pauses; a robot that is not
/// omnidirectional also where the path bends by more than 20 degrees, and with steps longer than
/// kInterval at all of them. The others it passes within kPass metres. A place that it comes no
/// nearer to for kPatience is given up: a path that was commanded fails, another goes on to the
/// next place.
///
/// Wandering it keeps its direction, changes it a little every few seconds, and turns away from
/// what is ahead, as Stage's controller of that name does.
class Navigator {
  public:
    static constexpr SimTime kInterval = std::chrono::milliseconds(100);
    static constexpr SimTime kPatience = std::chrono::seconds(10);
    static constexpr double kPass = 0.15, kArrive = 0.01;

    enum class State { Off, Underway, Arrived, Failed };

    Navigator() = default;
    /// For a mover with that id, wherever it stands.
    Navigator(const Mover& mover, std::uint64_t seed);

    /// Sets out. \param speed m/s, at most the mover's greatest
    void follow(const MotionPlan& course, double speed, bool commanded);
    void turnOff() { state_ = State::Off; }
    [[nodiscard]] bool isOn() const { return state_ == State::Underway; }
    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] const MotionPlan& course() const { return course_; }
    [[nodiscard]] double speed() const { return speed_; }

    /// True if steer() is due at that time or, as its goals are reached, before.
    [[nodiscard]] bool isDue(SimTime time, const Motion& motion) const {
        return isOn() && (time >= due_ || (motion.arrived() && !idle_));
    }
    /// Sets the goals of the motion. \pre isDue()
    void steer(const SteeringState& helm, Motion& motion);
    /// Its step was cancelled: somebody was in the way.
    void bumped() {
        due_ = {};
        bumped_ = true;
    }

  private:
    void walk(const SteeringState& helm, Motion& motion);
    void wander(const SteeringState& helm, Motion& motion);
    void arrive(SimTime time);
    void leave(SimTime time);
    /// What is in the way of going at that speed.
    [[nodiscard]] Steering lookAbout(const SteeringState& helm, double speed) const;
    void stepAside(const SteeringState& helm, const Steering& steering, const Motion& motion);
    /// \param stop metres from here where it comes to rest, if the direction leads there
    void go(Motion& motion, Angle direction, double speed, double stop);
    void stand(Motion& motion);
    [[nodiscard]] bool stopsAtNext(SimTime step) const;
    [[nodiscard]] double horizon(double speed) const;
    double random();

    MotionPlan course_;
    RobotModel model_;
    std::uint64_t seed_ = 0, id_ = 0, draws_ = 0;
    double speed_ = 0;
    State state_ = State::Off;
    bool commanded_ = false;
    bool idle_ = false;    // it stands and waits for a time
    bool bumped_ = false;  // and has not turned away since
    SimTime due_{};
    // On a path.
    std::size_t next_ = 0;
    double nearest_ = 0;  // to the next place, so far
    SimTime gained_{};    // when that was
    SimTime pause_until_{};
    SimTime blocked_since_{-1}, aside_until_{};
    Angle aside_;
    // Wandering.
    Angle aim_;
    bool has_aim_ = false;
    SimTime turn_at_{};
};

}  // namespace ispace
