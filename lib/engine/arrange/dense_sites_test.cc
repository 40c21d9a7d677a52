// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "arrange/placement_rules.h"
#include "base/error.h"
#include "base/file.h"
#include "env/level.h"
#include "geom/predicates.h"
#include "support/test_arrange.h"

namespace ispace {
namespace dense_sites_test {

double nearestWall(const std::vector<Region>& floor, Point2 p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Region& region : floor)
        region.forEachEdge(
            [&](const Segment2& edge) { nearest = std::min(nearest, distance(p, edge)); });
    return nearest;
}

bool isInside(const std::vector<Region>& floor, Point2 p) {
    return std::any_of(floor.begin(), floor.end(),
                       [p](const Region& region) { return region.locate(p) == Side::Inside; });
}

TEST(LatticePlaces, BeginHalfAStepInside) {
    const auto places = latticePlaces({{1, 2}, {2, 2.5}}, 0.25);
    ASSERT_EQ(places.size(), 8U);
    EXPECT_EQ(places[0], (Point2{1.125, 2.125}));
    EXPECT_EQ(places[3], (Point2{1.875, 2.125}));
    EXPECT_EQ(places[4], (Point2{1.125, 2.375}));
    EXPECT_EQ(latticePlaces({{0, 0}, {1, 1}}, 1.5).size(), 1U);
    EXPECT_TRUE(latticePlaces({{0, 0}, {1, 1}}, 2).empty()) << "the first would be on the limit";
    EXPECT_TRUE(latticePlaces(Box2(), 1).empty());
    EXPECT_THROW(latticePlaces({{0, 0}, {1000, 1000.001}}, 0.9), UsageError);
    EXPECT_THROW(latticePlaces({{0, 0}, {1e6, 1e6}}, 1e-9), UsageError);
}

TEST(PlacesAlong, OfASquareRoom) {
    const Environment room = roomOf("ispace size=4,3\n");
    const auto places = placesAlong(room.level(kScanHeight)->freeFloor(), 0.5, 0.02);
    ASSERT_EQ(places.size(), 28U);
    for (const Point2 p : places)
        EXPECT_NEAR(nearestWall(room.level(kScanHeight)->freeFloor(), p), 0.02, 1e-12);
    const auto near = [&places](Point2 wanted) {
        return std::any_of(places.begin(), places.end(),
                           [wanted](Point2 p) { return distance(p, wanted) < 1e-9; });
    };
    EXPECT_TRUE(near({-1.75, -1.48}));
    EXPECT_TRUE(near({1.98, 0.25}));
}

TEST(PlacesAlong, AStepLongerThanTheRoomGivesOneForEachWall) {
    const Environment room = roomOf("ispace size=4,3\n");
    // The walls are shorter than a step: they share sites.
    EXPECT_EQ(placesAlong(room.level(kScanHeight)->freeFloor(), 4, 0.02).size(), 2U + 1U + 1U);
    EXPECT_EQ(placesAlong(room.level(kScanHeight)->freeFloor(), 100, 0.02).size(), 1U);
}

TEST(PlacesAlong, RoundThingsDoNotGetOneForEachChord) {
    const Environment room = roomOf("ispace size=8,8\ncylinder at=1,1 size=1\n");
    const auto floor = room.level(kScanHeight)->freeFloor();
    const auto places = placesAlong(floor, 0.25, 0.02);
    EXPECT_EQ(places.size(), 128U + 13U);  // pi / 0.25 = 12.6
    const auto last = std::vector<Point2>(places.end() - 13, places.end());
    for (std::size_t i = 0; i < last.size(); ++i) {
        EXPECT_NEAR(distance(last[i], Point2{1, 1}), 0.52, 1e-4);
        EXPECT_NEAR(distance(last[i], last[(i + 1) % last.size()]), 0.25, 0.01);
    }
}

TEST(PlacesAlong, LieOnTheFreeSideInRoomsWithHoles) {
    const Environment room = roomOf(
        "ispace size=8,8\nfence path=-2,-2;-1,-2;-1,-1 closed=yes\ncube at=2,2 heading=20 size=1\n"
        "desk at=-2,2\ninside at=0,0\n");
    const auto floor = room.level(kScanHeight)->freeFloor();
    const auto places = placesAlong(floor, 0.3, 0.02);
    EXPECT_GT(places.size(), 100U);
    for (const Point2 p : places) {
        EXPECT_TRUE(isInside(floor, p));
        EXPECT_NEAR(nearestWall(floor, p), 0.02, 1e-9);
    }
}

TEST(PlacesAlong, KnowOfSheets) {
    const Environment room = roomOf(
        "ispace size=8,6\nwall id=w from=0,-3 to=0,3\ndoor wall=w offset=2 size=1 open=yes\n");
    const auto floor = room.level(kScanHeight)->freeFloor();
    const auto sheets = room.slice(kScanHeight).sheets;
    EXPECT_EQ(placesAlong(floor, 0.5, 0.02).size(), 56U);
    const auto places = placesAlong(floor, 0.5, 0.02, sheets);
    EXPECT_EQ(places.size(), 56U + 2U * (3U + 7U));
    EXPECT_EQ(std::count_if(places.begin(), places.end(),
                            [](Point2 p) { return std::abs(p.x - 0.02) < 1e-9; }),
              10);
    // The middle of each half, not of the whole.
    const auto axis = medialPlaces(floor, 0.5, sheets);
    for (const Point2 p : axis) EXPECT_TRUE(std::abs(p.x) > 0.25 || std::abs(p.y + 1) < 0.5);
}

TEST(PlacesAlong, RefuseTooMany) {
    EXPECT_TRUE(placesAlong({}, 1, 0).empty());
    const Region room{{{0, 0}, {100, 0}, {100, 100}, {0, 100}}, {}};
    EXPECT_THROW(placesAlong({room}, 1e-4, 0.02), UsageError);
}

TEST(MedialPlaces, OfARectangleRunAlongItsMiddle) {
    const Environment room = roomOf("ispace size=8,2\n");
    const auto places = medialPlaces(room.level(kScanHeight)->freeFloor(), 0.5);
    EXPECT_GT(places.size(), 14U);
    EXPECT_LT(places.size(), 40U);
    int middle = 0;
    for (const Point2 p : places) {
        // On the middle line or on a diagonal from a corner.
        const double from_end = 4 - std::abs(p.x), from_side = 1 - std::abs(p.y);
        EXPECT_TRUE(std::abs(from_side - std::min(1.0, from_end)) < 0.1) << p.x << ' ' << p.y;
        middle += from_side > 0.95 ? 1 : 0;
    }
    EXPECT_GE(middle, 12);
}

TEST(MedialPlaces, RunAroundHoles) {
    const Environment room = roomOf("ispace size=6,6\ncube at=0,0 size=2,2,1\n");
    const auto floor = room.level(kScanHeight)->freeFloor();
    const auto places = medialPlaces(floor, 0.4);
    EXPECT_GT(places.size(), 30U);
    for (const Point2 p : places) EXPECT_TRUE(isInside(floor, p));
    // Half-way between the cube and the wall, on each side.
    for (const Point2 wanted : {Point2{2, 0}, Point2{-2, 0}, Point2{0, 2}, Point2{0, -2}})
        EXPECT_TRUE(std::any_of(places.begin(), places.end(),
                                [wanted](Point2 p) { return distance(p, wanted) < 0.4; }));
}

TEST(MedialPlaces, DoNotRunIntoWideCorners) {
    // From sites on the way to a corner of a hexagon its walls are seen 60 degrees apart.
    Region hexagon;
    for (int i = 0; i < 6; ++i)
        hexagon.outline.push_back(Point2{5, 5} + 3 * unitVector(Angle::degrees(60 * i)));
    const auto places = medialPlaces({hexagon}, 0.3);
    EXPECT_GE(places.size(), 1U);
    for (const Point2 p : places) EXPECT_LT(distance(p, Point2{5, 5}), 0.5);
}

TEST(MedialPlaces, MoveWithThePlan) {
    const Region room{{{0.1, 0.3}, {7.7, 0.3}, {7.7, 2.9}, {3.3, 2.9}, {3.3, 6.1}, {0.1, 6.1}},
                      {{{1.1, 1.3}, {1.1, 1.9}, {1.9, 1.9}, {1.9, 1.3}}}};
    const Vec2 way{137, -2048};
    Region moved = room;
    for (Point2& p : moved.outline) p = p + way;
    for (Point2& p : moved.holes[0]) p = p + way;
    const auto places = medialPlaces({room}, 0.3), others = medialPlaces({moved}, 0.3);
    ASSERT_EQ(places.size(), others.size());
    EXPECT_GT(places.size(), 30U);
    for (std::size_t i = 0; i < places.size(); ++i)
        EXPECT_LT(distance(places[i] + way, others[i]), 1e-9);
}

TEST(MedialPlaces, AreNoneOfNothingAndFewOfTinyRooms) {
    EXPECT_TRUE(medialPlaces({}, 0.5).empty());
    const Region tiny{{{0, 0}, {0.3, 0}, {0.3, 0.3}, {0, 0.3}}, {}};
    EXPECT_LE(medialPlaces({tiny}, 5).size(), 1U);
    EXPECT_GE(medialPlaces({tiny}, 0.1).size(), 4U);
    EXPECT_THROW(medialPlaces({tiny}, 1e-9), UsageError);
}

TEST(FramePlaces, HangUnderTheBars) {
    const Environment room =
        roomOf("ispace size=8,8\ninfra at=1,1 heading=90 size=4,2 height=2.3 rows=2 cols=3\n");
    const auto places = framePlaces(room, 0.5);
    ASSERT_EQ(places.size(), 2U * 8U + 3U * 4U);
    for (const Point3 p : places) {
        EXPECT_NEAR(p.z, 2.3 - kUnderBar, 1e-12);
        EXPECT_TRUE(room.slice(2.31).blocked(p.onFloor()));
        EXPECT_FALSE(room.slice(p.z).blocked(p.onFloor()));
    }
    // The first row runs along +y on the right of the heading.
    EXPECT_NEAR(places[0].x, 2 - 0.025, 1e-12);
    EXPECT_NEAR(places[0].y, -1 + 0.25, 1e-12);
    EXPECT_NEAR(places[7].y, 3 - 0.25, 1e-12);
    EXPECT_TRUE(framePlaces(roomOf("ispace\n"), 0.5).empty());
    EXPECT_EQ(framePlaces(room, 50).size(), 5U);
    const Environment hall = roomOf("ispace size=500,500\ninfra size=400,400 rows=2 cols=2\n");
    EXPECT_THROW(framePlaces(hall, 0.001), UsageError);
}

}  // namespace dense_sites_test
}  // namespace ispace
