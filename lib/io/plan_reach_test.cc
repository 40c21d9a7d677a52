// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan_reach.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geom/boolean.h"

namespace ispace {
namespace {

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
    const auto open = withoutPassages(walls, door);
    EXPECT_EQ(open.size(), walls.size() + 2);  // the wall is drawn twice
    const std::vector<Region> rooms{left, right};
    EXPECT_NEAR(totalArea(reachedFloor(rooms, open, {1, 1}, 0.3)), 21 - 8 * cornerLoss(0.3), 0.01);
    EXPECT_NEAR(totalArea(reachedFloor(rooms, walls, {1, 1}, 0.3)), 12 - 4 * cornerLoss(0.3), 0.01);
}

TEST(ReachedFloor, RoundAPillar) {
    Region hall = kHall;
    hall.holes = {{{3, 2}, {3, 3}, {5, 3}, {5, 2}}};
    const auto reached = reachedFloor({{hall}}, edgesOf(hall), {1, 1}, 0.2);
    ASSERT_EQ(reached.size(), 1U);
    EXPECT_EQ(reached[0].holes.size(), 1U);
    EXPECT_NEAR(totalArea(reached), 38 - 4 * cornerLoss(0.2), 3e-3);
}

}  // namespace
}  // namespace ispace
