// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/presence_paths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "support/test_layout.h"

namespace ispace::presence {
namespace presence_paths_test {

TEST(Paths, AreReadFromAFolderOrWandered) {
    EXPECT_EQ(parseWays("evening").record, "evening");
    const PathsChoice some = parseWays("wander:4");
    EXPECT_EQ(some.record, "");
    EXPECT_EQ(some.people, 4);
    EXPECT_EQ(some.duration, std::chrono::minutes(10));
    EXPECT_EQ(parseWays("wander:2,90s").duration, std::chrono::seconds(90));
    for (const char* text : {"wander:", "wander:0", "wander:1001", "wander:2,", "wander:2,0",
                             "wander:2,25h", "wander:two", "wander:2,1min,3"})
        EXPECT_THROW(parseWays(text), UsageError) << text;
    EXPECT_THROW(readPaths(parseWays("no/such/folder"), testing::scene("ispace size=8,6\n"), 0),
                 std::system_error);
}

TEST(Paths, OfWanderersFillTheRoom) {
    const Scene room = testing::scene("ispace size=8,6\nwall from=0,-3 to=0,2\n",
                                      "human id=wanderer1 at=-2,0\nlaser at=1,1\n");
    const PathsChoice choice = parseWays("wander:3,60s");
    const PeoplePaths ways = readPaths(choice, room, 7);
    ASSERT_EQ(ways.people.size(), 3U) << "instead of the person of the scene";
    EXPECT_EQ(ways.people[1], "wanderer2");
    double length = 0;
    for (const PathPiece& piece : ways.pieces) {
        length += piece.length;
        EXPECT_LT(std::fabs(piece.place.x), 4);
        EXPECT_LT(std::fabs(piece.place.y), 3);
        EXPECT_LE(piece.time, 60);
    }
    EXPECT_GT(length, 3 * 60 * 0.3) << "wanderers rarely rest";
    const PeoplePaths again = readPaths(choice, room, 7), other = readPaths(choice, room, 8);
    ASSERT_EQ(again.pieces.size(), ways.pieces.size());
    EXPECT_EQ(again.pieces.back().place, ways.pieces.back().place);
    EXPECT_NE(other.pieces.front().place, ways.pieces.front().place);
}

}  // namespace presence_paths_test
}  // namespace ispace::presence
