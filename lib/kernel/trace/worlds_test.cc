// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/ray_world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "base/number.h"
#include "support/test_layout.h"

namespace ispace {

namespace worlds_test {

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

Directions along(Vec3 direction) { return {{direction.x}, {direction.y}, {direction.z}}; }

float ahead(const RayScenes& worlds, const Pose3& pose) {
    float range = 0;
    worlds.at(pose).cast(pose.position, along(pose.beam({})), 100, {&range, 1});
    return range;
}

TEST(RayScenes, LevelSensorsMeetTheSliceOfTheirHeightOthersTheMesh) {
    const Scene scene = furnishedRoom();
    RayScenes worlds(scene.environment);
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

TEST(RayScenes, SoundIsStoppedByClearGlassToo) {
    const Scene plain = furnishedRoom();
    RayScenes of_plain(plain.environment);
    of_plain.prepareMesh(Surfaces::Solid);
    EXPECT_EQ(&of_plain.mesh(Surfaces::Solid), &of_plain.mesh())
        << "one world is enough without clear glass";
    const Scene scene = testing::scene(
        "ispace size=8,6,2.5\ninside at=-3,0\nwall id=w from=1,-2.9 to=1,2.9 height=2.5\n"
        "window wall=w offset=2.9 size=3,0.1,2 sill=0.1\n");
    RayScenes worlds(scene.environment);
    worlds.prepareMesh();
    worlds.prepareMesh(Surfaces::Solid);
    const Point3 from{-2, 0, 1};
    float light = 0, sound = 0;
    worlds.mesh().cast(from, along({1, 0, 0}), 100, {&light, 1});
    worlds.mesh(Surfaces::Solid).cast(from, along({1, 0, 0}), 100, {&sound, 1});
    EXPECT_EQ(light, 6);
    EXPECT_EQ(sound, 3);
}

TEST(RayScenes, LightAndSoundMeetTheRoomsAround) {
    const Scene scene = furnishedRoom();
    const auto around = std::make_shared<const SurroundedRoom>(
        testing::scene("ispace at=4,3 size=8,6,2.5\ncube at=6,3 size=1,1,1\n").environment);
    RayScenes worlds(scene.environment, around), others(scene.environment, around);
    const Pose3 level = at(7.5, 3, 0.8, 180), down = at(6, 3, 1.5, 0, -90);
    worlds.prepare(level);
    EXPECT_FALSE(worlds.meshes().opaque);
    worlds.prepare(down);
    worlds.prepareMesh(Surfaces::Solid);
    EXPECT_TRUE(worlds.meshes().opaque);
    EXPECT_EQ(ahead(worlds, level), 1);
    EXPECT_NEAR(ahead(worlds, down), 0.5, 1e-6);
    float sound = 0;
    worlds.mesh(Surfaces::Solid).cast(down.position, along({0, 0, -1}), 100, {&sound, 1});
    EXPECT_NEAR(sound, 0.5, 1e-6);
    others.prepareMesh();
    EXPECT_EQ(&others.mesh(), &worlds.mesh()) << "it is built once";
}

TEST(RayScenes, HeightsBeyondThoseKeptAreTracedInTheMesh) {
    const Scene scene = furnishedRoom();
    RayScenes worlds(scene.environment);
    const auto pose = [](std::size_t i) {
        return at(7.5, 3, 0.1 + 0.01 * static_cast<double>(i), 180);
    };
    const std::size_t count = RayScenes::kMaxSlices + 20;
    for (std::size_t i = 0; i < count; ++i) worlds.prepare(pose(i));
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(&worlds.at(pose(i)) == &worlds.mesh(), i >= RayScenes::kMaxSlices) << i;
        // The cube is met up to its top.
        EXPECT_NEAR(ahead(worlds, pose(i)), i <= 40 ? 1 : 7.5, 1e-6) << i;
    }
    // Those prepared first stay.
    for (std::size_t i = 0; i < count; ++i) worlds.prepare(pose(i));
    EXPECT_NE(&worlds.at(pose(0)), &worlds.mesh());
    EXPECT_EQ(&worlds.at(pose(count - 1)), &worlds.mesh());
}

TEST(RayScenes, LevelPosesAtHeightsThatNobodyPreparedAreTracedInTheMesh) {
    const Scene scene = furnishedRoom();
    RayScenes worlds(scene.environment);
    const Pose3 low = at(7.5, 3, 0.15, 180), between = at(7.5, 3, 0.3, 180);
    const Pose3 high = at(7.5, 3, 0.8, 180);
    worlds.prepare(low);
    worlds.prepareMesh();
    EXPECT_NE(&worlds.at(low), &worlds.mesh());
    EXPECT_EQ(&worlds.at(between), &worlds.mesh());
    EXPECT_EQ(&worlds.at(high), &worlds.mesh());
    EXPECT_EQ(ahead(worlds, low), 1);
    EXPECT_NEAR(ahead(worlds, between), 1, 1e-6);
    EXPECT_NEAR(ahead(worlds, high), 7.5, 1e-6);
    // Once it is prepared it is the slice.
    worlds.prepare(between);
    EXPECT_NE(&worlds.at(between), &worlds.mesh());
    EXPECT_EQ(ahead(worlds, between), 1);
}

TEST(RayScenes, LevelRaysMeetInTheMeshWhatTheyMeetInTheSlice) {
    const Scene scene = furnishedRoom();
    std::mt19937_64 random(24);
    std::uniform_real_distribution<double> x(0.1, 7.9), y(0.1, 5.9), turn(0, 360);
    const RayWorld mesh = RayWorld::ofEnvironment(scene.environment);
    int beside = 0;
    for (const double height : {0.15, 0.31, 0.9}) {
        const RayWorld slice = RayWorld::ofSlice(scene.environment.slice(height));
        for (int i = 0; i < 20; ++i) {
            // Every fifth hangs on a wall.
            const Point3 origin{i % 5 == 0 ? 0 : x(random), y(random), height};
            Directions directions;
            directions.resize(300);
            for (std::size_t k = 0; k < 300; ++k) {
                const Vec2 d = unitVector(Angle::degrees(turn(random)));
                directions.set(k, {d.x, d.y, 0});
            }
            std::vector<float> flat(300), solid(300), flat_cosines(300), cosines(300);
            slice.cast(origin, directions, 30, flat, flat_cosines);
            mesh.cast(origin, directions, 30, solid, cosines);
            for (std::size_t k = 0; k < 300; ++k)
                if (flat[k] != solid[k] && !(std::fabs(flat[k] - solid[k]) < 1e-5F &&
                                             std::fabs(flat_cosines[k] - cosines[k]) < 1e-5F))
                    ++beside;
        }
    }
    EXPECT_LE(beside, 3);  // of 18 000
}

TEST(RayScenes, OthersReadWhileOneThreadPrepares) {
    const Scene scene = furnishedRoom();
    RayScenes worlds(scene.environment);
    const auto pose = [](int i) { return at(7.5, 3, 0.1 + 0.005 * i, 180); };
    std::atomic<int> ready = 0;
    std::vector<std::thread> readers;
    readers.reserve(3);
    std::atomic<int> wrong = 0;
    for (int reader = 0; reader < 3; ++reader)
        readers.emplace_back([&] {
            for (int i = 0; i < 40;) {
                if (i >= ready) {
                    std::this_thread::yield();
                    continue;
                }
                if (ahead(worlds, pose(i)) != 1) ++wrong;
                ++i;
            }
        });
    for (int i = 0; i < 40; ++i) {
        worlds.prepare(pose(i));
        ready = i + 1;
    }
    for (std::thread& reader : readers) reader.join();
    EXPECT_EQ(wrong, 0);
}

TEST(Mesh, PacketWidthChangesNothing) {
    const Scene scene = furnishedRoom();
    std::vector<RayWorld> worlds;
    for (const int width : {16, 8, 4, 1})
        worlds.push_back(RayWorld::ofEnvironment(scene.environment, Surfaces::Opaque, width));
    std::mt19937_64 random(21);
    std::uniform_real_distribution<double> x(0.1, 7.9), y(0.1, 5.9), z(0.05, 2.4), any(-1, 1);
    for (int i = 0; i < 100; ++i) {
        const Point3 origin{x(random), y(random), z(random)};
        Directions directions;
        directions.resize(333);
        for (std::size_t k = 0; k < 333; ++k) {
            const Vec3 way{any(random), any(random), any(random)};
            directions.set(k, (1 / length(way)) * way);
        }
        std::vector<float> first(333), again(333), cosines(333), cosines_again(333);
        worlds.front().cast(origin, directions, 20, first, cosines);
        for (const RayWorld& world : worlds) {
            world.cast(origin, directions, 20, again, cosines_again);
            EXPECT_EQ(first, again);
            EXPECT_EQ(cosines, cosines_again);
        }
    }
}

TEST(Mesh, PicturesAndMovingOriginsFarFromTheOriginOfThePlan) {
    const Scene scene = testing::scene("ispace at=5000,-7000 size=8,6,2.5 ceiling=yes\n");
    const RayWorld world = RayWorld::ofEnvironment(scene.environment);
    const Point3 origin{5001, -7000, 1};
    // Ahead of it lies a wall at 3 m, seen at right angles.
    const RayGrid grid{{1, 0.3, 0.2}, {0, -0.1, 0}, {0, 0, -0.1}, 7, 5};
    std::vector<float> multiples(grid.size()), cosines(grid.size());
    world.cast(origin, grid, 10, multiples, cosines);
    for (std::size_t k = 0; k < grid.size(); ++k) {
        EXPECT_EQ(multiples[k], 3);
        const Vec3 ray = grid.ray(static_cast<int>(k % 7), static_cast<int>(k / 7));
        EXPECT_NEAR(cosines[k], 1 / length(ray), 1e-7);
    }
    Directions directions;
    directions.resize(40);
    std::vector<Point3> origins;
    for (std::size_t k = 0; k < 40; ++k) {
        directions.set(k, {0.8, 0, 0.6});
        origins.push_back({5001 + 0.01 * static_cast<double>(k), -7000, 0.2});
    }
    std::vector<float> ranges(40);
    world.cast(origins, directions, 10, ranges);
    for (std::size_t k = 0; k < 40; ++k)
        EXPECT_NEAR(ranges[k], std::min(2.3 / 0.6, (3 - 0.01 * static_cast<double>(k)) / 0.8),
                    1e-6);
}

TEST(Mesh, EdgesAndCornersLetNoRayThrough) {
    std::mt19937_64 random(22);
    std::uniform_real_distribution<double> turn(0, 360), share(0, 1), part(-0.45, 0.45);
    for (int i = 0; i < 20; ++i) {
        const Pose2 room{{turn(random), -turn(random)}, Angle::degrees(i == 0 ? 0 : turn(random))};
        const Scene scene =
            testing::scene("ispace size=8,6,2.5 at=" + formatDouble(room.position.x) + ',' +
                           formatDouble(room.position.y) +
                           " heading=" + formatDouble(room.heading.degrees()) + "\n");
        const RayWorld world = RayWorld::ofEnvironment(scene.environment);
        const auto place = [&](double x, double y, double z) {
            const Point2 p = room * Point2{x, y};
            return Point3{p.x, p.y, z};
        };
        for (int k = 0; k < 200; ++k) {
            // Every other sensor hangs on a wall.
            const double side = k % 2 == 0 ? -4 : 8 * part(random);
            const Point3 origin = place(side, 6 * part(random), 0.1 + 2 * share(random));
            const Point3 targets[] = {place(8 * part(random), 3, 0), place(4, 6 * part(random), 0),
                                      place(8 * part(random), -3, 0), place(4, 3, 0),
                                      place(4, -3, 0), place(4, 3, 2 * share(random)),
                                      place(4, -3, 2 * share(random)),
                                      // In the plane of the wall on which it hangs.
                                      place(-4, 3, 2 * share(random)), place(-4, -3, 0.1)};
            for (const Point3& target : targets) {
                const Vec3 way = target - origin;
                float range = 0;
                world.cast(origin, along((1 / length(way)) * way), 100, {&range, 1});
                EXPECT_NEAR(range, length(way), 1e-4) << i << ' ' << k;
            }
        }
    }
}

TEST(Mesh, TiltedRaysPassASheetSeenFromItsEdge) {
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> turn(0, 360), tilts(-30, 30);
    for (int i = 0; i < 200; ++i) {
        // A wall from 2 to 4 m along the heading, in a room whose walls are farther away.
        const Angle heading = Angle::degrees(turn(random)), tilt = Angle::degrees(tilts(random));
        const Vec2 along = unitVector(heading);
        std::string wall = "wall height=2.5";
        for (const double at : {2.0, 4.0})
            wall += (at == 2.0 ? " from=" : " to=") + formatDouble(0.37 + at * along.x) + ',' +
                    formatDouble(-0.21 + at * along.y);
        const Scene scene =
            testing::scene("ispace size=16,16,9 ceiling=yes\ninside at=0.37,-0.21\n" + wall + "\n");
        RayScenes worlds(scene.environment);
        const Pose3 pose{{0.37, -0.21, 1.2}, heading, tilt, {}};
        worlds.prepare(pose);
        const float range = ahead(worlds, pose);
        const double floor = tilt.degrees() < 0 ? 1.2 / -sin(tilt) : 1e9;
        const double beyond = std::min(floor - 1e-4, 4 / cos(tilt));
        EXPECT_GT(range, beyond) << heading.degrees() << ' ' << tilt.degrees();
    }
}

TEST(Mesh, FloorIsMetOnlyIndoorsAndCoveringsAreNotFelt) {
    const Scene scene =
        testing::scene("ispace at=0,0 size=4,4\nfloor at=0,0 size=2,2 kind=checker\n");
    RayScenes worlds(scene.environment);
    const Pose3 inside = at(0.3, 0.3, 1, 0, -90), outside = at(3, 0, 1, 0, -90);
    worlds.prepare(inside);
    EXPECT_EQ(ahead(worlds, inside), 1);
    EXPECT_TRUE(std::isinf(ahead(worlds, outside)));
}

}  // namespace worlds_test

}  // namespace ispace
