// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/test_layout.h"

namespace ispace {

namespace motion_test {

using testing::scene;

TEST(FrictionMap, LastFloorHolds) {
    const Scene room = scene(
        "ispace size=20,20\n"
        "floor size=20,20 kind=checker\n"
        "floor at=2,0 size=4,2 friction=0.5\n"
        "floor at=2,0 size=1,1 heading=45 friction=0.25\n"
        "floor at=3.5,0 size=0.2,0.2\n");
    const FrictionMap friction(room.environment);
    EXPECT_FALSE(friction.empty());
    EXPECT_EQ(friction.at({0.5, 0.5}), 0.5);
    EXPECT_EQ(friction.at({2, 0}), 0.25);
    EXPECT_EQ(friction.at({2, 0.7}), 0.25);  // a corner of the turned square
    EXPECT_EQ(friction.at({2.45, 0.45}), 0.5);
    EXPECT_EQ(friction.at({3.5, 0}), 0);  // a smooth plate on the rough floor
    EXPECT_EQ(friction.at({0, 1}), 0.5);  // the edge belongs to it
    EXPECT_EQ(friction.at({-0.001, 0}), 0);
}

TEST(FrictionMap, NoFloorHasNone) {
    const Scene room = scene("ispace size=20,20\nfloor size=4,4\n");
    const FrictionMap friction(room.environment);
    EXPECT_TRUE(friction.empty());
    EXPECT_EQ(friction.at({0, 0}), 0);
}

constexpr double kTight = 1e-9;
/// speed 0.5, max 1.6, accel 0.3; rotspeed 100, max 300, rotaccel 100.
const RobotModel kModel;

Motion moving(double speed, double rotspeed = 0) {
    Motion motion;
    motion.drive.speed = motion.drive.goal.value = speed;
    motion.turn.speed = motion.turn.goal.value = rotspeed;
    return motion;
}

Motion commanded(Motion motion, Verb verb, double value) {
    motion.command({verb, value});
    return motion;
}

Motion after(Motion motion, double duration, double step = 0.005, double friction = 0) {
    const MotionLimits limits = limitsOf(kModel, friction);
    const auto steps = std::lround(duration / step);
    for (long i = 0; i < steps; ++i) motion = advance(motion, limits, step).motion;
    return motion;
}

/// When it has arrived, by halving; within one step so that the moment itself is found.
double timeToArrive(const Motion& motion, double friction = 0) {
    const MotionLimits limits = limitsOf(kModel, friction);
    double early = 0, late = 1000;
    for (int i = 0; i < 100; ++i) {
        const double middle = (early + late) / 2;
        (advance(motion, limits, middle).motion.arrived() ? late : early) = middle;
    }
    return late;
}

void expectNear(const Pose2& pose, double x, double y, double heading, double tolerance = kTight) {
    EXPECT_NEAR(pose.position.x, x, tolerance);
    EXPECT_NEAR(pose.position.y, y, tolerance);
    EXPECT_NEAR(wrapped(pose.heading - Angle::degrees(heading)).degrees(), 0, tolerance);
}

TEST(Motion, GoesStraight) {
    Motion motion = moving(0.8);
    motion.pose = {{1, 2}, Angle::degrees(90)};
    motion = after(motion, 3);
    EXPECT_EQ(motion.pose.position.x, 1);
    expectNear(motion.pose, 1, 4.4, 90);
}

TEST(Motion, SteadyWaysHaveTheBitsOfOthers) {
    const MotionLimits limits = limitsOf(kModel, 0);
    for (const double speed : {0.0, -0.0, 0.7, -0.3})
        for (const double heading : {0.0, -0.0, 33.7, -179.9, 180.0}) {
            Motion motion = moving(speed);
            motion.pose = {{0.1, -0.2}, Angle::degrees(heading)};
            motion.turn_end = motion.pose.heading + Angle();
            Motion turned = motion;  // by no angle
            turned.turn.goal.kind = AxisGoal::Kind::Distance;
            const Advance steady = advance(motion, limits, 0.1),
                          other = advance(turned, limits, 0.1);
            EXPECT_EQ(steady.motion.pose, other.motion.pose);
            EXPECT_EQ(std::signbit(steady.motion.pose.heading.degrees()),
                      std::signbit(other.motion.pose.heading.degrees()));
            EXPECT_EQ(steady.motion.drive.speed, other.motion.drive.speed);
            EXPECT_EQ(std::signbit(steady.motion.drive.speed),
                      std::signbit(other.motion.drive.speed));
            EXPECT_EQ(steady.motion.drive.accel, other.motion.drive.accel);
            EXPECT_EQ(steady.path, other.path);
            EXPECT_EQ(steady.bulge, other.bulge);
            EXPECT_EQ(steady.lag, other.lag);
        }
}

TEST(Motion, TurnsOnTheSpot) {
    const Motion motion = after(moving(0, 100), 2.5);
    EXPECT_EQ(motion.pose.position, Point2());
    expectNear(motion.pose, 0, 0, -110);
}

TEST(Motion, FollowsAnArc) {
    for (const double step : {0.005, 0.1, 1.0}) {
        const double speed = 0.7, rate = 0.4;
        const Motion motion = after(moving(speed, Angle::radians(rate).degrees()), 6, step);
        const double radius = speed / rate, turned = rate * 6;
        expectNear(motion.pose, radius * std::sin(turned), radius * (1 - std::cos(turned)),
                   Angle::radians(turned).degrees());
    }
    // An arc of hardly any turn.
    const Motion motion = after(moving(1, 1e-7), 1, 1);
    expectNear(motion.pose, 1, Angle::degrees(1e-7).radians() / 2, 1e-7, 1e-15);
}

TEST(Motion, ReachesASpeedWithinAStep) {
    const Motion motion = advance(commanded({}, Verb::Speed, 0.15), limitsOf(kModel, 0), 1).motion;
    EXPECT_EQ(motion.drive.speed, 0.15);
    EXPECT_EQ(motion.drive.accel, 0);
    expectNear(motion.pose, 0.15 * 0.5 / 2 + 0.15 * 0.5, 0, 0);
    // Half way there.
    const Motion half = after(commanded({}, Verb::Speed, 0.15), 0.25);
    EXPECT_NEAR(half.drive.speed, 0.075, kTight);
    EXPECT_EQ(half.drive.accel, 0.3);
    EXPECT_EQ(after(commanded(moving(1), Verb::Stop, 0), 0.25).drive.accel, -0.3);
}

TEST(Motion, NeedsSquareOfSpeedToStop) {
    for (const double step : {0.005, 0.1, 1.0}) {
        const Motion motion = after(commanded(moving(1.5), Verb::Stop, 0), 6, step);
        EXPECT_TRUE(motion.arrived());
        expectNear(motion.pose, 1.5 * 1.5 / (2 * 0.3), 0, 0);
    }
}

TEST(Motion, ForwardIsATrapezoid) {
    const Motion start = commanded({}, Verb::Forward, 2);
    // To 0.5 m/s and back takes 2 * 0.5 / 0.3 s and half of what it takes at full speed.
    const double expected = 2 / 0.5 + 0.5 / 0.3;
    EXPECT_NEAR(timeToArrive(start), expected, kTight);
    expectNear(after(start, 1).pose, 0.15, 0, 0);
    EXPECT_NEAR(after(start, 2).drive.speed, 0.5, kTight);
    for (const double step : {0.005, 0.1, 1.0}) {
        EXPECT_FALSE(after(start, 5, step).arrived());
        const Motion end = after(start, 6, step);
        EXPECT_TRUE(end.arrived());
        EXPECT_EQ(end.drive.goal.value, 0);
        EXPECT_EQ(end.drive.speed, 0);
        EXPECT_EQ(end.drive.accel, 0);
        expectNear(end.pose, 2, 0, 0, 1e-11);
    }
}

TEST(Motion, ShortForwardIsATriangle) {
    const Motion start = commanded({}, Verb::Forward, 0.3);
    const double expected = 2 * std::sqrt(0.3 / 0.3);
    EXPECT_NEAR(timeToArrive(start), expected, kTight);
    EXPECT_NEAR(after(start, expected / 2).drive.speed, 0.3, kTight);
    expectNear(after(start, 2.5).pose, 0.3, 0, 0, 1e-11);
    EXPECT_TRUE(after(commanded({}, Verb::Forward, 0), 0.005).arrived());
}

TEST(Motion, ForwardFromABadStart) {
    // Backward at 0.6: 0.6 m until it stands, 2.6 m from there.
    const Motion back = commanded(moving(-0.6), Verb::Forward, 2);
    EXPECT_NEAR(timeToArrive(back), 2 + 2.6 / 0.5 + 0.5 / 0.3, kTight);
    // Twice the top speed, 3 m: down to it within 1.25 m, then 1.75 m less those of braking.
    const Motion fast = commanded(moving(1), Verb::Forward, 3);
    const double braking = 0.5 * 0.5 / 0.6;
    EXPECT_NEAR(timeToArrive(fast), 0.5 / 0.3 + (1.75 - braking) / 0.5 + 0.5 / 0.3, kTight);
    // Too fast to stop within 0.5 m: stands after 1.5 / 0.9 m, comes back as a trapezoid.
    const Motion beyond = commanded(moving(1), Verb::Forward, 0.5);
    const double over = 1 / 0.6 - 0.5;
    EXPECT_NEAR(timeToArrive(beyond), 1 / 0.3 + over / 0.5 + 0.5 / 0.3, kTight);
    for (const double step : {0.005, 0.1, 1.0}) {
        expectNear(after(back, 15, step).pose, 2, 0, 0, 1e-11);
        expectNear(after(fast, 15, step).pose, 3, 0, 0, 1e-11);
        expectNear(after(beyond, 15, step).pose, 0.5, 0, 0, 1e-11);
    }
}

TEST(Motion, BackwardMirrorsForward) {
    const Motion start = commanded({}, Verb::Backward, 2);
    EXPECT_NEAR(timeToArrive(start), timeToArrive(commanded({}, Verb::Forward, 2)), kTight);
    expectNear(after(start, 6).pose, -2, 0, 0, 1e-11);
}

TEST(Motion, TurnsEndExactly) {
    for (const double step : {0.005, 0.1, 1.0}) {
        const Motion left = after(commanded({}, Verb::Left, 90), 3, step);
        EXPECT_TRUE(left.arrived());
        EXPECT_EQ(left.pose.heading, Angle::degrees(90));
        EXPECT_EQ(left.pose.position, Point2());
        const Motion right = after(commanded(left, Verb::Right, 270), 5, step);
        EXPECT_EQ(right.pose.heading, Angle::degrees(180));
        const Motion twice = after(commanded(left, Verb::Left, 720), 10, step);
        EXPECT_TRUE(twice.arrived());
        EXPECT_EQ(twice.pose.heading, Angle::degrees(90));
    }
    // 81 degrees: a triangle of 90 degrees a second at its top.
    EXPECT_NEAR(timeToArrive(commanded({}, Verb::Left, 81)), 2 * std::sqrt(81.0 / 100), kTight);
    EXPECT_NEAR(timeToArrive(commanded({}, Verb::Right, 250)), 3.5, kTight);
}

TEST(Motion, AxesKeepTheirGoals) {
    Motion motion = commanded(commanded({}, Verb::Speed, 0.4), Verb::Rotspeed, 30);
    EXPECT_EQ(motion.drive.goal.value, 0.4);
    EXPECT_EQ(motion.turn.goal.value, 30);
    motion.command({Verb::Stop, 0});
    EXPECT_EQ(motion.drive.goal.value, 0);
    EXPECT_EQ(motion.turn.goal.value, 0);
    // What comes to an end leaves no goal behind.
    motion = commanded(commanded({}, Verb::Forward, 5), Verb::Rotspeed, 30);
    EXPECT_EQ(motion.drive.goal.kind, AxisGoal::Kind::Speed);
    EXPECT_EQ(motion.drive.goal.value, 0);
    motion = commanded(commanded({}, Verb::Left, 50), Verb::Speed, 0.2);
    EXPECT_EQ(motion.turn.goal.kind, AxisGoal::Kind::Speed);
    EXPECT_EQ(motion.turn.goal.value, 0);
}

TEST(Motion, ForwardEndsTheTurning) {
    const Motion start = commanded(moving(0.2, 200), Verb::Forward, 0.1);
    // Turning takes the longer time: 2 s.
    EXPECT_NEAR(timeToArrive(start), 2, kTight);
    const Motion end = after(start, 2.5);
    EXPECT_EQ(end.turn.speed, 0);
    EXPECT_NEAR(end.pose.heading.degrees(), wrapped(Angle::degrees(200)).degrees(), kTight);
}

TEST(Motion, FrictionTakesItsShare) {
    const MotionLimits limits = limitsOf(kModel, 0.5);
    EXPECT_EQ(limits.drive.top, 0.25);
    EXPECT_EQ(limits.drive.max, 0.8);
    EXPECT_EQ(limits.drive.accel, 0.15);
    EXPECT_EQ(limits.turn.top, 50);
    EXPECT_EQ(limits.turn.max, 150);
    EXPECT_EQ(limits.turn.accel, 50);
    EXPECT_NEAR(timeToArrive(commanded({}, Verb::Forward, 2), 0.5), 2 / 0.25 + 0.25 / 0.15, kTight);
    // The goal outlives the floor.
    const Motion slow = after(commanded(moving(1.2), Verb::Speed, 1.2), 5, 0.005, 0.5);
    EXPECT_EQ(slow.drive.speed, 0.8);
    EXPECT_EQ(after(slow, 5).drive.speed, 1.2);
    // Where all movers stand.
    const Advance stuck = advance(moving(1, 50), limitsOf(kModel, 1), 0.5);
    EXPECT_EQ(stuck.motion.pose, Pose2());
    EXPECT_EQ(stuck.motion.drive.speed, 0);
    EXPECT_EQ(stuck.motion.turn.speed, 0);
    EXPECT_EQ(stuck.path, 0);
}

/// Eq. (5.1)-(5.4) by many small steps of Runge-Kutta; Simpson's rule, as nothing feeds back.
Point2 integrated(const Motion& start, double accel, double rotaccel, double duration) {
    const int steps = 20000;
    const double h = duration / steps;
    const double rate = Angle::degrees(start.turn.speed).radians();
    const double rate_accel = Angle::degrees(rotaccel).radians();
    const auto velocity = [&](double t) {
        const double heading = start.pose.heading.radians() + rate * t + rate_accel * t * t / 2;
        return (start.drive.speed + accel * t) * Vec2{std::cos(heading), std::sin(heading)};
    };
    Vec2 sum;
    for (int i = 0; i < steps; ++i) {
        const double t = i * h;
        sum = sum + (h / 6) * (velocity(t) + 4 * velocity(t + h / 2) + velocity(t + h));
    }
    return start.pose.position + sum;
}

TEST(Motion, CurvesAgreeWithFineIntegration) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> speed(-1.6, 1.6), rate(-300, 300), any(-180, 180);
    for (int i = 0; i < 40; ++i) {
        Motion start = moving(speed(random), rate(random));
        start.pose = {{speed(random), speed(random)}, Angle::degrees(any(random))};
        // Goals too far to be reached within the time.
        const double sign = i % 2 == 0 ? 1 : -1, rotsign = i % 3 == 0 ? 1 : -1;
        start.drive.goal.value = sign * 1e6;
        start.turn.goal.value = rotsign * 1e6;
        MotionLimits limits = limitsOf(kModel, 0);
        limits.drive.max = limits.turn.max = 1e6;
        const Point2 expected = integrated(start, sign * 0.3, rotsign * 100, 1);
        for (const int steps : {1, 7, 200}) {
            Motion motion = start;
            for (int k = 0; k < steps; ++k) motion = advance(motion, limits, 1.0 / steps).motion;
            EXPECT_NEAR(distance(motion.pose.position, expected), 0, 2e-13) << i << ' ' << steps;
        }
    }
}

TEST(Motion, HalvesMakeTheWhole) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> speed(-1.6, 1.6), rate(-300, 300), share(0, 1);
    const MotionLimits limits = limitsOf(kModel, 0.2);
    for (int i = 0; i < 300; ++i) {
        Motion start = moving(speed(random), rate(random));
        const auto verb = static_cast<Verb>(i % 7);
        const bool turn = verb == Verb::Left || verb == Verb::Right || verb == Verb::Rotspeed;
        start.command({verb, (turn ? 100 : 1) * share(random)});
        const double time = 3 * share(random), part = share(random) * time;
        const Motion whole = advance(start, limits, time).motion;
        const Motion both =
            advance(advance(start, limits, part).motion, limits, time - part).motion;
        EXPECT_NEAR(distance(whole.pose.position, both.pose.position), 0, 1e-11);
        EXPECT_NEAR(wrapped(whole.pose.heading - both.pose.heading).degrees(), 0, kTight);
        EXPECT_NEAR(whole.drive.speed, both.drive.speed, kTight);
        EXPECT_NEAR(whole.turn.speed, both.turn.speed, kTight);
        EXPECT_EQ(whole.arrived(), both.arrived());
    }
}

TEST(Motion, StaysWithinWhatItTellsOfItsChord) {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> speed(-1.6, 1.6), rate(-300, 300), share(0, 1);
    const MotionLimits limits = limitsOf(kModel, 0);
    for (int i = 0; i < 300; ++i) {
        Motion start = moving(speed(random), i % 3 == 0 ? 0 : rate(random));
        start.command({i % 2 == 0 ? Verb::Speed : Verb::Forward, share(random)});
        const double time = share(random);
        const Advance whole = advance(start, limits, time);
        const Vec2 chord = whole.motion.pose.position - start.pose.position;
        EXPECT_GE(whole.path, length(chord) - 1e-12);
        double path = 0;
        Point2 last = start.pose.position;
        for (int k = 1; k <= 100; ++k) {
            const Point2 p = advance(start, limits, time * k / 100).motion.pose.position;
            path += distance(last, p);
            last = p;
            const Vec2 from_start = p - start.pose.position;
            const double along = length(chord) > 0 ? dot(from_start, chord) / dot(chord, chord) : 0;
            const Vec2 nearest = std::min(1.0, std::max(0.0, along)) * chord;
            EXPECT_LE(length(from_start - nearest), whole.bulge + 1e-12);
            EXPECT_LE(length(from_start - (k / 100.0) * chord), whole.lag + 1e-12);
        }
        EXPECT_LE(path, whole.path + 1e-12);
        EXPECT_NEAR(path, whole.path, 1e-2 * whole.path + 1e-9);
    }
    EXPECT_EQ(advance(moving(1), limits, 0.5).bulge, 0);
    EXPECT_EQ(advance(moving(1), limits, 0.5).lag, 0);
    EXPECT_EQ(advance(commanded(moving(1), Verb::Stop, 0), limits, 0.5).bulge, 0);
}

}  // namespace motion_test

}  // namespace ispace
