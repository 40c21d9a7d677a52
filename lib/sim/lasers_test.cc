// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/lasers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "layout/test_layout.h"

namespace ispace {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using testing::scene;

TEST(Periods, RatesAreDecimals) {
    EXPECT_EQ(Periods(10).begin(3), milliseconds(300));
    EXPECT_EQ(Periods(7).begin(1), nanoseconds(142857143));
    EXPECT_EQ(Periods(7).begin(7), seconds(1));
    // The doubles nearest to 0.3 and 0.7 lie below them: their own periods would begin later.
    EXPECT_EQ(Periods(0.3).begin(3), seconds(10));
    EXPECT_EQ(Periods(0.7).begin(7), seconds(10));
    EXPECT_EQ(Periods(12.5).begin(1), milliseconds(80));
    EXPECT_EQ(Periods(1.0 / 3).begin(1), nanoseconds(3000000001));
    EXPECT_EQ(Periods(0.1).newest(seconds(9)), 0);
    EXPECT_EQ(Periods(0.1).newest(seconds(10)), 1);
    // After a century.
    const SimTime late = std::chrono::hours(24 * 36525);
    EXPECT_EQ(Periods(7).newest(late), 7LL * 3600 * 24 * 36525);
    EXPECT_EQ(Periods(1e5).newest(late), 100000LL * 3600 * 24 * 36525);
    EXPECT_EQ(Periods(1e-300).newest(late), 0);
    EXPECT_EQ(Periods(1e-300).begin(0), SimTime(0));
    EXPECT_GT(Periods(1e-300).begin(1), late);
}

TEST(Periods, BeginWhereTheyAreNewest) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> exponent(-9, 5);
    std::uniform_int_distribution<int> period(0, 1000000);
    for (int i = 0; i < 2000; ++i) {
        double rate = std::pow(10, exponent(random));
        if (i % 2 == 0) rate = std::max(1e-3, std::round(rate * 1000) / 1000);
        const Periods periods(rate);
        const std::int64_t k = period(random) % (1 + static_cast<int>(std::min(1e9 * rate, 1e6)));
        const SimTime begin = periods.begin(k);
        ASSERT_EQ(periods.newest(begin), k) << rate;
        if (k > 0) {
            ASSERT_EQ(periods.newest(begin - nanoseconds(1)), k - 1) << rate;
        }
        ASSERT_NEAR(static_cast<double>(begin.count()) * rate / 1e9, static_cast<double>(k),
                    1e-9 * static_cast<double>(k) + rate / 1e9);
    }
}

TEST(LaserReader, ReadsAtTheFirstStepOfAPeriod) {
    for (const int rate : {10, 40, 7}) {
        const Scene room = scene("ispace size=8,6\n",
                                 "laser id=a at=0,0 beams=3 rate=" + std::to_string(rate) + "\n");
        for (const SimTime step : {milliseconds(5), milliseconds(3)}) {
            World world(room, step);
            ASSERT_EQ(world.read().size(), 1U);
            EXPECT_EQ(world.reading(0).seq, 0);
            EXPECT_EQ(world.reading(0).time, SimTime(0));
            std::int64_t next = 1;
            for (int i = 1; i <= 1500; ++i) {
                world.step();
                // Period k begins at k / rate seconds.
                const bool due = i * step.count() * rate >= next * 1'000'000'000;
                ASSERT_EQ(world.read().size(), due ? 1U : 0U) << i;
                if (!due) continue;
                const SensorReading& reading = world.reading(0);
                ASSERT_EQ(reading.seq, next);
                ASSERT_EQ(reading.time, i * step);
                ASSERT_EQ(reading.scan.time, ispace::seconds(i * step));
                ASSERT_EQ(reading.scan.frame, next);
                ++next;
            }
        }
    }
}

TEST(LaserReader, ALongStepTakesTheNewest) {
    const Scene room =
        scene("ispace size=8,6\n", "laser id=a at=0,0 rate=40\nlaser id=b at=1,0 rate=0.5\n");
    World world(room, seconds(1));
    EXPECT_EQ(world.read().size(), 2U);
    world.step();
    ASSERT_EQ(world.read().size(), 1U);
    EXPECT_EQ(world.read()[0], 0U);
    EXPECT_EQ(world.reading(0).seq, 40);
    world.step();
    ASSERT_EQ(world.read().size(), 2U);
    EXPECT_EQ(world.reading(0).seq, 80);
    EXPECT_EQ(world.reading(1).seq, 1);
    EXPECT_EQ(world.reading(1).time, seconds(2));
}

TEST(LaserReader, GoesWithItsRobotAndDoesNotSeeIt) {
    const Scene room = scene("ispace size=8,6\n",
                             "robot id=r1 at=-1,0\n"
                             "laser id=own on=r1 at=0.1,0 fov=180 step=90\n"
                             "laser id=wall at=-3,0 fov=180 step=90\n");
    World world(room, milliseconds(100));
    const auto ahead = [&](std::size_t laser) { return world.reading(laser).scan.ranges.at(1); };
    EXPECT_NEAR(ahead(0), 4.9, 1e-6);
    EXPECT_NEAR(ahead(1), 1.7, 1e-6);
    world.command(0, {Verb::Forward, 1});
    for (int i = 0; i < 60; ++i) world.step();
    EXPECT_NEAR(world.reading(0).sensor.pose.position.x, 0.1, 1e-9);
    EXPECT_EQ(world.reading(0).time, seconds(6));
    EXPECT_NEAR(ahead(0), 3.9, 1e-6);
    EXPECT_NEAR(ahead(1), 2.7, 1e-6);
    world.command(0, {Verb::Left, 90});
    for (int i = 0; i < 60; ++i) world.step();
    EXPECT_EQ(world.reading(0).sensor.pose.heading, Angle::degrees(90));
    EXPECT_NEAR(ahead(0), 2.9, 1e-6);
    // Scene and lasers() keep the start.
    EXPECT_NEAR(world.lasers()[0].pose.position.x, -0.9, 1e-12);
}

TEST(LaserReader, ATiltedOneOnARobotSeesThroughClearGlass) {
    for (const char* const glass : {"clear", "opaque"}) {
        const Scene room = scene(std::string("ispace size=8,6,2.5\ninside at=-3,0\n"
                                             "wall id=w from=1,-2.9 to=1,2.9 height=2.5\n"
                                             "window wall=w offset=2.9 size=3,0.1,2 sill=0.1 "
                                             "glass=") +
                                     glass + "\n",
                                 "robot id=r1 at=-2,0\n"
                                 "laser on=r1 at=0,0,1 tilt=3 range=20 fov=20 step=10\n"
                                 "laser on=r1 at=0,0,1 range=20 fov=20 step=10\n");
        World world(room, milliseconds(100));
        const double expected = glass == std::string("clear") ? 6 : 3;
        EXPECT_NEAR(world.reading(0).scan.ranges.at(1) * cos(Angle::degrees(3)), expected, 1e-5);
        EXPECT_NEAR(world.reading(1).scan.ranges.at(1), expected, 1e-5);
    }
}

}  // namespace
}  // namespace ispace
