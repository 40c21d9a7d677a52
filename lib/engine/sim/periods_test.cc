// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sensor_reading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace ispace {
namespace periods_test {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

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

}  // namespace periods_test
}  // namespace ispace
