// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan_region.h"

#include <gtest/gtest.h>

#include <random>

#include "geom/predicates.h"

namespace ispace {
namespace {

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

TEST(PlanRegion, LargestFaceOrThePreferred) {
    const PlanFaces faces(flat());
    EXPECT_EQ(faces.faces().size(), 3U);
    EXPECT_DOUBLE_EQ(faces.region()->area(), 25);
    EXPECT_DOUBLE_EQ(faces.region(Point2{1, 1})->area(), 16);
    EXPECT_DOUBLE_EQ(faces.region(Point2{-1, 1})->area(), 25);
    EXPECT_FALSE(PlanFaces(Lines{{{0, 0}, {1, 0}}}).region());
    EXPECT_FALSE(PlanFaces(Lines{}).region());
}

TEST(PlanRegion, DoorsJoinRooms) {
    const Lines doors{{{4, 1}, {4, 2}}};
    const auto region = PlanFaces(flat(), doors).region();
    ASSERT_TRUE(region);
    EXPECT_DOUBLE_EQ(region->area(), 28);
    ASSERT_EQ(region->rooms.size(), 2U);
    EXPECT_DOUBLE_EQ(region->rooms[0].area(), 16);
    EXPECT_EQ(region->rooms[0].locate(region->inside), Side::Inside);
    // A door to the outside joins nothing.
    const Lines outside{{{0, 1}, {0, 2}}};
    EXPECT_DOUBLE_EQ(PlanFaces(flat(), outside).region()->area(), 25);
}

TEST(PlanRegion, InsideIsClearOfLinesThatStandFree) {
    Lines lines = rectangle(0, 0, 4, 4);
    lines.push_back({{1, 1}, {3, 3}});
    lines.push_back({{1, 3}, {3, 1}});
    const Point2 inside = PlanFaces(lines).region()->inside;
    for (const Segment2& line : lines) EXPECT_GT(distance(inside, line), 0.3);
}

TEST(PlanRegion, LinesThatBelong) {
    Lines lines = flat();
    lines.push_back({{1, 1}, {2, 2}});    // stands in the left room
    lines.push_back({{5, 1}, {6, 2}});    // in the right one
    lines.push_back({{4, 2}, {3, 2}});    // from the wall into the left one
    lines.push_back({{-3, 1}, {-2, 1}});  // outside
    const auto belongs = belongsTo(*PlanFaces(lines).region(Point2{1, 3}), lines);
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
        const PlanFaces faces(lines);
        const auto region = faces.region();
        if (!region) continue;
        const auto belongs = belongsTo(*region, lines);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            bool within = false;
            for (const double share : {0.01, 0.501, 0.99})
                within = within ||
                         region->rooms[0].locate(lines[i].a + share * (lines[i].b - lines[i].a)) ==
                             Side::Inside;
            bool bounds = false;
            region->rooms[0].forEachEdge([&](const Segment2& edge) {
                bounds = bounds || distance(edge.a + 0.5 * (edge.b - edge.a), lines[i]) < 2e-6;
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

}  // namespace
}  // namespace ispace
