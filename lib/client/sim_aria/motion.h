// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef SIM_ARIA_MOTION_H
#define SIM_ARIA_MOTION_H

#include <algorithm>
#include <cmath>

#include <sim_aria/math.h>

namespace sim_aria {

/// Direct motion: what the program wants of speed and of rotation, each of its own, and the speeds
/// that follow from it in each cycle. Speeds are whole mm/s and degrees/s, as a Pioneer is told
/// them; distances and headings are held as its firmware does, by speeds that fall towards the end.
class Motion {
  public:
    double max_vel = 1600, max_rot_vel = 300;  ///< mm/s, degrees/s
    double accel = 300, rot_accel = 100;       ///< mm/s², degrees/s²
    static constexpr double kMoveDone = 40;    ///< mm
    static constexpr double kHeadingDone = 3;  ///< degrees

    void setVel(double value) {
        move_ = Vel;
        vel_ = value;
    }
    void setRotVel(double value) {
        turn_ = Vel;
        rot_vel_ = value;
    }
    /// \param at where the robot is
    void move(double distance, const ArPose& at) {
        move_ = Goal;
        distance_ = distance;
        from_ = at;
    }
    void setHeading(double heading) {
        turn_ = Goal;
        heading_ = ArMath::fixAngle(heading);
    }
    /// Nothing is wanted any more.
    void clear() { move_ = turn_ = None; }

    bool isMoveDone(const ArPose& at, double delta) const {
        if (move_ != Goal) return true;
        return std::fabs(distance_) - from_.findDistanceTo(at) <= (delta == 0 ? kMoveDone : delta);
    }
    bool isHeadingDone(const ArPose& at, double delta) const {
        if (turn_ != Goal) return true;
        return std::fabs(ArMath::subAngle(heading_, at.getTh())) <=
               (delta == 0 ? kHeadingDone : delta);
    }

    /// The speed that is right now.
    double vel(const ArPose& at) const {
        if (move_ != Goal) return move_ == Vel ? rounded(vel_, max_vel) : 0;
        const double rest = std::fabs(distance_) - travelled(at);
        return std::copysign(1.0, distance_) * approach(rest, max_vel, accel);
    }
    double rotVel(const ArPose& at) const {
        if (turn_ != Goal) return turn_ == Vel ? rounded(rot_vel_, max_rot_vel) : 0;
        return approach(ArMath::subAngle(heading_, at.getTh()), max_rot_vel, rot_accel);
    }

  private:
    enum Wanted { None, Vel, Goal };

    static double rounded(double value, double most) {
        return std::round(std::max(-most, std::min(most, value)));
    }
    /// Half of what it can brake, as it learns a cycle late where it is.
    static double approach(double rest, double most, double accel) {
        const double left = std::fabs(rest);
        const double speed = std::min(std::min(most, std::sqrt(accel * left)), left / kSettle);
        return std::copysign(left < kStill ? 0 : speed, rest);
    }
    /// Along the way it faced when the motion began.
    double travelled(const ArPose& at) const {
        const double ahead = (at.getX() - from_.getX()) * ArMath::cos(from_.getTh()) +
                             (at.getY() - from_.getY()) * ArMath::sin(from_.getTh());
        // On a curve the distance counts.
        const double distance = from_.findDistanceTo(at);
        return turn_ == None ? std::copysign(1.0, distance_) * ahead : distance;
    }

    static constexpr double kSettle = 0.3;  // s in which the last bit is covered
    static constexpr double kStill = 0.5;   // mm or degrees that are not worth a motion

    Wanted move_ = None, turn_ = None;
    double vel_ = 0, rot_vel_ = 0, distance_ = 0, heading_ = 0;
    ArPose from_;
};

}  // namespace sim_aria

#endif  // SIM_ARIA_MOTION_H
