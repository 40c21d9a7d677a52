// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "base/error.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "geom/test_curves.h"
#include "geom/visibility_test_plans.h"

namespace ispace {
namespace {

using std::numbers::pi;
using test::box;
using test::edgesOf;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

VisibleRegion look(const std::vector<Segment2>& lines, Point2 viewpoint, double range) {
    return VisibilityMap(lines).look(viewpoint, range);
}

double areaSeen(const std::vector<Segment2>& lines, Point2 viewpoint, double range) {
    return area(look(lines, viewpoint, range));
}

/// What the header says of every region; `slack` radians for directions that rounding moves.
void expectSound(const VisibleRegion& region, double slack = 1e-9) {
    const Point2 v = region.viewpoint;
    double turned = 0;
    for (std::size_t i = 0; i < region.ends.size(); ++i) {
        const SightEnd& end = region.ends[i];
        const Vec2 from = end.from - v, to = end.to - v;
        EXPECT_GT(cross(from, to), 0);
        turned += std::atan2(cross(from, to), dot(from, to));
        if (end.line == SightEnd::kArc) {
            EXPECT_GE(dot(from, to), -1e-9 * dot(from, from));
            EXPECT_NEAR(length(from), region.max_range, 1e-9 * region.max_range);
            EXPECT_NEAR(length(to), region.max_range, 1e-9 * region.max_range);
        }
        const Vec2 next = region.ends[(i + 1) % region.ends.size()].from - v;
        EXPECT_NEAR(std::atan2(cross(to, next), dot(to, next)), 0, slack);
    }
    EXPECT_NEAR(turned, region.ends.empty() ? 0 : 2 * pi, slack);
    EXPECT_GE(area(region), 0);
    EXPECT_LE(area(region), pi * region.max_range * region.max_range * (1 + 1e-9));
    EXPECT_NEAR(signedArea(outlineOf(region)), area(region), 1e-9 * (1 + area(region)));
}

double nearest(const std::vector<Segment2>& lines, Point2 p) {
    double least = kInfinity;
    for (const Segment2& line : lines) least = std::min(least, distance(p, line));
    return least;
}

/// The area by dense rays against all lines, in the middle of each piece of the turn.
double areaByRays(const std::vector<Segment2>& lines, Point2 p, double range, int rays) {
    double sum = 0;
    for (int i = 0; i < rays; ++i) {
        const double angle = 2 * pi * (i + 0.5) / rays;
        const Vec2 ray{std::cos(angle), std::sin(angle)};
        double reach = range;
        for (const auto& [a, b] : lines) {
            const double right = cross(a - p, ray), left = cross(ray, b - p);
            if ((right > 0) != (left > 0)) continue;
            const double at = cross(a - p, b - a) / cross(ray, b - a);
            if (at > 0) reach = std::min(reach, at);
        }
        sum += reach * reach * pi / rays;
    }
    return sum;
}

TEST(Visibility, SquareRoom) {
    const std::vector<Segment2> room = edgesOf(box(0, 0, 4, 4));
    for (const Point2 p : {Point2{2, 2}, Point2{1, 3.5}, Point2{0.3, 0.2}}) {
        const VisibleRegion region = look(room, p, kInfinity);
        EXPECT_EQ(region.viewpoint, p);
        EXPECT_EQ(region.ends.size(), 4U);
        EXPECT_DOUBLE_EQ(area(region), 16);
        expectSound(region);
        for (const SightEnd& end : region.ends) {
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
    expectSound(look(room, {2, 2}, range));
    EXPECT_EQ(look(room, {2, 2}, range).ends.size(), 8U);
}

TEST(Visibility, NoLines) {
    for (const Point2 p : {Point2{0, 0}, Point2{0.3, -0.7}, Point2{1, 1}, Point2{-1, 0.5},
                           Point2{-8, 3}, Point2{1e6, 1e6}, Point2{1, 7}}) {
        const VisibleRegion region = look({}, p, 3);
        EXPECT_NEAR(area(region), 9 * pi, 1e-8);
        expectSound(region, 1e-8);
        EXPECT_TRUE(holds(region, p + Vec2{2.9, 0}));
        EXPECT_FALSE(holds(region, p + Vec2{0, 3.1}));
        EXPECT_TRUE(std::isfinite(areaSeen({}, p, kInfinity)));
    }
}

TEST(Visibility, ZeroRangeSeesNothing) {
    const VisibleRegion region = look(edgesOf(box(0, 0, 4, 4)), {1, 1}, 0);
    EXPECT_TRUE(region.ends.empty());
    EXPECT_EQ(area(region), 0);
    EXPECT_TRUE(outlineOf(region).empty());
    EXPECT_FALSE(holds(region, {1, 1}));
    EXPECT_TRUE(sectorOf(region, Angle(), Angle::degrees(90)).ends.empty());
}

TEST(Visibility, OneWallHidesWhatIsBehind) {
    // A wall of 2 m, 1 m away: the quarter behind it is hidden but for the triangle before it.
    const std::vector<Segment2> wall{{{1, 1}, {-1, 1}}};
    const VisibleRegion region = look(wall, {0, 0}, 5);
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
            const VisibleRegion region = map.look(p, range);
            expectSound(region);
            EXPECT_NEAR(area(region), area(wide.look(p, range)), 1e-9 * range * range) << i;
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
        for (const SightEnd& end : map.look(test::randomInside(random, plan), 6).ends) {
            if (end.line == SightEnd::kArc) continue;
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
        const VisibleRegion region = look(room, {2, off}, 1);
        EXPECT_EQ(region.viewpoint, (Point2{2, 0}));
        EXPECT_NEAR(area(region), 2 * half_disc, 1e-12) << off;
        expectSound(region);
        // From a corner, all around.
        EXPECT_EQ(look(room, {off, off / 4}, 1).viewpoint, (Point2{0, 0}));
        EXPECT_NEAR(areaSeen(room, {off, off / 4}, 1), pi, 1e-12);
    }
    // A little farther off it does.
    for (const double off : {2e-4, -2e-4}) {
        EXPECT_EQ(look(room, {2, off}, 1).viewpoint, (Point2{2, off}));
        EXPECT_NEAR(areaSeen(room, {2, off}, 1), half_disc, 1e-3);
    }
    // What continues the wall does not stop it, and what crosses it does.
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
    const VisibleRegion region = look(lines, {2, 2.5}, kInfinity);
    EXPECT_EQ(region.ends.size(), 4U);
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
    expectSound(look(lines, {2, 2}, kInfinity));
}

TEST(Visibility, CollinearLinesAlone) {
    const std::vector<Segment2> lines{{{0, 0}, {1, 0}}, {{2, 0}, {3, 0}}, {{5, 0}, {9, 0}}};
    expectSound(look(lines, {4, 0}, 6));
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
    // Closed at a point: nothing gets through.
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
        if (nearest(lines, p) <= kSightContact) continue;
        for (const double range : {0.2, 1.0, 3.0, 9.0, 40.0}) {
            map.look(p, range, region);
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
            const double here = area(map.look(p, range));
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
        const bool a_sees_b = holds(map.look(a, range), b);
        EXPECT_EQ(a_sees_b, holds(map.look(b, range), a));
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
                EXPECT_NEAR(area(other.look(moved * p, range)), area(map.look(p, range)),
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
        const VisibleRegion whole = map.look(test::randomInside(random, plan), 3);
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
    const VisibleRegion disc = look({}, {1, 2}, 2);
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
    EXPECT_TRUE(sectorOf(disc, Angle(), Angle()).ends.empty());
    EXPECT_TRUE(sectorOf(disc, Angle(), Angle::degrees(-3)).ends.empty());
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
        const VisibleRegion region = map.look(test::randomInside(random, plan), 3.5);
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
        const VisibleRegion region = map.look({place(random), place(random)}, 5);
        expectSound(region);
        for (const SightEnd& end : region.ends) {
            if (end.line == SightEnd::kArc) continue;
            ASSERT_LT(end.line, lines.size());
            EXPECT_LT(distance(end.from, lines[end.line]), 1e-12);
            EXPECT_LT(distance(end.to, lines[end.line]), 1e-12);
        }
    }
}

TEST(Visibility, FarFromTheOrigin) {
    // A room at 10 000 km, where a double is 2 nm.
    const std::vector<Segment2> room = edgesOf(box(1e7, -1e7, 1e7 + 4, -1e7 + 3));
    const VisibilityMap map(room);
    EXPECT_NEAR(area(map.look({1e7 + 1, -1e7 + 1}, kInfinity)), 12, 1e-12);
    EXPECT_NEAR(area(map.look({1e7 + 2, -1e7 + 1.5}, 1)), pi, 1e-8);
    EXPECT_NEAR(area(map.look({1e7, -1e7 + 1.5}, 1)), pi, 1e-8);
    expectSound(map.look({1e7 + 1, -1e7 + 1}, 2), 1e-8);
}

TEST(Visibility, TinyRooms) {
    const double side = 1e-3;
    const std::vector<Segment2> room = edgesOf(box(0, 0, side, side));
    EXPECT_NEAR(areaSeen(room, {0.4e-3, 0.3e-3}, kInfinity) / (side * side), 1, 1e-12);
    // Within contact of all of its walls there is nothing in the way.
    EXPECT_NEAR(areaSeen(edgesOf(box(0, 0, 1e-6, 1e-6)), {3e-7, 4e-7}, 1), pi, 1e-9);
}

TEST(Visibility, EveryFiniteNumberHasAnAnswer) {
    std::vector<double> numbers{0, 1, -1, 4, 1e-300, -1e-300, 5e-324, 1e-17, 1e7, -1e15};
    for (const double huge : {1e50, 1e100, 1e300, std::numeric_limits<double>::max()}) {
        numbers.push_back(huge);
        numbers.push_back(-huge);
    }
    std::mt19937_64 random(18);
    const auto any = [&] { return numbers[random() % numbers.size()]; };
    for (int round = 0; round < 60; ++round) {
        std::vector<Segment2> lines = edgesOf(box(0, 0, 4, 4));
        for (int i = 0; i < round % 6; ++i) {
            const Point2 from{any(), any()};
            lines.push_back({from, {any(), any()}});
        }
        const VisibilityMap map(lines);
        for (int i = 0; i < 100; ++i) {
            const Point2 p{any(), any()};
            const double range = i % 5 == 0 ? kInfinity : std::abs(any());
            const double seen = area(map.look(p, range));
            EXPECT_TRUE(std::isfinite(seen) && seen >= 0)
                << p.x << ',' << p.y << ' ' << range << " sees " << seen;
        }
    }
}

TEST(Visibility, HeapsOfCollinearAndTouchingLines) {
    std::mt19937_64 random(19);
    for (int round = 0; round < 40; ++round) {
        std::vector<Segment2> lines;
        const auto any = [&] { return static_cast<double>(random() % 5); };
        for (int i = 0; i < 25; ++i) {
            const Point2 from{any(), any()};
            lines.push_back({from, {any(), any()}});
        }
        const VisibilityMap map(lines);
        for (int i = 0; i < 40; ++i) {
            const Point2 p =
                i % 2 == 0 ? Point2{any(), any()} : Point2{any() + any() / 8, any() + any() / 16};
            for (const double range : {0.7, 3.0}) expectSound(map.look(p, range), 1e-7);
            if (nearest(lines, p) > kSightContact) {
                EXPECT_NEAR(area(map.look(p, 3)), areaByRays(lines, p, 3, 3000), 0.15)
                    << "round " << round << " from " << p.x << ',' << p.y;
            }
        }
    }
}

TEST(Visibility, DeepCombs) {
    // A comb of 20 000 teeth, seen along its whole length: all of them wait at once.
    std::vector<Segment2> lines;
    constexpr int kTeeth = 20'000;
    for (int i = 0; i < kTeeth; ++i)
        lines.push_back({{double(i), 1}, {i + 0.5, 1 + 1.0 * (1 + i % 3)}});
    const VisibilityMap map(lines);
    for (const Point2 p : {Point2{-5, 0}, Point2{kTeeth / 2.0, -3000}}) {
        const VisibleRegion region = map.look(p, 1e5);
        EXPECT_GT(region.ends.size(), 1000U);
        expectSound(region);
    }
}

TEST(Visibility, LinesThatCrossByTheMillionAreRefused) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 1100; ++i) {
        lines.push_back({{0, double(i)}, {2000, i + 0.3}});
        lines.push_back({{double(i), -1}, {i + 0.2, 2000}});
    }
    EXPECT_THROW(VisibilityMap{lines}, FormatError);
}

TEST(Visibility, RegionsAreUsedAgain) {
    const std::vector<Segment2> room = edgesOf(box(0, 0, 4, 4));
    const VisibilityMap map(room);
    VisibleRegion region = map.look({1, 1}, 2);
    const SightEnd* const memory = region.ends.data();
    map.look({2, 2}, kInfinity, region);
    EXPECT_EQ(region.ends.data(), memory);
    EXPECT_DOUBLE_EQ(area(region), 16);
    map.look({0, 0}, 1, region);
    EXPECT_NEAR(area(region), pi, 1e-12);
}

}  // namespace
}  // namespace ispace
