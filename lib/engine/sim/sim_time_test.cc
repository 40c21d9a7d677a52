// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sim_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "base/number.h"

namespace ispace {
namespace sim_time_test {

using std::chrono::nanoseconds;

constexpr std::int64_t kHundredYears = 3'155'760'000;  // in seconds

TEST(ParseSimTime, IsExactInNanoseconds) {
    EXPECT_EQ(parseSimTime("0.005"), nanoseconds(5'000'000));
    EXPECT_EQ(parseSimTime("12.3"), nanoseconds(12'300'000'000));
    EXPECT_EQ(parseSimTime("0"), nanoseconds(0));
    EXPECT_EQ(parseSimTime("+2.5"), nanoseconds(2'500'000'000));
    EXPECT_EQ(parseSimTime(".5"), nanoseconds(500'000'000));
    EXPECT_EQ(parseSimTime("5."), nanoseconds(5'000'000'000));
    EXPECT_EQ(parseSimTime("1e-3"), nanoseconds(1'000'000));
    EXPECT_EQ(parseSimTime("1.25E2"), nanoseconds(125'000'000'000));
    EXPECT_EQ(parseSimTime("00000000000000000000000000001"), nanoseconds(1'000'000'000));
    // More digits than a double holds.
    EXPECT_EQ(parseSimTime("3155759999.999999999"), nanoseconds(kHundredYears * 1'000'000'000 - 1));
}

TEST(ParseSimTime, TakesUnits) {
    EXPECT_EQ(parseSimTime("2s"), nanoseconds(2'000'000'000));
    EXPECT_EQ(parseSimTime("5ms"), nanoseconds(5'000'000));
    EXPECT_EQ(parseSimTime("200us"), nanoseconds(200'000));
    EXPECT_EQ(parseSimTime("7ns"), nanoseconds(7));
    EXPECT_EQ(parseSimTime("1e3us"), nanoseconds(1'000'000));
    EXPECT_EQ(parseSimTime("1min"), std::chrono::seconds(60));
    EXPECT_EQ(parseSimTime("0.1min"), std::chrono::seconds(6));
    EXPECT_EQ(parseSimTime("1.5h"), std::chrono::minutes(90));
    EXPECT_EQ(parseSimTime("876600h"), std::chrono::seconds(kHundredYears));
}

TEST(ParseSimTime, RoundsToNanosecondsOnce) {
    EXPECT_EQ(parseSimTime("0.4ns"), nanoseconds(0));
    EXPECT_EQ(parseSimTime("0.5ns"), nanoseconds(1));
    EXPECT_EQ(parseSimTime("0.49999999999999999999999999ns"), nanoseconds(0));
    EXPECT_EQ(parseSimTime("1.5ns"), nanoseconds(2));
    EXPECT_EQ(parseSimTime("0.05ns"), nanoseconds(0));
    EXPECT_EQ(parseSimTime("0.0000000009999"), nanoseconds(1));
    EXPECT_EQ(parseSimTime("9.9999999999"), nanoseconds(10'000'000'000));
    EXPECT_EQ(parseSimTime("0.00000000001min"), nanoseconds(1));  // 0.6 ns
    EXPECT_EQ(parseSimTime("0.000000000025h"), nanoseconds(90));
    EXPECT_EQ(parseSimTime("1e-13h"), nanoseconds(0));
}

TEST(ParseSimTime, EndsAtAHundredYears) {
    EXPECT_EQ(parseSimTime("3155760000"), std::chrono::seconds(kHundredYears));
    EXPECT_FALSE(parseSimTime("3155760000.000000001"));
    EXPECT_FALSE(parseSimTime("9223372036854775807ns"));
    EXPECT_FALSE(parseSimTime("876600.1h"));
    EXPECT_FALSE(parseSimTime("1e300"));
    EXPECT_FALSE(parseSimTime("1e300h"));
    EXPECT_FALSE(parseSimTime("1e99999999999"));
}

TEST(ParseSimTime, RefusesWhatIsNoTime) {
    for (const char* bad : {"",    " ",   "s",    "ms",   "-1",  "-0",  "+-1",   "1 s",  " 1",
                            "1 ",  "1m",  "1hr",  "1S",   "1ss", "1es", "e5s",   ".",    "1,5",
                            "nan", "inf", "infs", "0x10", "1e",  "--1", "1.2.3", "1e1e1"})
        EXPECT_FALSE(parseSimTime(bad)) << bad;
}

TEST(FormatSimTime, IsExactAndShortest) {
    EXPECT_EQ(formatSimTime(nanoseconds(0)), "0");
    EXPECT_EQ(formatSimTime(nanoseconds(5'000'000)), "0.005");
    EXPECT_EQ(formatSimTime(nanoseconds(12'000'000'000)), "12");
    EXPECT_EQ(formatSimTime(nanoseconds(100'000'000'000)), "100");
    EXPECT_EQ(formatSimTime(nanoseconds(1)), "0.000000001");
    EXPECT_EQ(formatSimTime(nanoseconds(10'100'000'000)), "10.1");
    EXPECT_EQ(formatSimTime(nanoseconds(-1'500'000'000)), "-1.5");
    EXPECT_EQ(formatSimTime(nanoseconds::min()), "-9223372036.854775808");
}

TEST(FormatMilliseconds, RoundsHalfAwayFromZero) {
    EXPECT_EQ(formatMilliseconds(nanoseconds(12'300'000'000)), "12.300");
    EXPECT_EQ(formatMilliseconds(nanoseconds(0)), "0.000");
    EXPECT_EQ(formatMilliseconds(nanoseconds(499'999)), "0.000");
    EXPECT_EQ(formatMilliseconds(nanoseconds(500'000)), "0.001");
    EXPECT_EQ(formatMilliseconds(nanoseconds(-500'000)), "-0.001");
    EXPECT_EQ(formatMilliseconds(nanoseconds(-499'999)), "0.000");
    EXPECT_EQ(formatMilliseconds(nanoseconds(999'999'999)), "1.000");
}

/// Times of all magnitudes up to a hundred years.
SimTime anyTime(std::mt19937_64& random) {
    const std::uint64_t bits = random() >> (random() % 62);
    return SimTime(static_cast<std::int64_t>(bits % (kHundredYears * 1'000'000'000ULL + 1)));
}

TEST(SimTimeProperty, WhatIsFormattedReadsBack) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20000; ++i) {
        const SimTime time = anyTime(random);
        ASSERT_EQ(parseSimTime(formatSimTime(time)), time) << time.count();
        ASSERT_EQ(parseSimTime(std::to_string(time.count()) + "ns"), time);
    }
}

TEST(SimTimeProperty, SecondsIsTheNearestDouble) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        const SimTime time = anyTime(random);
        ASSERT_EQ(seconds(time), parseDouble(formatSimTime(time))) << time.count();
    }
    EXPECT_EQ(seconds(nanoseconds(5'000'000)), 0.005);
    EXPECT_EQ(seconds(nanoseconds(-2'500'000'000)), -2.5);
}

TEST(SimTimeProperty, MillisecondsAreWithinHalfOfOne) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20000; ++i) {
        const SimTime time = anyTime(random);
        const auto back = parseDouble(formatMilliseconds(time));
        ASSERT_TRUE(back);
        // A double of 1e9 seconds is good to a tenth of a microsecond.
        ASSERT_NEAR(*back, seconds(time), 0.000501) << time.count();
    }
}

}  // namespace sim_time_test
}  // namespace ispace
