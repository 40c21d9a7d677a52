// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "support/test_mesh.h"
#include "support/test_scene.h"

namespace ispace {

namespace mesh_test {

using testing::volume;

using testing::record;

Vec3 crossProduct(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Point3 o = mesh.vertices[t[0]];
        sum += length(crossProduct(mesh.vertices[t[1]] - o, mesh.vertices[t[2]] - o)) / 2;
    }
    return sum;
}

/// Returns true if every edge is met once in each direction.
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
    EXPECT_TRUE(floorMesh({}).open);
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
    const std::vector<Triangulation> parts{triangulate(region)};
    const Mesh mesh = floorMesh(parts);
    EXPECT_EQ(mesh.material, Material::Floor);
    EXPECT_NEAR(area(mesh), 15, 1e-12);
    for (const Point3 p : mesh.vertices) EXPECT_EQ(p.z, 0);
    EXPECT_TRUE(meshesOf({}, Surfaces::Drawn).empty());
}

using testing::boxMesh;
using testing::record;
using testing::withMesh;

std::string meshFindings(const Record& mesh) {
    Diagnostics findings;
    checkMesh(mesh, meshBody(mesh), findings);
    try {
        findings.throwIfAny();
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

/// The corner of a mesh that is not at the origin, of a triangle with its others there.
Point3 image(const std::string& keys, std::array<float, 3> corner) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 1, 1}, corner};
    mesh.triangles = {{0, 1, 2}};
    return bodyOf(withMesh("mesh file=a.stl " + keys, mesh)).meshes.at(0).vertices.at(2);
}

TEST(MeshBody, IsNoneUntilTheFileIsLoaded) {
    const Record mesh = record("mesh file=a.stl");
    EXPECT_TRUE(bodyOf(mesh).meshes.empty());
    EXPECT_EQ(topOf(bodyOf(mesh)), 0);
    EXPECT_EQ(meshFindings(mesh), "the mesh file `a.stl` is not loaded");
    EXPECT_NE(testing::findings("ispace\nmesh file=\"b c.obj\"\n")
                  .find("room.env:3:11: error: the mesh file `b c.obj` is not loaded"),
              std::string::npos);
}

TEST(MeshBody, UnitScaleAxesHeadingAndPlace) {
    EXPECT_EQ(image("", {1, 2, 3}), (Point3{1, 2, 3}));
    EXPECT_EQ(image("up=z", {1, 2, 3}), (Point3{1, 2, 3}));
    EXPECT_EQ(image("up=y", {1, 2, 3}), (Point3{1, -3, 2}));
    EXPECT_EQ(image("up=x", {1, 2, 3}), (Point3{2, 3, 1}));
    EXPECT_EQ(image("scale=2", {1, 2, 3}), (Point3{2, 4, 6}));
    EXPECT_EQ(image("heading=90", {1, 2, 3}), (Point3{-2, 1, 3}));
    EXPECT_EQ(image("at=10,20 heading=90", {1, 2, 3}), (Point3{8, 21, 3}));
    EXPECT_EQ(image("at=10,20,0.5 heading=180 up=y scale=2", {1, 2, 3}), (Point3{8, 26, 4.5}));
    for (const auto& [unit, metres] :
         {std::pair{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"inch", 0.0254}, {"foot", 0.3048}}) {
        const Point3 p = image(std::string("unit=") + unit, {1, 2, 3});
        EXPECT_DOUBLE_EQ(p.z, 3 * metres) << unit;
        const Record record =
            withMesh(std::string("mesh file=a.stl scale=2 unit=") + unit, boxMesh({}, {1, 1, 1}));
        EXPECT_DOUBLE_EQ(meshScale(record), 2 * metres) << unit;
    }
}

TEST(MeshBody, AxesAreTurnsAndNoMirrors) {
    for (const char* up : {"auto", "x", "y", "z"}) {
        const Body body = bodyOf(
            withMesh(std::string("mesh file=a.stl up=") + up, boxMesh({1, 2, 3}, {2, 4, 6})));
        EXPECT_NEAR(volume(body.meshes.at(0)), 6, 1e-9) << up;
        EXPECT_FALSE(body.meshes[0].open);
    }
}

TEST(MeshBody, VerticesAtOnePlaceAreOne) {
    // As STL has it: three vertices a triangle.
    const TriangleMesh box = boxMesh({0, 0, -0.0F}, {1, 1, 1});
    TriangleMesh soup;
    for (const auto& triangle : box.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t corner : triangle) soup.vertices.push_back(box.vertices[corner]);
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    soup.vertices[0][2] = 0.0F;
    const Body body = bodyOf(withMesh("mesh file=a.stl", soup));
    ASSERT_EQ(body.meshes.size(), 1U);
    EXPECT_EQ(body.meshes[0].vertices.size(), 8U);
    EXPECT_FALSE(body.meshes[0].open);
    EXPECT_EQ(body.meshes[0].material, Material::Mesh);
    EXPECT_EQ(topOf(body), 1);
}

TEST(MeshBody, InsideOutIsTurned) {
    TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    for (auto& triangle : box.triangles) std::swap(triangle[0], triangle[1]);
    EXPECT_NEAR(volume(bodyOf(withMesh("mesh file=a.stl", box)).meshes.at(0)), 1, 1e-12);
}

TEST(MeshBody, OpenWhereAnEdgeHasOneTriangle) {
    TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    box.triangles.pop_back();
    EXPECT_TRUE(bodyOf(withMesh("mesh file=a.stl", box)).meshes.at(0).open);
}

TEST(MeshBody, DropsWhatIsNoTriangle) {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.vertices.push_back({nan, 0, 0});
    mesh.vertices.push_back({0, 0, 100});  // used by no triangle
    mesh.triangles.push_back({0, 0, 1});
    mesh.triangles.push_back({0, 1, 8});
    mesh.triangles.push_back({0, 1, 77});
    const Body body = bodyOf(withMesh("mesh file=a.stl", mesh));
    EXPECT_EQ(body.meshes.at(0).triangles.size(), 12U);
    EXPECT_EQ(topOf(body), 1);
    mesh.triangles = {{0, 0, 1}, {8, 1, 2}};
    EXPECT_EQ(meshFindings(withMesh("mesh file=a.stl", mesh)),
              "the mesh file `a.stl` has no triangle");
    EXPECT_EQ(meshFindings(withMesh("mesh file=a.stl", TriangleMesh())),
              "the mesh file `a.stl` has no triangle");
}

TEST(MeshBody, RefusesWhatReachesTooFar) {
    const TriangleMesh box = boxMesh({0, 0, 0}, {1e3F, 1, 1});
    EXPECT_EQ(meshFindings(withMesh("mesh file=a.stl scale=1000", box)), "");
    EXPECT_EQ(meshFindings(withMesh("mesh file=a.stl scale=3000", box)),
              "the mesh file `a.stl` reaches further than 2000 km from the origin; check `unit` "
              "and `scale`");
    EXPECT_NE(meshFindings(withMesh("mesh file=a.stl scale=1e6",
                                    boxMesh({-1e38F, -1e38F, 0}, {1e38F, 1e38F, 1}))),
              "");
}

}  // namespace mesh_test

}  // namespace ispace
