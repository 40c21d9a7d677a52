// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/track_log.h"

#include <gtest/gtest.h>

#include <string>

namespace ispace {
namespace track_log_test {

ToldTrack track(int name, int ms) {
    return {.told = std::chrono::milliseconds(ms), .track = std::to_string(name)};
}

TEST(TrackLog, KeepsTheNewestOfEachForASecond) {
    TrackLog log;
    EXPECT_TRUE(log.report(track(1, 0)));
    EXPECT_TRUE(log.report(track(2, 500)));
    EXPECT_TRUE(log.report(track(1, 900)));
    EXPECT_EQ(log.present(std::chrono::milliseconds(1400)).size(), 2U);
    EXPECT_EQ(log.present(std::chrono::milliseconds(1501)).size(), 1U);
    EXPECT_EQ(log.present(std::chrono::milliseconds(1901)).size(), 0U);
    EXPECT_EQ(log.next(), 3);
}

TEST(TrackLog, IsBounded) {
    TrackLog log;
    const int most = static_cast<int>(TrackLog::kMostTracks);
    for (int i = 0; i < most; ++i) EXPECT_TRUE(log.report(track(i, 0)));
    EXPECT_FALSE(log.report(track(most, 0)));
    EXPECT_TRUE(log.report(track(0, 10)));
    EXPECT_TRUE(log.report(track(most, 1005)));  // the others are over
    for (int i = 0; i < 20'000; ++i) log.report(track(0, 1010));
    EXPECT_EQ(log.next() - log.first(), TrackLog::kKept);
    EXPECT_EQ(log.at(log.first()).track, "0");
}

}  // namespace track_log_test
}  // namespace ispace
