// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "env/test_scene.h"

namespace ispace {
namespace {

using testing::record;

Vec3 crossProduct(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Volume by the divergence theorem: positive only if closed and wound outward.
double volume(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Point3 o{};
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o,
                   c = mesh.vertices[t[2]] - o;
        sum += dot(a, crossProduct(b, c)) / 6;
    }
    return sum;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Point3 o = mesh.vertices[t[0]];
        sum += length(crossProduct(mesh.vertices[t[1]] - o, mesh.vertices[t[2]] - o)) / 2;
    }
    return sum;
}

/// True if every edge is met once in each direction.
bool isClosed(const Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        const auto back = edges.find({edge.second, edge.first});
        if (count != 1 || back == edges.end() || back->second != 1) return false;
    }
    return true;
}

TEST(Mesh, BoxIsClosedAndOutward) {
    const auto meshes =
        meshesOf(bodyOf(record("cube at=5,6,1 size=2,3,4 heading=40")), Surfaces::Drawn);
    ASSERT_EQ(meshes.size(), 1U);
    EXPECT_EQ(meshes[0].vertices.size(), 8U);
    EXPECT_EQ(meshes[0].triangles.size(), 12U);
    EXPECT_TRUE(isClosed(meshes[0]));
    EXPECT_NEAR(volume(meshes[0]), 24, 1e-9);
}

TEST(Mesh, ClearGlassIsSolidButNotOpaque) {
    Body body;
    body.sheets.push_back({{{0, 0}, {2, 0}}, 0, 1, Material::Wall, false});
    body.sheets.push_back({{{2, 0}, {3, 0}}, 0, 1, Material::Glass, true});
    EXPECT_EQ(meshesOf(body, Surfaces::Drawn).size(), 2U);
    EXPECT_EQ(meshesOf(body, Surfaces::Solid).size(), 2U);
    const auto opaque = meshesOf(body, Surfaces::Opaque);
    ASSERT_EQ(opaque.size(), 1U);
    EXPECT_EQ(opaque[0].material, Material::Wall);
}

TEST(Mesh, ConcaveFootprint) {
    Body body;
    body.prisms.push_back(
        {{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 0.5, 2, Material::Brick});
    const auto meshes = meshesOf(body, Surfaces::Solid);
    ASSERT_EQ(meshes.size(), 1U);
    EXPECT_TRUE(isClosed(meshes[0]));
    EXPECT_NEAR(volume(meshes[0]), 5 * 1.5, 1e-12);
    EXPECT_NEAR(area(meshes[0]), 2 * 5 + 12 * 1.5, 1e-12);
}

TEST(Mesh, CollinearVertexInTheFootprint) {
    Body body;
    body.prisms.push_back({{{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 0, 1, Material::Box});
    const auto meshes = meshesOf(body, Surfaces::Solid);
    EXPECT_TRUE(isClosed(meshes[0]));
    EXPECT_NEAR(volume(meshes[0]), 4, 1e-12);
}

TEST(Mesh, EveryThingIsClosed) {
    for (const char* line : {"pillar kind=round", "table heading=20", "desk", "desk kind=closed",
                             "chair", "barrier", "cylinder size=2,1,1", "infra rows=1 cols=1",
                             "boxes heading=7", "screen", "wall from=0,0 to=2,1 thickness=0.1",
                             "fence path=0,0;2,0;2,2 closed=yes thickness=0.1"}) {
        const Body body = bodyOf(record(line));
        double expected = 0;
        for (const Prism& prism : body.prisms)
            expected += signedArea(prism.footprint) * (prism.top - prism.bottom);
        double found = 0;
        for (const Mesh& mesh : meshesOf(body, Surfaces::Drawn)) {
            EXPECT_TRUE(isClosed(mesh)) << line;
            found += volume(mesh);
        }
        EXPECT_NEAR(found, expected, 1e-9) << line;
    }
}

TEST(Mesh, OpenIsWhatHasARim) {
    for (const char* line : {"desk", "wall from=0,0 to=2,1 thickness=0.1"})
        for (const Mesh& mesh : meshesOf(bodyOf(record(line)), Surfaces::Drawn)) {
            EXPECT_FALSE(mesh.open) << line;
            EXPECT_TRUE(isWatertight(mesh)) << line;
        }
    for (const char* line : {"wall from=0,0 to=2,1", "floor", "ispace ceiling=yes"})
        for (const Mesh& mesh : meshesOf(bodyOf(record(line)), Surfaces::Drawn)) {
            EXPECT_TRUE(mesh.open) << line;
            EXPECT_FALSE(isWatertight(mesh)) << line;
        }
    EXPECT_TRUE(floorMesh({{{{{0, 0}, {1, 0}, {0, 1}}, {}}}}).open);
    EXPECT_TRUE(isWatertight(Mesh()));
}

TEST(Mesh, WatertightCountsEachWay) {
    // Both sides of a triangle close each other; twice the same side does not.
    Mesh mesh{Material::Mesh, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}};
    EXPECT_TRUE(isWatertight(mesh));
    mesh.triangles[1] = {1, 2, 0};
    EXPECT_FALSE(isWatertight(mesh));
}

TEST(Mesh, SheetsAreTwoTrianglesEach) {
    const auto meshes = meshesOf(bodyOf(record("ispace size=4,3")), Surfaces::Solid);
    ASSERT_EQ(meshes.size(), 1U);
    EXPECT_EQ(meshes[0].triangles.size(), 8U);
    EXPECT_NEAR(area(meshes[0]), 14 * 2.5, 1e-9);
}

TEST(Mesh, MaterialsComeInOrderOfFirstUse) {
    const auto meshes = meshesOf(bodyOf(record("desk")), Surfaces::Solid);
    ASSERT_EQ(meshes.size(), 2U);
    EXPECT_EQ(meshes[0].material, Material::Wood);
    EXPECT_EQ(meshes[1].material, Material::Metal);
    EXPECT_EQ(meshes[1].triangles.size(), 4U * 12U);
}

TEST(Mesh, PatternsOnlyWhereAskedFor) {
    const Body floor = bodyOf(record("floor kind=checker size=2,2"));
    EXPECT_TRUE(meshesOf(floor, Surfaces::Solid).empty());
    const auto meshes = meshesOf(floor, Surfaces::Drawn);
    ASSERT_EQ(meshes.size(), 2U);
    EXPECT_NEAR(area(meshes[0]) + area(meshes[1]), 4, 1e-12);
    // Plates face up.
    for (const Mesh& mesh : meshes)
        for (const auto& t : mesh.triangles)
            EXPECT_GT(crossProduct(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                                   mesh.vertices[t[2]] - mesh.vertices[t[0]])
                          .z,
                      0);
    EXPECT_EQ(meshesOf(bodyOf(record("ispace ceiling=yes")), Surfaces::Solid).size(), 2U);
}

TEST(Mesh, FloorOfARegionWithHoles) {
    const Region region{{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{{1, 1}, {1, 2}, {2, 2}, {2, 1}}}};
    const Mesh mesh = floorMesh({{region}});
    EXPECT_EQ(mesh.material, Material::Floor);
    EXPECT_NEAR(area(mesh), 15, 1e-12);
    for (const Point3 p : mesh.vertices) EXPECT_EQ(p.z, 0);
    EXPECT_TRUE(meshesOf({}, Surfaces::Drawn).empty());
}

}  // namespace
}  // namespace ispace
