// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>

#include "sim/motion.h"
#include "sim/world.h"
#include "wire/p2os_status.h"
#include "wire/p2os_type.h"

namespace ispace {

/// The motion controller of a Pioneer: it keeps what is to be reached along the heading and about
/// the centre, each by itself, and gives it to the wheels. Numbers are in millimetres and degrees.
///
/// Speeds keep to the limits that are set. Distances and headings are reached with the lower of
/// acceleration and deceleration. Who runs into something stands, is stalled as long as a speed
/// along the heading is wanted, and tries again twice a second.
class P2osDrive {
  public:
    P2osDrive(const P2osType& type, const RobotModel& model);

    [[nodiscard]] const P2osLimits& limits() const { return limits_; }
    [[nodiscard]] const P2osLimits& top() const { return top_; }
    /// One of them, up to the top one; nothing but 1 is less than 1.
    void limit(double P2osLimits::*which, double value);

    // What is to be reached. Ignored while the motors are off, or an emergency stop lasts.
    void setSpeed(double speed);
    void setRotspeed(double rotspeed);
    void move(double distance);
    /// \param heading by odometry, as `now` is
    void turnTo(Angle heading, Angle now);
    void turnBy(Angle angle, Angle now);
    /// \param by their wheels, mm/s
    void setWheels(double left, double right);
    void stop();
    /// Stops as hard as can be; nothing else until it stands.
    void stopHard();
    /// Turns the motors on or off, which stops the robot hard.
    void enable(bool on);
    /// Stands while the client is silent, and goes on then.
    void hush(bool silent);
    /// The robot was put elsewhere, at rest: reaches for the same again.
    void renew();

    [[nodiscard]] bool motors() const { return motors_; }
    [[nodiscard]] bool isStopping() const { return stopping_; }
    [[nodiscard]] bool isStalled() const { return stalled_; }
    [[nodiscard]] bool isHushed() const { return hushed_; }
    /// True if it is to go a distance.
    [[nodiscard]] bool hasDistance() const {
        return drive_.kind == AxisGoal::Kind::Distance && drive_.value != 0;
    }

    /// Gives the wheels what is new.
    void apply(World& world, std::size_t robot, Angle now);
    /// After each step; what is new then waits for apply().
    void stepped(const World& world, std::size_t robot);

  private:
    [[nodiscard]] bool mayMove() const { return motors_ && !stopping_; }
    void halt();
    /// The limits that fit what the axes do.
    [[nodiscard]] WheelOrder order(const RobotStatus& status) const;

    P2osType type_;
    P2osLimits top_, limits_;
    AxisGoal drive_, turn_;         // metres, degrees
    std::optional<Angle> heading_;  // to be reached, by odometry
    bool new_drive_ = false, new_turn_ = false;
    bool is_resumed_ = false;  // the turn goes on after a stop
    bool owns_ = false;        // the motors were on: until then the robot goes its own way
    bool motors_ = false, moving_ = false, stopping_ = false, hushed_ = false, stalled_ = false;
    SimTime retry_{};
    Point2 stall_place_;
    AxisLimits drive_limits_, turn_limits_;  // that the wheels have
};

}  // namespace ispace
