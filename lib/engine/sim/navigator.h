// SPDX-License-Identifier: GPL-3.0-or-later
// Autonomous movers: the pilot that follows a path, or wanders.
//
// Decides ten times a second, by steering.h, and sets goals of the motion: limits and collisions
// stay with the world. A navigator is a value without pointers to its surroundings, so that worlds
// copy it. It finds its way round bodies nearby, not through a maze: that is path_finder.h.
//
//     Navigator pilot(mover, seed);
//     pilot.follow({.path = {{2, 0}, {2, 3}}}, 0.4, false);
//     if (pilot.isDue(time, motion)) pilot.steer(helm, motion);
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "geom/point.h"
#include "scene/robot.h"
#include "sim/motion.h"
#include "sim/sim_time.h"
#include "sim/steering.h"

namespace ispace {

/// Drives a mover along a path or lets it wander, by setting the goals of its motion ten times a
/// second and whenever they are reached. It chooses a heading that is free for two seconds, or for
/// the braking time; if the room is too narrow for its speed, it tries a half, a quarter … of it.
/// Without a free heading it waits, and after a while tries to pass on the side. After a cancelled
/// step it turns on the spot before it goes on. Random numbers depend on the seed, the id and the
/// number of draws.
///
/// On a path it stops at the last point and at those with a pause; a robot that is not
/// omnidirectional also stops where the path bends by more than 20 degrees, and with steps longer
/// than kInterval at all points. It passes the other points within kPass metres. A point that gets
/// no nearer for kPatience is given up: a commanded path fails, any other one skips to the next
/// point.
///
/// A wandering mover keeps its direction, changes it a little every few seconds, and turns away
/// from obstacles ahead, as Stage's controller of that name does.
class Navigator {
  public:
    static constexpr SimTime kInterval = std::chrono::milliseconds(100);
    static constexpr SimTime kPatience = std::chrono::seconds(10);
    static constexpr double kPass = 0.15, kArrive = 0.01;

    enum class State { Off, Underway, Arrived, Failed };

    Navigator() = default;
    /// Creates the navigator of a mover with that id, at any pose.
    Navigator(const Mover& mover, std::uint64_t seed);

    /// Starts along a path. \param speed m/s, at most the mover's maximum
    /// \param is_attempt takeUnreached() returns no point of it
    void follow(const MotionPlan& course, double speed, bool commanded, bool is_attempt = false);
    void turnOff() { state_ = State::Off; }
    [[nodiscard]] bool isOn() const { return state_ == State::Underway; }
    /// Returns true once it wanders without a command.
    [[nodiscard]] bool isWandering() const {
        return isOn() && !commanded_ && course_.wander && next_ >= course_.path.size();
    }
    [[nodiscard]] State state() const { return state_; }
    [[nodiscard]] const MotionPlan& course() const { return course_; }
    [[nodiscard]] double speed() const { return speed_; }
    /// Returns the points of the path from the next one on.
    [[nodiscard]] std::span<const Point2> ahead() const {
        return std::span(course_.path).subspan(std::min(next_, course_.path.size()));
    }

    /// Returns true if steer() is due at that time, or earlier because its goals are reached.
    [[nodiscard]] bool isDue(SimTime time, const Motion& motion) const {
        return isOn() && (time >= due_ || (motion.arrived() && !idle_));
    }
    /// Sets the goals of the motion. \pre isDue()
    void steer(const SteeringState& helm, Motion& motion);
    /// Returns the point that was given up since the last call, if any.
    [[nodiscard]] std::optional<Point2> takeUnreached() {
        return std::exchange(unreached_, std::nullopt);
    }
    /// Reports that the mover's step was cancelled by a collision.
    void bumped() {
        due_ = {};
        bumped_ = true;
    }

  private:
    void walk(const SteeringState& helm, Motion& motion);
    void wander(const SteeringState& helm, Motion& motion);
    void arrive(SimTime time);
    void leave(SimTime time);
    /// Finds the obstacles that matter at that speed.
    [[nodiscard]] Steering lookAbout(const SteeringState& helm, double speed) const;
    void stepAside(const SteeringState& helm, const Steering& steering, const Motion& motion);
    /// \param stop metres from here at which it comes to rest, if the direction leads there
    void go(Motion& motion, Angle direction, double speed, double stop);
    void stand(Motion& motion);
    [[nodiscard]] bool stopsAtNext(SimTime step) const;
    [[nodiscard]] double horizon(double speed) const;
    double random();

    /// What it needs of a RobotModel, of which each of many worlds would hold a copy.
    struct Drives {
        Drive drive = Drive::Differential;
        double accel = 0, max_sidespeed = 0;
    };

    MotionPlan course_;
    Drives model_;
    std::uint64_t seed_ = 0, id_ = 0, draws_ = 0;
    double speed_ = 0;
    State state_ = State::Off;
    bool commanded_ = false, is_attempt_ = false;
    bool idle_ = false;    // it waits until a time
    bool bumped_ = false;  // and has not turned away since
    SimTime due_{};
    // On a path.
    std::size_t next_ = 0;
    std::optional<Point2> unreached_;
    double nearest_ = 0;  // least distance to the next point so far
    SimTime gained_{};    // time of nearest_
    SimTime pause_until_{};
    SimTime blocked_since_{-1}, aside_until_{};
    Angle aside_;
    // Wandering.
    Angle aim_;
    bool has_aim_ = false;
    SimTime turn_at_{};
};

}  // namespace ispace
