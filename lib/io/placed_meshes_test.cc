// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/placed_meshes.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace ispace {
namespace {

/// Six times the volume that the triangles enclose, positive if they are seen from outside.
double sixVolumes(const Mesh& mesh) {
    double sum = 0;
    for (const auto& [i, j, k] : mesh.triangles)
        sum += dot(mesh.vertices[i] - Point3(),
                   cross(mesh.vertices[j] - Point3(), mesh.vertices[k] - Point3()));
    return sum;
}

/// True if each edge has a triangle on both sides, in opposite directions.
bool isClosed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& [i, j, k] : mesh.triangles) {
        for (const auto& [a, b] : {std::pair{i, j}, {j, k}, {k, i}}) {
            ++edges[{a, b}];
            --edges[{b, a}];
        }
    }
    for (const auto& [edge, sum] : edges)
        if (sum != 0) return false;
    return true;
}

TEST(PlacedMeshes, AreClosedAndFaceOutwards) {
    RobotModel box;
    box.length = 0.6;
    box.width = 0.4;
    box.height = 0.3;
    const double nose = 0.05, base = 2 * nose * 0.25 * box.height;
    EXPECT_NEAR(sixVolumes(robotMesh(box)) / 6, 0.6 * 0.4 * 0.3 + base * 2 * nose / 3, 1e-12);
    EXPECT_TRUE(isClosed(robotMesh(box)));
    EXPECT_TRUE(isClosed(robotMesh(RobotModel())));
    EXPECT_GT(sixVolumes(robotMesh(RobotModel())), 0);
    EXPECT_TRUE(isClosed(sensorMesh()));
    EXPECT_GT(sixVolumes(sensorMesh()), 0);
}

}  // namespace
}  // namespace ispace
