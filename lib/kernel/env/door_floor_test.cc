// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/door_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "env/element_schemas.h"
#include "geom/predicates.h"
#include "record/text.h"

namespace ispace {
namespace door_floor_test {

Environment room(const std::string& records) {
    static const Schemas schemas(environmentSchemas());
    const Document document =
        readRecordText("#env 1\nispace size=20,20\n" + records, "room.env", schemas);
    return {document.records, assignIds(document.records)};
}

/// A door of a metre in a thin wall, from (0, 0) to (0, 1).
constexpr const char* kDoor = "wall id=w from=0,-5 to=0,5\ndoor id=d wall=w from=0,0 to=0,1\n";

Polygon floorOf(const std::string& records, double distance) {
    const Environment made = room(records);
    return DoorFloor(made).around(doorwaysOf(made).front(), distance);
}

bool isIn(const Polygon& outline, Point2 p) { return locate(outline, p) == Side::Inside; }

TEST(DoorFloor, WithoutWallsAboutIsAllWithinTheDistance) {
    const Environment made = room(kDoor);
    EXPECT_EQ(DoorFloor(made).around(doorwaysOf(made).front(), 1.5),
              floorAround(doorwaysOf(made).front(), 1.5));
}

TEST(DoorFloor, EndsAtAWallBesideTheDoor) {
    const std::string hall = std::string(kDoor) + "wall id=h from=0,1.2 to=8,1.2\n";
    const Polygon floor = floorOf(hall, 1.5);
    EXPECT_TRUE(isIn(floor, {1, 1.1}));
    EXPECT_FALSE(isIn(floor, {0.5, 1.4})) << "behind the wall";
    EXPECT_TRUE(isIn(floor, {-0.5, 1.4})) << "on the other side of the door";
    // Half of a stadium, and above the wall's line the half round of this side is missing.
    const double whole = signedArea(floorOf(kDoor, 1.5));
    const double height = 0.2, radius = 1.5;
    const double beyond = (radius * radius * std::acos(height / radius) -
                           height * std::sqrt(radius * radius - height * height)) /
                          2;
    EXPECT_NEAR(signedArea(floor), whole - beyond, 0.01);
}

TEST(DoorFloor, EndsAtAWallThatMeetsTheDoor) {
    for (const char* const y : {"1", "0"}) {
        const std::string wall = std::string("wall id=h from=0,") + y + " to=8," + y + "\n";
        const Polygon floor = floorOf(kDoor + wall, 1.5);
        EXPECT_TRUE(isIn(floor, {1, 0.5})) << y;
        EXPECT_EQ(isIn(floor, {0.5, 1.3}), *y == '0') << y;
        EXPECT_EQ(isIn(floor, {0.5, -0.3}), *y == '1') << y;
    }
}

TEST(DoorFloor, GoesThroughDoorsButNotThroughWindows) {
    const std::string wall = std::string(kDoor) + "wall id=h from=1,-5 to=1,5\n";
    EXPECT_FALSE(isIn(floorOf(wall, 2), {1.5, 0.5}));
    EXPECT_TRUE(isIn(floorOf(wall + "door id=e wall=h from=1,0 to=1,1\n", 2), {1.5, 0.5}));
    EXPECT_FALSE(isIn(floorOf(wall + "window id=e wall=h from=1,0 to=1,1\n", 2), {1.5, 0.5}));
    const std::string lintel = std::string(kDoor) + "wall id=h at=1,0,2 heading=90 size=10\n";
    EXPECT_TRUE(isIn(floorOf(lintel, 2), {1.5, 0.5})) << "above the heads";
}

TEST(DoorFloor, ReachesThroughWallsThatHaveTwoFaces) {
    // As walls of IFC: a hall from x = 0.3 on, 1.5 m wide, behind an outer wall of 0.3 m.
    const std::string house =
        "fence id=w path=0,-5;0,5\nfence id=i path=0.3,-0.25;0.3,1.25;8,1.25\n"
        "fence id=j path=0.3,-0.25;8,-0.25\ndoor id=d wall=w from=0,0 to=0,1 size=1,0.602\n";
    const Polygon floor = floorOf(house, 1.5);
    for (const Point2 p : {Point2{0.4, 1.2}, {0.4, -0.2}, {1.7, 0.5}, {0.15, 0.5}, {-1, 0.5}})
        EXPECT_TRUE(isIn(floor, p)) << p.x << ' ' << p.y;
    for (const Point2 p : {Point2{0.6, 1.3}, {0.6, -0.3}, {1.9, 0.5}})
        EXPECT_FALSE(isIn(floor, p)) << p.x << ' ' << p.y;
}

/// Returns true if no wall stands between a point and the nearest one of the opening.
bool isBefore(const std::vector<Segment2>& walls, Point2 p) {
    const Point2 nearest{0, std::clamp(p.y, 1e-6, 1 - 1e-6)};
    return std::none_of(walls.begin(), walls.end(), [&](const Segment2& wall) {
        return intersects(Segment2{nearest, p}, wall);
    });
}

TEST(DoorFloor, HasThePointsThatNoWallHides) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-2.5, 2.5);
    int inside = 0, hidden = 0;
    for (int i = 0; i < 40; ++i) {
        std::string records = kDoor;
        std::vector<Segment2> walls;
        for (int k = 0; k < 3; ++k) {
            const auto rounded = [&] { return std::round(100 * place(random)) / 100; };
            const Segment2 wall{{rounded(), rounded()}, {rounded(), rounded()}};
            if (wall.a.x * wall.b.x <= 0) continue;  // on both sides of the door
            walls.push_back(wall);
            records += "wall from=" + std::to_string(wall.a.x) + ',' + std::to_string(wall.a.y) +
                       " to=" + std::to_string(wall.b.x) + ',' + std::to_string(wall.b.y) + '\n';
        }
        const Polygon floor = floorOf(records, 1.5);
        EXPECT_GT(signedArea(floor), 0);
        for (int k = 0; k < 400; ++k) {
            const Point2 p{place(random), place(random)};
            const double away = std::hypot(p.x, p.y - std::clamp(p.y, 0.0, 1.0));
            if (std::abs(away - 1.5) < 0.01) continue;
            const bool is_near = away < 1.5, is_shown = isBefore(walls, p);
            EXPECT_EQ(isIn(floor, p), is_near && is_shown) << records << p.x << ' ' << p.y;
            inside += is_near;
            hidden += is_near && !is_shown;
        }
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(hidden, 100);
}

}  // namespace door_floor_test
}  // namespace ispace
