// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/findings/findings.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "base/file.h"
#include "geom/arrangement.h"
#include "record/text.h"
#include "support/test_check.h"
#include "support/test_layout.h"
#include "support/test_mesh.h"
#include "support/test_paths.h"

namespace ispace {

using testing::boxMesh;
using testing::check;
using testing::devices;
using testing::roomDocument;
using testing::scene;

namespace check_scene_test {

constexpr const char* kGood =
    "desk id=d at=2,2\n"
    "chair id=c at=2,1.55 heading=90 size=0.4,0.4,0.6\n"
    "table id=t at=5,3\n"
    "boxes id=b at=7,5\n"
    "screen id=s at=1,4 heading=90\n"
    "infra id=f at=4,3\n"
    "pillar id=p at=4,5 \n"
    "cylinder id=y at=5,3,0.7\n"
    "zone id=z at=4,3 size=20,20\n"
    "mat id=m at=6,2\n"
    "gate id=g at=6,1\n"
    "human id=h at=3,4\n"
    "robot id=r at=1,1\n"
    "laser id=l at=0.5,0.5\n"
    "laser id=k on=d at=0,0,0.1\n"
    "camera id=w at=8,3,2\n"
    "tag id=a on=r at=0,0,0.3\n"
    "laser id=later\n";

TEST(CheckScene, NothingToFind) {
    EXPECT_EQ(check(kGood),
              "room.env:20:1: warning: laser later has no position and takes no readings; give it "
              "`at` or `on`, or let arrange place it\n");
    EXPECT_EQ(check(""), "");
}

TEST(CheckScene, ScenesOfTheProjectAreInOrder) {
    for (const char* name : {"ispace.env", "facilities.env", "crowded.env", "tracking.env"}) {
        const std::string file = testing::sourcePath("share/scenes/") + name;
        const Document document = readRecordText(readAll(file), name, sceneSchemas());
        EXPECT_EQ(check(makeScene(document, nullptr, devices())), "") << name;
    }
}

TEST(CheckScene, OverlapWithPlaceAndCure) {
    EXPECT_EQ(
        check("desk id=d1 at=2,3\nchair id=c2 at=2.7,3\n"),
        "room.env:3:1: warning: desk d1 overlaps chair c2 near (2.49, 3.0); move one, e.g. by "
        "0.13 m\n");
    // Ids that were given by the program are told as they are.
    EXPECT_EQ(
        check("cube at=2,3\ncube at=2.4,3\n"),
        "room.env:3:1: warning: cube1 overlaps cube2 near (2.2, 3.0); move one, e.g. by 0.10 m\n");
}

TEST(CheckScene, ThePlaceOfTheCureIsRight) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(3, 3.8), heading(-180, 180);
    const char* kinds[] = {"cube", "desk kind=closed", "table", "chair", "boxes", "cylinder"};
    int found = 0;
    for (int run = 0; run < 200; ++run) {
        const auto thing = [&](const char* id) {
            std::string line = kinds[random() % 6];
            line += " id=" + std::string(id) + " at=" + std::to_string(place(random)) + ',' +
                    std::to_string(place(random)) + " heading=" + std::to_string(heading(random));
            return line + '\n';
        };
        const std::string a = thing("a"), b = thing("b");
        const Scene made = scene("ispace id=room at=4,3 size=8,6\n" + a + b);
        // By brute force: the areas of the cuts, together and each by itself.
        bool overlap = false;
        const Region all{rectangle({4, 3}, 8, 6, {}), {}};
        const auto area = [&](std::span<const Polygon> solids) {
            return all.area() - totalArea(difference(all, solids));
        };
        for (int k = 0; k < 60 && !overlap; ++k) {
            const double z = 0.0051 + 0.0171 * k;
            std::vector<Polygon> solids[2], both;
            for (std::size_t i : {1U, 2U})
                for (const Prism& prism : made.environment.elements()[i].body.prisms)
                    if (prism.bottom < z && z < prism.top) {
                        solids[i - 1].push_back(prism.footprint);
                        both.push_back(prism.footprint);
                    }
            overlap = area(solids[0]) + area(solids[1]) - area(both) > 1e-7;
        }
        const std::string text = check(made);
        EXPECT_TRUE(!overlap || !text.empty()) << a << b;
        found += overlap ? 1 : 0;
    }
    EXPECT_GT(found, 50);
    EXPECT_LT(found, 195);
}

TEST(CheckScene, WhatStandsOnBelowAndBesideIsFine) {
    EXPECT_EQ(check("cube id=a at=2,2 size=1\ncube id=b at=2,2,1 size=0.5\n"
                    "cube id=c at=3,2 size=1\ncube id=d at=2,3 heading=90 size=1\n"),
              "");
    EXPECT_EQ(check("cube id=a at=0.1,0.1,0.1 size=0.2\ncube id=b at=0.1,0.1,0.3 size=0.2\n"), "");
    EXPECT_NE(check("cube id=a at=2,2 size=1\ncube id=b at=2,2,0.99 size=0.5\n"), "");
    EXPECT_NE(check("cube id=a at=2,2 size=1\ncube id=c at=2.999,2 size=1\n"), "");
    // Turned and touching: rounding does not count.
    for (const double heading : {10.0, 33.0, 77.0, 123.0}) {
        const Vec2 way = unitVector(Angle::degrees(heading));
        const std::string turn = " heading=" + std::to_string(heading);
        const std::string at = std::to_string(4 + way.x) + "," + std::to_string(3 + way.y);
        EXPECT_EQ(
            check("cube id=a at=4,3 size=1" + turn + "\ncube id=b size=1 at=" + at + turn + "\n"),
            "");
    }
}

TEST(CheckScene, WallsWithAndWithoutThickness) {
    EXPECT_EQ(
        check("desk id=d at=0.5,3\n"),
        "room.env:3:1: warning: desk d overlaps ispace room near (0.0, 3.0); move it, e.g. by "
        "0.10 m\n");
    EXPECT_EQ(check("desk id=d at=0.6,3\n"), "") << "it stands against the wall";
    EXPECT_EQ(check("wall id=w from=3,3 to=5,3 thickness=0.2\ndesk id=d at=4,3.4\n"),
              "room.env:4:1: warning: desk d overlaps wall w near (4.0, 3.05); move it, e.g. by "
              "0.10 m\n");
    EXPECT_EQ(check("wall id=w from=3,3 to=5,3 thickness=0.2\ndesk id=d at=4,3.5\n"), "");
    // A low fence passes below the top, and between the legs.
    EXPECT_EQ(check("fence id=f path=3,3;5,3 height=0.3\ndesk id=d at=4,3\n"), "");
    EXPECT_NE(check("fence id=f path=3,3.38;5,3.38 height=0.3\ndesk id=d at=4,3\n"), "");
}

TEST(CheckScene, TheBuildingMayRunIntoItself) {
    EXPECT_EQ(check("pillar at=0,3\ninfra at=2,3\npillar at=4,3\npillar at=4.1,3\n"), "");
    EXPECT_NE(check("pillar at=0,3\ndesk at=0.7,3\n"), "");
    EXPECT_NE(check("pillar at=-3,3\n").find("pillar1 lies outside the room"), std::string::npos);
}

TEST(CheckScene, OutsideAndPartlyOutside) {
    EXPECT_EQ(check("desk id=d at=12,3\n"),
              "room.env:3:1: warning: desk d lies outside the room near (11.4, 2.6); move it in or "
              "leave it out\n");
    // Above the walls only the room tells.
    const std::string partly = check("cube id=f at=8,3,3\n");
    EXPECT_NE(partly.find("cube f lies partly outside the room near"), std::string::npos);
    // One finding is enough for what stands in the wall.
    EXPECT_EQ(check("desk id=d at=0,3\n").find("outside"), std::string::npos);
    const std::string zone = check("zone id=z at=20,3 size=2,2\nzone id=y at=8,3 size=1,1\n");
    EXPECT_EQ(zone,
              "room.env:3:1: warning: zone z lies outside the room near (19.0, 2.0); move it in "
              "or leave it out\n");
}

TEST(CheckScene, RoomsWithHolesAndCorners) {
    const std::string plan =
        "fence path=0,0;8,0;8,8;0,8 closed=yes\nfence path=3,3;5,3;5,5;3,5 closed=yes\n"
        "inside at=1,1\n";
    EXPECT_EQ(check(scene(plan + "cube at=1,4\n")), "");
    EXPECT_NE(check(scene(plan + "cube at=4,4\n")).find("cube1 lies outside the room"),
              std::string::npos);
    EXPECT_NE(check(scene(plan + "cube at=3,4\n")).find("cube1 overlaps fence2"),
              std::string::npos);
    EXPECT_NE(check(scene(plan + "zone at=4,4 size=1,1\n")), "");
    EXPECT_EQ(check(scene(plan + "zone at=4,4 size=3,3\n")), "") << "reaches around the hole";
}

TEST(CheckScene, SensorsInsideSolidsAndOutside) {
    EXPECT_EQ(
        check("cube id=c at=2,2 size=1\n", "laser id=l at=2,2\n"),
        "room.3dm:2:1: error: laser l stands inside cube c at (2.0, 2.0); move it, or raise it "
        "above 1.01 m\n");
    for (const char* line : {"laser at=2,2,1.01", "laser at=1.5,2", "laser at=2,1.50005",
                             "laser on=c", "tag at=2,2,1.5"})
        EXPECT_EQ(check("cube id=c at=2,2 size=1\n", std::string(line) + "\n"), "") << line;
    for (const char* line : {"camera at=2,2,0.5", "tag at=1.6,2", "ranger on=c at=0,0,-0.1",
                             "ultrasound at=2,2,0.999", "laser at=2,2,1"})
        EXPECT_NE(check("cube id=c at=2,2 size=1\n", std::string(line) + "\n"), "") << line;
    EXPECT_EQ(check("", "laser id=l at=9,3\n"),
              "room.3dm:2:1: error: laser l stands outside the room at (9.0, 3.0); move it in\n");
    EXPECT_EQ(check("", "laser at=8,3\n"), "") << "in the wall's line";
    for (const char* line : {"human at=9,3", "robot at=9,3", "mat at=9,3", "gate at=9,3"})
        EXPECT_NE(check("", std::string(line) + "\n"), "") << line;
    // What a robot carries is told once.
    const std::string text = check("", "robot id=r at=10,3\nlaser on=r\n");
    EXPECT_EQ(text,
              "room.3dm:2:1: error: robot r stands outside the room at (10.0, 3.0); move it "
              "in\n");
}

// Each advice is followed once, in stacks, under boards, and between storeys of a shelf.
TEST(CheckScene, TheHeightAdvisedForBuriedSensorsIsFree) {
    const std::vector<std::string> rooms = {
        "cube at=2,2 size=1\n",
        "cube at=2,2 size=1,1,1.004\n",
        "cube at=2,2 size=1\ncube at=2,2,1 size=1,1,0.5\n",
        "cube at=2,2 size=1\ncube at=2,2,1.05 size=1,1,0.3\n",
        "cube at=2,2 size=1\ncube at=2.2,2 size=1,1,1.3\ncube at=2,1.8,1.31 size=1,1,0.4\n",
        "cube at=2,2 size=1\ntable at=2,2 size=1,1,1.08\n"};
    for (const std::string& room : rooms)
        for (const std::string sensor : {"laser", "camera", "ultrasound", "tag"})
            for (const double height : {0.2, 0.5, 0.999}) {
                const auto text_at = [&](const std::string& z) {
                    return check(room, sensor + " at=2,2," + z + '\n');
                };
                const std::string text = text_at(formatDouble(height));
                const std::string before = "raise it above ";
                const std::size_t begin = text.find(before);
                ASSERT_NE(begin, std::string::npos) << room << sensor << text;
                const std::string advised = text.substr(begin + before.size(), 4);
                EXPECT_EQ(text_at(advised).find("inside"), std::string::npos) << room << text;
                EXPECT_EQ(text_at(formatDouble(std::stod(advised) + 0.05)).find("inside"),
                          std::string::npos)
                    << room << text;
            }
    EXPECT_NE(check("cube at=2,2 size=1,1,3\n", "laser at=2,2\n").find("(2.0, 2.0); move it\n"),
              std::string::npos)
        << "no height of the room is free";
}

TEST(CheckScene, PathsThatLeaveTheRoom) {
    EXPECT_EQ(check("", "human id=h at=6,3 path=6,3;9,3\n"),
              "room.3dm:2:1: warning: human h has a path that leaves the room at (9.0, 3.0); move "
              "that point in\n");
    EXPECT_EQ(check("", "robot id=r at=2,2 path=2,2;6,2\n"), "");
    EXPECT_EQ(check("", "laser id=l at=2,2,-0.05\n"),
              "room.3dm:2:1: error: laser l stands below the floor at (2.0, 2.0); raise it by "
              "0.05 m\n");
}

TEST(CheckScene, FiltersChecksAndIds) {
    const Scene made =
        scene("ispace id=room at=4,3 size=8,6\ncube id=c at=2,2 size=1\ncube at=2.2,2 size=1\n",
              "laser id=in at=2,2\nlaser id=out at=9,3\nrobot id=r at=10,3\nlaser id=spare\n");
    const auto found = [&made](const FindingFilter& filter) {
        std::string ids;
        for (const Finding& finding : checkScene(made, filter)) ids += finding.element + ' ';
        return ids;
    };
    EXPECT_EQ(found({}), "c in in out r spare ");
    EXPECT_EQ(found({.checks = {"outside"}}), "out r ");
    EXPECT_EQ(found({.checks = {"unplaced", "buried"}}), "in in spare ");
    const auto is_laser = [](const std::string& id) { return id == "out" || id == "spare"; };
    EXPECT_EQ(found({.ids = is_laser}), "out spare ");
    EXPECT_EQ(found({.checks = {"outside"}, .ids = is_laser}), "out ");
    for (const Diagnostic& warning : sceneWarnings(made, {.checks = {"outside"}}))
        EXPECT_EQ(warning.severity, Severity::Warning);
}

TEST(CheckScene, RobotsAndPeopleStandInThings) {
    EXPECT_EQ(check("cube id=c at=2,2 size=1\n", "robot id=r at=2.7,2\n"),
              "room.3dm:2:1: error: robot r stands in cube c near (2.5, 2.0); move it, e.g. by "
              "0.10 m\n");
    EXPECT_EQ(check("cube id=c at=2,2 size=1\n", "robot id=r at=2.8,2\n"), "");
    EXPECT_NE(check("cube id=c at=2,2 size=1\n", "robot id=r at=2.1,2\n").find("by 0.70 m"),
              std::string::npos);
    // Under a table top, but not through its foot.
    EXPECT_EQ(check("desk at=4,3 size=2,2\n", "robot at=4,3\n"), "");
    EXPECT_NE(check("table at=4,3\n", "robot at=4,3.2\n"), "");
    EXPECT_NE(check("desk at=4,3 size=2,2\n", "human at=4,3\n"), "");
    EXPECT_NE(check("", "robot at=0.2,3\n").find("stands in ispace room near (0.0, 3.0)"),
              std::string::npos);
    EXPECT_EQ(check("", "robot id=r at=2,2\nhuman id=h at=2.5,2\n"),
              "room.3dm:2:1: error: robot r overlaps human h near (2.25, 2.0); move one, e.g. by "
              "0.06 m\n");
    EXPECT_EQ(check("", "robot id=r at=2,2\nrobot id=h at=2.6,2\n"), "");
}

TEST(CheckScene, WallsThatCross) {
    const std::string text = check("wall id=v from=1,1 to=3,3\nwall id=w from=1,3 to=3,1\n");
    EXPECT_EQ(text,
              "room.env:3:1: warning: wall v crosses wall w near (2.0, 2.0); end one of them at "
              "the other\n");
    EXPECT_NE(check("wall id=v from=1,1 to=3,1\nwall id=w from=2,1 to=4,1\n").find("lies on"),
              std::string::npos);
    EXPECT_EQ(check("wall id=v from=1,1 to=3,1\nwall id=w from=3,1 to=3,4\n"), "");
}

/// The room with a mesh record; `line` without keyword and file.
Scene meshScene(TriangleMesh mesh, const std::string& keys, const std::string& others = "") {
    Document room = roomDocument("ispace id=room at=4,3 size=8,6\nmesh id=m file=a.stl " + keys +
                                 "\n" + others);
    mesh.digest = meshDigest(mesh);
    const auto content = std::make_shared<const TriangleMesh>(std::move(mesh));
    for (Record& record : room.records)
        if (record.keyword() == "mesh") record.setMesh(content);
    return makeScene(room, nullptr, devices());
}

TEST(CheckScene, OpenDoorsThatLeadIntoAWall) {
    // Another room a hand's breadth away: the door cuts the wall of the first only.
    const std::string annex = "ispace id=annex at=10.1,3 size=4,4\ninside at=1,1\n";
    EXPECT_EQ(
        check(annex + "door id=o at=8,3 open=yes\n"),
        "room.env:5:1: warning: door o is open, but leads only to ispace annex, 0.1 m behind, "
        "near (8.0, 3.0); say how far it reaches through with size=0.9,0.2\n");
    EXPECT_EQ(check(annex + "door id=o at=8,3 open=yes size=0.9,0.2\n"), "");
    EXPECT_EQ(check(annex + "door id=o at=8,3\n"), "") << "closed";
    EXPECT_EQ(check(annex + "door id=o at=0,3 open=yes\n"), "") << "to the outside";
    EXPECT_EQ(check("ispace id=annex at=10,3 size=4,4\ninside at=1,1\ndoor id=o at=8,3 open=yes\n"),
              "")
        << "a wall in common";
    EXPECT_EQ(check("ispace id=closet at=8.4,3 size=0.8,4\ninside at=1,1\n"
                    "door id=o at=8,3 open=yes\n"),
              "")
        << "the closet's back is near, but the closet is part of the room";
}

TEST(CheckScene, Meshes) {
    const TriangleMesh ring = testing::torusMesh(1, 0.2, 40, 16);
    EXPECT_EQ(check(meshScene(ring, "at=3,3,0.2")), "");
    // In the hole of the ring there is room.
    EXPECT_EQ(check(meshScene(ring, "at=3,3,0.2", "cube id=c at=3,3\n")), "");
    const std::string text = check(meshScene(ring, "at=3,3,0.2", "cube id=c at=4,3\n"));
    EXPECT_EQ(text.find("room.env:3:1: warning: mesh m overlaps cube c near ("), 0U) << text;
    EXPECT_NE(text.find("); move one\n"), std::string::npos) << text;
    // Wholly inside, and around.
    const TriangleMesh box = boxMesh({-1, -1, 0}, {1, 1, 2});
    EXPECT_NE(check(meshScene(box, "at=3,3", "cube id=c at=3,3,0.5 size=0.2\n")), "");
    EXPECT_NE(check(meshScene(box, "at=3,3", "cube id=c at=3,3 size=2.5\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=3,3", "cube id=c at=3,3,2\ncube at=4.25,3\n")), "");
    // In a wall, through a wall, outside.
    EXPECT_NE(check(meshScene(box, "at=0.5,3")).find("mesh m overlaps ispace room"),
              std::string::npos);
    EXPECT_EQ(check(meshScene(box, "at=1,3")), "");
    EXPECT_NE(check(meshScene(box, "at=12,3")).find("mesh m lies outside the room"),
              std::string::npos);
    // With each other.
    EXPECT_NE(check(meshScene(box, "at=2,3", "mesh id=n file=a.stl at=3,3\n")), "");
    EXPECT_NE(check(meshScene(box, "at=2,3", "mesh id=n file=a.stl at=2,3\n")), "");
    EXPECT_NE(check(meshScene(box, "at=2,3", "mesh id=n file=a.stl at=2,3 scale=0.5\n")), "");
    EXPECT_NE(check(meshScene(box, "at=2,3 scale=0.5", "mesh id=n file=a.stl at=2,3\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=2,3", "mesh id=n file=a.stl at=4,3\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=2,3", "mesh id=n file=a.stl at=2,3,2\n")), "");
}

TEST(CheckScene, PlacedInMeshes) {
    const TriangleMesh box = boxMesh({-1, -1, 0}, {1, 1, 2});
    EXPECT_NE(check(meshScene(box, "at=3,3", "laser at=3,3\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=3,3", "laser at=3,3,2\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=3,3", "robot at=4.4,3\n")), "");
    EXPECT_NE(check(meshScene(box, "at=3,3", "robot id=r at=4.2,3\n"))
                  .find("robot r stands in mesh m near (4.0, 3.0); move it, e.g. by 0.10 m"),
              std::string::npos);
    EXPECT_NE(check(meshScene(box, "at=3,3", "human at=3,3\n")), "");
    EXPECT_EQ(check(meshScene(box, "at=3,3,0.5", "robot at=3,3\n")), "") << "it stands below";
    // A surface with a rim.
    TriangleMesh wall;
    wall.vertices = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 2}, {-1, 0, 2}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    EXPECT_NE(check(meshScene(wall, "at=3,3", "robot at=3,3.2\n")), "");
    EXPECT_EQ(check(meshScene(wall, "at=3,3", "robot at=3,3.4\ncube at=3,2.75\n")), "");
    EXPECT_NE(check(meshScene(wall, "at=3,3", "cube at=3,2.8\n")), "");
}

TEST(CheckScene, InTheOrderOfTheRecordsAndNotTooMany) {
    std::string lines;
    for (int i = 0; i < 40; ++i)
        lines += "cube id=c" + std::to_string(i) + " at=" + std::to_string(20 + 2 * i) + ",3\n";
    const std::string text = check(lines);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 20);
    EXPECT_EQ(text.find("room.env:3:1: warning: cube c0 "), 0U);
    // All in one heap: still quick.
    std::string heap;
    for (int i = 0; i < 3000; ++i) heap += "table at=4,3\n";
    EXPECT_NE(check(heap), "");
}

TEST(CheckScene, TenThousandThings) {
    // Rows of tables and desks, close to each other but apart, in a hall with inner walls.
    std::string lines = "ispace at=150,150 size=310,310\n";
    for (int i = 0; i < 100; ++i)
        for (int k = 0; k < 100; ++k) {
            const std::string at = std::to_string(3 * i) + ',' + std::to_string(3 * k);
            lines += (i + k) % 2 == 0 ? "table at=" + at + " size=2.99\n"
                                      : "chair size=2.9,2.9 heading=3 at=" + at + "\n";
        }
    lines += "cube id=c at=150.5,150\n";
    const Scene made = scene(lines);
    const auto start = std::chrono::steady_clock::now();
    const std::string text = check(made);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_LT(seconds, 20) << "the square of it?";
    RecordProperty("seconds", std::to_string(seconds));
}

}  // namespace check_scene_test

}  // namespace ispace
