// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/run/run_marks.h"

#include <gtest/gtest.h>

#include <string>

#include "base/file.h"
#include "support/test_folder.h"
#include "support/test_layout.h"

namespace ispace {
namespace run_marks_test {

constexpr const char* kHead = "t,kind,id,other,x,y,value,text\n";

TEST(RunMarks, AreTheRemarkableEventsOfAllRecords) {
    const testing::TestFolder a, b;
    writeAll((a / "events.csv").string(), std::string(kHead) +
                                              "0.5,collision,r1,box,1,2,,\n0.5,stall,r1,,1,2,,\n"
                                              "3,mark,,,,,,\"half, or so\"\n");
    writeAll((b / "events.csv").string(),
             std::string(kHead) + "1,unreached,r2,kitchen,,,,no way\n");
    const auto marks = recordedMarks({a.path().string(), b.path().string(), "/nowhere"});
    ASSERT_EQ(marks.size(), 3U);
    EXPECT_EQ(marks[0], (RunMark{0.5, "collision", "r1", "box", ""}));
    EXPECT_EQ(marks[1], (RunMark{1, "unreached", "r2", "kitchen", "no way"}));
    EXPECT_EQ(marks[2], (RunMark{3, "mark", "", "", "half, or so"}));
}

TEST(RunMarks, OfLongRunsAreThinned) {
    const testing::TestFolder folder;
    std::string rows = kHead;
    for (int i = 0; i < 1000; ++i) rows += std::to_string(i) + ",mark,,,,,,m\n";
    writeAll((folder / "events.csv").string(), rows);
    const auto marks = recordedMarks({folder.path().string()}, 10);
    ASSERT_EQ(marks.size(), 10U);
    EXPECT_EQ(marks.front().time, 0);
    EXPECT_GE(marks.back().time, 899);
}

TEST(RunMarks, WantEvents) {
    const testing::TestFolder folder;
    writeAll((folder / "events.csv").string(), "a,b\n");
    EXPECT_NE(testing::findings([&] {
                  recordedMarks({folder.path().string()});
              }).find("events.csv:1: error: no events of a run"),
              std::string::npos);
    writeAll((folder / "events.csv").string(), std::string(kHead) + "-1,mark,,,,,,m\n");
    EXPECT_NE(testing::findings([&] {
                  recordedMarks({folder.path().string()});
              }).find("events.csv:2: error: t is `-1`"),
              std::string::npos);
}

}  // namespace run_marks_test
}  // namespace ispace
