// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts of random meshes.
#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <random>
#include <utility>

#include "env/body.h"
#include "env/slice.h"
#include "geom/arrangement.h"
#include "support/test_mesh.h"
#include "support/test_scene.h"

namespace ispace {
namespace mesh_random_test {

using testing::cut;
using testing::meshed;

using Tetrahedron = std::array<Point3, 4>;
/// Faces of a tetrahedron, seen from outside.
constexpr std::array<std::array<std::uint32_t, 3>, 4> kFaces{
    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};

void expectSound(const Slice& slice) {
    for (const Polygon& solid : slice.solids) {
        EXPECT_GE(solid.size(), 3U);
        EXPECT_GT(signedArea(solid), 0);
    }
    for (const Segment2& line : slice.sheets) EXPECT_NE(line.a, line.b);
}

/// With a volume, its faces seen from outside.
Tetrahedron anyTetrahedron(std::mt19937_64& random) {
    std::uniform_int_distribution<int> coordinate(0, 3);
    const auto corner = [&] {
        const int x = coordinate(random), y = coordinate(random), z = coordinate(random);
        return Point3{1.0 * x, 1.0 * y, 1.0 * z};
    };
    for (;;) {
        Tetrahedron t{corner(), corner(), corner(), corner()};
        const double six = dot(t[1] - t[0], cross(t[2] - t[0], t[3] - t[0]));
        if (six == 0) continue;
        if (six < 0) std::swap(t[2], t[3]);
        return t;
    }
}

void add(const Tetrahedron& t, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Point3& p : t)
        mesh.vertices.push_back(
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    for (const auto& [i, j, k] : kFaces)
        mesh.triangles.push_back({first + i, first + j, first + k});
}

/// How deep in it; negative outside.
double depthIn(const Tetrahedron& t, Point3 p) {
    double least = 1e9;
    for (const auto& [a, b, c] : kFaces) {
        const Vec3 normal = cross(t[b] - t[a], t[c] - t[a]);
        least = std::min(least, -dot(p - t[a], normal) / length(normal));
    }
    return least;
}

TEST(RandomMeshes, TetrahedraWithAnythingInCommon) {
    // Vertices, edges and faces, and heights through all of them.
    std::mt19937_64 random(41);
    int inside_at_all = 0, outside_at_all = 0;
    for (int run = 0; run < 600; ++run) {
        TriangleMesh mesh;
        std::vector<Tetrahedron> bodies(1 + random() % 8);
        for (Tetrahedron& t : bodies) {
            t = anyTetrahedron(random);
            add(t, mesh);
        }
        const Body body = meshed(mesh);
        for (const double height : {0.5, 1.0, 1.25, 2.0, 2.5}) {
            const Slice slice = cut(body, height);
            expectSound(slice);
            for (int i = 0; i < 40; ++i) {
                const Point3 p{0.0371 + 0.0413 * static_cast<double>(random() % 70),
                               0.0173 + 0.0419 * static_cast<double>(random() % 70), height};
                bool inside = false, near = false;
                for (const Tetrahedron& t : bodies) {
                    const double depth = depthIn(t, p);
                    inside = inside || depth > 1e-9;
                    near = near || std::abs(depth) <= 1e-9;
                }
                if (near) continue;
                EXPECT_EQ(slice.blocked(p.onFloor()), inside)
                    << run << ": " << p.x << ' ' << p.y << ' ' << p.z;
                ++(inside ? inside_at_all : outside_at_all);
            }
        }
    }
    EXPECT_GT(inside_at_all, 5000);
    EXPECT_GT(outside_at_all, 5000);
}

TEST(RandomMeshes, AnyTrianglesWhatsoever) {
    std::mt19937_64 random(43);
    for (int run = 0; run < 500; ++run) {
        TriangleMesh mesh;
        const std::size_t vertices = 3 + random() % 12, triangles = 1 + random() % 60;
        const auto coordinate = [&] { return static_cast<float>(random() % 4); };
        for (std::size_t i = 0; i < vertices; ++i) {
            const float x = coordinate(), y = coordinate(), z = coordinate();
            mesh.vertices.push_back({x, y, z});
        }
        const auto any = [&] { return static_cast<std::uint32_t>(random() % vertices); };
        for (std::size_t i = 0; i < triangles; ++i) {
            const std::uint32_t a = any(), b = any(), c = any();
            mesh.triangles.push_back({a, b, c});
        }
        const Body body = meshed(mesh);
        for (const double height : {0.0, 0.7, 1.0, 1.5, 2.0, 3.0}) {
            const Slice slice = cut(body, height);
            expectSound(slice);
            EXPECT_NO_THROW(difference({rectangle({0, 0}, 20, 20, {}), {}}, slice.solids));
            Slice band;
            bandOfMeshes(body, height, height + 0.6, band, 0);
            for (const Polygon& solid : band.solids) EXPECT_GT(signedArea(solid), 0);
        }
    }
}

TEST(RandomMeshes, FacesInCommonAndSurfacesDrawnTwice) {
    // Two tetrahedra on one face, corner by corner.
    TriangleMesh pair;
    pair.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}};
    pair.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                      {1, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}};
    EXPECT_NEAR(testing::volume(meshed(pair).meshes.at(0)), 4, 1e-9);
    const Slice slice = cut(meshed(pair), 0.5);
    for (double t = 0.05; t < 0.95; t += 0.1) {
        EXPECT_TRUE(slice.blocked({1.4 * t + 0.05, 1.4 * (1 - t) + 0.05})) << t;
        EXPECT_TRUE(slice.blocked({t, 0.7 * (1 - t)})) << t;
    }
    // A wall that is seen from both sides is a wall.
    TriangleMesh wall;
    wall.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
    EXPECT_TRUE(cut(meshed(wall), 0.5).solids.empty());
    EXPECT_EQ(cut(meshed(wall), 0.5).sheets.size(), 2U);
    Slice band;
    bandOfMeshes(meshed(wall), -1, 0.5, band, 0);
    EXPECT_FALSE(band.sheets.empty());
}

}  // namespace mesh_random_test
}  // namespace ispace
