// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms that open doors make one.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "base/number.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "support/test_floor_plans.h"
#include "support/test_scene.h"

namespace ispace {
namespace joined_rooms_test {

using testing::environment;
using testing::pointText;

TEST(JoinedRooms, ByOpenDoorsOnly) {
    const std::string rooms =
        "ispace id=a at=0,0 size=4,4\nispace id=b at=4,0 size=4,4\nispace id=c at=8,0 size=4,4\n"
        "inside at=0,0\n";
    const auto area = [&](const std::string& doors) {
        return environment(rooms + doors).indoor().area();
    };
    EXPECT_EQ(area(""), 16);
    EXPECT_EQ(area("door at=2,0\n"), 16);
    EXPECT_EQ(area("window at=2,0 glass=none\n"), 16);
    EXPECT_EQ(area("door at=2,0 open=yes\n"), 32);
    EXPECT_EQ(area("door at=2,0 open=yes\ndoor at=6,0 open=yes\n"), 48) << "through others";
    EXPECT_EQ(area("door at=6,0 open=yes\n"), 16) << "in neither of which is the point";
    EXPECT_EQ(area("door at=-2,0 open=yes\n"), 16) << "to the outside";
    EXPECT_EQ(area("door at=2,0 open=yes\nwindow at=2,1.4 size=1\ndoor at=2,-1.2 open=yes\n"), 32);
}

TEST(JoinedRooms, AreOneRegion) {
    const Environment env = environment(
        "fence path=-2,-2;6,-2;6,2;-2,2 closed=yes\nwall from=2,-2 to=2,2\n"
        "door at=2,0 open=yes\ninside at=0,0\n");
    const Region& indoor = env.indoor().parts.at(0);
    EXPECT_EQ(indoor.area(), 32);
    EXPECT_EQ(indoor.boundaryLength(), 24) << "what stands within bounds nothing";
    EXPECT_EQ(indoor.locate({2, 1.5}), Side::Inside);
    EXPECT_EQ(indoor.locate({2, 0}), Side::Inside);
    EXPECT_EQ(indoor.locate({5, 0}), Side::Inside);
    EXPECT_EQ(env.limits(), (Box2{{-2, -2}, {6, 2}}));
    // The parity rule wants the lines that enclose.
    std::vector<Segment2> edges;
    indoor.forEachEdge([&](const Segment2& edge) { edges.push_back(edge); });
    EXPECT_EQ(edges.size(), indoor.outline.size());
    EXPECT_EQ(env.wallLines().size(), 7U) << "all, openings closed";
}

TEST(JoinedRooms, ThickWallsJoinAsWell) {
    for (const double turn : {0.0, 13.0, 77.7}) {
        const Pose2 frame{{3, -2}, Angle::degrees(turn)};
        const auto at = [&](double x, double y) { return pointText(frame * Point2{x, y}); };
        const std::string plan = "fence path=" + at(0, 0) + ";" + at(8, 0) + ";" + at(8, 4) + ";" +
                                 at(0, 4) + " closed=yes thickness=0.3\nwall from=" + at(4, 0) +
                                 " to=" + at(4, 4) + " thickness=0.2\ninside at=" + at(1, 1) + "\n";
        const Environment env = environment(plan + "door open=yes at=" + at(4, 2) + "\n");
        EXPECT_NEAR(env.indoor().area(), 32, 1e-6);
        EXPECT_EQ(env.indoor().locate(frame * Point2{7, 1}), Side::Inside);
        // Through the doorway the free floor is one, under the lintel only.
        EXPECT_EQ(env.level(1)->freeFloor().size(), 1U);
        EXPECT_EQ(env.level(2.2)->freeFloor().size(), 2U);
    }
}

TEST(JoinedRooms, ABoothIsPartOfTheRoomOnceItsDoorIsOpen) {
    const std::string plan =
        "ispace size=8,6\nfence id=b path=1,1;3,1;3,2;1,2 closed=yes\ninside at=0,0\n";
    EXPECT_EQ(environment(plan + "door at=2,1\n").indoor().area(), 46);
    const Environment open = environment(plan + "door at=2,1 open=yes\n");
    EXPECT_EQ(open.indoor().area(), 48);
    EXPECT_TRUE(open.indoor().parts.at(0).holes.empty());
}

TEST(JoinedRooms, OverLinesThatCross) {
    // Partitions that run through each other: the arrangement's own route.
    const std::string plan =
        "ispace size=8,8\nwall from=-5,0 to=5,0\nwall from=0,-5 to=0,5\ninside at=1,1\n";
    EXPECT_EQ(environment(plan).indoor().area(), 16);
    EXPECT_EQ(environment(plan + "door at=0,2 open=yes\n").indoor().area(), 32);
    EXPECT_EQ(environment(plan + "door at=0,2 open=yes\ndoor at=-2,0 open=yes\n").indoor().area(),
              48);
}

TEST(JoinedRooms, RandomDoorsJoinWhatTheyConnect) {
    // A lattice of rooms with some doors open: the area is that of the rooms one can walk to.
    std::mt19937_64 random(5);
    constexpr int kSide = 5;
    for (int round = 0; round < 40; ++round) {
        const Pose2 frame{{1, 2}, Angle::degrees(9 * (round % 10))};
        std::string plan = "inside at=" + pointText(frame * Point2{1, 1}) + '\n';
        std::vector<int> room(std::size_t{kSide * kSide});
        std::iota(room.begin(), room.end(), 0);
        const auto join = [&](int a, int b) {
            const int from = room[static_cast<std::size_t>(a)];
            const int to = room[static_cast<std::size_t>(b)];
            std::replace(room.begin(), room.end(), from, to);
        };
        for (int i = 0; i <= kSide; ++i) {
            const auto wall = [&](Point2 from, Point2 to, const char* id) {
                plan += "wall id=" + std::string(id) + std::to_string(i) +
                        " from=" + pointText(frame * from) + " to=" + pointText(frame * to) +
                        (round % 2 == 0 ? "\n" : " thickness=0.1\n");
            };
            wall({3.0 * i, 0}, {3.0 * i, 3.0 * kSide}, "v");
            wall({0, 3.0 * i}, {3.0 * kSide, 3.0 * i}, "h");
            for (int k = 0; k < kSide; ++k) {
                for (const char* id : {"v", "h"}) {
                    if (random() % 2 == 0) continue;
                    const bool open = random() % 2 == 0;
                    plan += "door wall=" + std::string(id) + std::to_string(i) +
                            " offset=" + formatDouble(3.0 * k + 1.5) +
                            (open ? " open=yes\n" : "\n");
                    if (!open || i == 0 || i == kSide) continue;
                    if (*id == 'v') join(i - 1 + kSide * k, i + kSide * k);
                    if (*id == 'h') join(k + kSide * (i - 1), k + kSide * i);
                }
            }
        }
        const auto joined = std::count(room.begin(), room.end(), room[0]);
        EXPECT_NEAR(environment(plan).indoor().area(), 9.0 * static_cast<double>(joined), 1e-5)
            << plan;
    }
}

TEST(JoinedRooms, ClosedOpeningsChangeNothing) {
    testing::PlanStyle without, with;
    without.heading = with.heading = Angle::degrees(20);
    without.walls_per_door = 0;
    with.walls_per_door = 2;
    const Environment plain = environment(testing::buildingPlan(200, without));
    const Environment doors = environment(testing::buildingPlan(200, with));
    EXPECT_EQ(plain.indoor().parts.at(0).outline, doors.indoor().parts.at(0).outline);
    EXPECT_EQ(plain.wallLines(), doors.wallLines());
    EXPECT_EQ(plain.limits(), doors.limits());
}

TEST(SeveralRooms, EachInsidePointHasItsOwn) {
    const std::string rooms =
        "ispace id=a at=0,0 size=4,4\nispace id=b at=10,0 size=4,3\nispace id=c at=20,0 size=2,2\n";
    const Environment two = environment(rooms + "inside at=10,0\ninside at=20,0\n");
    ASSERT_EQ(two.indoor().parts.size(), 2U);
    EXPECT_DOUBLE_EQ(two.indoor().area(), 16);
    EXPECT_DOUBLE_EQ(two.indoor().boundaryLength(), 14 + 8);
    EXPECT_EQ(two.inside(), (Point2{10, 0}));
    EXPECT_EQ(two.indoor().locate({0, 0}), Side::Outside);
    EXPECT_EQ(two.indoor().locate({20, 0}), Side::Inside);
    EXPECT_EQ(two.indoor().locate({21, 0}), Side::Boundary);
    const Environment all = environment(rooms + "inside at=10,0\ninside at=20,0\ninside at=1,1\n");
    EXPECT_DOUBLE_EQ(all.indoor().area(), 32);
    // Points of one room are one.
    EXPECT_EQ(environment(rooms + "inside at=10,0\ninside at=10,0\ninside at=10,1\n")
                  .indoor()
                  .parts.size(),
              1U);
}

TEST(SeveralRooms, SideBySideAndWithin) {
    const std::string next = "ispace id=a at=0,0 size=4,4\nispace id=b at=4,0 size=4,4\n";
    const Environment side = environment(next + "inside at=0,0\ninside at=4,0\n");
    EXPECT_DOUBLE_EQ(side.indoor().area(), 32);
    EXPECT_EQ(side.indoor().locate({2, 0}), Side::Boundary);
    // A room within the ring of another.
    const std::string ring = "ispace id=a at=0,0 size=10,10\nispace id=b at=0,0 size=4,4\n";
    const Environment both = environment(ring + "inside at=4,0\ninside at=0,0\n");
    EXPECT_DOUBLE_EQ(both.indoor().area(), 100);
    EXPECT_DOUBLE_EQ(environment(ring + "inside at=4,0\n").indoor().area(), 84);
    const Environment with_cubes = environment(
        ring + "inside at=4,0\ninside at=0,0\ncube at=1,1 size=1,1,1\ncube at=4,4 size=1,1,1\n");
    EXPECT_DOUBLE_EQ(totalArea(with_cubes.level(0.15)->freeFloor()), 98);
}

}  // namespace joined_rooms_test
}  // namespace ispace
