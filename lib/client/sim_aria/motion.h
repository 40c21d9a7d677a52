// SPDX-License-Identifier: GPL-3.0-or-later
// Private to sim_aria: the speeds that ArRobot sends in each cycle, from goals of distance, heading
// and speed. Millimetres, degrees, seconds; no thread and no connection.
#ifndef SIM_ARIA_MOTION_H
#define SIM_ARIA_MOTION_H

#include <algorithm>
#include <cmath>

#include <sim_aria/math.h>

namespace sim_aria {

/// Direct motion: stores separate goals of translation and rotation, and computes the speeds of
/// each cycle. Speeds are whole mm/s and degrees/s, as in a Pioneer's commands; like its firmware,
/// it reaches distances and headings with speeds that decrease towards the goal: the speed at a
/// distance s is the least of the maximum, of sqrt(decel s), which brakes at half of the
/// deceleration since poses arrive a cycle late, and of s / 0.3 s. It is 0 below 0.5 mm or degrees.
class Motion {
  public:
    double top_vel = 750, top_rot_vel = 100;  ///< of the robot: bounds of the next two
    double max_vel = 750, max_rot_vel = 100;  ///< mm/s, degrees/s
    double accel = 300, rot_accel = 100;      ///< mm/s², degrees/s²; stored only
    double decel = 300, rot_decel = 100;      ///< towards a distance or a heading
    double move_done = 40;                    ///< mm
    double heading_done = 3;                  ///< degrees

    /// Sets a maximum, at most the robot's. \return false if it was too high or not positive
    static bool setMax(double& most, double value, double top) {
        if (!(value > 0)) return false;
        most = std::min(value, top);
        return value <= top;
    }

    void setVel(double value) {
        move_ = Vel;
        vel_ = value;
    }
    void setRotVel(double value) {
        turn_ = Vel;
        rot_vel_ = value;
    }
    /// \param at the robot's pose
    void move(double distance, const ArPose& at) {
        move_ = Goal;
        distance_ = distance;
        from_ = at;
    }
    void setHeading(double heading) {
        turn_ = Goal;
        heading_ = ArMath::fixAngle(heading);
    }
    /// Removes both goals.
    void clear() { move_ = turn_ = None; }
    /// Bounds the speeds of this cycle: forward and rotation from 0, backward up to 0.
    void limit(double forward, double backward, double rotation) {
        forward_limit_ = std::floor(forward);
        backward_limit_ = std::ceil(backward);
        rot_limit_ = std::floor(rotation);
    }
    void unlimited() { limit(kNoLimit, -kNoLimit, kNoLimit); }

    bool isMoveDone(const ArPose& at, double delta) const {
        if (move_ != Goal) return true;
        return std::fabs(distance_) - from_.findDistanceTo(at) <= (delta == 0 ? move_done : delta);
    }
    bool isHeadingDone(const ArPose& at, double delta) const {
        if (turn_ != Goal) return true;
        return std::fabs(ArMath::subAngle(heading_, at.getTh())) <=
               (delta == 0 ? heading_done : delta);
    }

    /// Computes the current speed.
    double vel(const ArPose& at) const {
        return std::max(backward_limit_, std::min(forward_limit_, wantedVel(at)));
    }
    double rotVel(const ArPose& at) const {
        return std::max(-rot_limit_, std::min(rot_limit_, wantedRotVel(at)));
    }

  private:
    enum Wanted { None, Vel, Goal };

    double wantedVel(const ArPose& at) const {
        if (move_ != Goal) return move_ == Vel ? rounded(vel_, max_vel) : 0;
        const double rest = std::fabs(distance_) - travelled(at);
        return std::copysign(1.0, distance_) * approach(rest, max_vel, decel);
    }
    double wantedRotVel(const ArPose& at) const {
        if (turn_ != Goal) return turn_ == Vel ? rounded(rot_vel_, max_rot_vel) : 0;
        return approach(ArMath::subAngle(heading_, at.getTh()), max_rot_vel, rot_decel);
    }

    static double rounded(double value, double most) {
        return std::round(std::max(-most, std::min(most, value)));
    }
    /// Uses half of the deceleration, since poses arrive one cycle late.
    static double approach(double rest, double most, double decel) {
        const double left = std::fabs(rest);
        const double speed = std::min(std::min(most, std::sqrt(decel * left)), left / kSettle);
        return std::copysign(left < kStill ? 0 : std::round(speed), rest);
    }
    /// Distance travelled along the initial heading.
    double travelled(const ArPose& at) const {
        const double ahead = (at.getX() - from_.getX()) * ArMath::cos(from_.getTh()) +
                             (at.getY() - from_.getY()) * ArMath::sin(from_.getTh());
        // On a curve, use the distance instead.
        const double distance = from_.findDistanceTo(at);
        return turn_ == None ? std::copysign(1.0, distance_) * ahead : distance;
    }

    static constexpr double kNoLimit = 1e9;
    static constexpr double kSettle = 0.3;  // s to cover the remainder
    static constexpr double kStill = 0.5;   // mm or degrees below which no motion starts

    Wanted move_ = None, turn_ = None;
    double forward_limit_ = kNoLimit, backward_limit_ = -kNoLimit, rot_limit_ = kNoLimit;
    double vel_ = 0, rot_vel_ = 0, distance_ = 0, heading_ = 0;
    ArPose from_;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_MOTION_H
