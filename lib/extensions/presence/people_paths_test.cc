// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/people_paths.h"

#include <gtest/gtest.h>

namespace ispace::presence {
namespace people_paths_test {

TEST(PathCutter, CutsWaysIntoPieces) {
    PathCutter cutter;
    for (int i = 0; i <= 50; ++i) cutter.add("p1", 0.1 * i, {-2 + 0.1 * i, 0});
    const PeoplePaths ways = cutter.finish();
    ASSERT_EQ(ways.pieces.size(), 25U);
    EXPECT_NEAR(ways.pieces[1].time, kPathStep, 1e-12);
    EXPECT_NEAR(ways.pieces[1].place.x, -1.8, 1e-12);
    EXPECT_NEAR(ways.pieces[1].velocity.x, 1, 1e-12);
    EXPECT_NEAR(ways.pieces[1].length, 0.2, 1e-12);
}

TEST(PathCutter, LeavesOutRestAndJumps) {
    PathCutter cutter;
    const double xs[] = {0, 0, 0.2, 0.2, 5, 5.2};  // a client moved it from 0.2 to 5
    for (int i = 0; i < 6; ++i) {
        cutter.add("p1", i * kPathStep, {xs[i], 0});
        cutter.add("still", i * kPathStep, {1, 1});
        cutter.add("p2", i * kPathStep, {0, 0.1 * i});
    }
    const PeoplePaths ways = cutter.finish();
    ASSERT_EQ(ways.people, (std::vector<std::string>{"p1", "still", "p2"}));
    EXPECT_EQ(ways.firsts(), (std::vector<std::size_t>{0, 2, 2, 7}));
    EXPECT_NEAR(ways.pieces[1].place.x, 5, 1e-12);
}

TEST(PathCutter, ReadsTheRecordOfARun) {
    RunReader reader("t,id,x,y,heading_deg\n0,r1,0,0,0\n0.1,r1,1,0,0\n0.3,r1,2,0,0\n",
                     "t,id,x,y,heading_deg\n0,p1,1,1,0\n0.1,p1,1.1,1,0\n0.3,p1,1.3,1,0\n");
    PathCutter cutter;
    visitPeople(reader, [&cutter](const std::string& id, double time, Point2 place) {
        cutter.add(id, time, place);
    });
    const PeoplePaths ways = cutter.finish();
    ASSERT_EQ(ways.people, std::vector<std::string>{"p1"});
    ASSERT_EQ(ways.pieces.size(), 1U);
    EXPECT_NEAR(ways.pieces[0].length, 0.3, 1e-12);
}

}  // namespace people_paths_test
}  // namespace ispace::presence
