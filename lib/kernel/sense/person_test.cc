// SPDX-License-Identifier: GPL-3.0-or-later
// One body of a person for all sensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "scene/bodies.h"
#include "sense/selection.h"
#include "support/test_readings.h"
#include "trace/render/render.h"

namespace ispace {
namespace person_test {

constexpr double kHeight = 1.7;

/// Range along a level ray to a disc; +infinity if it misses.
double toDisc(Point2 origin, Vec2 direction, Point2 center, double radius) {
    const Vec2 way = center - origin;
    const double along = dot(way, direction), aside = cross(way, direction);
    const double square = radius * radius - aside * aside;
    return square < 0 || along < 0 ? kNoReturn : along - std::sqrt(square);
}

/// Level ranges of a laser with a beam each half degree.
Scan levelScan(const Pose3& pose, const MovingBodies& bodies) {
    static const Scene room = testing::scene("ispace size=200,200\n");
    Sensor sensor{"l", Laser(), {}};
    sensor.pose = pose;
    sensor.as<Laser>().step = Angle::degrees(0.5);
    sensor.as<Laser>().beams = 361;
    sensor.as<Laser>().max_range = 30;
    RayScenes worlds(room.environment);
    worlds.prepare(pose);
    Scan scan;
    scan.pose = pose;
    LaserCaster(worlds, bodies, sensor, false, {}).cast(scan);
    return scan;
}

TEST(Person, LegsAreDiscsThatMoveWithTheHeight) {
    for (const double degrees : {-15.0, 0.0, 7.0, 15.0}) {
        const Angle swing = Angle::degrees(degrees);
        const Pose2 person{{0.3, -0.2}, Angle::degrees(30)};
        const MovingBodies bodies(humanBodies(kHeight, person, 0, swing));
        for (const double z : {0.0, 0.05, 0.15, 0.29, 0.30, 0.31, 0.45}) {
            const Pose3 pose{{-1, -0.4, z}, {}, {}, {}};
            const Scan scan = levelScan(pose, bodies);
            const double ahead = std::tan(swing.radians()) * (0.48 * kHeight - z);
            int met = 0;
            for (int k = 0; k < 361; ++k) {
                const Vec2 direction = unitVector(Angle::degrees(0.5 * k - 90));
                double range = kNoReturn;
                for (const double side : {-1.0, 1.0})
                    range = std::min(range,
                                     toDisc(pose.position.onFloor(), direction,
                                            person * Point2{side * ahead, side * 0.055 * kHeight},
                                            0.035 * kHeight));
                const auto found = static_cast<double>(scan.ranges[static_cast<std::size_t>(k)]);
                if (range == kNoReturn) {
                    EXPECT_EQ(found, kNoReturn) << degrees << " " << z << " " << k;
                    continue;
                }
                EXPECT_NEAR(found, range, 1e-6) << degrees << " " << z << " " << k;
                ++met;
            }
            EXPECT_GT(met, 10);
        }
    }
}

TEST(Person, TheHeadIsABall) {
    const double radius = 0.065 * kHeight, up = 1.68 - (kHeight - radius);
    const double range = 1.2 - std::sqrt(radius * radius - up * up);
    EXPECT_NEAR(range, 1.1366, 5e-5);
    const std::string room = "ispace size=8,6\n", person = "human at=0,0\n";
    const auto scans = testing::scans(
        testing::scene(room, person + "laser at=-1.2,0,1.68\nlaser at=-1.2,0,1.68 tilt=0.001\n"));
    EXPECT_NEAR(scans[0].ranges[90], range, 1e-6);
    EXPECT_NEAR(scans[1].ranges[90], range, 1e-4);
    const Scene seen = testing::scene(room, person + "camera at=-1.2,0,1.68 pixels=3,3 fov=1\n");
    const Sensor& camera = seen.sensors.front();
    const Rendering picture =
        render(RenderScene(seen), CameraView(camera.as<Camera>(), camera.pose),
               {.depths = true, .colors = false});
    EXPECT_NEAR(picture.depths[4], range, 1e-6);
}

/// A camera that looks at a walker, and all its lines of sight.
struct Appearance {
    Camera camera;
    Pose3 pose;
    RayGrid grid;

    Appearance(const Pose3& from, double fov) : pose(from) {
        camera.columns = 40;
        camera.rows = 31;
        camera.fx = camera.fy = camera.focalFor(camera.columns, Angle::degrees(fov));
        camera.center();
        const EvenPixelRays lines = *CameraView(camera, pose).evenPixelRays();
        grid = {lines.direction, lines.right, lines.down, camera.columns, camera.rows};
    }
};

/// What rays as those of tilted lasers and of level ones, one by one, and of rangers meet along a
/// camera's lines of sight: multiples of them.
std::array<std::vector<float>, 3> multiplesOf(const MovingBodies& bodies, const Appearance& look) {
    const std::size_t count = look.grid.size();
    std::array<std::vector<float>, 3> out;
    out.fill(std::vector<float>(count, kNoReturn));
    bodies.shorten(look.pose.position, look.grid, 100, MovingBodies::kNoOwner, out[0]);
    Directions directions;
    directions.resize(count);
    std::vector<double> lengths;
    for (std::size_t k = 0; k < count; ++k) {
        const auto columns = static_cast<std::size_t>(look.grid.columns);
        const Vec3 ray =
            look.grid.ray(static_cast<int>(k % columns), static_cast<int>(k / columns));
        lengths.push_back(length(ray));
        directions.set(k, 1 / lengths.back() * ray);
        if (std::fabs(ray.z) > 1e-12) continue;
        const Angle bearing = Angle::radians(std::atan2(ray.y, ray.x));
        const Directions level{{directions.x[k]},
                               {directions.y[k]},
                               {0.0},
                               Directions::Arc{bearing, Angle::degrees(1)}};
        bodies.shorten(look.pose.position, level, 100, MovingBodies::kNoOwner,
                       std::span(out[2]).subspan(k, 1));
        out[2][k] = static_cast<float>(static_cast<double>(out[2][k]) / lengths[k]);
    }
    bodies.shorten(look.pose.position, directions, 100, MovingBodies::kNoOwner, out[1]);
    for (std::size_t k = 0; k < count; ++k)
        out[1][k] = static_cast<float>(static_cast<double>(out[1][k]) / lengths[k]);
    return out;
}

TEST(Person, LasersRangersAndCamerasAgreeOnWalkers) {
    const Scene scene = testing::scene("ispace size=100,100\n", "human at=0,0\n");
    const RenderScene room(scene);
    const std::size_t label = scene.placed.front().record + 1;
    std::mt19937_64 random(32);
    std::uniform_real_distribution<double> unit(0, 1);
    std::size_t met = 0, level = 0;
    for (int round = 0; round < 1000; ++round) {
        const Pose2 person{{10 * unit(random) - 5, 10 * unit(random) - 5},
                           Angle::degrees(360 * unit(random))};
        const Angle swing = Angle::degrees(kMaxSwingDegrees * (2 * unit(random) - 1));
        const Angle bearing = Angle::degrees(360 * unit(random));
        const Point2 from = person.position - (1 + 2 * unit(random)) * unitVector(bearing);
        const double tilt = round % 2 == 0 ? 0 : 30 * unit(random) - 15;
        const Appearance look(
            {{from.x, from.y, 0.05 + 1.65 * unit(random)}, bearing, Angle::degrees(tilt), {}},
            30 + 40 * unit(random));
        const Pose3 pose{{person.position.x, person.position.y, 0}, person.heading, {}, {}};
        const Rendering picture =
            render(room.at({&pose, 1}, {&swing, 1}), CameraView(look.camera, look.pose),
                   {.labels = true, .depths = true, .colors = false});
        const auto found = multiplesOf(MovingBodies(humanBodies(kHeight, person, 0, swing)), look);
        for (std::size_t k = 0; k < look.grid.size(); ++k) {
            const float depth = picture.labels[k] == label ? picture.depths[k] : kNoReturn;
            const bool is_level = found[2][k] < kNoReturn;
            if (depth == kNoReturn) {
                EXPECT_EQ(found[0][k], kNoReturn) << round << " " << k;
                EXPECT_EQ(found[1][k], kNoReturn) << round << " " << k;
                EXPECT_FALSE(is_level) << round << " " << k;
                continue;
            }
            ++met;
            EXPECT_NEAR(found[0][k], depth, 1e-6) << round << " " << k;
            EXPECT_NEAR(found[1][k], depth, 1e-6) << round << " " << k;
            if (!is_level) continue;
            ++level;
            EXPECT_NEAR(found[2][k], depth, 1e-6) << round << " " << k;
        }
    }
    EXPECT_GT(met, 100000U);
    EXPECT_GT(level, 1000U);
}

}  // namespace person_test
}  // namespace ispace
