// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/point_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace ispace {
namespace {

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

}  // namespace
}  // namespace ispace
