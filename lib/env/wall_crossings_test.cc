// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "env/test_plans.h"
#include "env/test_scene.h"
#include "env/walls.h"
#include "geom/predicates.h"

namespace ispace {
namespace {

using testing::environment;
using testing::pointText;

const std::string kRoom = "ispace at=50,50 size=4,4\n";

std::vector<WallCrossing> crossings(const std::string& walls) {
    const Environment env = environment(kRoom + walls);
    return wallCrossings(env.elements());
}

TEST(WallCrossings, CrossingsAndOverlapsOfDifferentRecords) {
    const auto cross = crossings("wall from=0,0 to=4,4\nwall from=0,4 to=4,0\n");
    ASSERT_EQ(cross.size(), 1U);
    EXPECT_EQ(cross[0].a, 1U);
    EXPECT_EQ(cross[0].b, 2U);
    EXPECT_EQ(cross[0].place, (Point2{2, 2}));
    EXPECT_FALSE(cross[0].overlap);
    const auto overlap = crossings("wall from=0,0 to=4,0\nwall from=6,0 to=3,0\n");
    ASSERT_EQ(overlap.size(), 1U);
    EXPECT_EQ(overlap[0].place, (Point2{3.5, 0}));
    EXPECT_TRUE(overlap[0].overlap);
    EXPECT_EQ(crossings("wall from=0,0 to=4,0\nwall from=0,0 to=4,0\n").size(), 1U) << "doubled";
    EXPECT_EQ(crossings("wall from=0,0 to=4,0\nwall from=1,0 to=2,0\n").size(), 1U) << "within";
}

TEST(WallCrossings, MeetingIsNoCrossing) {
    for (const char* walls : {
             "wall from=0,0 to=4,0\nwall from=4,0 to=4,4\n",           // corner
             "wall from=0,0 to=4,0\nwall from=2,0 to=2,4\n",           // T
             "wall from=0,0 to=4,0\nwall from=2,-0.0000005 to=2,4\n",  // T but for rounding
             "wall from=0,0 to=4,0\nwall from=4,0 to=8,0\n",           // end to end
             "wall from=0,0 to=4,0\nwall from=0,1 to=4,1\n",           // side by side
             "fence path=0,0;4,4;4,0;0,4\n",                      // with itself: see checkShape
             "ispace at=0,0 size=4,4\nispace at=4,0 size=4,4\n",  // rooms side by side
         })
        EXPECT_TRUE(crossings(walls).empty()) << walls;
    EXPECT_EQ(crossings("ispace at=0,0 size=4,4\nispace at=3,1 size=4,4\n").size(), 2U);
    EXPECT_EQ(crossings("ispace at=0,0 size=4,4\nwall from=-2,0 to=-2,1\n").size(), 1U);
}

TEST(WallCrossings, AgreeWithBruteForce) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> coordinate(-10, 10), step(-2, 2);
    std::string walls;
    for (int i = 0; i < 400; ++i) {
        const Point2 from{coordinate(random), coordinate(random)};
        walls += "wall from=" + pointText(from) +
                 " to=" + pointText(from + Vec2{step(random), step(random)}) + '\n';
    }
    const Environment env = environment(kRoom + walls);
    std::set<std::pair<std::size_t, std::size_t>> expected, found;
    std::vector<Segment2> lines;
    Diagnostics findings;
    for (std::size_t i = 1; i < env.elements().size(); ++i)
        lines.push_back(wallLines(env.elements()[i].record, findings).at(0));
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t k = i + 1; k < lines.size(); ++k)
            if (intersects(lines[i], lines[k])) expected.insert({i + 1, k + 1});
    for (const WallCrossing& crossing : wallCrossings(env.elements())) {
        EXPECT_TRUE(found.insert({crossing.a, crossing.b}).second);
        EXPECT_LT(distance(crossing.place, lines[crossing.a - 1]), 1e-9);
        EXPECT_LT(distance(crossing.place, lines[crossing.b - 1]), 1e-9);
    }
    EXPECT_GT(expected.size(), 50U);
    EXPECT_EQ(found, expected);
}

TEST(WallCrossings, AllAreFoundHoweverUnevenThePlan) {
    std::string walls = "wall from=9000,9000 to=9000,9001\n";
    constexpr int kSide = 50;
    for (int i = 0; i < kSide; ++i) {
        for (int k = 0; k < kSide; ++k) {
            const Point2 corner{0.4 * i, 0.4 * k};
            walls += "wall from=" + pointText(corner) + " to=" + pointText(corner + Vec2{0.4, 0});
            walls += "\nwall from=" + pointText(corner) + " to=" + pointText(corner + Vec2{0, 0.4});
            walls += '\n';
        }
    }
    const auto found =
        crossings(walls + "wall from=0.1,19.3 to=0.3,19.5\nwall from=0.1,19.5 to=0.3,19.3\n");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].a, 2U + 2 * kSide * kSide);
    EXPECT_NEAR(found[0].place.y, 19.4, 1e-9);
}

TEST(WallCrossings, ComeInTheOrderOfElements) {
    const std::string fence = "fence path=0,0;10,0;10,1;0,1\n";
    const Environment env =
        environment(kRoom + fence + "wall from=5,0.5 to=5,2\nwall from=1,-1 to=1,0.5\n");
    const auto all = wallCrossings(env.elements());
    ASSERT_EQ(all.size(), 2U);
    EXPECT_EQ(all[0].b, 2U);
    EXPECT_EQ(all[1].b, 3U);
    const auto first = wallCrossings(env.elements(), 1);
    ASSERT_EQ(first.size(), 1U);
    EXPECT_EQ(first[0].b, 2U) << "though a later line of the fence crosses it";
    EXPECT_TRUE(wallCrossings(env.elements(), 0).empty());
}

TEST(WallCrossings, ManyAreCutShort) {
    std::string walls = "inside at=0.5,0.5\n";
    for (int i = 0; i < 100; ++i) {
        walls += "wall from=" + std::to_string(i) + ",-1 to=" + std::to_string(i) + ",200\n";
        walls += "wall from=-1," + std::to_string(i) + " to=200," + std::to_string(i) + "\n";
    }
    const Environment env = environment(walls);
    EXPECT_EQ(wallCrossings(env.elements()).size(), 1000U);
    EXPECT_EQ(wallCrossings(env.elements(), 7).size(), 7U);
    EXPECT_EQ(wallCrossings(env.elements(), 20000).size(), 10000U);
}

}  // namespace
}  // namespace ispace
