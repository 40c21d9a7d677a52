// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/visible_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/test_scenes.h"

namespace ispace {
namespace visible_area_test {

struct Room {
    explicit Room(const std::string& lines, int columns = 60, int rows = 40)
        : scene(sceneOf(lines)), grid{scene.environment.limits(), columns, rows} {}

    [[nodiscard]] CellSet seen(const Sensor& sensor) const {
        sight.prepare(sensor);
        return sight.cellsOf(grid, sensor);
    }

    Scene scene;
    Grid grid;
    RayScenes worlds{scene.environment};
    VisibleArea sight{scene.environment, 0, &worlds};
};

Laser bareLaser(double range, double fov) {
    Laser laser;
    laser.max_range = range;
    laser.first = Angle::degrees(-fov / 2);
    laser.beams = static_cast<int>(fov) + 1;
    return laser;
}

Pose3 level(double x, double y, double heading) {
    return {{x, y, kScanHeight}, Angle::degrees(heading), {}, {}};
}

TEST(CellsSeen, EmptyRoomIsSeenByRangeAndFieldOfView) {
    Room room("ispace size=12,8");
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> x(-5.9, 5.9), y(-3.9, 3.9), turn(-360, 360);
    for (int trial = 0; trial < 20; ++trial) {
        const double range = trial % 3 == 0 ? 30 : 1 + trial % 5, fov = 20 + 17 * trial;
        const Sensor sensor{"l", bareLaser(range, fov), level(x(random), y(random), turn(random))};
        const CellSet cells = room.seen(sensor);
        for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
            const Vec2 offset = room.grid.center(cell) - sensor.pose.position.onFloor();
            const double off_axis =
                std::abs(wrapped(directionOf(offset.x, offset.y) - sensor.pose.heading).degrees());
            const double half =
                std::floor(fov) / 2;  // last beam: not always as far out as the first
            if (std::abs(off_axis - half) < 1 || std::abs(length(offset) - range) < 1e-6) continue;
            ASSERT_EQ(cells.test(cell), length(offset) < range && off_axis < half)
                << trial << ": cell " << cell;
        }
    }
}

TEST(CellsSeen, EndsOfRangeAndFieldOfViewAreIncluded) {
    Room room("ispace size=12,8", 12, 8);  // centres at .5
    const CellSet cells = room.seen({"l", bareLaser(3, 180), level(-0.5, 0.5, 0)});
    EXPECT_TRUE(cells.test(room.grid.cell(8, 4)));   // 3 m ahead
    EXPECT_FALSE(cells.test(room.grid.cell(9, 4)));  // 4 m ahead
    EXPECT_TRUE(cells.test(room.grid.cell(5, 7)));   // 3 m to the left, on the last beam
    EXPECT_TRUE(cells.test(room.grid.cell(5, 1)));   // 3 m to the right, on the first beam
    EXPECT_FALSE(cells.test(room.grid.cell(4, 4)));  // behind
    EXPECT_TRUE(cells.test(room.grid.cell(5, 4)));   // its own cell
}

TEST(CellsSeen, ThingsCastShadows) {
    Room room("ispace size=12,8\ncube at=0,0 size=1,8.5,1\n", 61);  // no centre on the cube's face
    const CellSet cells = room.seen({"l", bareLaser(30, 360), level(-3, 0, 0)});
    for (std::size_t cell = 0; cell < room.grid.size(); ++cell)
        ASSERT_EQ(cells.test(cell), room.grid.center(cell).x < -0.5) << cell;
}

TEST(CellsSeen, LevelLaserLooksOverLowThings) {
    Room room("ispace size=12,8\ncube at=0,0 size=1,8.5,1\n");
    Pose3 pose = level(-3, 0, 0);
    pose.position.z = 1.2;
    EXPECT_TRUE(room.seen({"l", bareLaser(30, 180), pose}).test(room.grid.cell(50, 20)));
    pose.position.z = 1;  // solids are closed
    EXPECT_FALSE(room.seen({"l", bareLaser(30, 180), pose}).test(room.grid.cell(50, 20)));
}

TEST(CellsSeen, FullTurnSeesAllHeadings) {
    Room room("ispace size=12,8");
    const CellSet all = room.seen({"l", bareLaser(30, 360), level(1, 1, 77)});
    EXPECT_EQ(all.count(), room.grid.size());
}

TEST(CellsSeen, TiltedDownReachesTheFloorAndNoFarther) {
    Room room("ispace size=12,8");
    Pose3 pose{{0, 0, 1}, Angle::degrees(0), Angle::degrees(-45), {}};
    const CellSet cells = room.seen({"l", bareLaser(30, 180), pose});
    for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
        const double x = room.grid.center(cell).x;  // meets the floor at x = 1
        if (std::abs(x - 1) < 1e-3 || std::abs(x) < 1e-3) continue;
        ASSERT_EQ(cells.test(cell), 0 < x && x < 1) << cell;
    }
}

TEST(CellsSeen, TiltedRangeIsMeasuredInSpace) {
    Room room("ispace size=12,8,20");
    const Pose3 pose{{0, 0, 0.1}, Angle::degrees(0), Angle::degrees(60), {}};
    const CellSet cells = room.seen({"l", bareLaser(2, 180), pose});
    for (std::size_t cell = 0; cell < room.grid.size(); ++cell) {
        const Point2 p = room.grid.center(cell);
        const double range = std::hypot(2 * p.x, p.y);  // 1 / cos 60
        if (std::abs(range - 2) < 1e-3 || std::abs(p.x) < 1e-3) continue;
        ASSERT_EQ(cells.test(cell), p.x > 0 && range < 2) << cell;
    }
}

TEST(CellsSeen, TiltedUpLooksOverThingsOnly) {
    Room room("ispace size=12,8\ncube at=3,0 size=1,8.5,1\n");
    const Pose3 pose{{0, 0, 0.5}, Angle::degrees(0), Angle::degrees(30), {}};
    // Over the cube's front, at x = 2.5, the plane is 1.94 m high; walls are 2.5 m high.
    const CellSet cells = room.seen({"l", bareLaser(30, 180), pose});
    EXPECT_TRUE(cells.test(room.grid.cell(55, 20)));
    const Pose3 flat{{0, 0, 0.5}, Angle::degrees(0), Angle::degrees(5), {}};
    EXPECT_FALSE(room.seen({"l", bareLaser(30, 180), flat}).test(room.grid.cell(55, 20)));
}

TEST(CellsSeen, UprightPlaneCoversNothing) {
    Room room("ispace size=12,8");
    const Pose3 pose{{0, 0, 1}, Angle::degrees(0), Angle::degrees(-90), {}};
    EXPECT_EQ(room.seen({"l", bareLaser(30, 180), pose}).count(), 0U);
}

TEST(CellsSeen, SlightTiltIsNearlyLevel) {
    Room room("ispace size=12,8\npillar at=1,1 size=0.62,0.62\n");
    const Sensor flat{"l", bareLaser(30, 180), level(-3, 0.01, 10)};
    Sensor tilted = flat;
    tilted.pose.tilt = Angle::degrees(1e-4);
    const CellSet a = room.seen(flat), b = room.seen(tilted);
    EXPECT_GT(a.count(), 1000U);
    EXPECT_LE(a.count() + b.count() - 2 * countCommon(a, b), 4U);
}

}  // namespace visible_area_test
}  // namespace ispace
