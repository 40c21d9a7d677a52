// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/unread.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "geom/predicates.h"

namespace ispace {
namespace unread_test {

/// A room of 10 m x 8 m with a pillar of 2 m x 2 m.
std::vector<PlanRegion> room() {
    Region region;
    region.outline = {{0, 0}, {10, 0}, {10, 8}, {0, 8}};
    region.holes = {{{4, 4}, {4, 6}, {6, 6}, {6, 4}}};
    return {{{region}, {1, 1}}};
}

UnreadThing thing(double x0, double y0, double x1, double y1) {
    UnreadThing thing{"3DSOLID"};
    thing.extent = {{x0, y0}, {x1, y1}};
    return thing;
}

TEST(RoomVicinity, SizeAndPlaceDecide) {
    const auto rooms = room();
    const RoomVicinity vicinity(rooms);
    EXPECT_TRUE(vicinity.mayHaveWall({"3DSOLID"}));  // of unknown size
    EXPECT_TRUE(vicinity.mayHaveWall(thing(1, 1, 1.1, 2)));
    EXPECT_FALSE(vicinity.mayHaveWall(thing(1, 1, 1.4, 1.4)));      // small
    EXPECT_TRUE(vicinity.mayHaveWall(thing(10.4, 1, 10.5, 4)));     // beside it
    EXPECT_FALSE(vicinity.mayHaveWall(thing(10.6, 1, 10.7, 4)));    // off it
    EXPECT_FALSE(vicinity.mayHaveWall(thing(4.6, 4.6, 5.4, 5.2)));  // in the pillar
    EXPECT_TRUE(RoomVicinity({}).mayHaveWall(thing(1, 1, 1, 2)));
}

// The same answers as those of each edge in turn.
TEST(RoomVicinity, FindsAllOfARoomOfManyEdges) {
    Region region;
    for (int i = 0; i < 500; ++i) {  // teeth
        region.outline.push_back({i * 0.1, i % 2 == 0 ? 0.0 : -2.0});
        if (i == 499) region.outline.insert(region.outline.end(), {{50, 9}, {0, 9}});
    }
    const std::vector<PlanRegion> rooms{{{region}, {25, 4}}};
    const RoomVicinity vicinity(rooms);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(-3, 53), y(-5, 12);
    for (int i = 0; i < 2000; ++i) {
        const double left = x(random), low = y(random);
        const UnreadThing box = thing(left, low, left + 0.6, low + 0.1);
        bool expected = region.locate(box.extent.center()) != Side::Outside;
        region.forEachEdge([&](const Segment2& edge) {
            expected = expected || bounds(edge).meets(box.extent.expanded(0.5));
        });
        EXPECT_EQ(vicinity.mayHaveWall(box), expected) << left << ',' << low;
    }
}

}  // namespace unread_test
}  // namespace ispace
