// SPDX-License-Identifier: GPL-3.0-or-later
// Findings about rooms: ends of walls, several rooms; errors and warnings.
#include <gtest/gtest.h>

#include <string>

#include "support/test_check.h"

namespace ispace {

using testing::check;
using testing::scene;

namespace check_rooms_test {

TEST(CheckScene, LooseEndsThatMissAnotherWall) {
    const std::string miss = "wall id=v from=2,0 to=2,5.88\n";
    EXPECT_EQ(
        check(miss),
        "room.env:3:1: warning: 1 loose end of a wall, the narrowest gap 0.12 m near (2.0, 5.88); "
        "make them meet\n");
    // Two ends that miss each other are one gap, and the narrowest of all is told.
    EXPECT_EQ(
        check(miss + "wall id=w from=4,0 to=4,2\nwall id=x from=4,2.05 to=4,6\n"),
        "room.env:4:1: warning: 3 loose ends of walls, the narrowest gap 0.05 m near (4.0, 2.0); "
        "make them meet\n");
    // An end between two walls is one end.
    EXPECT_EQ(
        check("wall id=v from=0.1,0.1 to=4,3\n"),
        "room.env:3:1: warning: 1 loose end of a wall, the narrowest gap 0.1 m near (0.0, 0.1); "
        "make them meet\n");
}

TEST(CheckScene, EndsThatAreMeantToHang) {
    EXPECT_EQ(check("wall id=v from=2,2 to=2,4\n"), "") << "stands free";
    EXPECT_EQ(check("wall id=v from=2,0 to=2,5\n"), "") << "leaves a passage";
    EXPECT_EQ(check("wall id=v from=2,0 to=2,6\ninside at=1,1\n"), "") << "meets what it should";
    EXPECT_EQ(check("fence id=p path=2,2;3,2;3,3;2,3 closed=yes\n"
                    "fence id=q path=3.1,2;4,2;4,3;3.1,3 closed=yes\ninside at=1,1\n"),
              "")
        << "corners are no ends";
    EXPECT_EQ(check("wall id=v from=9,0 to=9,2\nwall id=w from=9,2.1 to=9,4\n"), "")
        << "outside, where nothing is measured";
    EXPECT_EQ(check("wall id=v from=2,0 to=2,6\nwall id=w from=5,0 to=5,5.9\ninside at=1,1\n"), "")
        << "in another room";
    EXPECT_NE(check("wall id=v from=2,0 to=2,6\nwall id=w from=5,0 to=5,5.9\n"
                    "inside at=1,1\ninside at=4,1\n"),
              "")
        << "in the second room";
}

TEST(CheckScene, ErrorsStopWarningsDoNot) {
    const auto severities = [](const Scene& made) {
        std::string all;
        for (const Finding& finding : checkScene(made))
            all += finding.severity == Severity::Error ? 'e' : 'w';
        return all;
    };
    const std::string room = "ispace id=room at=4,3 size=8,6\n";
    EXPECT_EQ(severities(scene(room + "desk at=2,3\nchair at=2.2,3\ncube at=30,3\n"
                                      "zone at=20,20 size=1,1\n"
                                      "wall from=5,1 to=7,3\nwall from=5,3 to=7,1\n")),
              "wwww");
    EXPECT_EQ(severities(scene(room + "cube at=2,2\n",
                               "laser at=2,2\nlaser at=9,3\nrobot at=2.3,2\nrobot at=6,3\n"
                               "human at=6.2,3\n")),
              "eeee");
}

TEST(CheckScene, SeveralRooms) {
    const std::string two = "ispace id=b at=20,3 size=4,4\ninside at=1,1\ninside at=20,3\n";
    EXPECT_EQ(check(two + "desk at=20,3\nzone id=z at=20,3 size=1,1\n",
                    "laser id=l at=21,4\nrobot id=r at=19,2\nlaser id=m at=1,1\n"),
              "");
    EXPECT_EQ(check(two, "robot id=r at=12,3\n"),
              "room.3dm:2:1: error: robot r stands outside the room at (12.0, 3.0); move it in\n");
    // Both sides of the wall between two rooms are in the room; what stands in the wall is not.
    const std::string beside = "ispace id=b at=10,3 size=4,6\ninside at=1,1\ninside at=10,3\n";
    EXPECT_EQ(check(beside, "robot id=r at=7.5,3\nrobot id=s at=8.5,3\n"), "");
    EXPECT_EQ(check(beside, "robot id=r at=8,3\n").find("room.3dm:2:1: error: robot r stands in"),
              0U);
}

}  // namespace check_rooms_test
}  // namespace ispace
