// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <numeric>
#include <random>

#include "geom/arrangement.h"
#include "geom/predicates.h"
#include "io/plan/plan_rooms.h"
#include "support/test_work.h"

namespace ispace {

namespace plan_region_test {

using Lines = std::vector<Segment2>;

/// A rectangle's four lines.
Lines rectangle(double x0, double y0, double x1, double y1) {
    return {{{x0, y0}, {x1, y0}}, {{x1, y0}, {x1, y1}}, {{x1, y1}, {x0, y1}}, {{x0, y1}, {x0, y0}}};
}

/// Rooms of 4 m x 4 m and 3 m x 4 m with a wall between, and a shed apart.
Lines flat() {
    Lines lines = rectangle(0, 0, 7, 4);
    lines.push_back({{4, 0}, {4, 4}});
    for (const Segment2& line : rectangle(20, 0, 25, 5)) lines.push_back(line);
    return lines;
}

TEST(PlanRegion, GroupsByAreaAndPlace) {
    const PlanFaces faces(flat(), ampleWork());
    EXPECT_EQ(faces.faces().size(), 3U);
    ASSERT_EQ(faces.groups().size(), 3U);
    EXPECT_DOUBLE_EQ(faces.groups().front().area, 25);
    EXPECT_DOUBLE_EQ(faces.groupAt({1, 1})->area, 16);
    EXPECT_EQ(faces.groupAt({-1, 1}), nullptr);
    EXPECT_TRUE(PlanFaces(Lines{{{0, 0}, {1, 0}}}, ampleWork()).groups().empty());
    EXPECT_TRUE(PlanFaces(Lines{}, ampleWork()).groups().empty());
}

TEST(PlanRegion, DoorsJoinRooms) {
    const Lines doors{{{4, 1}, {4, 2}}};
    const PlanFaces faces(flat(), ampleWork(), doors);
    const PlanRegion region = faces.region(faces.groups().front());
    EXPECT_DOUBLE_EQ(region.area(), 28);
    ASSERT_EQ(region.rooms.size(), 2U);
    EXPECT_DOUBLE_EQ(region.rooms[0].area(), 16);
    EXPECT_EQ(region.rooms[0].locate(region.inside), Side::Inside);
    // A door to the outside joins no rooms.
    const Lines outside{{{0, 1}, {0, 2}}};
    EXPECT_DOUBLE_EQ(PlanFaces(flat(), ampleWork(), outside).groups().front().area, 25);
}

TEST(PlanRegion, HollowsOfWallsAreNoRooms) {
    Lines lines = rectangle(0, 0, 6, 5);
    for (const Segment2& line : rectangle(0.3, 0.3, 5.7, 4.7)) lines.push_back(line);
    for (const Segment2& line : rectangle(2, 1, 3, 2)) lines.push_back(line);
    const PlanFaces faces(lines, ampleWork());
    ASSERT_EQ(faces.groups().size(), 3U);  // the room, the hollow, a closed thing
    EXPECT_FALSE(faces.isHollow(faces.groups()[0]));
    EXPECT_NEAR(faces.groups()[1].area, 30 - 5.4 * 4.4, 1e-9);
    EXPECT_TRUE(faces.isHollow(faces.groups()[1]));
    EXPECT_FALSE(faces.isHollow(faces.groups()[2]));
    // The same in millimetres that were taken for metres.
    for (Segment2& line : lines)
        line = {{line.a.x / 1000, line.a.y / 1000}, {line.b.x / 1000, line.b.y / 1000}};
    const PlanFaces small(lines, ampleWork());
    EXPECT_FALSE(small.isHollow(small.groups()[0]));
    EXPECT_TRUE(small.isHollow(small.groups()[1]));
}

TEST(PlanRegion, ClosingsBoundOnlyAgainstTheOutside) {
    // Two rooms without the wall between them, and without a piece of the outer wall.
    const Lines walls{{{0, 0}, {3, 0}}, {{4, 0}, {7, 0}}, {{7, 0}, {7, 4}}, {{7, 4}, {0, 4}},
                      {{0, 4}, {0, 0}}, {{3, 0}, {3, 1}}, {{3, 3}, {3, 4}}};
    const Lines closings{{{3, 0}, {4, 0}}, {{3, 1}, {3, 3}}};
    const PlanFaces faces(walls, ampleWork(), {}, closings);
    ASSERT_EQ(faces.groups().size(), 1U);
    EXPECT_DOUBLE_EQ(faces.groups()[0].area, 28);
    const auto closed = faces.closedBy(faces.region(faces.groups()[0]));
    ASSERT_EQ(closed.size(), 1U);
    EXPECT_DOUBLE_EQ(distance(closed[0].a, closed[0].b), 1);
    EXPECT_DOUBLE_EQ(closed[0].a.y, 0);
    EXPECT_TRUE(PlanFaces(walls, ampleWork()).groups().empty());
}

TEST(PlanRegion, InsideIsClearOfLinesThatStandFree) {
    Lines lines = rectangle(0, 0, 4, 4);
    lines.push_back({{1, 1}, {3, 3}});
    lines.push_back({{1, 3}, {3, 1}});
    const PlanFaces faces(lines, ampleWork());
    const Point2 inside = faces.region(faces.groups().front()).inside;
    for (const Segment2& line : lines) EXPECT_GT(distance(inside, line), 0.3);
}

PlanRegion leftRoom(const Lines& lines) {
    const PlanFaces faces(lines, ampleWork());
    return faces.region(*faces.groupAt({1, 3}));
}

// Rooms of 1 m in a raster that leans, some with a table in them; doors join some of them.
TEST(PlanRegion, DoorsJoinAsCountedByHand) {
    constexpr std::size_t kSide = 12;
    std::mt19937_64 random(5);
    const Vec2 x = unitVector(Angle::degrees(17)), y = perpendicular(x);
    const auto at = [&](double i, double k) { return Point2{} + i * x + k * y; };
    Lines lines, doors;
    std::vector<std::size_t> group(kSide * kSide);
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto join = [&](std::size_t a, std::size_t b) {
        std::replace(group.begin(), group.end(), std::size_t{group[b]}, std::size_t{group[a]});
    };
    for (std::size_t i = 0; i <= kSide; ++i) {
        const auto far = static_cast<double>(i);
        lines.push_back({at(far, 0), at(far, kSide)});
        lines.push_back({at(0, far), at(kSide, far)});
    }
    for (std::size_t i = 0; i < kSide; ++i)
        for (std::size_t k = 0; k < kSide; ++k) {
            const auto a = static_cast<double>(i), b = static_cast<double>(k);
            if (random() % 4 == 0) {
                const std::array<Point2, 4> table{at(a + 0.4, b + 0.4), at(a + 0.6, b + 0.4),
                                                  at(a + 0.6, b + 0.6), at(a + 0.4, b + 0.6)};
                for (std::size_t n = 0; n < 4; ++n) lines.push_back({table[n], table[(n + 1) % 4]});
            }
            const std::size_t cell = i * kSide + k;
            if (i + 1 < kSide && random() % 3 == 0) {
                doors.push_back({at(a + 1, b + 0.2), at(a + 1, b + 0.7)});
                join(cell, cell + kSide);
            }
            if (k + 1 < kSide && random() % 3 == 0) {
                doors.push_back({at(a + 0.3, b + 1), at(a + 0.9, b + 1)});
                join(cell, cell + 1);
            }
            if (k == 0 && random() % 3 == 0) doors.push_back({at(a + 0.3, 0), at(a + 0.9, 0)});
        }
    const PlanFaces faces(lines, ampleWork(), doors);
    for (std::size_t i = 0; i < group.size(); ++i)
        for (const std::size_t other : {(i + 1) % group.size(), (i + kSide) % group.size()}) {
            const auto group_of = [&](std::size_t cell) {
                const std::size_t row = cell / kSide, column = cell % kSide;
                return faces.groupAt(
                    at(static_cast<double>(row) + 0.1, static_cast<double>(column) + 0.1));
            };
            ASSERT_NE(group_of(i), nullptr);
            EXPECT_EQ(group_of(i) == group_of(other), group[i] == group[other])
                << i << ' ' << other;
        }
}

TEST(PlanRegion, LinesThatBelong) {
    Lines lines = flat();
    lines.push_back({{1, 1}, {2, 2}});    // stands in the left room
    lines.push_back({{5, 1}, {6, 2}});    // in the right one
    lines.push_back({{4, 2}, {3, 2}});    // from the wall into the left one
    lines.push_back({{-3, 1}, {-2, 1}});  // outside
    const auto belongs = belongsTo({{leftRoom(lines)}}, lines);
    const std::vector<bool> expected{true,  false, true, true,  true, false, false,
                                     false, false, true, false, true, false};
    // The lower and upper sides run on to the right room; they bound the left one as well.
    EXPECT_EQ(belongs, expected);
}

TEST(PlanRegion, BelongingEqualsBruteForce) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 60; ++round) {
        Lines lines;
        for (int i = 0; i < 25; ++i) {
            const auto at = [&] {
                return Point2{static_cast<double>(random() % 9), static_cast<double>(random() % 9)};
            };
            lines.push_back({at(), at()});
        }
        const PlanFaces faces(lines, ampleWork());
        if (faces.groups().empty()) continue;
        const PlanRegion region = faces.region(faces.groups().front());
        const auto belongs = belongsTo({{region}}, lines);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            bool within = false;
            for (const double share : {0.01, 0.501, 0.99})
                within = within ||
                         region.rooms[0].locate(lines[i].a + share * (lines[i].b - lines[i].a)) ==
                             Side::Inside;
            // A stretch of an edge lies on the line: of the points of one on the other some do.
            const auto lie_on = [](const Segment2& s, const Segment2& t) {
                int on = 0;
                for (int k = 0; k < 400; ++k)
                    if (distance(s.a + (k + 0.5) / 400 * (s.b - s.a), t) < 2e-6) ++on;
                return on > 1;
            };
            bool bounds = false;
            region.rooms[0].forEachEdge([&](const Segment2& edge) {
                bounds = bounds || lie_on(edge, lines[i]) || lie_on(lines[i], edge);
            });
            EXPECT_EQ(belongs[i], within || bounds) << round << ' ' << i;
        }
    }
}

TEST(PlanRegion, HatchingIsNoPlan) {
    Lines grid;
    for (int i = 0; i < 1000; ++i) {
        grid.push_back({{i * 0.01, 0}, {i * 0.01, 10}});
        grid.push_back({{0, i * 0.01}, {10, i * 0.01}});
    }
    EXPECT_TRUE(crossTooOften(grid));
    grid.resize(400);
    EXPECT_FALSE(crossTooOften(grid));
    EXPECT_FALSE(crossTooOften(Lines{}));
    EXPECT_FALSE(crossTooOften(Lines{{{0, 0}, {1, 1}}}));
    Lines rows;
    for (int i = 0; i < 100'000; ++i) rows.push_back({{0, i * 1.0}, {10, i * 1.0}});
    EXPECT_FALSE(crossTooOften(rows));
}

std::vector<Segment2> edgesOf(const Region& region) {
    std::vector<Segment2> edges;
    region.forEachEdge([&](const Segment2& edge) { edges.push_back(edge); });
    return edges;
}

/// What a disc loses in a right-angled corner.
double cornerLoss(double radius) { return (1 - std::numbers::pi / 4) * radius * radius; }

const Region kHall{{{0, 0}, {8, 0}, {8, 5}, {0, 5}}, {}};

TEST(ReachedFloor, CornersAreRounded) {
    const double radius = 0.25;
    const auto reached = reachedFloor({{kHall}}, edgesOf(kHall), {4, 2}, radius);
    ASSERT_EQ(reached.size(), 1U);
    EXPECT_NEAR(totalArea(reached), 40 - 4 * cornerLoss(radius), 3e-3);
}

TEST(ReachedFloor, StripsBehindNarrowGapsDoNotCount) {
    std::vector<Segment2> walls = edgesOf(kHall);
    walls.push_back({{6, 0}, {6, 2}});
    walls.push_back({{6, 2.4}, {6, 5}});  // a gap of 0.4 m
    const auto narrow = reachedFloor({{kHall}}, walls, {1, 1}, 0.25);
    EXPECT_NEAR(totalArea(narrow), 30 - 4 * cornerLoss(0.25), 0.05);
    const auto wide = reachedFloor({{kHall}}, walls, {1, 1}, 0.15);
    EXPECT_NEAR(totalArea(wide), 40 - 8 * cornerLoss(0.15), 0.01);
    // From the other side the other part.
    EXPECT_NEAR(totalArea(reachedFloor({{kHall}}, walls, {7, 1}, 0.25)), 10 - 4 * cornerLoss(0.25),
                0.05);
    EXPECT_TRUE(reachedFloor({{kHall}}, walls, {0.1, 0.1}, 0.25).empty());
}

TEST(ReachedFloor, ThroughDoorsIntoTheNextRoom) {
    const Region left{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
    const Region right{{{4, 0}, {7, 0}, {7, 3}, {4, 3}}, {}};
    std::vector<Segment2> walls = edgesOf(left);
    for (const Segment2& edge : edgesOf(right)) walls.push_back(edge);
    const std::vector<Segment2> door{{{4, 1}, {4, 2}}};
    const auto open = withoutPassages(walls, door, ampleWork());
    EXPECT_EQ(open.size(), walls.size() + 2);  // the wall is drawn twice
    const std::vector<Region> rooms{left, right};
    EXPECT_NEAR(totalArea(reachedFloor(rooms, open, {1, 1}, 0.3)), 21 - 8 * cornerLoss(0.3), 0.01);
    EXPECT_NEAR(totalArea(reachedFloor(rooms, walls, {1, 1}, 0.3)), 12 - 4 * cornerLoss(0.3), 0.01);
}

TEST(ReachedFloor, OutlinesAreOpenAtDoorsBetweenPieces) {
    const Region left{{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {}};
    const Region right{{{4, 0}, {7, 0}, {7, 3}, {4, 3}}, {}};
    const std::vector<Region> pieces{left, right};
    const std::vector<Segment2> doors{{{4, 1}, {4, 2}}, {{0, 1}, {0, 2}}};
    const auto outlines = reachedOutlines(pieces, doors, ampleWork());
    ASSERT_EQ(outlines.size(), 2U);
    EXPECT_EQ(outlines[0].points,
              (Polygon{{4, 2}, {4, 3}, {0, 3}, {0, 0}, {4, 0}, {4, 1}}));  // the way out is shut
    EXPECT_FALSE(outlines[0].closed);
    EXPECT_EQ(outlines[1].points, (Polygon{{4, 1}, {4, 0}, {7, 0}, {7, 3}, {4, 3}, {4, 2}}));
    const auto shut = reachedOutlines(pieces, {}, ampleWork());
    ASSERT_EQ(shut.size(), 2U);
    EXPECT_TRUE(shut[0].closed);
    EXPECT_EQ(shut[0].points, left.outline);
}

TEST(ReachedFloor, RoundAPillar) {
    Region hall = kHall;
    hall.holes = {{{3, 2}, {3, 3}, {5, 3}, {5, 2}}};
    const auto reached = reachedFloor({{hall}}, edgesOf(hall), {1, 1}, 0.2);
    ASSERT_EQ(reached.size(), 1U);
    EXPECT_EQ(reached[0].holes.size(), 1U);
    EXPECT_NEAR(totalArea(reached), 38 - 4 * cornerLoss(0.2), 3e-3);
}

}  // namespace plan_region_test

}  // namespace ispace
