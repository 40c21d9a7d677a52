// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/worlds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "layout/test_layout.h"

namespace ispace {

namespace {

constexpr int kWidths[] = {1, 4, 8, 16};

Scene furnishedRoom() {
    return testing::scene(
        "ispace at=4,3 size=8,6,2.5\n"
        "inside at=7.5,5.5\n"
        "cube at=6,3 size=1,1,0.5\n"
        "desk at=2,4 heading=30\n"
        "table at=5,1\n"
        "cylinder at=3,2\n"
        "wall from=4,5 to=5,5.5 height=1\n");
}

Pose3 at(double x, double y, double z, double heading = 0, double tilt = 0) {
    return {{x, y, z}, Angle::degrees(heading), Angle::degrees(tilt), {}};
}

float ahead(const Worlds& worlds, const Pose3& pose) {
    const Vec3 direction = pose.beam({});
    float range = 0;
    worlds.at(pose).cast(pose.position, {&direction, 1}, 100, {&range, 1});
    return range;
}

TEST(Worlds, LevelSensorsMeetTheSliceOfTheirHeightOthersTheMesh) {
    const Scene scene = furnishedRoom();
    Worlds worlds(scene.environment);
    const Pose3 low = at(7.5, 3, 0.15, 180), high = at(7.5, 3, 0.8, 180);
    const Pose3 down = at(6, 3, 1.5, 0, -90), slightly = at(7.5, 3, 0.8, 180, -10);
    for (const Pose3& pose : {low, high, down, slightly, low}) worlds.prepare(pose);
    EXPECT_EQ(ahead(worlds, low), 1);
    EXPECT_EQ(ahead(worlds, high), 7.5F);
    EXPECT_NEAR(ahead(worlds, down), 1, 1e-6);
    EXPECT_NEAR(ahead(worlds, slightly), 0.3 / std::sin(0.17453292519943295), 1e-5);
    // Worlds are made once, and one for every height.
    EXPECT_EQ(&worlds.at(low), &worlds.at(at(1, 1, 0.15, 7)));
    EXPECT_NE(&worlds.at(low), &worlds.at(high));
    EXPECT_EQ(&worlds.at(down), &worlds.at(slightly));
    EXPECT_NE(&worlds.at(down), &worlds.at(low));
}

TEST(Mesh, SameAtEveryPacketWidthAndWhateverIsAskedTogether) {
    const Scene scene = furnishedRoom();
    std::vector<RayWorld> worlds;
    for (const int width : kWidths)
        worlds.push_back(RayWorld::ofEnvironment(scene.environment, width));
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> x(0.1, 7.9), y(0.1, 5.9), z(0.05, 2.4), any(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const Point3 origin{x(random), y(random), z(random)};
        std::vector<Vec3> directions;
        for (int k = 0; k < 333; ++k) {
            Vec3 way{any(random), any(random), any(random)};
            // Every other one straight at an edge or a corner of the room or of the cube.
            const double low = k % 8 < 4 ? 0 : 1, high = k % 16 < 8 ? 0 : 1;
            if (k % 4 == 0) way = Point3{8, 6 * low, std::max(0.0, any(random))} - origin;
            if (k % 4 == 2) way = Point3{5.5, 2.5 + low, 0.5 * high} - origin;
            directions.push_back((1 / length(way)) * way);
        }
        std::vector<float> first(directions.size()), again(directions.size()), single(1);
        worlds.front().cast(origin, directions, 20, first);
        for (const RayWorld& world : worlds) {
            world.cast(origin, directions, 20, again);
            EXPECT_EQ(again, first);
            world.cast(origin, {&directions[7], 1}, 20, single);
            EXPECT_EQ(single[0], first[7]);
        }
    }
}

TEST(Mesh, GazesAreTheSameAtEveryPacketWidth) {
    const Scene scene = furnishedRoom();
    const Slice slice = scene.environment.slice(0.15);
    std::vector<Point3> centers;
    for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 80; ++column)
            centers.push_back({0.05 + 0.1 * column, 0.05 + 0.1 * row, 0.15});
    // Places on the same raster: gazes through corners, along faces and walls are the rule.
    std::vector<Point3> places;
    for (int i = 0; i <= 16; ++i)
        for (int k = 0; k <= 12; ++k) places.push_back({0.5 * i, 0.5 * k, 0.15});
    std::vector<std::uint8_t> first(centers.size()), again(centers.size());
    const RayWorld flat = RayWorld::ofSlice(slice, 1),
                   solid = RayWorld::ofEnvironment(scene.environment, 1);
    for (const int width : kWidths) {
        const RayWorld level = RayWorld::ofSlice(slice, width);
        const RayWorld mesh = RayWorld::ofEnvironment(scene.environment, width);
        for (const Point3& place : places) {
            flat.look(place, centers, first);
            level.look(place, centers, again);
            EXPECT_EQ(first, again) << width << ' ' << place.x << ' ' << place.y;
            solid.look(place, centers, first);
            mesh.look(place, centers, again);
            EXPECT_EQ(first, again) << width << ' ' << place.x << ' ' << place.y;
        }
    }
}

TEST(Mesh, FloorIsMetOnlyIndoorsAndCoveringsAreNotFelt) {
    const Scene scene =
        testing::scene("ispace at=0,0 size=4,4\nfloor at=0,0 size=2,2 kind=checker\n");
    Worlds worlds(scene.environment);
    const Pose3 inside = at(0.3, 0.3, 1, 0, -90), outside = at(3, 0, 1, 0, -90);
    worlds.prepare(inside);
    EXPECT_EQ(ahead(worlds, inside), 1);
    EXPECT_TRUE(std::isinf(ahead(worlds, outside)));
}

}  // namespace

}  // namespace ispace
