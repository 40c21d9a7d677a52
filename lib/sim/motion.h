// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/environment.h"
#include "geom/pose.h"
#include "layout/robot.h"
#include "sim/command.h"

namespace ispace {

/// Friction of the floor from place to place.
class FrictionMap {
  public:
    explicit FrictionMap(const Environment& environment);

    /// That of the last `floor` record, in file order, that holds the point, edges included: later
    /// ones lie on top. 0 if there is none.
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
    double max = 0;    ///< greatest speed, either way
    double accel = 0;  ///< of speeding up and braking
};

/// What a robot can do where it stands.
struct MotionLimits {
    AxisLimits drive, turn;
};

/// The model's figures, all times (1 - friction).
MotionLimits limitsOf(const RobotModel& model, double friction);

/// What one axis is to do.
struct AxisGoal {
    enum class Kind {
        Speed,    ///< reach a speed and keep it
        Distance  ///< go that far, come to rest exactly there
    } kind = Kind::Speed;
    double value = 0;  ///< the speed, or the signed distance left
};

/// One axis: its speed, and what it does next.
struct Axis {
    AxisGoal goal;
    double speed = 0;
    double accel = 0;  ///< at the end of the last step
};

/// State of a robot in motion: a unicycle that drives along its heading and turns about its centre
/// of rotation.
struct Motion {
    Pose2 pose;      ///< heading within (-180, 180]
    Axis drive;      ///< metres
    Axis turn;       ///< degrees, counter-clockwise
    Angle turn_end;  ///< the heading at which a turn of given angle ends

    /// Sets the goals of a command. Speed and Rotspeed keep the speed the other one has set.
    void command(const Command& command);
    /// Both axes at rest and no distance left.
    [[nodiscard]] bool arrived() const;
    /// At rest at once, without a goal.
    void halt();
};

/// What a motion comes to, and how far it strayed from an even motion along its chord.
struct Advance {
    Motion motion;
    double path = 0;   ///< length of the way travelled
    double bulge = 0;  ///< no place of it is farther than this from the chord
    double lag = 0;    ///< nor from where an even motion along the chord would be at that moment
};

/// Where a robot is after `duration` seconds.
///
/// Each axis goes to its goal in the least time, by accelerations that are constant between the
/// moments where it starts to brake or has reached a speed; these may lie anywhere within the
/// duration. The plan depends on the state alone: two halves are as good as the whole. With a
/// distance to go it keeps to its top speed, brakes first if it goes the wrong way or is too fast
/// to stop in time (and comes back), and ends with speed and distance left exactly 0.
///
/// Eq. (5.1)-(5.4) of the thesis, integrated in closed form where speeds are constant and else by
/// Gauss-Legendre quadrature over pieces of little turn: accurate to 1e-13 of the way travelled.
/// Without acceleration (friction 1) it stands at once.
/// \pre duration >= 0
Advance advance(const Motion& from, const MotionLimits& limits, double duration);

}  // namespace ispace
