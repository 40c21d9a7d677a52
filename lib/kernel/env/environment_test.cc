// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "env/level.h"
#include "geom/predicates.h"
#include "record/yaml/yaml.h"
#include "support/test_scene.h"

namespace ispace {
namespace environment_test {

using testing::document;
using testing::environment;
using testing::findings;

TEST(Environment, RoomByOneRecord) {
    const Environment env = environment("ispace at=1,2 size=6,4\n");
    EXPECT_EQ(env.limits(), (Box2{{-2, 0}, {4, 4}}));
    EXPECT_EQ(env.indoor().area(), 24);
    EXPECT_TRUE(env.indoor().parts.at(0).holes.empty());
    EXPECT_EQ(env.height(), 2.5);
    EXPECT_EQ(env.wallLines().size(), 4U);
    // The origin lies on the lower wall, so a point of the room stands in for it.
    EXPECT_EQ(env.indoor().locate(env.inside()), Side::Inside);
    EXPECT_EQ(env.level(kScanHeight)->freeFloor().size(), 1U);
}

TEST(Environment, RoomKeepsItsCeiling) {
    const Environment env = environment("ispace size=6,4,2.2 ceiling=yes\n");
    const Body& body = env.elements().front().body;
    ASSERT_EQ(body.plates.size(), 1U);
    EXPECT_EQ(body.plates[0].z, 2.2);
    EXPECT_EQ(body.sheets.size(), 4U);
}

TEST(Environment, LRoom) {
    const Environment env =
        environment("fence path=0,0;6,0;6,2;2,2;2,5;0,5 closed=yes height=3\ninside at=1,1\n");
    EXPECT_EQ(env.limits(), (Box2{{0, 0}, {6, 5}}));
    EXPECT_DOUBLE_EQ(env.indoor().area(), 18);
    EXPECT_DOUBLE_EQ(env.indoor().boundaryLength(), 22);
    EXPECT_EQ(env.height(), 3);
    EXPECT_EQ(env.inside(), (Point2{1, 1}));
    EXPECT_EQ(env.indoor().locate({4, 4}), Side::Outside);
}

TEST(Environment, WhatATangledFenceEnclosesIsNotAsked) {
    // Where the point lies would take an overlay of all crossings, of which there may be millions.
    EXPECT_EQ(findings("fence path=0,0;4,4;4,0;0,4 closed=yes\ninside at=9,9\n"),
              "room.env:2:12: error: fence crosses itself near (2.0, 2.0)\n");
}

TEST(Environment, LeavesOtherRecordsAlone) {
    Schemas others({Schema{"laser",
                           RecordType::Placement,
                           "a sensor",
                           {KeySpec{.name = "id", .type = KeyType::Word, .help = "name"}}}});
    std::vector<Record> records = document("ispace id=room\n").records;
    records.insert(records.begin(), readRecord("laser id=l1", "line", others));
    const Environment env(records, assignIds(records));
    ASSERT_EQ(env.elements().size(), 1U);
    EXPECT_EQ(env.elements()[0].id, "room");
}

TEST(Environment, InsideIsTheOriginElseTheLargest) {
    // Two rooms; the origin lies in the smaller one.
    const std::string rooms = "ispace at=0,0 size=2,2\nispace at=5,0 size=6,4\n";
    EXPECT_EQ(environment(rooms).indoor().area(), 4);
    EXPECT_EQ(environment(rooms).inside(), Point2());
    // A record decides.
    EXPECT_EQ(environment(rooms + "inside at=5,1\n").indoor().area(), 24);
    EXPECT_EQ(environment(rooms + "inside at=5,1\n").inside(), (Point2{5, 1}));
    // The origin in neither: the largest, wherever it stands in the file.
    const Environment far = environment("ispace at=9,0 size=2,2\nispace at=5,0 size=6,4\n");
    EXPECT_EQ(far.indoor().area(), 24);
    EXPECT_EQ(far.indoor().locate(far.inside()), Side::Inside);
}

TEST(Environment, OriginInAClosedPillar) {
    const std::string plan =
        "fence path=-4,-4;4,-4;4,4;-4,4 closed=yes\n"
        "fence path=-0.5,-0.5;0.5,-0.5;0.5,0.5;-0.5,0.5 closed=yes\n";
    // By the rule the face that holds the origin is the pillar; importers write `inside`.
    EXPECT_EQ(environment(plan).indoor().area(), 1);
    const Environment room = environment(plan + "inside at=2,2\n");
    EXPECT_EQ(room.indoor().area(), 63);
    EXPECT_EQ(room.indoor().parts.at(0).holes.size(), 1U);
    EXPECT_EQ(room.indoor().boundaryLength(), 36);
    // A pillar record is a thing in the room, not a wall.
    EXPECT_EQ(environment("ispace\npillar size=1,1\n").indoor().area(), 64);
}

TEST(Environment, PartitionsSplitOrDangle) {
    const std::string room = "ispace at=0,0 size=8,6\n";
    EXPECT_EQ(environment(room + "wall from=1,-3 to=1,3\n").indoor().area(), 5 * 6);
    const Environment dangling = environment(room + "wall from=1,-3 to=1,2\n");
    EXPECT_EQ(dangling.indoor().area(), 48);
    EXPECT_EQ(dangling.slice(1).sheets.size(), 6U);  // the lower wall is split at the partition
}

TEST(Environment, TellsTheGap) {
    EXPECT_EQ(findings("wall id=w1 from=0,0 to=4,0\nwall id=w2 from=4,0 to=4,2\n"
                       "wall id=w3 from=4.16,2 to=4.16,3\nwall id=w5 from=4.16,3 to=0,3\n"
                       "wall id=w4 from=0,3 to=0,0\n")
                  .substr(0, 82),
              "room.env:3:1: error: not enclosed: 0.16 m between w2 and w3 near (4.08, 2.0); make");
    EXPECT_EQ(findings("fence id=f1 path=0,0;4,0;4,3;0.005,3;0,0.2\n"),
              "room.env:2:1: error: not enclosed: 0.2 m between f1 and f1 near (0.0, 0.1); "
              "closed=yes joins its ends\n");
}

TEST(Environment, GapIsTheFormOfTheManual) {
    const std::string text = findings(
        "wall id=w1 from=0,0 to=4.1,0\nwall id=w2 from=0,0 to=0,4\n"
        "wall id=w3 from=4.1,0 to=4.1,1.94\nwall id=w4 from=4.1,2.06 to=4.1,4\n"
        "wall id=w5 from=4.1,4 to=0,4\n");
    EXPECT_NE(text.find("not enclosed: 0.12 m between w3 and w4 near (4.1, 2.0)"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("room.env:4:"), 0U) << text;
}

TEST(Environment, SmallGapsAreToldToo) {
    for (const char* gap : {"0.005", "0.0012", "0.00002"}) {
        const std::string text = findings(
            "wall from=0,0 to=4,0\nwall from=4,0 to=4,3\n"
            "wall from=4,3 to=0,3\nwall from=0,3 to=0," +
            std::string(gap) + "\n");
        EXPECT_NE(text.find("not enclosed: " + std::string(gap) + " m between wall1 and wall4"),
                  std::string::npos)
            << text;
    }
    // Nearer than the weld is no gap.
    EXPECT_EQ(findings("wall from=0,0 to=4,0\nwall from=4,0 to=4,3\nwall from=4,3 to=0,3\n"
                       "wall from=0,3 to=0,0.0000005\n"),
              "");
}

TEST(Environment, InsideMustBeInside) {
    const std::string room = "ispace at=0,0 size=4,4\n";
    EXPECT_NE(findings(room + "inside at=7,8.5\n")
                  .find("room.env:3:11: error: inside point (7.0, 8.5) lies outside of everything"),
              std::string::npos)
        << findings(room + "inside at=7,8.5\n");
    EXPECT_NE(findings(room + "inside at=2,0\n").find("(2.0, 0.0) lies on a wall"),
              std::string::npos);
    EXPECT_EQ(findings(room + "inside at=1,1\ninside at=1,0\ninside at=1,1\n"), "");
    // Each point is checked by itself.
    EXPECT_EQ(findings(room + "inside at=1,1\ninside at=2,0\ninside at=7,8.5\n"),
              "room.env:4:11: error: inside point (2.0, 0.0) lies on a wall; move it off\n"
              "room.env:5:11: error: inside point (7.0, 8.5) lies outside of everything enclosed; "
              "move it into the room, or leave it out\n");
}

TEST(Environment, InsideOfALeakyRoomTellsTheGapThoughAPillarIsClosed) {
    const std::string leaky =
        "wall from=0,0 to=4,0\nwall from=4,0 to=4,3\nwall from=4,3 to=0,3\nwall from=0,3 to=0,0.3\n"
        "fence path=1,1;1.5,1;1.5,1.5;1,1.5 closed=yes\n";
    for (const char* inside : {"inside at=3,2\n", ""}) {
        const std::string text = findings(leaky + inside);
        EXPECT_NE(text.find("not enclosed: 0.3 m between wall1 and wall4 near (0.0, 0.15)"),
                  std::string::npos)
            << text;
    }
}

TEST(Environment, ALooseWallOutsideIsNoLeak) {
    EXPECT_EQ(findings("ispace size=4,4\nwall from=-9,-9 to=9,-9\nwall from=-9,9 to=9,9\n"), "");
}

TEST(Environment, NoWallsAtAll) {
    EXPECT_EQ(findings(""),
              "error: no walls: nothing encloses a room; add an ispace, wall or fence "
              "record, or read a layout beside its room (ROOM LAYOUT)\n");
    EXPECT_NE(findings("desk\n").find("room.env: error: no walls"), std::string::npos);
    EXPECT_NE(findings("wall from=0,0 to=1,0\n").find("not enclosed"), std::string::npos);
}

TEST(Environment, ReportsAllFindingsWithTheirPlace) {
    EXPECT_EQ(findings("ispace\nwall from=1,1 to=1,1\nzone id=z path=0,0;1,1;1,0;0,1\n"
                       "zone id=y path=0,0;1,1\nzone id=x\nzone id=w path=0,0;1,1;2,2\n"
                       "fence path=0,0;2,2;2,0;0,2 closed=yes\n"),
              "room.env:3:18: error: wall has zero length\n"
              "room.env:4:16: error: zone crosses itself near (0.5, 0.5)\n"
              "room.env:5:16: error: zone has 2 points, wanted at least 3\n"
              "room.env:6:1: error: zone has no extent: give `path`, or `at` and `size`\n"
              "room.env:7:16: error: zone has no area\n"
              "room.env:8:12: error: fence crosses itself near (1.0, 1.0)\n");
}

TEST(Environment, HasOneWeather) {
    EXPECT_EQ(findings("ispace\nweather sun=500\n"), "");
    EXPECT_EQ(findings("weather sun=500\nispace\nweather id=w\n"),
              "room.env:4:1: error: the room has weather already, in line 2\n");

    const std::vector<Record> one = document("ispace\nweather id=w\n").records;
    const std::vector<Record> changed = document("ispace\nweather id=w sun=500\n").records;
    const std::vector<Record> two = document("ispace\nweather id=w\nweather id=v\n").records;
    const Environment before = environment(one);
    EXPECT_NO_THROW(Environment(changed, assignIds(changed), before));
    EXPECT_THROW(Environment(two, assignIds(two), before), FormatError);
}

TEST(Environment, RefusesWhatVanishesInRounding) {
    EXPECT_NE(findings("ispace\ncube at=1000000,0 size=1e-11\n").find("too small"),
              std::string::npos);
    EXPECT_NE(findings("ispace\ntable size=1e-200\n").find("too small"), std::string::npos);
    EXPECT_EQ(findings("ispace\ncube size=1e-5\n"), "");
}

TEST(Environment, SliceCutsWhatStandsAtItsHeight) {
    const Environment env = environment(
        "fence path=0,0;8,0;8,6;0,6 closed=yes height=2\nwall from=4,0 to=4,3 height=1\n"
        "cube at=2,2 size=1,1,0.5\ncube at=6,2,1.5 size=1,1,0.5\n");
    EXPECT_EQ(env.slice(0).sheets.size(), 6U);
    EXPECT_EQ(env.slice(0).solids.size(), 1U);
    EXPECT_EQ(env.slice(0.5).solids.size(), 1U);
    EXPECT_EQ(env.slice(0.6).solids.size(), 0U);
    EXPECT_EQ(env.slice(1).sheets.size(), 6U);
    EXPECT_EQ(env.slice(1.1).sheets.size(), 5U);
    EXPECT_EQ(env.slice(2).solids.size(), 1U);
    EXPECT_EQ(env.slice(2.1).sheets.size(), 0U);
    EXPECT_EQ(env.slice(-0.1).sheets.size(), 0U);
    EXPECT_TRUE(env.slice(0.15).blocked({2, 2}));
    EXPECT_TRUE(env.slice(0.15).blocked({2.5, 2.5}));
    EXPECT_FALSE(env.slice(0.15).blocked({2.6, 2.5}));
    int lines = 0;
    env.slice(0.15).forEachLine([&](const Segment2&) { ++lines; });
    EXPECT_EQ(lines, 6 + 4);
}

TEST(Environment, BandHoldsWhatStandsBetweenItsHeights) {
    const Environment env = environment(
        "ispace size=6,6,2\n"
        "wall from=-1,-1 to=1,-1 height=0.1\n"
        "cube at=2,2,0 size=1,1,0.5\n"
        "cube at=-2,2,0.8 size=1,1,0.5\n"
        "floor size=2,2 kind=checker\n");
    const Slice low = env.band(0, 0.22);
    EXPECT_EQ(low.sheets.size(), 5U);
    ASSERT_EQ(low.solids.size(), 1U);
    EXPECT_EQ(locate(low.solids[0], {2, 2}), Side::Inside);
    EXPECT_EQ(low.sheet_owners, (std::vector<std::size_t>{0, 0, 0, 0, 1}));
    EXPECT_EQ(low.solid_owners, std::vector<std::size_t>{2});
    int lines = 0;
    low.forEachLine([&](const Segment2&) { ++lines; });
    EXPECT_EQ(lines, 5 + 4);
    EXPECT_EQ(env.band(0, 1).solids.size(), 2U);
    // Between a thing's top and the underside of another; both ends count.
    EXPECT_EQ(env.band(0.6, 0.7).solids.size(), 0U);
    EXPECT_EQ(env.band(0.5, 0.7).solids.size(), 1U);
    EXPECT_EQ(env.band(0.6, 0.8).solids.size(), 1U);
    EXPECT_EQ(env.band(0.5, 0.8).solids.size(), 2U);
    EXPECT_EQ(env.band(0.11, 0.2).sheets.size(), 4U);
    EXPECT_EQ(env.band(2, 3).sheets.size(), 4U);
    EXPECT_TRUE(env.band(2.01, 3).sheets.empty());
    EXPECT_TRUE(env.band(-1, -0.01).sheets.empty());
}

TEST(Environment, ABandOfNoHeightIsTheSlice) {
    const Environment env = environment(
        "ispace size=8,8\ndesk at=2,2\ntable at=-2,2\nchair at=1,-2\npillar at=-2,-2 kind=round\n");
    for (const double height : {0.0, 0.15, 0.42, 0.68, 0.7, 1.0, 2.5, 3.0}) {
        Slice slice = env.slice(height);
        const Slice band = env.band(height, height);
        // Round solids are inscribed in a band, and have their area in a slice.
        for (const Slice::Round& round : slice.rounds) {
            EXPECT_NEAR(signedArea(slice.solids[round.solid]), round.curve.area(), 1e-12);
            slice.solids[round.solid] = inscribedIn(round.curve);
        }
        EXPECT_EQ(band.sheets, slice.sheets) << height;
        EXPECT_EQ(band.solids, slice.solids) << height;
        EXPECT_EQ(band.sheet_owners, slice.sheet_owners) << height;
        EXPECT_EQ(band.solid_owners, slice.solid_owners) << height;
    }
}

TEST(Environment, FreeFloorAroundRoundThingsIsExact) {
    const std::string room = "ispace at=0,0 size=8,6\n";
    const auto free = [&](const std::string& things) {
        return totalArea(environment(room + things).level(kScanHeight)->freeFloor());
    };
    const double pi = std::numbers::pi;
    for (const double r : {0.05, 0.1, 0.3, 0.5, 1.0}) {
        const std::string size = " size=" + std::to_string(2 * r) + ",";
        const std::string circle = size + std::to_string(2 * r) + ",1";
        EXPECT_NEAR(free("cylinder at=1,0.5" + circle), 48 - pi * r * r, 1e-9) << r;
        EXPECT_NEAR(free("pillar kind=round at=1,0.5" + circle), 48 - pi * r * r, 1e-9) << r;
        EXPECT_NEAR(free("cylinder at=1,0.5 heading=30" + size + "0.2,1"), 48 - pi * r * 0.1, 1e-9);
        // In contact with a wall, and cut in half by it.
        EXPECT_NEAR(free("cylinder at=" + std::to_string(4 - r) + ",0" + circle), 48 - pi * r * r,
                    1e-6);
        EXPECT_NEAR(free("cylinder at=4,0" + circle), 48 - pi * r * r / 2, 1e-6);
        EXPECT_NEAR(free("cylinder at=4,0 heading=13" + circle), 48 - pi * r * r / 2, 1e-6);
        // Two discs that are as far apart as their radius share a lens.
        const double lens = r * r * (2 * pi / 3 - std::sqrt(3) / 2);
        EXPECT_NEAR(free("cylinder at=1,0.5" + circle + "\ncylinder at=" + std::to_string(1 + r) +
                         ",0.5" + circle),
                    48 - 2 * pi * r * r + lens, 1e-6)
            << r;
    }
    // A table's foot; its top is higher.
    EXPECT_NEAR(free("table at=1,1 size=0.9"), 48 - pi * 0.045 * 0.045, 1e-9);
}

TEST(Environment, FreeFloorIsExact) {
    const std::string room = "ispace at=0,0 size=8,6\n";
    const auto free = [&](const std::string& things, double height = kScanHeight) {
        return totalArea(environment(room + things).level(height)->freeFloor());
    };
    EXPECT_DOUBLE_EQ(free("cube at=1,1 size=1\n"), 47);
    EXPECT_DOUBLE_EQ(free("cube at=1,1 size=1\ncube at=1.5,1 size=1\n"), 46.5);
    EXPECT_DOUBLE_EQ(free("cube at=1,1 size=1\ncube at=2,1 size=1\n"), 46);
    EXPECT_DOUBLE_EQ(free("cube at=3.5,1 size=1\n"), 47);    // along the wall
    EXPECT_DOUBLE_EQ(free("cube at=4,1 size=1\n"), 47.5);    // half through it
    EXPECT_DOUBLE_EQ(free("cube at=9,1 size=1\n"), 48);      // outside
    EXPECT_DOUBLE_EQ(free("cube at=1,1,0.2 size=1\n"), 48);  // above the plane
    EXPECT_DOUBLE_EQ(free("cube at=1,1,0.2 size=1\n", 0.2), 47);
    EXPECT_DOUBLE_EQ(free("cube size=20\n"), 0);
    EXPECT_NEAR(free("cube size=1 heading=30\n"), 47, 1e-9);
    // A wall of boxes cuts the room in two.
    const auto pieces = environment(room + "cube size=1,6\n").level(kScanHeight)->freeFloor();
    EXPECT_EQ(pieces.size(), 2U);
}

TEST(Environment, ThickWallsTakeTheirHalfOfTheFloor) {
    const Environment env =
        environment("fence path=-4,-3;4,-3;4,3;-4,3 closed=yes thickness=0.2\n");
    EXPECT_DOUBLE_EQ(env.indoor().area(), 48);
    EXPECT_NEAR(totalArea(env.level(1)->freeFloor()), 7.8 * 5.8, 1e-9);
    EXPECT_EQ(env.limits(), (Box2{{-4, -3}, {4, 3}}));
}

TEST(Environment, HolesOfImportedPlansAreNotIndoor) {
    std::string plan = "fence path=0,0;20,0;20,20;0,20 closed=yes\ninside at=0.5,0.5\n";
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            const auto p = [&](double x, double y) {
                return std::to_string(2 * (i + 1) + x) + "," + std::to_string(2 * (j + 1) + y);
            };
            plan += "fence path=" + p(-0.25, -0.25) + ";" + p(0.25, -0.25) + ";" + p(0.25, 0.25) +
                    ";" + p(-0.25, 0.25) + " closed=yes\n";
        }
    const Environment env = environment(plan);
    EXPECT_EQ(env.indoor().parts.at(0).holes.size(), 81U);
    EXPECT_NEAR(env.indoor().area(), 400 - 81 * 0.25, 1e-9);
}

TEST(Environment, ParityAgreesWhereWallsAreClosedCurves) {
    const Environment env = environment(
        "fence path=0,0;7,0;7,3;5,3;5,5;9,5;9,8;0,8;0,6;2,6;2,2;0,2 closed=yes\n"
        "fence path=3,5;4,6;3,7 closed=yes\nfence path=5,6;6,6;6,7;5,7 closed=yes\n"
        "inside at=1,1\n");
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> x(-1, 10), y(-1, 9);
    int inside = 0;
    for (int i = 0; i < 4000; ++i) {
        const Point2 p{x(random), y(random)};
        const bool exact = env.indoor().locate(p) == Side::Inside;
        EXPECT_EQ(insideByParity(p, env.inside(), env.wallLines()), exact) << p.x << ' ' << p.y;
        inside += exact;
    }
    EXPECT_GT(inside, 1000);
    EXPECT_LT(inside, 3000);
}

TEST(Environment, ParityErrsBehindAFreeStandingWall) {
    const Environment env = environment("ispace\nwall from=1,-1 to=1,1\n");
    EXPECT_EQ(env.indoor().locate({2, 0}), Side::Inside);
    EXPECT_FALSE(insideByParity({2, 0}, env.inside(), env.wallLines()));
    EXPECT_TRUE(insideByParity({0.5, 0}, env.inside(), env.wallLines()));
}

TEST(Environment, RefusesShapesWithoutEnd) {
    std::string lines = "fence path=0,0;8,0;8,6;0,6 closed=yes\n";
    for (int i = 0; i < 800; ++i) lines += "floor size=40,40 kind=checker\n";
    const std::string found = findings(lines);
    // 64 x 64 squares of four corners each: 66 of them are more than a million and 66 000.
    EXPECT_TRUE(found.starts_with("room.env:6")) << found;
    EXPECT_NE(found.find(" corners: fewer"), std::string::npos) << found;
}

TEST(Environment, BearsFewerRoundThingsThatARepetitionMakes) {
    const auto made = [](const std::string& rows) {
        const Document scene =
            readYaml("- ispace: {size: [500, 500]}\n- cylinder: {repeat: {rows: " + rows +
                         ", cols: 100, step: [1, 1]}}\n",
                     "hall.yaml", testing::schemas());
        try {
            (void)environment(scene.records);
        } catch (const FormatError& error) {
            return error.diagnostics().front().text();
        }
        return std::string();
    };
    EXPECT_EQ(made("50"), "");
    EXPECT_NE(made("120").find("hall.yaml:2:3: error: the shapes up to here"), std::string::npos)
        << made("120");
}

TEST(Environment, BearsAsManyRoundThingsAsSomebodyWrites) {
    std::string lines = "fence path=0,0;800,0;800,6;0,6 closed=yes\n";
    for (int i = 0; i < 3000; ++i) lines += "table at=" + std::to_string(5 + i / 4) + ",3\n";
    EXPECT_EQ(findings(lines), "");
}

TEST(Environment, SameForAnyRun) {
    const std::string plan = "ispace heading=13\ncube at=1,1 heading=5\nwall from=0,0 to=1,2\n";
    const Environment a = environment(plan), b = environment(plan);
    EXPECT_EQ(a.indoor().parts.at(0).outline, b.indoor().parts.at(0).outline);
    EXPECT_EQ(a.wallLines(), b.wallLines());
    EXPECT_EQ(a.inside(), b.inside());
}

}  // namespace environment_test
}  // namespace ispace
