// SPDX-License-Identifier: GPL-3.0-or-later
// The rules of a pilot: arrive, give up, turn aside, slow down, wait, step aside, wander.
//
// Two movers that meet pass on the right, since Steering tests right first. A mover without a free
// heading waits one to three seconds before it tries a side, and one that circles about a point
// between walls goes straight on after two. Random numbers are keyed by seed, id and a count of
// draws, so that each mover has a sequence for itself.
#include "sim/navigator.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"

namespace ispace {

namespace {

constexpr SimTime kNever{-1};

/// m/s: a faster mover tries lower speeds down to this one.
constexpr double kPace = 1;
/// Time without a gain after which a mover near its goal is taken to circle there.
constexpr SimTime kCircling = std::chrono::seconds(2);
/// Degrees: for a wider turn the mover turns on the spot.
constexpr double kWide = 30;

double degreesOff(Angle a, Angle b) { return wrapped(a - b).degrees(); }

}  // namespace

Navigator::Navigator(const Mover& mover, std::uint64_t seed)
    : model_{mover.model.drive, mover.model.accel, mover.model.max_sidespeed},
      seed_(seed),
      id_(hashOf(mover.id)) {}

void Navigator::follow(const MotionPlan& course, double speed, bool commanded, bool is_attempt) {
    const bool goes = course.wander || !course.path.empty();
    course_ = course;
    speed_ = speed;
    commanded_ = commanded;
    is_attempt_ = is_attempt;
    unreached_.reset();
    state_ = goes ? State::Underway : State::Off;
    due_ = pause_until_ = aside_until_ = turn_at_ = {};
    next_ = 0;
    nearest_ = kForever;
    gained_ = blocked_since_ = kNever;
    has_aim_ = idle_ = bumped_ = false;
}

/// In [0, 1).
double Navigator::random() {
    float value = 0;
    draw({seed_, Purpose::Wander, id_, draws_++}, 0, {.uniform = std::span(&value, 1)});
    return static_cast<double>(value);
}

/// Returns the seconds ahead that must be free: enough to brake.
double Navigator::horizon(double speed) const {
    constexpr double kMinValue = 2, kSlack = 0.5;
    return std::max(kMinValue, speed / model_.accel + kSlack);
}

void Navigator::steer(const SteeringState& helm, Motion& motion) {
    due_ = helm.time + kInterval;
    idle_ = false;
    if (gained_ == kNever) {
        gained_ = helm.time;
        // Spreads the movers over the steps.
        due_ = helm.time + SimTime(static_cast<SimTime::rep>(id_ % kInterval.count()));
    }
    if (next_ < course_.path.size())
        walk(helm, motion);
    else
        wander(helm, motion);
}

bool Navigator::stopsAtNext(SimTime step) const {
    constexpr double kStraight = 20;  // degrees
    const std::vector<Point2>& path = course_.path;
    if (step > kInterval || course_.pause > 0 || (next_ + 1 == path.size() && !course_.loop))
        return true;
    if (model_.drive == Drive::Omni || next_ == 0) return model_.drive != Drive::Omni;
    const Vec2 before = path[next_] - path[next_ - 1];
    const Vec2 after = path[(next_ + 1) % path.size()] - path[next_];
    return dot(before, after) <=
           std::cos(Angle::degrees(kStraight).radians()) * length(before) * length(after);
}

void Navigator::arrive(SimTime time) {
    nearest_ = kForever;
    gained_ = time;
    if (course_.pause > 0) pause_until_ = time + simSeconds(course_.pause);
    leave(time);
}

/// Goes on to the next point.
void Navigator::leave(SimTime time) {
    nearest_ = kForever;
    gained_ = time;
    if (++next_ < course_.path.size()) return;
    if (course_.loop)
        next_ = 0;
    else if (!course_.wander)
        state_ = State::Arrived;
}

/// In this order: pauses, arrives, gives up a point that it has not come nearer to for kPatience,
/// keeps aside, and goes straight on to a stop that it circles. Else takes the free heading nearest
/// to the direct one, at half the speed again and again while no heading is free; if it finds no
/// heading at all it stands, and then steps aside.
void Navigator::walk(const SteeringState& helm, Motion& motion) {
    if (helm.time < pause_until_) return stand(motion);
    const Vec2 way = course_.path[next_] - motion.pose.position;
    const double left = length(way);
    const bool stops = stopsAtNext(helm.step);
    if (left <= (stops ? kArrive : kPass)) {
        // The last centimetre to a stop.
        const bool ends = motion.drive.goal.kind == AxisGoal::Kind::Distance;
        if (stops && ends && !motion.arrived()) return;
        if (stops) stand(motion);
        arrive(helm.time);
        if (isOn() && !idle_) due_ = helm.time;
        return;
    }
    constexpr double kGain = 0.02;  // metres
    if (left < nearest_ - kGain) {
        nearest_ = left;
        gained_ = helm.time;
    } else if (helm.time - gained_ > kPatience) {
        stand(motion);
        if (!is_attempt_) unreached_ = course_.path[next_];
        if (commanded_)
            state_ = State::Failed;
        else
            leave(helm.time);
        return;
    }
    const Steering steering = lookAbout(helm, speed_);
    if (helm.time < aside_until_) {
        if (steering.freeTime(aside_) > 0) return go(motion, aside_, speed_ / 2, kForever);
        aside_until_ = {};
    }
    const Angle direct = Angle::radians(std::atan2(way.y, way.x));
    // Walls about a point turn the mover aside, so that it circles there: it goes straight on.
    constexpr double kLast = 0.5;  // metres
    if (stops && left < std::min(kLast, speed_ * horizon(speed_)) &&
        helm.time - gained_ > kCircling && steering.isFree(way)) {
        bumped_ = true;
        return go(motion, direct, speed_, left);
    }
    // Obstacles behind the point do not matter.
    const auto needed = [&](double speed) { return std::min(horizon(speed), left / speed); };
    constexpr double kMinValue = 0.3;  // seconds
    double pace = speed_;
    FreeHeading free = steering.choose(direct, needed(pace));
    while (free.time < std::min(kMinValue, needed(pace)) && pace >= 2 * kPace) {
        pace /= 2;
        free = lookAbout(helm, pace).choose(direct, needed(pace));
    }
    if (free.time < std::min(kMinValue, needed(pace))) {
        stand(motion);
        return stepAside(helm, steering, motion);
    }
    blocked_since_ = kNever;
    const double speed = pace * std::min(1.0, free.time / std::min(1.0, needed(pace)));
    double stop = kForever;
    if (free.direction == direct && stops && pace == speed_) stop = left;
    go(motion, free.direction, speed, stop);
}

Steering Navigator::lookAbout(const SteeringState& helm, double speed) const {
    return {helm, speed, horizon(speed)};
}

/// Waits a while, then tries to pass on the side.
void Navigator::stepAside(const SteeringState& helm, const Steering& steering,
                          const Motion& motion) {
    constexpr double kWait = 1, kWaitMore = 2, kAside = 0.7;  // seconds
    if (blocked_since_ == kNever) {
        blocked_since_ = helm.time + simSeconds(kWait + kWaitMore * random());
        return;
    }
    if (helm.time < blocked_since_) return;
    blocked_since_ = kNever;
    const Angle first = motion.pose.heading + Angle::degrees(90 + 180 * random());
    const FreeHeading aside = steering.choose(first, kAside);
    if (aside.time < kAside / 2) return;
    aside_ = aside.direction;
    aside_until_ = helm.time + simSeconds(kAside + 2 * random());
}

/// Turns its aim a little every few seconds; before a wall to the free heading nearest to it, then
/// back, and in a corner to any. Draws come from the seed and the mover alone, so a run repeats.
void Navigator::wander(const SteeringState& helm, Motion& motion) {
    constexpr double kBend = 30, kOften = 2, kSeldom = 4;
    constexpr double kMinValue = 0.5;  // seconds
    if (!has_aim_) aim_ = motion.pose.heading;
    if (helm.time >= turn_at_) {
        if (has_aim_) aim_ = aim_ + Angle::degrees(kBend * (2 * random() - 1));
        turn_at_ = helm.time + simSeconds(kOften + kSeldom * random());
    }
    has_aim_ = true;
    double pace = speed_;
    std::optional<Steering> steering(std::in_place, helm, pace, horizon(pace));
    FreeHeading free = steering->choose(aim_, horizon(pace));
    const auto suits = [&] {
        return free.time >= horizon(pace) &&
               std::abs(degreesOff(free.direction, motion.pose.heading)) < kWide;
    };
    while (pace >= 2 * kPace && !suits()) {
        pace /= 2;
        steering.emplace(helm, pace, horizon(pace));
        free = steering->choose(aim_, horizon(pace));
    }
    if (free.time < kMinValue) free = steering->choose(aim_ + Angle::degrees(180), horizon(pace));
    if (free.time < kMinValue) {
        aim_ = aim_ + Angle::degrees(360 * random());
        return stand(motion);
    }
    aim_ = wrapped(free.direction);
    go(motion, aim_, pace * std::min(1.0, free.time), kForever);
}

void Navigator::stand(Motion& motion) {
    idle_ = true;
    motion.drive.goal = motion.turn.goal = motion.side.goal = {};
}

void Navigator::go(Motion& motion, Angle direction, double speed, double stop) {
    constexpr double kAligned = 1, kExact = 1e-9;  // degrees
    const double off = degreesOff(direction, motion.pose.heading);
    if (std::abs(off) > kExact) {
        motion.turn.goal = {AxisGoal::Kind::Distance, off};
        motion.turn_end = wrapped(motion.pose.heading + Angle::degrees(off));
    } else {
        motion.turn.goal = {};
    }
    motion.side.goal = {};
    if (std::abs(off) <= kAligned) bumped_ = false;
    if (std::abs(off) <= kAligned && stop < kForever) {
        motion.drive.goal = {AxisGoal::Kind::Distance, stop};
        return;
    }
    // Allows it to stop there, turning on the way.
    speed = std::min(speed, std::sqrt(2 * model_.accel * stop));
    const double aside = Angle::degrees(off).radians();
    // After a bump it turns on the spot: sidling, it would bend towards what it met again.
    const bool sidles = model_.drive == Drive::Omni && std::abs(off) < 2 * kWide && !bumped_;
    const bool turns = std::abs(off) >= kWide || bumped_;
    const double ahead = sidles ? speed * std::cos(aside) : turns ? 0 : speed;
    motion.drive.goal = {AxisGoal::Kind::Speed, ahead};
    if (sidles)
        motion.side.goal = {
            AxisGoal::Kind::Speed,
            std::clamp(speed * std::sin(aside), -model_.max_sidespeed, model_.max_sidespeed)};
}

}  // namespace ispace
