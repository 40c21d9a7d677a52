// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/pace.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "base/error.h"
#include "sim/run_limits.h"
#include "support/test_layout.h"

namespace ispace {
namespace pace_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

bool always(const std::string& /*id*/) { return true; }

TEST(Pace, IsMeasuredOverASecond) {
    Pace pace;
    Pace::Moment now{};
    for (int i = 0; i < 99; ++i) {
        now += milliseconds(10);
        pace.worked({milliseconds(3), milliseconds(1), milliseconds(10)}, now);
    }
    EXPECT_EQ(pace.load(always).all, 0) << "not a whole second yet";
    pace.worked({milliseconds(3), milliseconds(1), milliseconds(10)}, now);
    EXPECT_NEAR(pace.load(always).all, 0.3, 1e-9);
    EXPECT_NEAR(pace.load(always).reading, 0.1, 1e-9);
    // A world that is far behind is measured all the same.
    for (int i = 0; i < 20; ++i) {
        now += milliseconds(200);
        pace.worked({milliseconds(200), milliseconds(100), milliseconds(10)}, now);
    }
    EXPECT_NEAR(pace.load(always).all, 20, 1e-9);
    pace.restarted();
    EXPECT_EQ(pace.load(always).all, 0);
}

TEST(Pace, WhatIsAddedCountsUntilItIsMeasured) {
    const Scene scene = testing::scene("ispace size=8,6\n", "laser id=m at=0,0 rate=200\n");
    Pace pace;
    pace.added({&scene.sensors[0]}, std::chrono::microseconds(500));
    EXPECT_NEAR(pace.load(always).all, 0.2, 1e-9);
    EXPECT_EQ(pace.load([](const std::string& id) { return id != "m"; }).all, 0) << "removed since";
    // One of the same id in another world counts by itself, and only its world knows of its end.
    const auto* const other = reinterpret_cast<const World*>(&scene);
    pace.added({&scene.sensors[0]}, std::chrono::microseconds(500), other);
    EXPECT_NEAR(pace.load(always).all, 0.4, 1e-9);
    EXPECT_NEAR(pace.load([](const std::string&) { return false; }).all, 0.2, 1e-9);
    EXPECT_NEAR(pace.load([](const std::string&) { return false; }, other).all, 0.2, 1e-9);
    Pace::Moment now{};
    for (int i = 0; i < 2; ++i)
        pace.worked({milliseconds(100), milliseconds(90), seconds(1)}, now += seconds(1));
    EXPECT_NEAR(pace.load(always).all, 0.1, 1e-9) << "as measured";
}

TEST(Pace, ReadingsThatAreMadeMoreOftenCountAtOnce) {
    const Scene scene = testing::scene("ispace size=8,6\n", "laser id=m at=0,0 rate=1\n");
    Pace pace;
    pace.worked({milliseconds(30), milliseconds(20), seconds(1)}, {});
    pace.added({&scene.sensors[0]}, milliseconds(5));
    pace.rescaled(10);
    EXPECT_NEAR(pace.load(always).all, 0.01 + 0.2 + 0.1, 1e-9) << "steps, readings, first readings";
    EXPECT_NEAR(pace.load(always).reading, 0.3, 1e-9);
}

TEST(Pace, AWorldBehindItRefusesMore) {
    const RunLoad few{.records = 3, .readings = 10}, more{.records = 4, .readings = 10},
        faster{.records = 3, .readings = 20};
    EXPECT_NO_THROW(checkPace(few, more, Pace::kMost));
    EXPECT_NO_THROW(checkPace(more, few, 2)) << "less is welcome";
    EXPECT_NO_THROW(checkPace(few, few, 2)) << "so is a robot that is moved";
    EXPECT_THROW(checkPace(few, more, 2), OverLimit);
    EXPECT_THROW(checkPace(few, faster, 2), OverLimit);
}

}  // namespace pace_test
}  // namespace ispace
