// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/walls.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "base/number.h"
#include "env/level.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "support/test_floor_plans.h"
#include "support/test_scene.h"

namespace ispace {
namespace walls_test {

using testing::environment;
using testing::pointText;
using testing::record;

std::vector<Segment2> lines(const std::string& line) {
    Diagnostics findings;
    std::vector<Segment2> out = wallLines(record(line), findings);
    EXPECT_TRUE(findings.empty()) << line;
    return out;
}

std::string finding(const std::string& line) {
    Diagnostics findings;
    const auto out = wallLines(record(line), findings);
    try {
        findings.throwIfAny();
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    ADD_FAILURE() << line << " gave " << out.size() << " lines and no finding";
    return "";
}

TEST(WallLines, WallByEndsOrByCentre) {
    EXPECT_EQ(lines("wall from=1,2 to=3,4"), (std::vector<Segment2>{{{1, 2}, {3, 4}}}));
    EXPECT_EQ(lines("wall at=1,2 size=4"), (std::vector<Segment2>{{{-1, 2}, {3, 2}}}));
    EXPECT_EQ(lines("wall at=1,2 size=4 heading=90"), (std::vector<Segment2>{{{1, 0}, {1, 4}}}));
    EXPECT_EQ(lines("wall size=4"), (std::vector<Segment2>{{{-2, 0}, {2, 0}}}));
}

TEST(WallLines, FenceOpenClosedAndByEnds) {
    EXPECT_EQ(lines("fence from=0,0 to=1,0").size(), 1U);
    EXPECT_EQ(lines("fence path=0,0;1,0;1,1").size(), 2U);
    EXPECT_EQ(lines("fence path=0,0;1,0;1,1 closed=yes").size(), 3U);
    // A repeated first point at the end has no effect.
    EXPECT_EQ(lines("fence path=0,0;1,0;1,1;0,0 closed=yes").size(), 3U);
}

TEST(WallLines, RoomIsItsFourWalls) {
    EXPECT_EQ(lines("ispace at=1,1 size=4,2").size(), 4U);
    EXPECT_TRUE(lines("desk").empty());
    EXPECT_TRUE(lines("pillar").empty());
}

TEST(WallLines, FindsWhatIsNoWall) {
    EXPECT_EQ(finding("wall from=1,1 to=1,1"), "wall has zero length");
    EXPECT_EQ(finding("wall from=1,1 to=1.0000001,1"), "wall has zero length");
    EXPECT_EQ(finding("wall size=0"), "wall has zero length");
    EXPECT_EQ(finding("wall size=1,0,0"), "wall has zero height");
    EXPECT_NE(finding("wall").find("no extent"), std::string::npos);
    EXPECT_NE(finding("wall from=0,0").find("`to` is missing"), std::string::npos);
    EXPECT_NE(finding("wall from=0,0 to=1,1 size=3").find("one way only"), std::string::npos);
    EXPECT_NE(finding("wall from=0,0 to=1,1 at=3,3").find("`at`"), std::string::npos);
    EXPECT_NE(finding("fence").find("no extent"), std::string::npos);
    EXPECT_NE(finding("fence path=0,0").find("1 points"), std::string::npos);
    EXPECT_NE(finding("fence path=0,0;1,1 closed=yes").find("at least 3"), std::string::npos);
    EXPECT_NE(finding("fence path=0,0;1,1;1,1").find("zero length at (1, 1)"), std::string::npos);
    EXPECT_NE(finding("fence path=0,0;1,1 from=0,0 to=1,1").find("one way"), std::string::npos);
    EXPECT_NE(finding("ispace size=1e-7,3").find("zero length"), std::string::npos);
}

TEST(WallBodies, SheetsStandFromUndersideToHeight) {
    const Body wall = bodyOf(record("wall at=0,0,1 size=4,0,0.5 kind=brick"));
    ASSERT_EQ(wall.sheets.size(), 1U);
    EXPECT_EQ(wall.sheets[0].bottom, 1);
    EXPECT_EQ(wall.sheets[0].top, 1.5);
    EXPECT_EQ(wall.sheets[0].material, Material::Brick);
    const Body fence = bodyOf(record("fence path=0,0;1,0;1,1 height=1.2"));
    ASSERT_EQ(fence.sheets.size(), 2U);
    EXPECT_EQ(fence.sheets[1].top, 1.2);
}

TEST(WallBodies, ThickWallIsABoxAboutItsMidLine) {
    const Body wall = bodyOf(record("wall from=0,0 to=4,0 thickness=0.2"));
    EXPECT_TRUE(wall.sheets.empty());
    ASSERT_EQ(wall.prisms.size(), 1U);
    EXPECT_EQ(wall.prisms[0].footprint, (Polygon{{0, -0.1}, {4, -0.1}, {4, 0.1}, {0, 0.1}}));
    EXPECT_EQ(bodyOf(record("wall size=4,0.3")).prisms.size(), 1U);
}

TEST(WallBodies, MitreFillsTheCorner) {
    const Body fence = bodyOf(record("fence path=0,0;4,0;4,3 thickness=0.2"));
    ASSERT_EQ(fence.prisms.size(), 3U);
    const Polygon& joint = fence.prisms[1].footprint;
    EXPECT_NEAR(signedArea(joint), 0.01, 1e-12);
    EXPECT_EQ(locate(joint, {4.05, -0.05}), Side::Inside);
    EXPECT_NE(locate(joint, {4.1, -0.1}), Side::Outside);
    // The joint has the very corners of the boxes.
    const auto has = [](const Polygon& polygon, Point2 p) {
        return std::find(polygon.begin(), polygon.end(), p) != polygon.end();
    };
    int shared = 0;
    for (const Point2 p : joint)
        shared += has(fence.prisms[0].footprint, p) + has(fence.prisms[2].footprint, p);
    EXPECT_EQ(shared, 2);
}

TEST(WallBodies, SharpCornerIsCutOff) {
    const Body fence = bodyOf(record("fence path=0,0;4,0;0,0.2 thickness=0.2"));
    ASSERT_EQ(fence.prisms.size(), 3U);
    EXPECT_EQ(fence.prisms[1].footprint.size(), 3U);
    for (const Point2 p : fence.prisms[1].footprint) EXPECT_LT(distance(p, Point2{4, 0}), 0.41);
    // There and back again encloses no area.
    EXPECT_EQ(bodyOf(record("fence path=0,0;4,0;0,0 thickness=0.2")).prisms.size(), 2U);
}

TEST(WallBodies, ClosedThickFenceHasNoNotches) {
    const Environment env = environment(
        "fence path=0,0;6,0;6,4;3,4;3,2;0,2 closed=yes "
        "thickness=0.2\n");
    EXPECT_NEAR(env.indoor().area(), 18, 1e-9);
    // Inner faces: 5.8 x 3.8 less the 3 x 2 notch, whose corner is a full mitre.
    const double free = totalArea(env.level(1)->freeFloor());
    EXPECT_NEAR(free, 5.8 * 3.8 - 3 * 2, 1e-9);
}

TEST(WallBodies, JointOfTwoRecordsBelongsToTheFirst) {
    const Environment env = environment(
        "wall id=a from=0,0 to=4,0 thickness=0.2\n"
        "wall id=b from=4,0 to=4,4 thickness=0.4 height=2\n"
        "wall id=c from=4,4 to=0,4\nwall id=d from=0,4 to=0,0\n");
    EXPECT_EQ(env.elements()[0].body.prisms.size(), 2U);
    EXPECT_EQ(env.elements()[1].body.prisms.size(), 1U);
    EXPECT_EQ(env.elements()[0].body.prisms[1].top, 2);
    EXPECT_NEAR(signedArea(env.elements()[0].body.prisms[1].footprint), 0.02, 1e-12);
    EXPECT_EQ(env.height(), 2.5);
}

/// Ends of all sheets as exact pairs.
std::multiset<std::pair<double, double>> sheetEnds(const Environment& env) {
    std::multiset<std::pair<double, double>> ends;
    for (const Element& element : env.elements())
        for (const Sheet& sheet : element.body.sheets) {
            ends.insert({sheet.line.a.x, sheet.line.a.y});
            ends.insert({sheet.line.b.x, sheet.line.b.y});
        }
    return ends;
}

std::string wallAt(Point2 center, double length, double heading) {
    return "wall at=" + formatDouble(center.x) + "," + formatDouble(center.y) +
           " size=" + formatDouble(length) + " heading=" + formatDouble(heading) + "\n";
}

TEST(WallBodies, RotatedWallsShareTheirCorners) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> turn(-180, 180), shift(-50, 50);
    for (int round = 0; round < 50; ++round) {
        const Pose2 world_from_room{{shift(random), shift(random)}, Angle::degrees(turn(random))};
        const double h = world_from_room.heading.degrees();
        // A 6 x 4 room of four walls and a partition that ends on two of them.
        const std::string room = wallAt(world_from_room * Point2{3, 0}, 6, h) +
                                 wallAt(world_from_room * Point2{6, 2}, 4, h + 90) +
                                 wallAt(world_from_room * Point2{3, 4}, 6, h + 180) +
                                 wallAt(world_from_room * Point2{0, 2}, 4, h - 90) +
                                 wallAt(world_from_room * Point2{2, 2}, 4, h + 90);
        const Point2 inside = world_from_room * Point2{4, 2};
        const Environment env = environment(room + "inside at=" + formatDouble(inside.x) + "," +
                                            formatDouble(inside.y) + "\n");
        const auto ends = sheetEnds(env);
        const std::set<std::pair<double, double>> places(ends.begin(), ends.end());
        EXPECT_EQ(places.size(), 6U);
        EXPECT_EQ(ends.size(), 14U);
        for (const auto& place : places)
            EXPECT_GE(ends.count(place), 2U) << place.first << ' ' << place.second;
        EXPECT_NEAR(env.indoor().area(), 16, 1e-5);
    }
}

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

TEST(WallCrossings, OfStarsAreOverlapsAlone) {
    // 1000 walls from a common end: none crosses another, two lie on each other.
    std::string walls = kRoom;
    for (int i = 0; i < 1000; ++i) {
        const double turn = 2 * 3.14159265358979 * i / 1000;
        walls += "wall from=0,0 to=" + std::to_string(3 * std::cos(turn)) + ',' +
                 std::to_string(3 * std::sin(turn)) + '\n';
    }
    EXPECT_TRUE(wallCrossings(environment(walls).elements()).empty());
    walls += "wall from=2,0 to=0,0\n";
    const Environment env = environment(walls);
    const auto found = wallCrossings(env.elements());
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found[0].overlap);
    EXPECT_EQ(found[0].b, 1001U);
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

}  // namespace walls_test
}  // namespace ispace
