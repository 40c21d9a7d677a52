// SPDX-License-Identifier: GPL-3.0-or-later
#include "wire/p2os_drive.h"

#include <algorithm>
#include <cmath>

namespace ispace {

namespace {

constexpr double kMillimetres = 1000;
constexpr SimTime kRetryAfter = std::chrono::milliseconds(500);

/// How fast an axis may be and change its speed now.
AxisLimits limitsFor(const AxisGoal& goal, double speed, double max, double accel, double decel) {
    if (goal.kind == AxisGoal::Kind::Distance) return {max, max, std::min(accel, decel)};
    const double wanted = std::clamp(goal.value, -max, max);
    const bool faster = wanted * speed >= 0 && std::abs(wanted) > std::abs(speed);
    return {max, max, faster ? accel : decel};
}

bool wants(const AxisGoal& goal) { return goal.value != 0; }

}  // namespace

P2osDrive::P2osDrive(const P2osType& type, const RobotModel& model)
    : type_(type), top_(p2osTopLimits(type, model)), limits_(p2osUsualLimits(model)) {}

void P2osDrive::limit(double P2osLimits::*which, double value) {
    limits_.*which = std::clamp(value, 1.0, std::max(1.0, top_.*which));
}

void P2osDrive::setSpeed(double speed) {
    if (!mayMove()) return;
    const AxisGoal goal{AxisGoal::Kind::Speed, speed / kMillimetres};
    if (goal == drive_) return;
    if (goal.value * drive_.value <= 0) stalled_ = false;
    drive_ = goal;
    new_drive_ = true;
}

void P2osDrive::setRotspeed(double rotspeed) {
    if (!mayMove()) return;
    heading_.reset();
    turn_ = {AxisGoal::Kind::Speed, rotspeed};
    new_turn_ = true;
}

void P2osDrive::move(double distance) {
    if (!mayMove()) return;
    drive_ = {AxisGoal::Kind::Distance, distance / kMillimetres};
    new_drive_ = true;
    stalled_ = false;
}

void P2osDrive::turnTo(Angle heading, Angle now) {
    if (!mayMove()) return;
    heading_ = heading;
    turn_ = {AxisGoal::Kind::Distance, wrapped(heading - now).degrees()};
    new_turn_ = true;
}

void P2osDrive::turnBy(Angle angle, Angle now) {
    if (!mayMove()) return;
    heading_ = wrapped(now + angle);
    turn_ = {AxisGoal::Kind::Distance, angle.degrees()};
    new_turn_ = true;
}

void P2osDrive::setWheels(double left, double right) {
    setSpeed((left + right) / 2);
    setRotspeed(Angle::radians((right - left) / 2 * type_.turn).degrees());
}

void P2osDrive::stop() {
    setSpeed(0);
    setRotspeed(0);
}

void P2osDrive::halt() {
    drive_ = turn_ = {};
    heading_.reset();
    new_drive_ = new_turn_ = true;
    stopping_ = moving_;
    stalled_ = false;
}

void P2osDrive::stopHard() { halt(); }

void P2osDrive::enable(bool on) {
    if (motors_ == on) return;
    halt();
    motors_ = on;
    owns_ = true;
}

void P2osDrive::hush(bool silent) {
    if (silent == hushed_) return;
    hushed_ = silent;
    renew();
}

void P2osDrive::renew() {
    // What is left of a distance is not known.
    if (drive_.kind == AxisGoal::Kind::Distance) drive_ = {};
    new_drive_ = new_turn_ = is_resumed_ = true;
}

WheelOrder P2osDrive::order(const RobotStatus& status) const {
    const P2osLimits& is = stopping_ ? top_ : limits_;
    WheelOrder order;
    order.drive_limits =
        limitsFor(hushed_ ? AxisGoal() : drive_, status.speed, is.speed / kMillimetres,
                  is.accel / kMillimetres, is.decel / kMillimetres);
    order.turn_limits = limitsFor(hushed_ ? AxisGoal() : turn_, status.rotspeed.degrees(),
                                  is.rotspeed, is.rotaccel, is.rotdecel);
    return order;
}

void P2osDrive::apply(World& world, std::size_t robot, Angle now) {
    if (!owns_) return;
    WheelOrder next = order(world.status(robot));
    const bool same = next.drive_limits == drive_limits_ && next.turn_limits == turn_limits_;
    if (same && !new_drive_ && !new_turn_) return;
    if (new_drive_) {
        next.drive = hushed_ ? AxisGoal{} : drive_;
        retry_ = world.time() + kRetryAfter;
    }
    if (new_turn_) {
        if (heading_ && is_resumed_) turn_.value = wrapped(*heading_ - now).degrees();
        next.turn = hushed_ ? AxisGoal{} : turn_;
    }
    is_resumed_ = false;
    new_drive_ = new_turn_ = false;
    drive_limits_ = next.drive_limits;
    turn_limits_ = next.turn_limits;
    world.steer(robot, next);
}

void P2osDrive::stepped(const World& world, std::size_t robot) {
    const RobotStatus status = world.status(robot);
    moving_ = status.speed != 0 || status.rotspeed != Angle();
    stopping_ = stopping_ && moving_;
    const bool hit = std::any_of(world.collisions().begin(), world.collisions().end(),
                                 [robot](const Collision& one) { return one.robot == robot; });
    if (hit) {
        // It stands, where it was to turn as well.
        stalled_ = wants(drive_);
        stall_place_ = status.pose.position;
        retry_ = world.time() + kRetryAfter;
        new_turn_ = is_resumed_ = wants(turn_);
        if (drive_.kind == AxisGoal::Kind::Distance) drive_.value = 0;
    }
    // Up to a step away from the thing it can go, which frees it from nothing.
    constexpr double kFree = 0.02;
    if (distance(status.pose.position, stall_place_) > kFree) stalled_ = false;
    if (stalled_ && drive_.kind == AxisGoal::Kind::Speed && world.time() >= retry_)
        new_drive_ = true;
}

}  // namespace ispace
