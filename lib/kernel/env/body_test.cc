// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geom/pose.h"
#include "support/test_scene.h"

namespace ispace {
namespace body_test {

using testing::areaOf;
using testing::record;

/// Footprints of the prisms that the plane at this height meets.
std::vector<Polygon> cut(const Body& body, double height) {
    std::vector<Polygon> out;
    for (const Prism& prism : body.prisms)
        if (prism.bottom <= height && height <= prism.top) out.push_back(prism.footprint);
    return out;
}

std::vector<Polygon> cut(const std::string& line, double height) {
    return cut(bodyOf(record(line)), height);
}

bool covers(const std::vector<Polygon>& solids, Point2 p) {
    return std::any_of(solids.begin(), solids.end(),
                       [p](const Polygon& solid) { return locate(solid, p) != Side::Outside; });
}

TEST(Shapes, RectangleIsExactAtQuarterTurns) {
    EXPECT_EQ(rectangle({1, 2}, 4, 2, Angle()), (Polygon{{-1, 1}, {3, 1}, {3, 3}, {-1, 3}}));
    EXPECT_EQ(rectangle({1, 2}, 4, 2, Angle::degrees(90)),
              (Polygon{{2, 0}, {2, 4}, {0, 4}, {0, 0}}));
    EXPECT_NEAR(signedArea(rectangle({5, -7}, 3, 2, Angle::degrees(31))), 6, 1e-12);
}

TEST(Shapes, EllipseStaysWithinTolerance) {
    for (const double diameter : {1e-5, 0.001, 0.05, 0.9, 10.0, 500.0}) {
        const Polygon circle = ellipse({3, 4}, diameter, diameter, Angle::degrees(17));
        EXPECT_GT(signedArea(circle), 0);
        double worst = 0;
        forEachEdge(circle, [&](const Segment2& edge) {
            EXPECT_NEAR(distance(edge.a, {3, 4}), diameter / 2, 1e-12 * diameter + 1e-15);
            const Point2 middle{(edge.a.x + edge.b.x) / 2, (edge.a.y + edge.b.y) / 2};
            worst = std::max(worst, diameter / 2 - distance(middle, {3, 4}));
        });
        EXPECT_LE(worst, kCurveTolerance) << diameter;
    }
}

TEST(Shapes, EllipseLiesOnTheCurveAlongItsHeading) {
    const Pose2 frame{{1, 1}, Angle::degrees(60)};
    const Polygon polygon = ellipse(frame.position, 4, 1, frame.heading);
    for (const Point2 p : polygon) {
        const Vec2 v = p - frame.position;
        const double x = dot(v, unitVector(frame.heading)) / 2;
        const double y = cross(unitVector(frame.heading), v) / 0.5;
        EXPECT_NEAR(x * x + y * y, 1, 1e-12);
    }
    EXPECT_NEAR(signedArea(polygon), std::numbers::pi, 0.003);
    const Box2 upright = bounds(ellipse({0, 0}, 4, 1, Angle()));
    EXPECT_EQ(upright, (Box2{{-2, -0.5}, {2, 0.5}}));
}

TEST(Body, CubeTakesOneTwoOrThreeNumbers) {
    const auto extent = [](const std::string& line) {
        const Body body = bodyOf(record(line));
        const Box2 box = bounds(body.prisms.at(0).footprint);
        return Point3{box.width(), box.depth(), body.prisms[0].top};
    };
    EXPECT_EQ(extent("cube"), (Point3{0.5, 0.5, 0.5}));
    EXPECT_EQ(extent("cube size=2"), (Point3{2, 2, 2}));
    EXPECT_EQ(extent("cube size=2,1"), (Point3{2, 1, 2}));
    EXPECT_EQ(extent("cube size=2,1 height=3"), (Point3{2, 1, 3}));
    EXPECT_EQ(extent("cube size=2,1,4"), (Point3{2, 1, 4}));
    EXPECT_EQ(extent("cube size=2,1 heading=90"), (Point3{1, 2, 2}));
}

TEST(Body, AtIsCentreAndUnderside) {
    const Body body = bodyOf(record("cube at=3,4,1 size=2,1,0.5"));
    ASSERT_EQ(body.prisms.size(), 1U);
    EXPECT_EQ(body.prisms[0].bottom, 1);
    EXPECT_EQ(body.prisms[0].top, 1.5);
    EXPECT_EQ(body.prisms[0].footprint, (Polygon{{2, 3.5}, {4, 3.5}, {4, 4.5}, {2, 4.5}}));
    EXPECT_EQ(cut(body, 0.9).size(), 0U);
    EXPECT_EQ(cut(body, 1).size(), 1U);
    EXPECT_EQ(cut(body, 1.5).size(), 1U);
    EXPECT_EQ(cut(body, 1.6).size(), 0U);
}

TEST(Body, PillarBarrierCylinder) {
    EXPECT_NEAR(areaOf(cut("pillar", 2.5)), 0.16, 1e-12);
    EXPECT_NEAR(areaOf(cut("pillar kind=round size=1", 1)), std::numbers::pi / 4, 0.002);
    EXPECT_NEAR(areaOf(cut("barrier", 0.15)), 0.06, 1e-12);
    EXPECT_TRUE(cut("barrier", 1.01).empty());
    EXPECT_NEAR(areaOf(cut("cylinder size=2", 0.5)), std::numbers::pi, 0.003);
    EXPECT_NEAR(areaOf(cut("cylinder size=4,1,3", 3)), std::numbers::pi, 0.003);
    EXPECT_TRUE(cut("cylinder size=2", 0.51).empty());
}

TEST(Body, TableIsTopStemAndFoot) {
    const double whole = std::numbers::pi * 0.45 * 0.45;
    EXPECT_NEAR(areaOf(cut("table", 0.69)), whole, 0.002);
    EXPECT_NEAR(areaOf(cut("table", 0.15)), whole / 100, 0.001);
    EXPECT_NEAR(areaOf(cut("table", 0.01)), whole / 4, 0.002);
    EXPECT_TRUE(cut("table", 0.71).empty());
}

TEST(Body, DeskOnLegs) {
    const auto top = cut("desk", 0.69), low = cut("desk", 0.15);
    EXPECT_NEAR(areaOf(top), 0.96, 1e-12);
    ASSERT_EQ(low.size(), 4U);
    EXPECT_NEAR(areaOf(low), 4 * 0.0025, 1e-12);
    for (const Point2 p :
         {Point2{-0.6, -0.4}, Point2{0.6, -0.4}, Point2{0.6, 0.4}, Point2{-0.6, 0.4}})
        EXPECT_TRUE(covers(low, p));
    EXPECT_FALSE(covers(low, {0, 0}));
}

TEST(Body, ClosedDeskIsOpenToItsRightOnly) {
    const auto low = cut("desk kind=closed", 0.15);
    EXPECT_TRUE(covers(low, {-0.6, 0}));
    EXPECT_TRUE(covers(low, {0.6, 0}));
    EXPECT_TRUE(covers(low, {0, 0.4}));
    EXPECT_FALSE(covers(low, {0, -0.4}));
    // Heading 90: the right is +x.
    EXPECT_FALSE(covers(cut("desk kind=closed heading=90", 0.15), {0.4, 0}));
    EXPECT_TRUE(covers(cut("desk kind=closed heading=90", 0.15), {-0.4, 0}));
}

TEST(Body, ChairHasItsBackBehind) {
    const auto back = cut("chair", 0.8);
    EXPECT_TRUE(covers(back, {-0.22, 0}));
    EXPECT_FALSE(covers(back, {0.2, 0}));
    EXPECT_EQ(cut("chair", 0.15).size(), 4U);
    EXPECT_NEAR(areaOf(cut("chair", 0.44)), 0.45 * 0.45, 1e-12);
}

TEST(Body, EverythingIsCounterClockwiseWithinItsExtent) {
    for (const char* line :
         {"pillar", "pillar kind=round", "table", "desk", "desk kind=closed", "chair", "barrier",
          "cube", "cylinder", "boxes", "boxes count=1", "boxes count=100", "screen",
          "screen size=1,0.5", "screen size=0.01,0.01,0.01", "cylinder size=1,0.2,1",
          "desk size=0.01,0.01,0.01 kind=closed", "chair size=0.01,2,0.02", "table size=0.001"}) {
        const Record r = record(std::string(line) + " heading=33 at=-3,2,0.5");
        const Body body = bodyOf(r);
        EXPECT_FALSE(body.prisms.empty()) << line;
        const Tuple& size = r.tuple("size");
        const double length = size[0], width = size.size() > 1 ? size[1] : size[0];
        for (const Prism& prism : body.prisms) {
            EXPECT_GT(signedArea(prism.footprint), 0) << line;
            EXPECT_GE(prism.bottom, 0.5) << line;
            EXPECT_GT(prism.top, prism.bottom) << line;
            for (const Point2 p : prism.footprint) {
                const Vec2 v = p - Point2{-3, 2};
                const Vec2 ahead = unitVector(Angle::degrees(33));
                EXPECT_LE(std::abs(dot(v, ahead)), length / 2 + 1e-12) << line;
                EXPECT_LE(std::abs(cross(ahead, v)), width / 2 + 1e-12) << line;
            }
        }
    }
}

TEST(Body, BoxesStandUponEachOtherToTheVeryTop) {
    const Body three = bodyOf(record("boxes at=1,2,0.5"));
    ASSERT_EQ(three.prisms.size(), 3U);
    EXPECT_EQ(three.prisms.front().bottom, 0.5);
    EXPECT_EQ(three.prisms.back().top, 0.5 + 0.9);
    for (std::size_t i = 1; i < 3; ++i) {
        EXPECT_EQ(three.prisms[i].bottom, three.prisms[i - 1].top);
        EXPECT_NE(three.prisms[i].footprint, three.prisms[i - 1].footprint);
    }
    // The lowest is as broad as the stack.
    EXPECT_EQ(bounds(three.prisms[0].footprint), (Box2{{0.7, 1.8}, {1.3, 2.2}}));
    for (const int count : {1, 2, 7, 100}) {
        const Body body = bodyOf(record("boxes count=" + std::to_string(count) + " size=1,1,3"));
        ASSERT_EQ(body.prisms.size(), static_cast<std::size_t>(count));
        for (double z = 0; z <= 3; z += 0.0625) {
            const auto solids = cut(body, z);
            EXPECT_GE(solids.size(), 1U);
            EXPECT_GT(areaOf(solids), 0.7);
        }
        EXPECT_TRUE(cut(body, 3.01).empty());
    }
}

TEST(Body, ScreenIsABoardOnTwoFeet) {
    const Body body = bodyOf(record("screen size=2,0.6,2 at=0,0,0"));
    const auto board = cut(body, 1);
    ASSERT_EQ(board.size(), 1U);
    EXPECT_NEAR(areaOf(board), 2 * 0.02, 1e-12);
    EXPECT_EQ(cut(body, 0.15).size(), 2U) << "two posts";
    EXPECT_FALSE(covers(cut(body, 0.15), {0, 0}));
    const auto feet = cut(body, 0.01);
    EXPECT_EQ(feet.size(), 2U);
    for (const Polygon& foot : feet) EXPECT_NEAR(bounds(foot).depth(), 0.6, 1e-12);
    EXPECT_EQ(topOf(body), 2);
    // The bare screen stands on feet half a metre deep.
    for (const Polygon& foot : cut("screen", 0)) EXPECT_NEAR(bounds(foot).depth(), 0.5, 1e-12);
}

TEST(Body, InfraHangsAtItsHeightFromEdgeToEdge) {
    const Body body = bodyOf(record("infra at=1,1 size=4,2 rows=3 cols=5"));
    ASSERT_EQ(body.prisms.size(), 8U);
    Box2 box;
    for (const Prism& prism : body.prisms) {
        EXPECT_EQ(prism.bottom, 2.4);
        EXPECT_DOUBLE_EQ(prism.top, 2.45);
        for (const Point2 p : prism.footprint) box.add(p);
    }
    EXPECT_NEAR(box.low.x, -1, 1e-12);
    EXPECT_NEAR(box.high.x, 3, 1e-12);
    EXPECT_NEAR(box.low.y, 0, 1e-12);
    EXPECT_NEAR(box.high.y, 2, 1e-12);
    EXPECT_TRUE(cut(body, 2.3).empty());
    const auto bars = cut(body, 2.42);
    // Rows at 0.025, 1 and 1.975; columns every 0.9875.
    for (const double y : {0.01, 1.0, 1.99}) EXPECT_TRUE(covers(bars, {1.5, y})) << y;
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(covers(bars, {-1 + 0.025 + 0.9875 * i, 0.5})) << i;
    EXPECT_FALSE(covers(bars, {1.5, 0.5}));
    // One bar lies in the middle; many are as thin as they have to be.
    EXPECT_TRUE(covers(cut("infra rows=1 cols=1 heading=90", 2.42), {0, 1.9}));
    EXPECT_EQ(cut("infra rows=1 cols=1", 2.42).size(), 2U);
    const Body dense = bodyOf(record("infra size=0.1,0.1 rows=1000 cols=1000"));
    EXPECT_EQ(dense.prisms.size(), 2000U);
    for (const Prism& prism : dense.prisms) EXPECT_GT(signedArea(prism.footprint), 0);
}

TEST(Body, TopCountsMeshes) {
    Body body = bodyOf(record("cube"));
    body.meshes.push_back({Material::Mesh, {{0, 0, 2}, {1, 0, 3}, {0, 1, 1}}, {{0, 1, 2}}});
    EXPECT_EQ(topOf(body), 3);
    body.prisms.clear();
    body.meshes[0].vertices = {{0, 0, -2}, {1, 0, -3}, {0, 1, -1}};
    EXPECT_EQ(topOf(body), -1);
}

TEST(Body, FloorIsAPatternThatNoRayMeets) {
    const Body plain = bodyOf(record("floor size=3,2"));
    ASSERT_EQ(plain.plates.size(), 1U);
    const Body checker = bodyOf(record("floor kind=checker size=3,2 at=1,1 heading=20"));
    double area = 0;
    for (const Plate& plate : checker.plates) {
        EXPECT_TRUE(plate.visual_only);
        area += signedArea(plate.outline);
    }
    EXPECT_EQ(checker.plates.size(), 6U * 4U);
    EXPECT_NEAR(area, 6, 1e-12);
    EXPECT_EQ(bodyOf(record("floor kind=checker size=1e6,1e6")).plates.size(), 4096U);
    EXPECT_EQ(bodyOf(record("floor kind=checker size=0.1,0.1")).plates.size(), 4U);
}

TEST(Body, CeilingIsOffByDefault) {
    EXPECT_TRUE(bodyOf(record("ispace")).plates.empty());
    const Body room = bodyOf(record("ispace ceiling=yes size=4,3,2.2"));
    ASSERT_EQ(room.plates.size(), 1U);
    EXPECT_EQ(room.plates[0].z, 2.2);
    EXPECT_FALSE(room.plates[0].visual_only);
    EXPECT_NEAR(signedArea(room.plates[0].outline), 12, 1e-12);
    EXPECT_EQ(room.sheets.size(), 4U);
}

TEST(Body, InsideAndZoneHaveNone) {
    for (const char* line : {"inside at=0,0", "zone size=1,1"}) {
        const Body body = bodyOf(record(line));
        EXPECT_TRUE(body.prisms.empty() && body.sheets.empty() && body.plates.empty());
    }
}

TEST(Zone, IsPolygonOrRectangle) {
    EXPECT_EQ(zoneOutline(record("zone at=1,1 size=2,4 heading=90")),
              (Polygon{{3, 0}, {3, 2}, {-1, 2}, {-1, 0}}));
    EXPECT_GT(signedArea(zoneOutline(record("zone path=0,0;0,1;1,0"))), 0);
}

}  // namespace body_test
}  // namespace ispace
