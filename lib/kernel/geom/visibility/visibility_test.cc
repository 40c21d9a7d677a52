// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "support/test_curves.h"
#include "support/test_plans.h"
#include "support/test_visibility.h"

namespace ispace {
namespace visibility_test {

using std::numbers::pi;
using test::areaByRays;
using test::areaSeen;
using test::box;
using test::edgesOf;
using test::expectSound;
using test::kInfinity;
using test::nearest;
using test::query;

TEST(Visibility, SquareRoom) {
    const std::vector<Segment2> room = edgesOf(box(0, 0, 4, 4));
    for (const Point2 p : {Point2{2, 2}, Point2{1, 3.5}, Point2{0.3, 0.2}}) {
        const VisibleRegion region = query(room, p, kInfinity);
        EXPECT_EQ(region.viewpoint, p);
        EXPECT_EQ(region.edges.size(), 4U);
        EXPECT_DOUBLE_EQ(area(region), 16);
        expectSound(region);
        for (const VisibilityEdge& end : region.edges) {
            EXPECT_EQ(room[end.line].a, end.from);
            EXPECT_EQ(room[end.line].b, end.to);
        }
    }
    // A disc that the walls do not touch, one they cut, and one that holds them.
    EXPECT_NEAR(areaSeen(room, {2, 2}, 1.5), pi * 2.25, 1e-12);
    const double range = 2.5, half = std::acos(2 / range);
    const double cut = range * range * (half - std::sin(2 * half) / 2);
    EXPECT_NEAR(areaSeen(room, {2, 2}, range), pi * range * range - 4 * cut, 1e-12);
    EXPECT_NEAR(areaSeen(room, {2, 2}, 10), 16, 1e-12);
    expectSound(query(room, {2, 2}, range));
    EXPECT_EQ(query(room, {2, 2}, range).edges.size(), 8U);
}

TEST(Visibility, NoLines) {
    for (const Point2 p : {Point2{0, 0}, Point2{0.3, -0.7}, Point2{1, 1}, Point2{-1, 0.5},
                           Point2{-8, 3}, Point2{1e6, 1e6}, Point2{1, 7}}) {
        const VisibleRegion region = query({}, p, 3);
        EXPECT_NEAR(area(region), 9 * pi, 1e-8);
        expectSound(region, 1e-8);
        EXPECT_TRUE(holds(region, p + Vec2{2.9, 0}));
        EXPECT_FALSE(holds(region, p + Vec2{0, 3.1}));
        EXPECT_TRUE(std::isfinite(areaSeen({}, p, kInfinity)));
    }
}

TEST(Visibility, ZeroRangeSeesNothing) {
    const VisibleRegion region = query(edgesOf(box(0, 0, 4, 4)), {1, 1}, 0);
    EXPECT_TRUE(region.edges.empty());
    EXPECT_EQ(area(region), 0);
    EXPECT_TRUE(outlineOf(region).empty());
    EXPECT_FALSE(holds(region, {1, 1}));
    EXPECT_TRUE(sectorOf(region, Angle(), Angle::degrees(90)).edges.empty());
}

TEST(Visibility, OneWallHidesWhatIsBehind) {
    // A wall of 2 m, 1 m away: the quarter behind it is hidden but for the triangle before it.
    const std::vector<Segment2> wall{{{1, 1}, {-1, 1}}};
    const VisibleRegion region = query(wall, {0, 0}, 5);
    EXPECT_NEAR(area(region), 25 * pi * 3 / 4 + 1, 1e-12);
    expectSound(region);
    EXPECT_TRUE(holds(region, {0.5, 0.99}));
    EXPECT_FALSE(holds(region, {0.5, 1.01}));
    EXPECT_TRUE(holds(region, {4, 1}));
    // From outside of all that is triangulated.
    const double far_away = areaSeen(wall, {0, -1000}, 2000);
    const double half = std::atan2(1, 1001);
    EXPECT_NEAR(far_away, 4e6 * (pi - half) + 1001, 1e-6);
    EXPECT_NEAR(areaSeen(wall, {50, 1}, 100), 1e4 * pi, 1e-9);  // in line with it
}

TEST(Visibility, FromBeyondTheTriangles) {
    std::vector<Segment2> lines = test::linesOf(test::makePlan(20, {1, 1, 4, 4, 8}));
    const VisibilityMap map(lines);
    // The same with a far line, so that it is looked at from inside.
    lines.push_back({{1e4, 1e4}, {1e4 + 1, 1e4}});
    const VisibilityMap wide(lines);
    for (int i = 0; i < 48; ++i) {
        const Point2 p = Point2{3, -2} + 300 * unitVector(Angle::degrees(7.5 * i));
        for (const double range : {250.0, 299.0, 302.0, 400.0}) {
            const VisibleRegion region = map.query(p, range);
            expectSound(region);
            EXPECT_NEAR(area(region), area(wide.query(p, range)), 1e-9 * range * range) << i;
        }
    }
}

TEST(Visibility, VerticesAreExact) {
    std::mt19937_64 random(21);
    const Region plan = test::makePlan(21, {2, 2, 9, 6, 20});
    const std::vector<Segment2> lines = test::linesOf(plan);
    const VisibilityMap map(lines);
    int exact = 0;
    for (int i = 0; i < 50; ++i) {
        for (const VisibilityEdge& end : map.query(test::randomInside(random, plan), 6).edges) {
            if (end.line == VisibilityEdge::kArc) continue;
            for (const Point2 p : {end.from, end.to}) {
                for (const Point2 vertex : {lines[end.line].a, lines[end.line].b}) {
                    if (distance(p, vertex) > 1e-12) continue;
                    EXPECT_EQ(p, vertex);
                    ++exact;
                }
            }
        }
    }
    EXPECT_GT(exact, 500);
}

TEST(Visibility, AWallDoesNotStopSightFromIt) {
    const std::vector<Segment2> room = edgesOf(box(0, 0, 4, 4));
    const double half_disc = pi / 2;
    for (const double off : {0.0, 1e-17, -1e-17, 1e-9, 5e-5, -9e-5}) {
        const VisibleRegion region = query(room, {2, off}, 1);
        EXPECT_EQ(region.viewpoint, (Point2{2, 0}));
        EXPECT_NEAR(area(region), 2 * half_disc, 1e-12) << off;
        expectSound(region);
        // From a corner, all around.
        EXPECT_EQ(query(room, {off, off / 4}, 1).viewpoint, (Point2{0, 0}));
        EXPECT_NEAR(areaSeen(room, {off, off / 4}, 1), pi, 1e-12);
    }
    // A little farther off it does.
    for (const double off : {2e-4, -2e-4}) {
        EXPECT_EQ(query(room, {2, off}, 1).viewpoint, (Point2{2, off}));
        EXPECT_NEAR(areaSeen(room, {2, off}, 1), half_disc, 1e-3);
    }
    // A collinear continuation of the wall does not stop it; a line across it does.
    std::vector<Segment2> crossed{{{0, 0}, {4, 0}}, {{4, 0}, {8, 0}}, {{3, -9}, {3, 9}}};
    EXPECT_NEAR(areaSeen(crossed, {2, 0}, 2), areaSeen({crossed[2]}, {2, 0}, 2), 1e-12);
    EXPECT_LT(areaSeen(crossed, {2, 0}, 2), 4 * pi - 1);
    // Two lines that nearly are one.
    const std::vector<Segment2> two{{{-1, 0}, {1, 0}}, {{-1, 5e-5}, {1, 5e-5}}};
    EXPECT_NEAR(areaSeen(two, {0.1, 1e-5}, 1), pi, 1e-3);
}

TEST(Visibility, PiecesOfAWallAreOne) {
    // A wall behind that ends at the room's wall, and one that crosses it there.
    std::vector<Segment2> lines = edgesOf(box(0, 0, 4, 4));
    lines.push_back({{4, 2}, {7, 2}});
    lines.push_back({{1, 4}, {1, 6}});
    const VisibleRegion region = query(lines, {2, 2.5}, kInfinity);
    EXPECT_EQ(region.edges.size(), 4U);
    EXPECT_DOUBLE_EQ(area(region), 16);
}

TEST(Visibility, DoubledAndOverlappingLinesCountOnce) {
    std::vector<Segment2> lines = edgesOf(box(0, 0, 4, 4));
    for (int i = 0; i < 4; ++i) lines.push_back({lines[i].b, lines[i].a});
    lines.push_back({{1, 0}, {6, 0}});
    lines.push_back({{2, 2}, {2, 2}});  // no length
    lines.push_back({{3, 3}, {3.5, 3}});
    const double hidden =
        16 - areaSeen({lines[0], lines[1], lines[2], lines[3], lines.back()}, {3, 1}, kInfinity);
    EXPECT_NEAR(hidden, 0.5 * 1.75 / 2 - 0.125 + 0.0, 0.5);
    EXPECT_NEAR(areaSeen(lines, {3, 1}, kInfinity), 16 - hidden, 1e-12);
    expectSound(query(lines, {2, 2}, kInfinity));
}

TEST(Visibility, CollinearLinesAlone) {
    const std::vector<Segment2> lines{{{0, 0}, {1, 0}}, {{2, 0}, {3, 0}}, {{5, 0}, {9, 0}}};
    expectSound(query(lines, {4, 0}, 6));
    EXPECT_NEAR(areaSeen(lines, {4, 0}, 6), 36 * pi, 1e-12);
    EXPECT_NEAR(areaSeen(lines, {1.5, 0}, 6), 36 * pi, 1e-12);
    EXPECT_NEAR(areaSeen(lines, {2.5, 1}, 4), areaByRays(lines, {2.5, 1}, 4, 20000), 1e-2);
}

TEST(Visibility, ASlitLetsSightThrough) {
    // 1e-6 m wide, a metre away: a triangle of that angle.
    const std::vector<Segment2> lines{{{-50, 1}, {-5e-7, 1}}, {{5e-7, 1}, {50, 1}}};
    const double behind = areaSeen(lines, {0, 0}, 10);
    std::vector<Segment2> closed = lines;
    closed.push_back({{-5e-7, 1}, {5e-7, 1}});
    EXPECT_NEAR(behind - areaSeen(closed, {0, 0}, 10), (100 - 1) * 1e-6 / 2, 1e-9);
    // Closed at a point: no ray gets through.
    const std::vector<Segment2> touching{{{-50, 1}, {0, 1}}, {{0, 1}, {50, 1}}};
    EXPECT_NEAR(areaSeen(touching, {0, 0}, 10), areaSeen(closed, {0, 0}, 10), 1e-9);
}

TEST(Visibility, AgreesWithRaysAtAnyRange) {
    std::mt19937_64 random(11);
    const Region plan = test::makePlan(11, {2, 2, 12, 7, 40});
    const std::vector<Segment2> lines = test::linesOf(plan);
    const VisibilityMap map(lines);
    const Box2 around = test::boxOf(lines);
    const Box2 wide{around.low - Vec2{12, 12}, around.high + Vec2{12, 12}};
    VisibleRegion region;
    for (int i = 0; i < 120; ++i) {
        const Point2 p = test::randomIn(random, i % 4 == 0 ? wide : around);
        if (nearest(lines, p) <= kRayEpsilon) continue;
        for (const double range : {0.2, 1.0, 3.0, 9.0, 40.0}) {
            map.query(p, range, region);
            expectSound(region);
            const double wanted = areaByRays(lines, p, range, 2000);
            EXPECT_NEAR(area(region), wanted, 0.02 * range * range) << p.x << ',' << p.y;
        }
    }
}

TEST(Visibility, LargerRangesSeeMore) {
    std::mt19937_64 random(12);
    const Region plan = test::makePlan(12, {2, 2, 9, 6, 20});
    const VisibilityMap map(test::linesOf(plan));
    for (int i = 0; i < 200; ++i) {
        const Point2 p = test::randomInside(random, plan);
        double last = 0;
        for (const double range :
             {1e-6, 1e-3, 0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0, 20.0, kInfinity}) {
            const double here = area(map.query(p, range));
            EXPECT_GE(here, last * (1 - 1e-12));
            last = here;
        }
        EXPECT_LE(last, plan.area() * (1 + 1e-12));
    }
}

TEST(Visibility, IsSymmetric) {
    std::mt19937_64 random(13);
    const Region plan = test::makePlan(13, {2, 2, 15, 6, 20});
    const std::vector<Segment2> lines = test::linesOf(plan);
    const VisibilityMap map(lines);
    const double range = 6;
    int seen = 0;
    for (int i = 0; i < 1000; ++i) {
        const Point2 a = test::randomInside(random, plan), b = test::randomInside(random, plan);
        const bool a_sees_b = holds(map.query(a, range), b);
        EXPECT_EQ(a_sees_b, holds(map.query(b, range), a));
        const bool is_free =
            distance(a, b) < range && std::none_of(lines.begin(), lines.end(), [&](auto& line) {
                return intersects(line, {a, b});
            });
        EXPECT_EQ(a_sees_b, is_free);
        seen += a_sees_b ? 1 : 0;
    }
    EXPECT_GT(seen, 100);
    EXPECT_LT(seen, 900);
}

TEST(Visibility, MovedAndTurnedPlansHaveTheSameAreas) {
    std::mt19937_64 random(14);
    const Region plan = test::makePlan(14, {2, 2, 9, 6, 20});
    const std::vector<Segment2> lines = test::linesOf(plan);
    const VisibilityMap map(lines);
    std::uniform_real_distribution<double> turn(-180, 180), share(0, 1);
    for (const double far_away : {0.0, 30.0, 1e5}) {
        const Pose2 moved{{far_away, -2 * far_away}, Angle::degrees(turn(random))};
        std::vector<Segment2> there = lines;
        for (auto& [a, b] : there) a = moved * a, b = moved * b;
        const VisibilityMap other(there);
        const double slack = 1e-12 + 1e-14 * far_away;
        for (int i = 0; i < 150; ++i) {
            // Anywhere, on walls and on vertices.
            const Segment2& line = lines[static_cast<std::size_t>(i) % lines.size()];
            const Point2 p = i % 3 == 0   ? test::randomInside(random, plan)
                             : i % 3 == 1 ? line.a + share(random) * (line.b - line.a)
                                          : line.b;
            for (const double range : {0.5, 4.0}) {
                EXPECT_NEAR(area(other.query(moved * p, range)), area(map.query(p, range)),
                            100 * slack * range)
                    << "point " << i << " at " << far_away;
            }
        }
    }
}

TEST(Visibility, SectorsAddUp) {
    std::mt19937_64 random(15);
    std::uniform_real_distribution<double> start(-400, 400);
    const Region plan = test::makePlan(15, {2, 1, 9, 6, 20});
    const VisibilityMap map(test::linesOf(plan));
    for (int i = 0; i < 200; ++i) {
        const VisibleRegion whole = map.query(test::randomInside(random, plan), 3);
        for (const int parts : {1, 2, 3, 7, 40}) {
            const double first = i == 0 ? 0 : start(random), span = 360.0 / parts;
            double sum = 0;
            for (int k = 0; k < parts; ++k) {
                const VisibleRegion part =
                    sectorOf(whole, Angle::degrees(first + k * span), Angle::degrees(span));
                EXPECT_EQ(part.is_whole, parts == 1);
                EXPECT_NEAR(signedArea(outlineOf(part)), area(part), 1e-12);
                sum += area(part);
            }
            EXPECT_NEAR(sum, area(whole), 1e-10);
        }
        // All but a degree, and its complement.
        const Angle first = Angle::degrees(start(random)), span = Angle::degrees(359);
        const VisibleRegion most = sectorOf(whole, first, span);
        const VisibleRegion rest = sectorOf(whole, first + span, Angle::degrees(1));
        EXPECT_NEAR(area(most) + area(rest), area(whole), 1e-10);
        EXPECT_FALSE(most.is_whole);
    }
}

TEST(Visibility, SectorsInTheOpen) {
    const VisibleRegion disc = query({}, {1, 2}, 2);
    for (const double span : {1.0, 90.0, 180.0, 270.0, 359.0}) {
        const VisibleRegion sector = sectorOf(disc, Angle::degrees(-45), Angle::degrees(span));
        EXPECT_NEAR(area(sector), 2 * pi * span / 180, 1e-12) << span;
        const Curve outline = outlineOf(sector);
        EXPECT_EQ(outline.front().from, (Point2{1, 2}));
        EXPECT_EQ(outline.back().to, (Point2{1, 2}));
        for (std::size_t i = 1; i < outline.size(); ++i)
            EXPECT_EQ(outline[i].from, outline[i - 1].to);
        EXPECT_NEAR(perimeter(outline), 4 + 2 * pi * span / 90 / 2 * 1, 1e-9) << span;
    }
    EXPECT_TRUE(sectorOf(disc, Angle(), Angle()).edges.empty());
    EXPECT_TRUE(sectorOf(disc, Angle(), Angle::degrees(-3)).edges.empty());
    EXPECT_FALSE(sectorOf(disc, Angle(), Angle()).is_whole);
    const VisibleRegion right = sectorOf(disc, Angle::degrees(-90), Angle::degrees(180));
    EXPECT_TRUE(holds(right, {2, 2}));
    EXPECT_FALSE(holds(right, {0, 2}));
}

TEST(Visibility, OutlinesJoin) {
    std::mt19937_64 random(16);
    const Region plan = test::makePlan(16, {2, 2, 9, 6, 20});
    const VisibilityMap map(test::linesOf(plan));
    for (int i = 0; i < 100; ++i) {
        const VisibleRegion region = map.query(test::randomInside(random, plan), 3.5);
        const Curve outline = outlineOf(region);
        for (std::size_t k = 0; k < outline.size(); ++k)
            EXPECT_EQ(outline[k].to, outline[(k + 1) % outline.size()].from);
        EXPECT_NEAR(signedArea(outline), area(region), 1e-11);
    }
}

TEST(Visibility, LinesOfEndsAreThere) {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> place(0, 10), way(-2, 2);
    std::vector<Segment2> lines;
    for (int i = 0; i < 200; ++i) {
        const Point2 from{place(random), place(random)};
        lines.push_back({from, from + Vec2{way(random), way(random)}});
    }
    const VisibilityMap map(lines);
    for (int i = 0; i < 200; ++i) {
        const VisibleRegion region = map.query({place(random), place(random)}, 5);
        expectSound(region);
        for (const VisibilityEdge& end : region.edges) {
            if (end.line == VisibilityEdge::kArc) continue;
            ASSERT_LT(end.line, lines.size());
            EXPECT_LT(distance(end.from, lines[end.line]), 1e-12);
            EXPECT_LT(distance(end.to, lines[end.line]), 1e-12);
        }
    }
}

}  // namespace visibility_test
}  // namespace ispace
