// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/packed_mesh.h"

#include <cstring>
#include <limits>

#include "support/test_import.h"

namespace ispace {
namespace packed_mesh_test {

TriangleMesh wall() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

TEST(PackedMesh, SurviveTheSocket) {
    const std::string bytes = packedMesh(wall());
    const TriangleMesh mesh = unpackedMesh(bytes, "x.obj");
    EXPECT_EQ(mesh.vertices, wall().vertices);
    EXPECT_EQ(mesh.triangles, wall().triangles);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        EXPECT_THROW(unpackedMesh(bytes.substr(0, i), "x.obj"), FormatError) << i;
    EXPECT_THROW(unpackedMesh(bytes + '\0', "x.obj"), FormatError);
}

// A child that its input has taken over may answer anything: its answer is checked.
TEST(PackedMesh, AreNotTrusted) {
    TriangleMesh mesh = wall();
    mesh.triangles[0][1] = 3;
    EXPECT_THROW(unpackedMesh(packedMesh(mesh), "x.obj"), FormatError);
    mesh = wall();
    mesh.vertices[2][1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(unpackedMesh(packedMesh(mesh), "x.obj"), FormatError);
    // Counts that would take all memory.
    const std::string good = packedMesh(wall());
    for (std::size_t at = 0; at + 8 <= good.size(); ++at) {
        std::string bytes = good;
        std::memset(&bytes[at], 0xff, 8);
        const std::string errors = errorsOf([&] { unpackedMesh(bytes, "x.obj"); });
        EXPECT_NE(errors, "") << at;
    }
}

TEST(PackedMesh, LimitsGrowWithTheFile) {
    constexpr std::size_t kMega = 1U << 20U;
    EXPECT_EQ(meshLimits(0).memory, 1024 * kMega);
    EXPECT_GE(meshLimits(100 * kMega).memory, meshLimits(kMega).memory);
    EXPECT_GT(meshLimits(100 * kMega).seconds, meshLimits(0).seconds);
    EXPECT_LT(meshLimits(SIZE_MAX).seconds, 6 * 3600U);
}

}  // namespace packed_mesh_test
}  // namespace ispace
