// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/course_check.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/test_layout.h"

namespace ispace {
namespace course_check_test {

using testing::scene;

const std::string kHall = "fence id=f path=0,0;12,0;12,8;0,8 closed=yes\n";
const std::string kWall = kHall + "wall id=w from=6,0 to=6,5\n";

/// Returns the messages of the findings, a line each.
std::string found(const std::string& room, const std::string& layout) {
    std::string text;
    for (const Finding& finding : checkCourses(scene(room, layout))) text += finding.message + '\n';
    return text;
}

TEST(CourseCheck, ALegThroughAWallIsFound) {
    EXPECT_EQ(found(kWall, "human id=p at=3,2 path=9,2\n"),
              "human p has a path whose leg from (3.0, 2.0) to (9.0, 2.0) crosses wall w and is "
              "given up there\n");
    EXPECT_EQ(found(kWall, "robot id=r at=3,6.5 path=9,6.5;9,2;3,2\n"),
              "robot r has a path whose leg from (9.0, 2.0) to (3.0, 2.0) crosses wall w and is "
              "given up there\n");
    // The way back of a loop.
    EXPECT_EQ(found(kWall, "robot id=r at=3,2 path=3,2;3,6.5;9,6.5;9,2 loop=yes\n"),
              "robot r has a path whose leg from (9.0, 2.0) to (3.0, 2.0) crosses wall w and is "
              "given up there\n");
}

TEST(CourseCheck, AClosedDoorIsFound) {
    const std::string room = kHall + "wall id=w from=6,0 to=6,8\ninside at=3,4\ninside at=9,4\n";
    const std::string person = "human id=p at=3,2 path=9,2\n";
    EXPECT_EQ(found(room + "door id=d wall=w at=6,2 size=1,2\n", person),
              "human p has a path whose leg from (3.0, 2.0) to (9.0, 2.0) crosses door d and is "
              "given up there\n");
    EXPECT_EQ(found(room + "door id=d wall=w at=6,2 size=1,2 open=yes\n", person), "");
}

TEST(CourseCheck, AGapTooNarrowIsFound) {
    const std::string room = kHall + "wall id=a from=6,0 to=6,3.8\nwall id=b from=6,4.3 to=6,8\n";
    const std::string text = found(room, "robot id=r at=3,4 radius=0.35 path=9,4\n");
    EXPECT_NE(text.find("from (3.0, 4.0) to (9.0, 4.0) is given up: its radius is 0.35 m, and wall "
                        "a leaves less room"),
              std::string::npos)
        << text;
    EXPECT_EQ(found(room, "robot id=r at=3,4.05 radius=0.15 path=9,4.05\n"), "");
}

TEST(CourseCheck, ATargetInsideAThingIsFound) {
    const std::string room = kHall + "cube id=box at=8,2 size=1,1,1\n";
    EXPECT_EQ(found(room, "human id=p at=3,2 path=8,2;10,2;3,5\n"),
              "human p has a path to (8.0, 2.0), where cube box leaves it no room\n");
}

TEST(CourseCheck, WaysRoundThingsAreNone) {
    EXPECT_EQ(found(kHall + "cube id=box at=6,2 size=0.4,0.4,1\n", "human id=p at=3,2 path=9,2\n"),
              "");
    EXPECT_EQ(found(kHall + "cylinder id=post at=6,2 size=0.5,0.5,2\n",
                    "robot id=r at=3,2 path=9,2;9,6;3,6 loop=yes pause=3\n"),
              "");
    // Those that wander, or stand, have no target.
    EXPECT_EQ(found(kWall, "human id=p at=3,2 walk=wander\nrobot id=r at=3,4\n"), "");
    // Above the head.
    EXPECT_EQ(
        found(kHall + "cube id=shelf at=6,2,2 size=1,8,0.3\n", "human id=p at=3,2 path=9,2\n"), "");
}

TEST(CourseCheck, LeavesOutWhatOthersFind) {
    // Points outside; movers outside or in a body.
    EXPECT_EQ(found(kHall, "robot id=r at=3,2 path=20,2;5,2\n"), "");
    EXPECT_EQ(found(kWall, "robot id=r at=-3,2 path=9,2\nrobot id=s at=6,2 path=9,2\n"), "");
}

TEST(CourseCheck, AsManyAsAreReported) {
    std::string layout;
    for (int i = 0; i < 30; ++i)
        layout += "human id=p" + std::to_string(i) + " at=3," + std::to_string(0.5 + 0.1 * i) +
                  " path=9,2\n";
    EXPECT_EQ(checkCourses(scene(kWall, layout)).size(), Diagnostics::kMax);
}

}  // namespace course_check_test
}  // namespace ispace
