// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "geom/pose.h"
#include "support/test_triangles.h"

namespace ispace {

using namespace testing;

namespace ray_world_test {

/// Lines where `pose` puts them.
Slice moved(std::vector<Segment2> sheets, const Pose2& pose) {
    for (Segment2& line : sheets) line = {pose * line.a, pose * line.b};
    return {.sheets = std::move(sheets), .solids = {}};
}

std::vector<Segment2> rectangleLines(Point2 low, Point2 high) {
    const Point2 b{high.x, low.y}, d{low.x, high.y};
    return {{low, b}, {b, high}, {high, d}, {d, low}};
}

/// The same direction again and again.
Directions alike(Vec3 direction, std::size_t count) {
    Directions directions;
    directions.resize(count);
    for (std::size_t i = 0; i < count; ++i) directions.set(i, direction);
    return directions;
}

/// Rays of a slice, and the same against its lines as walls in a mesh, whose rays are traced
/// `width` together; sight goes by the mesh.
class World {
  public:
    World(const std::vector<Segment2>& lines, int width, const Pose2& pose)
        : pose_(pose),
          slice_(RayWorld::ofSlice(moved(lines, pose))),
          mesh_(standing(moved(lines, Pose2{{}, pose.heading}).sheets), kRayEpsilon, width) {}

    /// One ray in the frame of the pose, asked alone and in a full packet of its like.
    [[nodiscard]] double range(Point2 from, Angle heading, double max_range = 100) const {
        const Point2 origin = pose_ * from, near = Pose2{{}, pose_.heading} * from;
        const Vec2 direction = unitVector(pose_.heading + heading);
        const Directions rays = alike({direction.x, direction.y, 0}, 17);
        std::vector<float> ranges(17), walls(17);
        slice_.cast({origin.x, origin.y, 0.15}, rays, max_range, ranges);
        for (const float other : ranges) EXPECT_EQ(other, ranges.front());
        mesh_.cast({near.x, near.y, 0}, rays, max_range, {walls, {}});
        for (const float other : walls) EXPECT_EQ(other, walls.front());
        if (std::isinf(ranges.front())) {
            EXPECT_EQ(walls.front(), ranges.front());
        } else {
            EXPECT_NEAR(walls.front(), ranges.front(), 1e-5);
        }
        float alone = 0;
        slice_.cast({origin.x, origin.y, 0.15}, alike(rays[0], 1), max_range, {&alone, 1});
        EXPECT_EQ(alone, ranges.front());
        return alone;
    }
    [[nodiscard]] bool sees(Point2 from, Point2 to) const {
        const Pose2 turn{{}, pose_.heading};
        const Point2 origin = turn * from, target = turn * to;
        std::uint8_t seen = 7;
        const Point3 at{target.x, target.y, 0};
        mesh_.query({origin.x, origin.y, 0}, {&at, 1}, {&seen, 1});
        EXPECT_LE(seen, 1);
        return seen == 1;
    }
    [[nodiscard]] const RayWorld& slice() const { return slice_; }

  private:
    Pose2 pose_;
    RayWorld slice_;
    EmbreeScene mesh_;
};

/// The same degenerate cases square to the axes, turned, and far from the origin.
class RayWorldCases : public ::testing::TestWithParam<std::pair<int, Pose2>> {
  protected:
    [[nodiscard]] World world(const std::vector<Segment2>& lines) const {
        return {lines, GetParam().first, pose()};
    }
    [[nodiscard]] Pose2 pose() const { return GetParam().second; }
    void expectRange(const World& world, Point2 from, double heading, double expected,
                     double max_range = 100) const {
        const double found = world.range(from, Angle::degrees(heading), max_range);
        if (std::isinf(expected)) {
            EXPECT_TRUE(std::isinf(found)) << heading << " degrees, found " << found;
        } else {
            EXPECT_NEAR(found, expected, 1e-5) << heading << " degrees";
        }
    }
};

std::vector<std::pair<int, Pose2>> cases() {
    std::vector<std::pair<int, Pose2>> all;
    for (const int width : kWidths) {
        all.push_back({width, {}});
        all.push_back({width, {{1e5, -2e5}, {}}});
        for (const double heading : {17.0, 45.0, 123.456})
            all.push_back({width, {{3.3, -1.7}, Angle::degrees(heading)}});
        all.push_back({width, {{-1e5, 1e5}, Angle::degrees(200.1)}});
    }
    return all;
}
INSTANTIATE_TEST_SUITE_P(MoverPoses, RayWorldCases, ::testing::ValuesIn(cases()));

TEST_P(RayWorldCases, Room) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    expectRange(room, {3, 2}, 0, 5);
    expectRange(room, {3, 2}, 90, 4);
    expectRange(room, {3, 2}, 180, 3);
    expectRange(room, {3, 2}, -90, 2);
    // Into the corners.
    expectRange(room, {4, 3}, Angle::radians(std::atan2(3, 4)).degrees(), 5);
    expectRange(room, {4, 3}, Angle::radians(std::atan2(-3, -4)).degrees(), 5);
    expectRange(room, {2, 2}, -135, 2 * std::sqrt(2.0));
}

TEST_P(RayWorldCases, CornersLetNoRayThrough) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> x(0.1, 7.9), y(0.1, 5.9), off(-1e-7, 1e-7);
    for (int i = 0; i < 400; ++i) {
        const Point2 from{x(random), y(random)};
        for (const Point2 corner : {Point2{0, 0}, {8, 0}, {8, 6}, {0, 6}}) {
            const Vec2 way = corner - from;
            const double exact = i % 2 == 0 ? 0 : off(random);
            const Angle heading = directionOf(way.x, way.y) + Angle::radians(exact);
            EXPECT_NEAR(room.range(from, heading), length(way), 1e-4);
        }
    }
}

/// A closed wall of many bends, no two alike.
std::vector<Segment2> raggedWall(int corners) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> rough(0, 0.02);
    std::vector<Segment2> lines;
    const auto corner = [&](int i) {
        const double turn = 2 * std::numbers::pi * i / corners;
        const double radius = 25 + 2 * std::sin(37 * turn) + rough(random);
        return Point2{radius * std::cos(turn), radius * std::sin(turn)};
    };
    const Point2 first = corner(0);
    for (int i = 1; i <= corners; ++i) {
        const Point2 from = lines.empty() ? first : lines.back().b;
        lines.push_back({from, i == corners ? first : corner(i)});
    }
    return lines;
}

TEST_P(RayWorldCases, BendsLetNoRayThrough) {
    const std::vector<Segment2> lines = raggedWall(2000);
    const World room = world(lines);
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> place(-15, 15);
    Directions directions;
    directions.resize(lines.size());
    std::vector<float> ranges(lines.size());
    for (int i = 0; i < 20; ++i) {
        const Point2 from = pose() * Point2{place(random), place(random)};
        for (std::size_t k = 0; k < lines.size(); ++k) {
            const Vec2 way = pose() * lines[k].a - from;
            directions.set(k, {way.x / length(way), way.y / length(way), 0});
        }
        room.slice().cast({from.x, from.y, 0.15}, directions, 200, ranges);
        for (const float range : ranges) EXPECT_LT(range, 15 * std::sqrt(2.0) + 28) << i;
    }
}

TEST_P(RayWorldCases, FromAWallItLooksOutOnBothSidesAndAlong) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    expectRange(room, {2, 0}, 0, 6);
    expectRange(room, {2, 0}, 180, 2);
    expectRange(room, {2, 0}, 90, 6);
    expectRange(room, {2, 0}, -90, kInfinity);
    for (const double small : {1e-4, 1e-3, 0.1}) {
        const double up = 6 * std::tan(small * std::numbers::pi / 180);
        expectRange(room, {2, 0}, small, std::hypot(6, up));
        expectRange(room, {2, 0}, -small, kInfinity);
    }
    // Within the contact distance of the wall, on either side.
    for (const double y : {9e-5, -9e-5}) {
        expectRange(room, {2, y}, 90, 6 - y);
        expectRange(room, {2, y}, -90, kInfinity);
        expectRange(room, {2, y}, y > 0 ? -0.01 : 0.01, y > 0 ? kInfinity : 6);
    }
    // Beyond it the wall stands in the way.
    expectRange(room, {2, 2e-4}, -90, 2e-4);
    expectRange(room, {2, -2e-4}, 90, 2e-4);
}

TEST_P(RayWorldCases, FromACorner) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    expectRange(room, {0, 0}, 0, 8);
    expectRange(room, {0, 0}, 90, 6);
    expectRange(room, {0, 0}, 45, 6 * std::sqrt(2.0));
    expectRange(room, {0, 0}, 225, kInfinity);
}

TEST_P(RayWorldCases, WallInPiecesIsNoneForASensorOnIt) {
    std::vector<Segment2> lines = rectangleLines({0, 0}, {8, 6});
    lines[0] = {{0, 0}, {3, 0}};
    lines.push_back({{3, 0}, {5, 0}});
    lines.push_back({{5, 0}, {8, 0}});
    const World room = world(lines);
    expectRange(room, {2, 0}, 0, 6);
    expectRange(room, {7, 0}, 180, 7);
    EXPECT_TRUE(room.sees({2, 0}, {7.5, 0}));
    EXPECT_TRUE(room.sees({2, 0}, {7.5, 3}));
}

TEST_P(RayWorldCases, SheetSeenFromItsEdgeStopsNothing) {
    std::vector<Segment2> lines = rectangleLines({0, 0}, {8, 6});
    lines.push_back({{3, 2}, {5, 2}});
    const World room = world(lines);
    expectRange(room, {1, 2}, 0, 7);
    expectRange(room, {1, 2}, 0.001, 7);
    expectRange(room, {3, 1}, 90, 1);  // its end, seen from the side
    expectRange(room, {1, 1}, Angle::radians(std::atan2(1, 3)).degrees(), std::sqrt(10.0));
    // A wall across its end does.
    lines.push_back({{3, 1}, {3, 3}});
    expectRange(world(lines), {1, 2}, 0, 2);
}

TEST_P(RayWorldCases, SolidIsClosed) {
    std::vector<Segment2> lines = rectangleLines({0, 0}, {8, 6});
    for (const Segment2& line : rectangleLines({3, 2}, {4, 3})) lines.push_back(line);
    const World room = world(lines);
    expectRange(room, {1, 2.5}, 0, 2);
    expectRange(room, {1, 2}, 0, 2);  // along a face
    expectRange(room, {1, 3}, 0, 2);
    expectRange(room, {1, 3.001}, 0, 7);
    expectRange(room, {2, 4}, -45, std::sqrt(2.0));  // touches the corner (3, 3)
    EXPECT_FALSE(room.sees({2, 4}, {4.5, 1.5}));
    EXPECT_TRUE(room.sees({2, 4.01}, {4, 3.01}));
}

TEST_P(RayWorldCases, MaximumRangeIsInclusive) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    expectRange(room, {3, 2}, 0, 5, 5);
    expectRange(room, {3, 2}, 0, kInfinity, 4.9999);
    expectRange(room, {3, 2}, 0, 5, kInfinity);
    expectRange(room, {3.905, 2}, 0, 4.095, 4.095);
    expectRange(room, {3, 2}, 180, kInfinity, 2.9);
}

TEST_P(RayWorldCases, ThinGap) {
    const World gap = world({{{2, -3}, {2, -0.0005}}, {{2, 0.0005}, {2, 3}}, {{6, -9}, {6, 9}}});
    expectRange(gap, {0, 0}, 0, 6);
    expectRange(gap, {0, 0}, 0.012, 6);
    expectRange(gap, {0, 0}, 0.017, 2);
    expectRange(gap, {0, 0}, -0.017, 2);
    EXPECT_TRUE(gap.sees({0, 0}, {6, 0}));
    EXPECT_FALSE(gap.sees({0, 0}, {6, 0.003}));
}

TEST_P(RayWorldCases, EndOfAGazeIsOpen) {
    const World room = world(rectangleLines({0, 0}, {8, 6}));
    EXPECT_TRUE(room.sees({3, 2}, {8, 2}));
    EXPECT_TRUE(room.sees({3, 2}, {8 + 9e-5, 2}));
    EXPECT_FALSE(room.sees({3, 2}, {8 + 2e-4, 2}));
    EXPECT_TRUE(room.sees({3, 2}, {8, 6}));
    EXPECT_TRUE(room.sees({3, 2}, {3, 2}));
    EXPECT_TRUE(room.sees({8, 2}, {9, 2}));
    EXPECT_TRUE(room.sees({8, 2}, {7, 2}));
}

TEST(RayWorld, EmptyWorldStopsNothing) {
    for (const int width : kWidths) {
        const World nothing({}, width, {});
        EXPECT_TRUE(std::isinf(nothing.range({1, 2}, {})));
        EXPECT_TRUE(nothing.sees({1, 2}, {1e3, 2}));
        // A line without length is none.
        const World point({{{1, 1}, {1, 1}}}, width, {});
        EXPECT_TRUE(std::isinf(point.range({0, 0}, Angle::degrees(45))));
        EXPECT_TRUE(point.sees({0, 0}, {2, 2}));
        nothing.slice().cast(Point3(), Directions(), 5, {});
    }
}

}  // namespace ray_world_test

}  // namespace ispace
