// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/mesh_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "env/test_mesh.h"
#include "env/test_scene.h"

namespace ispace {
namespace {

using testing::boxMesh;
using testing::record;
using testing::volume;
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

}  // namespace
}  // namespace ispace
