// SPDX-License-Identifier: GPL-3.0-or-later
// What is said about doors and windows that are in no wall. Where the others stand: openings_test.
#include <gtest/gtest.h>

#include "support/test_scene.h"

namespace ispace {
namespace opening_sites_test {

using testing::findings;

TEST(OpeningSites, TellsWhatIsWrongWithAPlace) {
    const std::string room =
        "ispace id=r size=8,6\nwall id=w3 from=0,-3 to=0,0\ndesk id=k at=2,2\n";
    const auto message = [&](const std::string& line) {
        const std::string text = findings(room + line + "\n");
        const std::string start = "room.env:5:";
        EXPECT_EQ(text.substr(0, start.size()), start) << text;
        return text.substr(text.find("error: ") + 7);
    };
    EXPECT_EQ(message("door id=d1"),
              "door has no place: give `wall` and `offset`, or `at`, or `from` and `to`\n");
    EXPECT_EQ(message("window wall=w3"),
              "window has no place: give `wall` and `offset`, or `at`, or `from` and `to`\n");
    EXPECT_EQ(message("door at=0,-1 wall=w3 offset=1"),
              "door has `offset` and also `at`: give its place one way only\n");
    EXPECT_EQ(message("door at=0,-1 from=0,-1 to=0,-2"),
              "door has `from`/`to` and also `at`: give its place one way only\n");
    EXPECT_EQ(message("door wall=w3 offset=1 from=0,-1 to=0,-2"),
              "door has `from`/`to` and also `offset`: give its place one way only\n");
    EXPECT_EQ(message("door from=0,-1"), "`from` and `to` belong together: `to` is missing\n");
    EXPECT_EQ(message("door to=0,-1"), "`from` and `to` belong together: `from` is missing\n");
    EXPECT_EQ(message("door offset=1"), "`offset` counts along a wall: give `wall` too\n");
    EXPECT_EQ(message("door from=0,-1 to=0,-2 size=2"),
              "door is 1.0 m wide by `from` and `to`, and 2.0 m by `size`\n");
    EXPECT_EQ(message("door from=0,-1 to=0,-1"), "door has zero width\n");
    EXPECT_EQ(message("door size=0.0005 at=0,-1"),
              "door door1 is too narrow: wanted more than 1 mm\n");
    EXPECT_EQ(message("door wall=w4 offset=1"),
              "`wall`: nothing has the id `w4`, did you mean `w3`?\n");
    EXPECT_EQ(message("door wall=k offset=1"),
              "`wall`: k is a desk; a door is in a wall, fence or ispace\n");
    EXPECT_EQ(message("door wall=w3 offset=3.4"),
              "`offset` of 3.4 m lies beyond the end of wall w3, which is 3.0 m long\n");
    EXPECT_EQ(message("door id=d1 at=1,-1"),
              "door d1 at (1.0, -1.0) is not on a wall: the nearest is wall w3, 1.0 m away\n");
    EXPECT_EQ(message("door id=d1 at=50,-1"),
              "door d1 at (50.0, -1.0) is not on a wall: the nearest is ispace r, 46.0 m away\n");
    EXPECT_EQ(message("door id=d1 at=4,-1 wall=w3"),
              "door d1 at (4.0, -1.0) is not on wall w3: the nearest point of it is 4.0 m away\n");
    EXPECT_EQ(message("door id=d1 at=0,-1 heading=30"),
              "door d1 at (0.0, -1.0) is not on a wall: none has that direction\n");
    EXPECT_EQ(message("door id=d1 at=0.2,-1 heading=0"),
              "door d1 at (0.2, -1.0) is not on a wall: the nearest is ispace r, 2.0 m away\n");
    EXPECT_EQ(message("door id=d1 from=1,0 to=2,0"),
              "door d1 at (1.5, 0.0) is not on a wall: the nearest is ispace r, 3.0 m away\n");
}

TEST(OpeningSites, TellsWhatDoesNotFit) {
    const std::string room = "ispace id=r size=8,6\nwall id=w3 from=0,-3 to=0,0\n";
    const auto message = [&](const std::string& line) {
        const std::string text = findings(room + line + "\n");
        EXPECT_EQ(text.substr(0, 11), "room.env:4:") << text;
        return text.substr(text.find("error: ") + 7);
    };
    EXPECT_EQ(message("door id=d1 wall=w3 offset=2.67"),
              "door d1 (0.9 m) does not fit wall w3: 0.12 m too long; move it or make it "
              "narrower\n");
    EXPECT_EQ(message("door id=d1 wall=w3 offset=1.5 size=3.12"),
              "door d1 (3.12 m) does not fit wall w3: 0.12 m too long; make it narrower\n");
    EXPECT_EQ(message("door id=d1 wall=w3 offset=2.552"),
              "door d1 (0.9 m) does not fit wall w3: 0.002 m too long; move it or make it "
              "narrower\n");
    EXPECT_EQ(message("door id=d1 from=0,-1 to=0,0.25"),
              "door d1 (1.25 m) does not fit wall w3: 0.25 m too long; move it or make it "
              "narrower\n");
    EXPECT_EQ(message("door id=d1 wall=w3 offset=1 height=2.6"),
              "door d1 reaches up to 2.6 m, wall w3 only to 2.5 m; make it lower or the wall "
              "higher\n");
    EXPECT_EQ(message("window id=n wall=w3 offset=1 sill=1.4"),
              "window n reaches up to 2.6 m, wall w3 only to 2.5 m; make it lower or the wall "
              "higher\n");
    // A millimetre is fitted, and heights may be equal.
    for (const char* line : {"door wall=w3 offset=2.5509", "window wall=w3 offset=1 sill=1.3",
                             "door wall=w3 offset=1.5 size=3.0015 height=2.5"})
        EXPECT_EQ(findings(room + line + "\n"), "") << line;
    EXPECT_EQ(findings("ispace\nwall id=u at=0,0,1 size=4,0,3\nwindow id=n wall=u offset=1\n"),
              "room.env:4:1: error: window n begins at 0.9 m, wall u only at 1.0 m; make its sill "
              "higher\n");
}

}  // namespace opening_sites_test
}  // namespace ispace
