// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/passages/lift.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ispace::passages {
namespace lift_test {

constexpr SimTime kStep = std::chrono::milliseconds(5);

/// Advances until the lift is in a phase; returns the seconds that took, or -1.
double until(Lift& lift, Lift::Phase phase, SimTime& time) {
    const SimTime from = time;
    for (int i = 0; i < 100'000; ++i) {
        if (lift.phase() == phase) return seconds(time - from);
        time += kStep;
        lift.advance(time, false);
    }
    return -1;
}

TEST(Lift, RidesByTheClosedForm) {
    // At 1 m/s and 1 m/s2 over 3 m: a second up to speed over half a metre, 2 s, a second down.
    EXPECT_DOUBLE_EQ(liftRide(3, 1), 4);
    // It never reaches 10 m/s.
    EXPECT_DOUBLE_EQ(liftRide(4, 10), 4);
    EXPECT_DOUBLE_EQ(liftRide(0, 1), 0);
    for (const double speed : {0.3, 1.0, 1.6, 10.0}) {
        for (const double way : {0.1, 1.0, 2.8, 30.0}) {
            const double whole = liftRide(way, speed);
            EXPECT_DOUBLE_EQ(liftPath(way, speed, 0), 0);
            EXPECT_DOUBLE_EQ(liftPath(way, speed, whole), way);
            EXPECT_NEAR(liftPath(way, speed, whole / 2), way / 2, 1e-12);
            double before = 0;
            for (int i = 1; i <= 1000; ++i) {
                const double now = liftPath(way, speed, whole * i / 1000);
                EXPECT_GE(now, before);
                EXPECT_LE(now - before, speed * whole / 1000 * (1 + 1e-9));
                before = now;
            }
        }
    }
}

TEST(Lift, TakesTheTimesOfDoorsAndRide) {
    Lift lift({.floors = {0, 3.2, 6}, .speed = 1.6, .door = 0.9});
    SimTime time{};
    lift.call(2);
    lift.advance(time, false);
    ASSERT_EQ(lift.phase(), Lift::Phase::Riding);
    const double step = seconds(kStep);
    EXPECT_NEAR(until(lift, Lift::Phase::Opening, time), 6 / 1.6 + 1.6, step);
    EXPECT_EQ(lift.stop(), 2U);
    EXPECT_NEAR(until(lift, Lift::Phase::Open, time), 1.5, step);
    EXPECT_NEAR(until(lift, Lift::Phase::Closing, time), seconds(Lift::kDwell), step);
    EXPECT_NEAR(until(lift, Lift::Phase::Waiting, time), 1.5, step);
    EXPECT_DOUBLE_EQ(lift.height(time), 6);
    EXPECT_TRUE(lift.calls().empty());
}

TEST(Lift, ServesCallsInTheirOrderOnce) {
    Lift lift({.floors = {0, 3, 6}});
    for (const std::size_t stop : {2U, 0U, 1U, 2U, 0U}) lift.call(stop);
    EXPECT_EQ(lift.calls().size(), 3U);
    SimTime time{};
    std::vector<std::size_t> served;
    for (int i = 0; i < 20'000; ++i, time += kStep) {
        const bool was_open = lift.phase() == Lift::Phase::Open;
        lift.advance(time, false);
        if (!was_open && lift.phase() == Lift::Phase::Open) served.push_back(lift.stop());
    }
    EXPECT_EQ(served, (std::vector<std::size_t>{2, 0, 1}));
    EXPECT_EQ(lift.phase(), Lift::Phase::Waiting);
}

TEST(Lift, KeepsItsDoorsOpenAtAStop) {
    Lift lift({.floors = {0, 3, 6}});
    SimTime time{};
    lift.call(2);
    lift.hold(1);
    until(lift, Lift::Phase::Open, time);
    EXPECT_TRUE(lift.isOpenAt(1)) << "before calls";
    EXPECT_EQ(lift.calls(), std::vector<std::size_t>{2});
    lift.call(0);
    EXPECT_EQ(until(lift, Lift::Phase::Closing, time), -1);
    lift.hold(0);
    EXPECT_GE(until(lift, Lift::Phase::Riding, time), 0);
    until(lift, Lift::Phase::Open, time);
    EXPECT_TRUE(lift.isOpenAt(0));
    lift.hold(std::nullopt);
    EXPECT_GE(until(lift, Lift::Phase::Riding, time), 0);
    until(lift, Lift::Phase::Open, time);
    EXPECT_TRUE(lift.isOpenAt(2)) << "calls of others follow";
}

TEST(Lift, OpensWhereItStandsAndIsHeld) {
    Lift lift({.floors = {0, 3}});
    SimTime time{};
    lift.call(0);
    until(lift, Lift::Phase::Open, time);
    EXPECT_TRUE(lift.isOpenAt(0));
    EXPECT_FALSE(lift.isOpenAt(1));
    for (int i = 0; i < 10'000; ++i) lift.advance(time += kStep, true);
    EXPECT_EQ(lift.phase(), Lift::Phase::Open);
    EXPECT_DOUBLE_EQ(lift.opening(time), 1);
    lift.advance(time += kStep, false);
    EXPECT_EQ(lift.phase(), Lift::Phase::Closing);
    time += std::chrono::milliseconds(750);
    EXPECT_NEAR(lift.opening(time), 0.5, 1e-9);
}

}  // namespace lift_test
}  // namespace ispace::passages
