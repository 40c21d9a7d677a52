// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/formats/point_cloud.h"

#include <gtest/gtest.h>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "sense/depth.h"
#include "support/test_readings.h"

namespace ispace {

namespace point_cloud_test {

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

}  // namespace point_cloud_test

namespace point_cloud_test {

const float kNan = std::nanf("");

PointCloud threePoints() {
    PointCloud cloud;
    cloud.width = 3;
    cloud.xyz = {1, -2.5F, 0.1F, kNan, kNan, kNan, 0, -0.0F, 1e6F};
    return cloud;
}

PointCloud grid() {
    PointCloud cloud = threePoints();
    cloud.xyz.insert(cloud.xyz.end(), {4, 5, 6, 7, 8, 9, kNan, kNan, kNan});
    cloud.height = 2;
    return cloud;
}

template <typename T>
std::vector<T> valuesOf(std::string_view bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

TEST(Pcd, Ascii) {
    EXPECT_EQ(pcdOf(threePoints(), Encoding::Ascii),
              "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
              "TYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\n"
              "DATA ascii\n1 -2.5 0.1\nnan nan nan\n0 0 1000000\n");
}

TEST(Pcd, BinaryIsTheFloatsAfterTheHeader) {
    const PointCloud cloud = grid();
    const std::string bytes = pcdOf(cloud, Encoding::Binary);
    const std::string head = "WIDTH 3\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\nDATA binary\n";
    const std::size_t at = bytes.find(head);
    ASSERT_NE(at, std::string::npos);
    const std::string_view data = std::string_view(bytes).substr(at + head.size());
    ASSERT_EQ(data.size(), std::size_t{18} * sizeof(float));
    EXPECT_EQ(std::memcmp(data.data(), cloud.xyz.data(), data.size()), 0);
}

TEST(Pcd, ViewpointHasTheRealPartFirst) {
    PointCloud cloud = threePoints();
    cloud.viewpoint = {{1, 2, -0.5}, Angle::degrees(180), {}, {}};
    EXPECT_NE(pcdOf(cloud, Encoding::Ascii).find("\nVIEWPOINT 1 2 -0.5 0 0 0 1\n"),
              std::string::npos);
    cloud.viewpoint = {{}, {}, Angle::degrees(-180), {}};
    EXPECT_NE(pcdOf(cloud, Encoding::Ascii).find("\nVIEWPOINT 0 0 0 0 0 1 0\n"), std::string::npos);
}

TEST(Ply, AsciiLeavesOutMissingPoints) {
    EXPECT_EQ(plyOf(threePoints(), Encoding::Ascii),
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
              "property float z\nend_header\n1 -2.5 0.1\n0 0 1000000\n");
}

TEST(Ply, OrganisedCloudsKeepTheirRows) {
    const std::string head =
        "obj_info num_cols 3\nobj_info num_rows 2\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement range_grid 6\n"
        "property list uchar int vertex_indices\nend_header\n";
    EXPECT_EQ(plyOf(grid(), Encoding::Ascii),
              "ply\nformat ascii 1.0\n" + head +
                  "1 -2.5 0.1\n0 0 1000000\n4 5 6\n7 8 9\n1 0\n0\n1 1\n1 2\n1 3\n0\n");

    const std::string binary = plyOf(grid(), Encoding::Binary);
    const std::string begin = "ply\nformat binary_little_endian 1.0\n" + head;
    ASSERT_TRUE(binary.starts_with(begin)) << binary;
    const std::string_view data = std::string_view(binary).substr(begin.size());
    ASSERT_EQ(data.size(), 4 * 12 + 4 * 5 + 2 * 1U);
    const std::vector<float> points = valuesOf<float>(data.substr(0, 48));
    EXPECT_EQ(points, (std::vector<float>{1, -2.5F, 0.1F, 0, 0, 1e6F, 4, 5, 6, 7, 8, 9}));
    std::string_view cells = data.substr(48);
    std::vector<int> indices;
    while (!cells.empty()) {
        const bool present = cells.front() == 1;
        indices.push_back(present ? valuesOf<std::int32_t>(cells.substr(1, 4)).front() : -1);
        cells.remove_prefix(present ? 5 : 1);
    }
    EXPECT_EQ(indices, (std::vector<int>{0, -1, 1, 2, 3, -1}));
}

TEST(PointCloud, NoPoints) {
    const PointCloud cloud;
    EXPECT_NE(pcdOf(cloud, Encoding::Ascii).find("WIDTH 0\nHEIGHT 1\n"), std::string::npos);
    EXPECT_TRUE(pcdOf(cloud, Encoding::Binary).ends_with("POINTS 0\nDATA binary\n"));
    EXPECT_TRUE(plyOf(cloud, Encoding::Binary).ends_with("end_header\n"));
}

}  // namespace point_cloud_test

}  // namespace ispace
