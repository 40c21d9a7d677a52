// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/openings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "env/environment.h"
#include "env/level.h"
#include "support/test_scene.h"

namespace ispace {
namespace openings_test {

using testing::environment;
using testing::findings;

const Element& element(const Environment& env, const std::string& id) {
    const auto found = std::find_if(env.elements().begin(), env.elements().end(),
                                    [&id](const Element& e) { return e.id == id; });
    if (found == env.elements().end()) throw std::logic_error("no element " + id);
    return *found;
}

double rounded(double value) { return std::round(value * 1e9) / 1e9 + 0.0; }
Point2 rounded(Point2 p) { return {rounded(p.x), rounded(p.y)}; }

/// The one sheet of a leaf or pane, to the nanometre.
Sheet sheetOf(const Environment& env, const std::string& id) {
    const Body& body = element(env, id).body;
    EXPECT_EQ(body.sheets.size(), 1U) << id;
    EXPECT_TRUE(body.prisms.empty());
    if (body.sheets.empty()) return {};
    Sheet sheet = body.sheets.front();
    sheet.line = {rounded(sheet.line.a), rounded(sheet.line.b)};
    return sheet;
}

std::vector<double> sorted(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values;
}

/// x of all ends of sheets at this height on the line y.
std::vector<double> endsAlong(const Environment& env, double y, double height) {
    std::vector<double> xs;
    for (const Segment2& s : env.slice(height).sheets)
        if (s.a.y == y && s.b.y == y) xs.insert(xs.end(), {rounded(s.a.x), rounded(s.b.x)});
    return sorted(std::move(xs));
}

TEST(Openings, DoorByOffset) {
    const Environment env = environment(
        "wall id=w from=0,0 to=8,0\nfence path=8,0;8,6;0,6;0,0\ndoor id=d wall=w offset=3\n");
    const Sheet leaf = sheetOf(env, "d");
    EXPECT_EQ(leaf.line, (Segment2{{2.55, 0}, {3.45, 0}}));
    EXPECT_EQ(leaf.bottom, 0);
    EXPECT_EQ(leaf.top, 2);
    EXPECT_EQ(leaf.material, Material::Wood);
    EXPECT_FALSE(leaf.clear);
    // The wall on both sides and the lintel.
    const Body& wall = element(env, "w").body;
    ASSERT_EQ(wall.sheets.size(), 3U);
    EXPECT_EQ(wall.sheets[0].line, (Segment2{{0, 0}, {2.55, 0}}));
    EXPECT_EQ(wall.sheets[1].line, element(env, "d").body.sheets[0].line);
    EXPECT_EQ(wall.sheets[1].bottom, 2);
    EXPECT_EQ(wall.sheets[1].top, 2.5);
    EXPECT_EQ(wall.sheets[2].line, (Segment2{{3.45, 0}, {8, 0}}));
    EXPECT_EQ(wall.sheets[2].bottom, 0);
    EXPECT_EQ(env.indoor().area(), 48);
    EXPECT_EQ(env.indoor().parts.at(0).outline.size(), 4U) << "closed openings leave no trace";
}

TEST(Openings, OffsetRunsAlongTheWholeRecord) {
    const std::string path = "fence id=f path=0,0;8,0;8,6;0,6 closed=yes\ninside at=1,1\n";
    const auto line = [&](const std::string& offset) {
        return sheetOf(environment(path + "door id=d wall=f offset=" + offset + "\n"), "d").line;
    };
    EXPECT_EQ(line("11"), (Segment2{{8, 2.55}, {8, 3.45}}));
    EXPECT_EQ(line("15"), (Segment2{{7.45, 6}, {6.55, 6}}));
    EXPECT_EQ(line("27.55"), (Segment2{{0, 0.9}, {0, 0}})) << "up to the corner";
    // A room is turned counter-clockwise from its lower left corner.
    const Environment room = environment("ispace id=r size=8,6\ndoor id=d wall=r offset=11\n");
    EXPECT_EQ(sheetOf(room, "d").line, (Segment2{{4, -0.45}, {4, 0.45}}));
}

TEST(Openings, WindowHasSillAndLintel) {
    const Environment env = environment("ispace size=8,6\nwindow id=w at=0,-3\n");
    const Sheet pane = sheetOf(env, "w");
    EXPECT_EQ(pane.line, (Segment2{{-0.6, -3}, {0.6, -3}}));
    EXPECT_EQ(pane.bottom, 0.9);
    EXPECT_DOUBLE_EQ(pane.top, 2.1);
    EXPECT_EQ(pane.material, Material::Glass);
    EXPECT_TRUE(pane.clear);
    EXPECT_EQ(endsAlong(env, -3, 0.5), (std::vector<double>{-4, -0.6, -0.6, 0.6, 0.6, 4}));
    EXPECT_EQ(endsAlong(env, -3, 1.5), (std::vector<double>{-4, -0.6, 0.6, 4})) << "beams pass";
    EXPECT_EQ(endsAlong(env, -3, 2.2), (std::vector<double>{-4, -0.6, -0.6, 0.6, 0.6, 4}));
    EXPECT_EQ(env.slice(1.5).sheets.size() + 1, env.band(1.5, 1.5).sheets.size());

    const Environment opaque = environment("ispace size=8,6\nwindow id=w at=0,-3 glass=opaque\n");
    EXPECT_FALSE(sheetOf(opaque, "w").clear);
    EXPECT_EQ(opaque.slice(1.5).sheets.size(), opaque.band(1.5, 1.5).sheets.size());
    const Environment none = environment("ispace size=8,6\nwindow id=w at=0,-3 glass=none\n");
    EXPECT_TRUE(element(none, "w").body.sheets.empty());
    EXPECT_EQ(none.band(1.5, 1.5).sheets.size(), 5U);
}

TEST(Openings, OpenDoorHasNoLeaf) {
    const Environment env = environment("ispace size=8,6\ndoor id=d at=0,-3 open=yes\n");
    EXPECT_TRUE(element(env, "d").body.sheets.empty());
    EXPECT_TRUE(element(env, "d").body.prisms.empty());
    EXPECT_EQ(endsAlong(env, -3, 1), (std::vector<double>{-4, -0.45, 0.45, 4}));
    EXPECT_EQ(endsAlong(env, -3, 2.2), (std::vector<double>{-4, -0.45, -0.45, 0.45, 0.45, 4}));
    EXPECT_EQ(env.indoor().area(), 48) << "a door to the outside joins nothing";
}

TEST(Openings, AsHighAsTheWallLeavesNoLintel) {
    for (const char* size : {"size=0.9,0.1,2.5", "height=2.5"}) {
        const Environment env =
            environment("ispace size=8,6\ndoor id=d at=0,-3 open=yes " + std::string(size) + "\n");
        EXPECT_EQ(endsAlong(env, -3, 2.4), (std::vector<double>{-4, -0.45, 0.45, 4})) << size;
    }
    const Environment whole = environment(
        "fence path=4,0;4,3;0,3;0,0\nwall id=w from=0,0 to=4,0\ndoor wall=w offset=2 size=4 "
        "height=2.5 open=yes\n");
    EXPECT_TRUE(element(whole, "w").body.sheets.empty());
    EXPECT_EQ(whole.height(), 2.5);
    EXPECT_EQ(whole.indoor().area(), 12);
}

TEST(Openings, DoorStandsOnTheBottomOfItsWall) {
    const Environment env = environment(
        "ispace size=8,6\nwall id=w at=0,0,1 size=4,0,3\ndoor id=d wall=w offset=2\nwindow id=n "
        "wall=w offset=1 size=0.5 sill=1\n");
    EXPECT_EQ(sheetOf(env, "d").bottom, 1);
    EXPECT_EQ(sheetOf(env, "d").top, 3);
    EXPECT_EQ(sheetOf(env, "n").bottom, 1) << "sills count from the floor";
}

TEST(Openings, ThickWallHasALeafAboutItsMidLine) {
    const Environment env = environment(
        "fence id=f path=-4,-3;4,-3;4,3;-4,3 closed=yes thickness=0.2\n"
        "door id=d at=0,-3\nwindow id=w at=0,3\n");
    const Body& door = element(env, "d").body;
    ASSERT_EQ(door.prisms.size(), 1U);
    EXPECT_NEAR(signedArea(door.prisms[0].footprint), 0.9 * 0.04, 1e-12);
    EXPECT_EQ(locate(door.prisms[0].footprint, {0, -3.019}), Side::Inside);
    EXPECT_EQ(door.prisms[0].top, 2);
    EXPECT_EQ(door.prisms[0].material, Material::Wood);
    EXPECT_TRUE(sheetOf(env, "w").clear);
    EXPECT_EQ(sheetOf(env, "w").line.a.y, 3) << "glass on the mid-line";
    // Jambs: the ends of the boxes, with the corner of leaf and pane.
    for (const double height : {1.0, 2.3}) {
        const double free = totalArea(env.level(height)->freeFloor());
        const double doorway = 0.9 * (0.1 - 0.02), window = 1.2 * 0.1;
        EXPECT_NEAR(free, 7.8 * 5.8 + (height < 2 ? doorway + window : 0), 1e-9);
    }
}

TEST(Openings, CutEveryWallOnTheSameLine) {
    const Environment env = environment(
        "ispace id=a at=0,0 size=4,4\nispace id=b at=4,0 size=4,4\n"
        "door id=d at=2,0 open=yes\nwindow id=w wall=b at=2,1.2 size=0.5\n");
    const auto blocked = [&](double y, double height) {
        int count = 0;
        env.slice(height).forEachLine([&](const Segment2& line) {
            count += line.a.x == 2 && line.b.x == 2 && std::min(line.a.y, line.b.y) < y &&
                     y < std::max(line.a.y, line.b.y);
        });
        return count;
    };
    EXPECT_EQ(blocked(0, 1), 0);
    EXPECT_EQ(blocked(1.2, 1), 0);
    EXPECT_EQ(blocked(0.7, 1), 2);
    EXPECT_EQ(blocked(0, 2.2), 2);
    EXPECT_EQ(element(env, "w").body.sheets.size(), 1U) << "one pane for both walls";
}

TEST(Openings, CutWhatOverlapsAndWhatDepthReaches) {
    const std::string room = "ispace size=8,6\n";
    const auto solid = [](const Environment& env, Point2 p) { return env.slice(1).blocked(p); };
    // Two thick walls that overlap.
    const Environment both =
        environment(room +
                    "wall id=u from=-2,0 to=2,0 thickness=0.2\nwall id=v from=-2,0.15 to=2,0.15 "
                    "thickness=0.2\ndoor wall=u offset=2 open=yes\n");
    EXPECT_FALSE(solid(both, {0, 0.15}));
    EXPECT_TRUE(solid(both, {1, 0.15}));
    // One that only touches stays.
    const Environment touching =
        environment(room +
                    "wall id=u from=-2,0 to=2,0 thickness=0.2\nwall id=v from=-2,0.2 to=2,0.2 "
                    "thickness=0.2\ndoor wall=u offset=2 open=yes\n");
    EXPECT_FALSE(solid(touching, {0, 0}));
    EXPECT_TRUE(solid(touching, {0, 0.2}));
    // A sheet on its face goes.
    const Environment lined = environment(
        room +
        "wall id=u from=-2,0 to=2,0 thickness=0.2\nwall id=v from=-2,0.1 to=2,0.1\ndoor "
        "wall=u offset=2 open=yes\n");
    EXPECT_EQ(endsAlong(lined, 0.1, 1), (std::vector<double>{-2, -0.45, 0.45, 2}));
    // A hollow wall by its width; the doorway is lined.
    const std::string hollow =
        room +
        "wall id=u from=-4,0 to=4,0\nwall from=-4,0.3 to=4,0.3\ninside at=0,-1\ndoor id=d "
        "wall=u offset=4 size=1,0.6 open=yes\n";
    const Environment through = environment(hollow);
    EXPECT_EQ(endsAlong(through, 0.3, 1), (std::vector<double>{-4, -0.5, 0.5, 4}));
    EXPECT_NEAR(through.indoor().area(), 48 - 0.3 * 7, 1e-9) << "both rooms and the doorway";
    EXPECT_EQ(through.indoor().locate({1, 0.15}), Side::Outside);
    int reveals = 0;
    through.slice(1).forEachLine([&](const Segment2& line) {
        reveals +=
            std::abs(line.a.y - line.b.y) > 0.29 && std::abs(std::abs(line.a.x) - 0.5) < 1e-9;
    });
    EXPECT_EQ(reveals, 2);
}

TEST(Openings, RevealsHaveAUnitDirection) {
    // Walls that are not quite parallel: the jambs are not equally far from the host.
    const Environment env = environment(
        "ispace at=0,-9 size=2,2\nwall id=u from=-4,0 to=4,0\nwall from=-4,0.25 to=4,0.35\n"
        "door id=d wall=u offset=4 size=1,0.8 open=yes\n");
    WallPlan plan;
    Diagnostics findings;
    for (std::size_t i = 0; i < env.elements().size(); ++i)
        for (const WallLine& wall : wallLinesOf(env.elements()[i].record, findings))
            plan.add(wall, i);
    const auto openings = placeOpenings(env.elements(), plan, findings);
    const CutWalls cut = cutOpenings(env.elements(), plan, weld(plan.lines), openings, findings);
    std::size_t reveals = 0;
    for (const WallPart& part : cut.parts) {
        EXPECT_NEAR(length(part.along), 1, 1e-12);
        reveals += std::abs(part.along.y) > 0.9 && std::abs(part.piece.line.a.x) < 1;
    }
    EXPECT_EQ(reveals, 2U);
}

TEST(Openings, ByPlaceOnTheNearestWall) {
    const std::string walls =
        "ispace id=r size=8,6\nwall id=v from=0,-3 to=0,3\nwall id=t from=0,0 to=4,0 "
        "thickness=0.8\ninside at=-2,0\n";
    const auto owner = [&](const std::string& keys) {
        const Environment env = environment(walls + "door id=d " + keys + " size=0.4\n");
        const auto place = [](const Body& body) {
            return body.sheets.empty() ? interiorPoint({body.prisms.at(0).footprint, {}})
                                       : body.sheets[0].line.a +
                                             0.5 * (body.sheets[0].line.b - body.sheets[0].line.a);
        };
        const Point2 p = place(element(env, "d").body);
        return formatFixed(p.x, 2) + ' ' + formatFixed(p.y, 2);
    };
    EXPECT_EQ(owner("at=0.1,1"), "0.00 1.00");
    EXPECT_EQ(owner("at=-0.29,1"), "0.00 1.00");
    EXPECT_EQ(owner("at=2,0.45"), "2.00 0.00") << "near the face of a thick wall";
    EXPECT_EQ(owner("at=0.25,-0.2 heading=90"), "0.00 -0.20");
    EXPECT_EQ(owner("at=0.25,-0.2 heading=180"), "0.25 0.00");
    EXPECT_EQ(owner("at=0.25,0.2 heading=0.5"), "0.25 0.00");
    EXPECT_EQ(owner("at=0.2,-2.8005 wall=v"), "0.00 -2.80") << "fitted within a millimetre";
}

TEST(Openings, ByEnds) {
    const std::string room = "ispace id=r size=8,6\n";
    const auto leaf = [&](const std::string& keys) {
        return sheetOf(environment(room + "door id=d " + keys + "\n"), "d").line;
    };
    EXPECT_EQ(leaf("from=1,-3 to=2,-3"), (Segment2{{1, -3}, {2, -3}}));
    EXPECT_EQ(leaf("from=2,-3.2 to=1,-2.8"), (Segment2{{1, -3}, {2, -3}})) << "off by a little";
    EXPECT_EQ(leaf("from=-4,1 to=-4,2 size=1,0.1,1.8"), (Segment2{{-4, 2}, {-4, 1}}));
}

TEST(Openings, MayNotOverlapInOneWall) {
    const std::string room = "ispace id=r size=8,6\nwall id=w from=0,-3 to=0,3\ninside at=1,1\n";
    EXPECT_EQ(findings(room + "door id=d wall=w offset=3\nwindow id=n wall=w offset=3.8\n"),
              "room.env:6:1: error: window n overlaps door d in wall w near (0.0, 0.2); move one "
              "of them\n");
    // By two records of the same wall: told once.
    EXPECT_EQ(findings("ispace id=a at=0,0 size=4,4\nispace id=b at=4,0 size=4,4\n"
                       "door id=d wall=a at=2,0\ndoor id=e wall=b at=2,0.5\n"),
              "room.env:5:1: error: door e overlaps door d in ispace a near (2.0, 0.05); move one "
              "of them\n");
    // Side by side, and one above the other, is fine.
    EXPECT_EQ(
        findings(room + "door wall=w offset=3\ndoor wall=w offset=3.9\nwindow wall=w offset=3 "
                        "sill=2 height=0.3 size=0.9\n"),
        "");
}

TEST(Openings, SideBySideShareTheirJamb) {
    const Environment env = environment(
        "ispace size=8,6\ndoor id=d from=-1,-3 to=0,-3\nwindow id=n from=0,-3 to=1,-3 "
        "glass=opaque\nwindow id=o from=-1,-3 to=0,-3 sill=2 height=0.4 glass=none\n");
    EXPECT_EQ(sheetOf(env, "d").line.b, sheetOf(env, "n").line.a);
    EXPECT_EQ(endsAlong(env, -3, 1), (std::vector<double>{-4, -1, -1, 0, 0, 1, 1, 4}));
    EXPECT_EQ(endsAlong(env, -3, 2.2), (std::vector<double>{-4, -1, 0, 1, 1, 4}));
    EXPECT_EQ(endsAlong(env, -3, 2.45), (std::vector<double>{-4, -1, -1, 0, 0, 1, 1, 4}));
}

TEST(Openings, LeafFollowsWhatEndsOnIt) {
    // A partition ends in the middle of a closed door.
    const Environment env =
        environment("ispace size=8,6\nwall from=0,-3 to=0,3\ndoor id=d at=0,-3\ninside at=1,1\n");
    ASSERT_EQ(element(env, "d").body.sheets.size(), 2U);
    EXPECT_EQ(element(env, "d").body.sheets[0].line.b, (Point2{0, -3}));
    EXPECT_EQ(env.indoor().area(), 24);
}

TEST(Openings, FindingsComeTogether) {
    EXPECT_EQ(
        findings("fence path=0,0;4,0;4,3;0,3;0,0.2\ndoor at=9,9\ncube at=1e6,0 size=1e-11\n"
                 "zone id=z\nwindow wall=fence1 offset=1 sill=3\n"),
        "room.env:4:1: error: cube is too small for its distance from the origin: no area is "
        "left of it\n"
        "room.env:5:1: error: zone has no extent: give `path`, or `at` and `size`\n"
        "room.env:3:9: error: door door1 at (9.0, 9.0) is not on a wall: the nearest is fence "
        "fence1, 7.81 m away\n"
        "room.env:6:1: error: window window1 reaches up to 4.2 m, fence fence1 only to 2.5 m; "
        "make it lower or the wall higher\n"
        "room.env:2:1: error: not enclosed: 0.2 m between fence1 and fence1 near (0.0, 0.1); "
        "closed=yes joins its ends\n");
    // A broken wall may be the one that closes the room, so later findings are held back.
    EXPECT_EQ(findings("fence path=0,0;4,0;4,3;0,3\nwall id=w from=0,3 to=0,3\ndoor wall=w "
                       "offset=1\n"),
              "room.env:3:23: error: wall has zero length\n");
}

TEST(Openings, ManyOnOneWallAndManyWallsOnOnePlace) {
    std::string plan = "fence id=f path=-1,-1;4001,-1;4001,1;-1,1 closed=yes\ninside at=0,0\n";
    for (int i = 0; i < 2000; ++i)
        plan += "door wall=f offset=" + formatDouble(2 * i + 2) + (i % 2 ? " open=yes\n" : "\n");
    const Environment env = environment(plan);
    EXPECT_EQ(env.slice(1).sheets.size(), 2001U + 1000U + 3U);

    std::string heap = "ispace size=8,6\n";
    for (int i = 0; i < 100; ++i) heap += "wall from=0,0 to=4,0\n";
    EXPECT_EQ(
        findings(heap + "door id=d at=2,0\n"),
        "room.env:103:1: error: door d goes through more than 64 walls upon each other; leave "
        "out the doubles\n");
}

TEST(Texts, LengthsHaveAtLeastTwoDigits) {
    EXPECT_EQ(lengthText(0.12), "0.12");
    EXPECT_EQ(lengthText(0.0012), "0.0012");
    EXPECT_EQ(lengthText(2), "2.0");
    EXPECT_EQ(lengthText(0), "0.0");
    EXPECT_EQ(lengthText(1234.5678), "1234.568");
}

}  // namespace openings_test
}  // namespace ispace
