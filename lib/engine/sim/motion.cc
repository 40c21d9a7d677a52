// SPDX-License-Identifier: GPL-3.0-or-later
// Profiles of axes, and the way along them.
//
// An axis is a list of phases of constant acceleration: brake if it goes the wrong way or too fast,
// ramp up, hold, ramp down. A step runs all axes from one change of an acceleration to the next.
// Between these the way is a closed form if all speeds are constant or the mover does not turn;
// elsewhere Gauss and Legendre's quadrature with three or five points over pieces that turn little,
// accurate to 1e-14 of the way. A mover at a constant speed on a straight way, as most people are,
// takes a short cut that computes the same.
#include "sim/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/tolerance.h"

namespace ispace {

FrictionMap::FrictionMap(const Environment& environment) {
    for (const Element& element : environment.elements()) {
        const Record& record = element.record;
        // A smooth floor below the first rough one has no effect.
        const bool tells =
            record.keyword() == "floor" && (!floors_.empty() || record.number("friction") != 0);
        if (!tells) continue;
        const Tuple& at = record.tuple("at");
        const Tuple& size = record.tuple("size");
        floors_.push_back({{at[0], at[1]},
                           unitVector(record.angle("heading")),
                           size[0] / 2,
                           size[1] / 2,
                           record.number("friction")});
    }
}

double FrictionMap::at(Point2 p) const {
    for (auto floor = floors_.rbegin(); floor != floors_.rend(); ++floor) {
        const Vec2 offset = p - floor->center;
        if (std::abs(dot(offset, floor->along)) <= floor->half_length &&
            std::abs(cross(floor->along, offset)) <= floor->half_width)
            return floor->friction;
    }
    return 0;
}

namespace {

/// Seconds: moments closer than this count as one.
constexpr double kInstant = 1e-13;
/// A piece of quadrature turns by at most so many radians, and its rate changes at most so much
/// (square root of the radians that makes): five points are then accurate to 1e-14 of the way. So
/// are three if it turns little, as in most steps.
constexpr double kMaxTurn = 0.25, kMaxBend = 0.3;
constexpr double kLittleTurn = 0.015, kLittleBend = 0.01;

/// A time of constant acceleration.
struct Phase {
    double duration, accel;
    double speed;  // at its end
};

/// Computes the future motion of an axis: phases, the last of them without end.
class Profile {
  public:
    explicit Profile(double speed) : speed_(speed) {}
    void rampTo(double speed, double accel) {
        if (speed == speed_) return;
        const double duration = std::abs(speed - speed_) / accel;
        phases_[size_++] = {duration, speed > speed_ ? accel : -accel, speed};
        speed_ = speed;
    }
    void hold(double duration) {
        if (duration > 0) phases_[size_++] = {duration, 0, speed_};
    }
    [[nodiscard]] const Phase& operator[](std::size_t i) const { return phases_[i]; }
    [[nodiscard]] std::size_t size() const { return size_; }

  private:
    std::array<Phase, 6> phases_;
    std::size_t size_ = 0;
    double speed_;
};

/// Ramps to the goal, clamped to the limits, and holds it.
Profile speedProfile(const Axis& axis, const AxisLimits& limits) {
    Profile profile(axis.speed);
    profile.rampTo(std::clamp(axis.goal.value, -limits.max, limits.max), limits.accel);
    profile.hold(kForever);
    return profile;
}

/// Returns the fastest profile that ends at rest at a distance: brake, ramp to a peak, hold, ramp
/// down. The peak is the top speed, or that from which braking just suffices. Within kUnitTolerance
/// of the way in which it comes to rest, it brakes at once, so that rounding starts no new ramp.
Profile distanceProfile(const Axis& axis, const AxisLimits& limits) {
    const double accel = limits.accel;
    double left = axis.goal.value, speed = axis.speed;
    Profile profile(speed);
    const double to_rest = speed * std::abs(speed) / (2 * accel);
    const double slack = kUnitTolerance * std::max({1.0, std::abs(left), std::abs(to_rest)});
    if (std::abs(left - to_rest) <= slack) {
        profile.rampTo(0, accel);
        profile.hold(kForever);
        return profile;
    }
    // Brakes first if it goes the wrong way, or would overshoot.
    if (speed != 0 && (speed * left <= 0 || std::abs(to_rest) > std::abs(left))) {
        profile.rampTo(0, accel);
        left -= to_rest;
        speed = 0;
    }
    const double sign = left < 0 ? -1 : 1;
    left = std::abs(left);
    speed = std::abs(speed);
    if (speed > limits.top) {
        profile.rampTo(sign * limits.top, accel);
        left -= (speed - limits.top) * (speed + limits.top) / (2 * accel);
        speed = limits.top;
    }
    const double peak =
        std::max(speed, std::min(limits.top, std::sqrt(accel * left + speed * speed / 2)));
    profile.rampTo(sign * peak, accel);
    profile.hold((left - (peak * peak - speed * speed / 2) / accel) / peak);
    profile.rampTo(0, accel);
    profile.hold(kForever);
    return profile;
}

/// Runs an axis through its profile.
class Run {
  public:
    Run(const Axis& axis, const AxisLimits& limits)
        : profile_(axis.goal.kind == AxisGoal::Kind::Speed ? speedProfile(axis, limits)
                                                           : distanceProfile(axis, limits)),
          rest_(profile_[0].duration),
          speed_(axis.speed),
          fastest_(std::abs(axis.speed)),
          came_with_(axis.speed) {}

    /// Seconds until the acceleration changes.
    [[nodiscard]] double rest() const { return rest_; }
    [[nodiscard]] double speed() const { return speed_; }
    [[nodiscard]] double accel() const { return profile_[phase_].accel; }
    [[nodiscard]] bool atGoal() const { return phase_ + 1 == profile_.size(); }
    /// Returns the way in a time. \pre time <= rest()
    [[nodiscard]] double way(double time) const { return time * (speed_ + accel() * time / 2); }

    /// \pre time <= rest()
    void pass(double time) {
        if (atGoal() && speed_ == 0) {  // at rest from now on
            speed_ += 0.0;              // no -0 remains, as below
            return;
        }
        const Phase& phase = profile_[phase_];
        way_ += way(time);
        path_ += pathOf(time);
        hardest_ = std::max(hardest_, std::abs(phase.accel));
        rest_ -= time;
        if (rest_ <= kInstant) {
            speed_ = phase.speed;
            rest_ = profile_[++phase_].duration;
        } else {
            speed_ += phase.accel * time;
        }
        fastest_ = std::max(fastest_, std::abs(speed_));
        reverses_ = reverses_ || speed_ * came_with_ < 0;
        if (speed_ != 0) came_with_ = speed_;
    }

    /// Returns the axis after all passed times.
    [[nodiscard]] Axis after(const Axis& from) const {
        Axis axis{from.goal, speed_, accel()};
        if (axis.goal.kind == AxisGoal::Kind::Distance)
            axis.goal.value = atGoal() ? 0 : axis.goal.value - way_;
        return axis;
    }
    [[nodiscard]] double path() const { return path_; }
    [[nodiscard]] double fastest() const { return fastest_; }  // of all speeds so far
    [[nodiscard]] double hardest() const { return hardest_; }  // of all accelerations so far
    [[nodiscard]] bool reverses() const { return reverses_; }

  private:
    [[nodiscard]] double pathOf(double time) const {
        const double end = speed_ + accel() * time;
        if (speed_ * end >= 0) return std::abs(way(time));
        return (speed_ * speed_ + end * end) / (2 * std::abs(accel()));
    }

    Profile profile_;
    std::size_t phase_ = 0;
    double rest_, speed_;
    double way_ = 0, path_ = 0, fastest_, hardest_ = 0;
    double came_with_;  // the last speed that was not 0
    bool reverses_ = false;
};

/// Radians up to which four terms of Taylor's series are accurate to rounding: steps usually turn
/// by less.
constexpr double kLittle = 0.03;

double sinc(double x) {
    if (std::abs(x) > kLittle) return std::sin(x) / x;
    const double square = x * x;
    return 1 - square * (1.0 / 6) * (1 - square * (1.0 / 20) * (1 - square * (1.0 / 42)));
}

/// Computes both of an angle in radians.
CosSin cosSinOf(double x) {
    if (std::abs(x) > kLittle) return {std::cos(x), std::sin(x)};
    const double square = x * x;
    return {1 - square * 0.5 * (1 - square * (1.0 / 12) * (1 - square * (1.0 / 30))), x * sinc(x)};
}

/// Converts a vector from the frame that faces along `forward`.
Vec2 turned(Vec2 local, Vec2 forward) {
    return local.x * forward + local.y * perpendicular(forward);
}

/// A speed along the heading and one to its left, each with its acceleration.
struct Velocity {
    Vec2 speed, accel;
};

/// Points in [-1, 1] and their weights, by Gauss and Legendre.
template <std::size_t kCount>
struct Rule {
    std::array<double, kCount> nodes, weights;
};
constexpr Rule<3> kThree = {{-0.7745966692414834, 0, 0.7745966692414834},
                            {5.0 / 9, 8.0 / 9, 5.0 / 9}};
constexpr Rule<5> kFive = {
    {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831, 0.9061798459386640},
    {0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
     0.2369268850561891}};

/// Computes the displacement from time `begin` on for twice `half`.
template <std::size_t kCount>
Vec2 quadrature(const Rule<kCount>& rule, const Velocity& velocity, double rate, double rate_accel,
                double begin, double half) {
    Vec2 sum;
    for (std::size_t i = 0; i < kCount; ++i) {
        const double t = begin + half * (1 + rule.nodes[i]);
        const auto [cos, sin] = cosSinOf(t * (rate + rate_accel * t / 2));
        sum =
            sum + half * rule.weights[i] * turned(velocity.speed + t * velocity.accel, {cos, sin});
    }
    return sum;
}

/// Computes the displacement while speeds and rate of turning (radians) change, in a frame that
/// faces along the heading of the start.
Vec2 quadrature(const Velocity& velocity, double rate, double rate_accel, double time) {
    const double turn = std::max(std::abs(rate), std::abs(rate + rate_accel * time)) * time;
    if (turn <= kLittleTurn && std::abs(rate_accel) * time * time <= kLittleBend * kLittleBend)
        return quadrature(kThree, velocity, rate, rate_accel, 0, time / 2);
    const double pieces = std::ceil(
        std::max({1.0, turn / kMaxTurn, std::sqrt(std::abs(rate_accel)) * time / kMaxBend}));
    Vec2 sum;
    for (double piece = 0; piece < pieces; ++piece)
        sum = sum + quadrature(kFive, velocity, rate, rate_accel, piece * time / pieces,
                               time / pieces / 2);
    return sum;
}

bool rests(const Run& run) { return run.speed() == 0 && run.accel() == 0; }

/// \param forward unit vector along the heading of the start
Vec2 displacement(Vec2 forward, const Run& drive, const Run& side, const Run& turn, double time) {
    const bool constant = drive.accel() == 0 && side.accel() == 0 && turn.accel() == 0;
    if (constant || rests(turn)) {
        // Along the heading in the middle of an arc; a straight way is an arc of no turn.
        const double half = Angle::degrees(turn.way(time) / 2).radians();
        const auto [cos, sin] = cosSinOf(half);
        return sinc(half) * turned({drive.way(time), side.way(time)}, turned({cos, sin}, forward));
    }
    const Velocity velocity{{drive.speed(), side.speed()}, {drive.accel(), side.accel()}};
    return turned(quadrature(velocity, Angle::degrees(turn.speed()).radians(),
                             Angle::degrees(turn.accel()).radians(), time),
                  forward);
}

void setDeviation(Advance& to, const Run& drive, const Run& side, const Run& turn,
                  double duration) {
    // A motion of acceleration at most a deviates from a uniform one by at most a T^2 / 8.
    const double rate = Angle::degrees(turn.fastest()).radians();
    const double accel =
        drive.hardest() + side.hardest() + (drive.fastest() + side.fastest()) * rate;
    to.lag = std::min(accel * duration * duration / 8, to.path);
    const bool one_way = drive.path() == 0 || side.path() == 0;
    const bool straight = rate == 0 && one_way && !drive.reverses() && !side.reverses();
    to.bulge = straight ? 0 : std::min(to.lag, to.path / 2);
}

/// Returns true for a straight way at a constant speed, which most steps of people are: advance()
/// computes the same from such a state in a fraction of the time.
bool isSteady(const Motion& motion, const MotionLimits& limits) {
    const auto keeps = [](const Axis& axis, double speed, const AxisLimits& most) {
        return axis.goal.kind == AxisGoal::Kind::Speed && axis.speed == speed &&
               std::clamp(axis.goal.value, -most.max, most.max) == speed;
    };
    return keeps(motion.drive, motion.drive.speed, limits.drive) &&
           keeps(motion.turn, 0, limits.turn) && keeps(motion.side, 0, limits.side) &&
           std::abs(motion.pose.heading.degrees()) < 180;
}

}  // namespace

MotionLimits limitsOf(const RobotModel& model, double friction) {
    const double share = 1 - friction;
    return {{share * model.speed, share * model.max_speed, share * model.accel},
            {share * model.rotspeed.degrees(), share * model.max_rotspeed.degrees(),
             share * model.rotaccel.degrees()},
            {share * model.max_sidespeed, share * model.max_sidespeed, share * model.accel}};
}

MotionLimits narrowed(const MotionLimits& model, const MotionLimits& order, double friction) {
    const auto narrow = [friction](const AxisLimits& axis, const AxisLimits& own) {
        const double most = std::min(axis.max, (1 - friction) * own.max);
        return AxisLimits{std::min(most, (1 - friction) * own.top), most,
                          (1 - friction) * own.accel};
    };
    return {narrow(model.drive, order.drive), narrow(model.turn, order.turn), model.side};
}

void Motion::command(const Command& command) {
    const auto speed_of = [](const Axis& axis) {
        return axis.goal.kind == AxisGoal::Kind::Speed ? axis.goal : AxisGoal{};
    };
    const auto turn_by = [&](double degrees) {
        drive.goal = side.goal = {};
        turn.goal = {AxisGoal::Kind::Distance, degrees};
        turn_end = wrapped(pose.heading + Angle::degrees(degrees));
    };
    const auto drive_by = [&](double metres) {
        drive.goal = {AxisGoal::Kind::Distance, metres};
        turn.goal = side.goal = {};
    };
    switch (command.verb) {
        case Verb::Forward:
            return drive_by(command.value);
        case Verb::Backward:
            return drive_by(-command.value);
        case Verb::Left:
            return turn_by(command.value);
        case Verb::Right:
            return turn_by(-command.value);
        case Verb::Speed:
            turn.goal = speed_of(turn);
            side.goal = speed_of(side);
            drive.goal = {AxisGoal::Kind::Speed, command.value};
            return;
        case Verb::Rotspeed:
            drive.goal = speed_of(drive);
            side.goal = speed_of(side);
            turn.goal = {AxisGoal::Kind::Speed, command.value};
            return;
        case Verb::Sidespeed:
            drive.goal = speed_of(drive);
            turn.goal = speed_of(turn);
            side.goal = {AxisGoal::Kind::Speed, command.value};
            return;
        case Verb::Stop:
        case Verb::Path:
        case Verb::Goto:
            drive.goal = turn.goal = side.goal = {};
            return;
    }
}

void Motion::steer(const WheelOrder& order) {
    side.goal = {};
    if (order.drive) drive.goal = *order.drive;
    if (!order.turn) return;
    turn.goal = *order.turn;
    if (turn.goal.kind == AxisGoal::Kind::Distance)
        turn_end = wrapped(pose.heading + Angle::degrees(turn.goal.value));
}

bool Motion::arrived() const {
    const auto rests = [](const Axis& axis) { return axis.speed == 0 && axis.goal.value == 0; };
    return rests(drive) && rests(turn) && rests(side);
}

void Motion::halt() { drive = turn = side = {}; }

/// Runs the axes from one change of acceleration to the next.
Advance advance(const Motion& from, const MotionLimits& limits, const double duration) {
    Advance to{.motion = from};
    if (!(limits.drive.accel > 0 && limits.turn.accel > 0)) {
        to.motion.drive = {.goal = from.drive.goal};
        to.motion.turn = {.goal = from.turn.goal};
        to.motion.side = {.goal = from.side.goal};
        return to;
    }
    if (duration > 0 && isSteady(from, limits)) {
        Motion& motion = to.motion;
        const double way = duration * from.drive.speed;
        if (way != 0) motion.pose.position = from.pose.position + way * from.forward();
        motion.pose.heading = from.pose.heading + Angle();  // no -0 remains, as below
        for (Axis* const axis : {&motion.drive, &motion.turn, &motion.side}) {
            axis->speed += 0.0;
            axis->accel = 0;
        }
        to.path = std::abs(way);
        return to;
    }
    Run drive(from.drive, limits.drive), turn(from.turn, limits.turn), side(from.side, limits.side);
    Pose2& pose = to.motion.pose;
    double left = duration;
    while (left > 0) {
        const double time = std::min({left, drive.rest(), turn.rest(), side.rest()});
        if (!rests(drive) || !rests(side))
            pose.position =
                pose.position + displacement(to.motion.forward(), drive, side, turn, time);
        pose.heading = pose.heading + Angle::degrees(turn.way(time));
        drive.pass(time);
        turn.pass(time);
        side.pass(time);
        left -= time;
    }
    to.motion.drive = drive.after(from.drive);
    to.motion.turn = turn.after(from.turn);
    to.motion.side = side.after(from.side);
    const bool turned = from.turn.goal.kind == AxisGoal::Kind::Distance && turn.atGoal();
    if (turned)
        pose.heading = from.turn_end;
    else if (std::abs(pose.heading.degrees()) >= 180)  // rare, and a remainder is slow
        pose.heading = wrapped(pose.heading);
    to.path = drive.path() + side.path();
    setDeviation(to, drive, side, turn, duration);
    return to;
}

}  // namespace ispace
