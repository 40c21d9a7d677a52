// SPDX-License-Identifier: GPL-3.0-or-later
// Kinematics of a mover: how commands and limits become motion.
//
// A mover drives along its heading and turns about its centre (a unicycle; eq. 5.1-5.4 of the
// thesis); one with an omnidirectional drive also moves sideways. Each axis speeds up and brakes at
// a constant rate, so speed over time is a trapezoid. Turns end exactly at their headings and
// distances at a remainder of exactly 0, at rest; positions are sums of the ways, with their
// rounding.
//
// Positions are accurate to 1e-13 of the way. Two half steps give the same as a whole one, up to
// rounding. Pure functions. Metres and seconds; the axis of turning counts degrees.
//
//     Motion motion;                                    // at 0,0, heading 0, at rest
//     motion.command({Verb::Forward, 1.5});
//     const Advance to = advance(motion, limitsOf(model, 0), 0.005);
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "env/environment.h"
#include "geom/pose.h"
#include "scene/robot.h"
#include "sim/command.h"

namespace ispace {

/// Seconds: a time without end.
inline constexpr double kForever = std::numeric_limits<double>::infinity();

/// Maps points of the floor to friction.
class FrictionMap {
  public:
    explicit FrictionMap(const Environment& environment);

    /// Returns the friction of the last `floor` record in file order that contains the point, edges
    /// included, as later ones lie on top; 0 without any.
    [[nodiscard]] double at(Point2 p) const;
    /// Returns true if it is 0 everywhere.
    [[nodiscard]] bool empty() const { return floors_.empty(); }

  private:
    struct Floor {
        Point2 center;
        Vec2 along;  // unit vector of its length
        double half_length, half_width;
        double friction;
    };
    std::vector<Floor> floors_;
};

/// Limits of one axis of motion: metres along the heading, or degrees about the centre of rotation.
struct AxisLimits {
    double top = 0;    ///< speed of commands that come to an end
    double max = 0;    ///< greatest speed in either direction
    double accel = 0;  ///< of speeding up and braking
    friend bool operator==(const AxisLimits&, const AxisLimits&) = default;
};

/// Limits of a mover at its position.
struct MotionLimits {
    AxisLimits drive, turn, side;
    friend bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

/// Returns the model's limits, each multiplied by (1 - friction).
MotionLimits limitsOf(const RobotModel& model, double friction);

/// Returns the limits of a robot on this floor, with those of an order replacing its defaults.
MotionLimits narrowed(const MotionLimits& model, const MotionLimits& order, double friction);

/// Goal of one axis.
struct AxisGoal {
    enum class Kind {
        Speed,    ///< reach a speed and keep it
        Distance  ///< go that far and come to rest exactly there
    } kind = Kind::Speed;
    double value = 0;  ///< the speed, or the signed distance left
    friend bool operator==(const AxisGoal&, const AxisGoal&) = default;
};

/// Order of a program that drives the wheels directly: a goal for each axis, with limits.
struct WheelOrder {
    std::optional<AxisGoal> drive, turn;  ///< unset: the axis keeps its goal
    /// Limits of both axes until the next Command. Speeds may reach the model's maxima.
    AxisLimits drive_limits, turn_limits;
};

/// One axis: its speed and its goal.
struct Axis {
    AxisGoal goal;
    double speed = 0;
    double accel = 0;  ///< at the end of the last step
};

/// Kinematic state of a mover: a unicycle that drives along its heading and turns about its centre
/// of rotation. An omnidirectional robot also moves sideways at the same time.
struct Motion {
    Pose2 pose;      ///< heading within (-180, 180]
    Axis drive;      ///< metres
    Axis turn;       ///< degrees, counter-clockwise
    Axis side;       ///< metres, to the left
    Angle turn_end;  ///< heading at which a turn by a given angle ends

    /// Returns the unit vector along the heading.
    [[nodiscard]] Vec2 forward() const {
        return kept_heading == pose.heading ? kept_forward : unitVector(pose.heading);
    }
    /// Stores that vector, for repeated calls.
    void keepForward() {
        kept_forward = forward();
        kept_heading = pose.heading;
    }
    /// Sets the goals of a command. Speed, Rotspeed and Sidespeed keep the speeds of the other
    /// axes. Path stops all axes: its Navigator sets the goals.
    void command(const Command& command);
    /// Sets the goals of an order; axes without a goal keep theirs.
    void steer(const WheelOrder& order);
    /// Returns true if all axes are at rest and no distance is left.
    [[nodiscard]] bool arrived() const;
    /// Stops all axes at once and removes their goals.
    void halt();

    Vec2 kept_forward{1, 0};  ///< of kept_heading, see forward()
    Angle kept_heading;
};

/// Result of a motion, and its deviation from a uniform motion along the chord.
struct Advance {
    Motion motion;
    double path = 0;   ///< length of the path; an upper bound if it also moves sideways
    double bulge = 0;  ///< upper bound of its distance from the chord
    double lag = 0;    ///< upper bound of its distance from a uniform motion along the chord
};

/// Returns the motion of a mover after `duration` seconds.
///
/// Each axis reaches its goal in the least time, with accelerations that are constant between the
/// moments at which it starts to brake or reaches a speed; these may lie anywhere within the
/// duration. The plan depends on the state alone, so two half steps give the same as a whole one.
/// With a distance to go, an axis keeps to its top speed, brakes first if it goes the wrong way or
/// is too fast to stop in time (and comes back), and ends with speed and remaining distance exactly
/// 0.
///
/// Integrates eq. (5.1)-(5.4) of the thesis, in closed form where speeds are constant and otherwise
/// by Gauss-Legendre quadrature over pieces of small turn: accurate to 1e-13 of the path length.
/// Without acceleration (friction 1) the mover stops at once.
/// \pre duration >= 0
Advance advance(const Motion& from, const MotionLimits& limits, double duration);

}  // namespace ispace
