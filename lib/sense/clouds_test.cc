// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "sense/depth.h"
#include "sense/sample_readings.h"

namespace ispace {
namespace {

Point3 pointAt(const PointCloud& cloud, std::size_t index) {
    return {cloud.xyz[3 * index], cloud.xyz[3 * index + 1], cloud.xyz[3 * index + 2]};
}

bool isMissing(const PointCloud& cloud, std::size_t index) {
    const Point3 p = pointAt(cloud, index);
    return std::isnan(p.x) && std::isnan(p.y) && std::isnan(p.z);
}

void expectNear(Point3 a, Point3 b, double tolerance) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

/// A place of a sensor's frame in the world.
Point3 toWorld(const Pose3& pose, Point3 local) {
    const Vec3 forward = pose.beam({}), left = pose.beam(Angle::degrees(90));
    const Vec3 up = cross(forward, left);
    return pose.position + local.x * forward + local.y * left + local.z * up;
}

TEST(LaserCloud, RightAnglesAreExact) {
    const Sensor sensor = threeBeams();
    const Scan scan = scanOf({{1, 2, 0.5}, Angle::degrees(90), {}, {}}, {1.5F, kNone, 2});
    const PointCloud world = cloudOf(sensor.as<Laser>(), std::span(&scan, 1), Coordinates::World);
    EXPECT_EQ(world.width, 3U);
    EXPECT_EQ(world.height, 1U);
    EXPECT_EQ(world.viewpoint, Pose3());
    EXPECT_EQ(pointAt(world, 0), (Point3{2.5, 2, 0.5}));
    EXPECT_TRUE(isMissing(world, 1));
    EXPECT_EQ(pointAt(world, 2), (Point3{-1, 2, 0.5}));
    const PointCloud own = cloudOf(sensor.as<Laser>(), std::span(&scan, 1), Coordinates::Sensor);
    EXPECT_EQ(own.viewpoint, scan.pose);
    EXPECT_EQ(pointAt(own, 0), (Point3{0, -1.5, 0}));
    EXPECT_TRUE(isMissing(own, 1));
    EXPECT_EQ(pointAt(own, 2), (Point3{0, 2, 0}));
}

TEST(LaserCloud, AnyPose) {
    std::mt19937 random(1);
    Laser laser;
    laser.first = Angle::degrees(-119.5);
    laser.step = Angle::degrees(0.35);
    laser.beams = 683;
    for (int round = 0; round < 20; ++round) {
        const Scan scan = scanOf(randomPose(random), randomRanges(random, 683));
        const PointCloud world = cloudOf(laser, std::span(&scan, 1), Coordinates::World);
        for (std::size_t k = 0; k < 683; ++k) {
            ASSERT_EQ(isMissing(world, k), std::isinf(scan.ranges[k]));
            if (isMissing(world, k)) continue;
            const Vec3 beam = scan.pose.beam(laser.bearing(static_cast<int>(k)));
            expectNear(pointAt(world, k), scan.pose.position + double{scan.ranges[k]} * beam, 2e-6);
        }
    }
}

TEST(LaserCloud, ScansOfASweepComeIntoTheFrameOfTheFirst) {
    std::mt19937 random(2);
    const Sensor sensor = threeBeams();
    std::vector<Scan> scans;
    scans.reserve(5);
    for (int j = 0; j < 5; ++j)
        scans.push_back(scanOf(randomPose(random), randomRanges(random, 3)));
    // One that moves while it scans.
    for (int k = 0; k < 3; ++k) scans[3].beam_poses.push_back(randomPose(random));
    const PointCloud world = cloudOf(sensor.as<Laser>(), scans, Coordinates::World);
    const PointCloud own = cloudOf(sensor.as<Laser>(), scans, Coordinates::Sensor);
    EXPECT_EQ(own.width, 3U);
    EXPECT_EQ(own.height, 5U);
    EXPECT_EQ(own.viewpoint, scans.front().pose);
    for (std::size_t i = 0; i < own.size(); ++i) {
        const Scan& scan = scans[i / 3];
        ASSERT_EQ(isMissing(own, i), std::isinf(scan.ranges[i % 3]));
        ASSERT_EQ(isMissing(own, i), isMissing(world, i));
        if (isMissing(own, i)) continue;
        expectNear(toWorld(scans.front().pose, pointAt(own, i)), pointAt(world, i), 1e-5);
        const Pose3& pose = scan.poseAt(i % 3);
        const Vec3 beam = pose.beam(sensor.as<Laser>().bearing(static_cast<int>(i % 3)));
        expectNear(pointAt(world, i), pose.position + double{scan.ranges[i % 3]} * beam, 2e-6);
    }
}

TEST(LaserCloud, NoScans) {
    const PointCloud cloud = cloudOf(Laser(), std::span<const Scan>(), Coordinates::Sensor);
    EXPECT_EQ(cloud.size(), 0U);
    EXPECT_TRUE(cloud.xyz.empty());
}

TEST(RangerCloud, IsTheRaysTimesTheDepths) {
    std::mt19937 random(3);
    for (const Projection projection : {Projection::Pinhole, Projection::Spherical}) {
        for (const auto& [columns, rows] : {std::pair{31, 22}, std::pair{8, 1}, std::pair{1, 5}}) {
            Sensor sensor = smallRanger(projection, columns, rows);
            if (projection == Projection::Spherical) {
                sensor.as<Ranger>().fov_x = Angle::degrees(360);
                sensor.as<Ranger>().fov_y = Angle::degrees(170);
            }
            DepthFrame frame;
            frame.pose = randomPose(random);
            frame.depths = randomRanges(random, sensor.as<Ranger>().pixels());
            const PointCloud own = cloudOf(sensor.as<Ranger>(), frame, Coordinates::Sensor);
            const PointCloud world = cloudOf(sensor.as<Ranger>(), frame, Coordinates::World);
            EXPECT_EQ(own.width, static_cast<std::size_t>(columns));
            EXPECT_EQ(own.height, static_cast<std::size_t>(rows));
            EXPECT_EQ(own.viewpoint, frame.pose);
            EXPECT_EQ(world.viewpoint, Pose3());
            std::size_t i = 0;
            for (int row = 0; row < rows; ++row) {
                for (int column = 0; column < columns; ++column, ++i) {
                    ASSERT_EQ(isMissing(own, i), std::isinf(frame.depths[i]));
                    if (isMissing(own, i)) continue;
                    const Vec3 ray = double{frame.depths[i]} * sensor.as<Ranger>().ray(column, row);
                    expectNear(pointAt(own, i), Point3{} + ray, 2e-6);
                    expectNear(pointAt(world, i), toWorld(frame.pose, Point3{} + ray), 4e-6);
                }
            }
        }
    }
}

}  // namespace
}  // namespace ispace
