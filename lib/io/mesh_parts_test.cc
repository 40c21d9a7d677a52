// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/mesh_parts.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "io/test_import.h"

namespace ispace {
namespace {

MeshPart wall() {
    MeshPart part;
    part.nodes = {{"IfcWall_a_1", 0.5}, {"", -3}};
    part.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.mesh.triangles = {{0, 1, 2}};
    return part;
}

TEST(MeshParts, SurviveTheSocket) {
    const std::string bytes = packedParts({wall(), MeshPart()});
    const std::vector<MeshPart> parts = unpackedParts(bytes, "x.ifc");
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].nodes[0].name, "IfcWall_a_1");
    EXPECT_EQ(parts[0].nodes[1].height, -3);
    EXPECT_EQ(parts[0].mesh.vertices, wall().mesh.vertices);
    EXPECT_EQ(parts[0].mesh.triangles, wall().mesh.triangles);
    for (std::size_t i = 0; i < bytes.size(); ++i)
        EXPECT_THROW(unpackedParts(bytes.substr(0, i), "x.ifc"), FormatError) << i;
    EXPECT_THROW(unpackedParts(bytes + '\0', "x.ifc"), FormatError);
}

// Whoever makes assimp do what it wants says what it wants.
TEST(MeshParts, AreNotTrusted) {
    MeshPart part = wall();
    part.mesh.triangles[0][1] = 3;
    EXPECT_THROW(unpackedParts(packedParts({part}), "x.obj"), FormatError);
    part = wall();
    part.mesh.vertices[2][1] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(unpackedParts(packedParts({part}), "x.obj"), FormatError);
    part = wall();
    part.nodes[0].height = HUGE_VAL;
    EXPECT_THROW(unpackedParts(packedParts({part}), "x.obj"), FormatError);
    part = wall();
    part.nodes.resize(kMaxMeshNodeDepth + 1);
    EXPECT_THROW(unpackedParts(packedParts({part}), "x.obj"), FormatError);
    // Counts that would take all memory.
    const std::string good = packedParts({wall()});
    for (std::size_t at = 0; at + 8 <= good.size(); ++at) {
        std::string bytes = good;
        std::memset(&bytes[at], 0xff, 8);
        const std::string errors = errorsOf([&] { unpackedParts(bytes, "x.obj"); });
        EXPECT_NE(errors, "") << at;
    }
}

TEST(MeshParts, LimitsGrowWithTheFile) {
    constexpr std::size_t kMega = 1U << 20U;
    EXPECT_EQ(meshLimits(0, false).memory, 1024 * kMega);
    EXPECT_GE(meshLimits(100 * kMega, false).memory, meshLimits(kMega, false).memory);
    EXPECT_GT(meshLimits(100 * kMega, false).seconds, meshLimits(0, false).seconds);
    EXPECT_GT(meshLimits(0, true).seconds, meshLimits(0, false).seconds);
    EXPECT_LT(meshLimits(SIZE_MAX, true).seconds, 6 * 3600U);
}

}  // namespace
}  // namespace ispace
