// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "env/environment.h"
#include "geom/pose.h"
#include "scene/robot.h"
#include "sim/command.h"

namespace ispace {

/// Friction of the floor from place to place.
class FrictionMap {
  public:
    explicit FrictionMap(const Environment& environment);

    /// Friction of the last `floor` record in file order that contains the point, edges included,
    /// as later ones lie on top; 0 if there is none.
    [[nodiscard]] double at(Point2 p) const;
    /// True if it is 0 everywhere.
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

/// Limits of one axis of motion: along the heading in metres, or about the centre of rotation in
/// degrees.
struct AxisLimits {
    double top = 0;    ///< speed of commands that come to an end
    double max = 0;    ///< greatest speed in either direction
    double accel = 0;  ///< of speeding up and braking
    friend bool operator==(const AxisLimits&, const AxisLimits&) = default;
};

/// What a robot or a person can do where it stands.
struct MotionLimits {
    AxisLimits drive, turn, side;
    friend bool operator==(const MotionLimits&, const MotionLimits&) = default;
};

/// The model's limits, each times (1 - friction).
MotionLimits limitsOf(const RobotModel& model, double friction);

/// The limits of a robot on this floor, with those of an order in place of its usual ones.
MotionLimits narrowed(const MotionLimits& model, const MotionLimits& order, double friction);

/// What one axis is to do.
struct AxisGoal {
    enum class Kind {
        Speed,    ///< reach a speed and keep it
        Distance  ///< go that far and come to rest exactly there
    } kind = Kind::Speed;
    double value = 0;  ///< the speed, or the signed distance left
    friend bool operator==(const AxisGoal&, const AxisGoal&) = default;
};

/// What a program that speaks to the wheels asks of a robot: each axis by itself, and how hard.
struct WheelOrder {
    std::optional<AxisGoal> drive, turn;  ///< nothing: it goes on as it does
    /// Of both axes, until the next Command. Speeds count up to the model's greatest ones.
    AxisLimits drive_limits, turn_limits;
};

/// One axis: its speed, and what it does next.
struct Axis {
    AxisGoal goal;
    double speed = 0;
    double accel = 0;  ///< at the end of the last step
};

/// State of a robot or a person in motion: a unicycle that drives along its heading and turns about
/// its centre of rotation. Who is omnidirectional moves sideways at the same time.
struct Motion {
    Pose2 pose;      ///< heading within (-180, 180]
    Axis drive;      ///< metres
    Axis turn;       ///< degrees, counter-clockwise
    Axis side;       ///< metres, to the left
    Angle turn_end;  ///< the heading at which a turn of given angle ends

    /// Unit vector along the heading.
    [[nodiscard]] Vec2 forward() const {
        return kept_heading == pose.heading ? kept_forward : unitVector(pose.heading);
    }
    /// Keeps it, for those who ask more than once.
    void keepForward() {
        kept_forward = forward();
        kept_heading = pose.heading;
    }
    /// Sets the goals of a command. Speed, Rotspeed and Sidespeed keep the speeds that the others
    /// have set. Path brings all to rest: who walks it sets the goals, see route.h.
    void command(const Command& command);
    /// Sets the goals of an order; a goal that is not in it stays.
    void steer(const WheelOrder& order);
    /// All axes at rest and no distance left.
    [[nodiscard]] bool arrived() const;
    /// At rest at once, without a goal.
    void halt();

    Vec2 kept_forward{1, 0};  ///< of kept_heading, see forward()
    Angle kept_heading;
};

/// Result of a motion, and how far it strayed from an even motion along its chord.
struct Advance {
    Motion motion;
    double path = 0;   ///< length of the path travelled; sideways at the same time: at most
    double bulge = 0;  ///< upper bound of its distance from the chord
    double lag = 0;    ///< upper bound of its distance from an even motion along the chord
};

/// Where a robot or a person is after `duration` seconds.
///
/// Each axis reaches its goal in the least time, with accelerations that are constant between the
/// moments where it starts to brake or reaches a speed; these may lie anywhere within the duration.
/// The plan depends on the state alone, so two half steps give the same as a whole one. With a
/// distance to go it keeps to its top speed, brakes first if it goes the wrong way or is too fast
/// to stop in time (and comes back), and ends with speed and remaining distance exactly 0.
///
/// Eq. (5.1)-(5.4) of the thesis, integrated in closed form where speeds are constant and else by
/// Gauss-Legendre quadrature over pieces of small turn: accurate to 1e-13 of the path length.
/// Without acceleration (friction 1) it stops at once.
/// \pre duration >= 0
Advance advance(const Motion& from, const MotionLimits& limits, double duration);

}  // namespace ispace
