// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/ration.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

using std::chrono::milliseconds;

int taken(Ration& ration, WallTime now) {
    int count = 0;
    for (; ration.has(now); ++count) ration.take();
    return count;
}

TEST(Ration, GivesABurstAndThenItsRate) {
    const WallTime start{std::chrono::hours(1)};
    Ration ration({.rate = 10, .burst = 5});
    EXPECT_EQ(taken(ration, start), 5);
    EXPECT_EQ(taken(ration, start + milliseconds(99)), 0);
    EXPECT_EQ(taken(ration, start + milliseconds(101)), 1);
    EXPECT_EQ(taken(ration, start + milliseconds(302)), 2);
    EXPECT_EQ(taken(ration, start + std::chrono::hours(1)), 5);
}

TEST(Ration, MayBeginEmpty) {
    const WallTime start{std::chrono::hours(1)};
    Ration ration({.rate = 1, .burst = 1}, start);
    EXPECT_EQ(taken(ration, start), 0);
    EXPECT_EQ(taken(ration, start + milliseconds(999)), 0);
    EXPECT_EQ(taken(ration, start + milliseconds(1001)), 1);
}

TEST(Ration, CountsWhatComesInSmallPieces) {
    const WallTime start{std::chrono::hours(1)};
    Ration ration({.rate = 10, .burst = 5});
    int count = 0;
    for (int ms = 0; ms <= 2000; ++ms) count += taken(ration, start + milliseconds(ms));
    EXPECT_GE(count, 24);
    EXPECT_LE(count, 25);
}

TEST(Ration, SurvivesAClockThatDoesNotMove) {
    const WallTime start{std::chrono::hours(1)};
    Ration ration({.rate = 1, .burst = 2});
    EXPECT_EQ(taken(ration, start), 2);
    EXPECT_EQ(taken(ration, start), 0);
    EXPECT_EQ(taken(ration, start - milliseconds(5000)), 0);
}

}  // namespace
}  // namespace ispace
