// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/slice.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "env/body.h"
#include "geom/predicates.h"
#include "support/test_mesh.h"
#include "support/test_scene.h"

namespace ispace {
namespace mesh_cut_test {

using testing::boxMesh;
using testing::cut;
using testing::joined;
using testing::meshed;
using testing::record;
using testing::torusMesh;
using testing::unionArea;

double edgeDistance(const std::vector<Polygon>& solids, Point2 p) {
    double least = 1e300;
    for (const Polygon& solid : solids)
        forEachEdge(solid,
                    [&](const Segment2& edge) { least = std::min(least, distance(p, edge)); });
    return least;
}

/// How often the surface winds around a point: counted along the ray upwards.
int winding(const Mesh& mesh, Point3 p) {
    int sum = 0;
    for (const auto& t : mesh.triangles) {
        const Point3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        const Point2 q = p.onFloor();
        const Turn s = orientation(a.onFloor(), b.onFloor(), q),
                   u = orientation(b.onFloor(), c.onFloor(), q),
                   v = orientation(c.onFloor(), a.onFloor(), q);
        if (s != u || u != v || s == Turn::Straight) continue;
        const Vec3 normal = cross(b - a, c - a);
        const double z = a.z - (normal.x * (p.x - a.x) + normal.y * (p.y - a.y)) / normal.z;
        if (z > p.z) sum += normal.z > 0 ? 1 : -1;
    }
    return sum;
}

/// The cut and a count for each point agree, away from the edges.
void expectTrueCut(const Body& body, double height, double reach, std::uint64_t seed) {
    const Slice slice = cut(body, height);
    EXPECT_TRUE(slice.sheets.empty());
    for (const Polygon& solid : slice.solids) EXPECT_GT(signedArea(solid), 0);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(-reach, reach);
    int inside = 0;
    for (int i = 0; i < 400; ++i) {
        const Point2 p{place(random), place(random)};
        int sum = 0;
        for (const Mesh& mesh : body.meshes) sum += winding(mesh, {p.x, p.y, height});
        if (edgeDistance(slice.solids, p) < 1e-6) continue;
        EXPECT_EQ(slice.blocked(p), sum != 0) << p.x << ' ' << p.y << ' ' << height;
        inside += sum != 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 0) << height;
}

TEST(CutMeshes, BoxIsClosedAtBothEnds) {
    const Body body = meshed(boxMesh({0, 0, 0}, {2, 1, 3}), "at=5,5 heading=90");
    for (const double height : {0.0, 1.0, 2.5, 3.0}) {
        const Slice slice = cut(body, height);
        ASSERT_EQ(slice.solids.size(), 1U) << height;
        EXPECT_TRUE(slice.sheets.empty());
        EXPECT_NEAR(signedArea(slice.solids[0]), 2, 1e-12);
        EXPECT_TRUE(slice.blocked({4.5, 6}));
        EXPECT_TRUE(slice.blocked({4, 6})) << "its edge belongs to it";
        EXPECT_FALSE(slice.blocked({5.5, 6}));
    }
    for (const double height : {-0.001, 3.001, -10.0, 10.0})
        EXPECT_TRUE(cut(body, height).solids.empty());
}

TEST(CutMeshes, StepsCountFromBothSides) {
    // A broad box with a narrow one upon it: at the step both count, as prisms do.
    const Body body =
        meshed(joined(boxMesh({0, 0, 0}, {2, 2, 1}), boxMesh({0.5F, 0.5F, 1}, {1, 1, 2})));
    EXPECT_EQ(cut(body, 1).solids.size(), 2U);
    EXPECT_NEAR(unionArea(cut(body, 1).solids), 4, 1e-9);
    EXPECT_NEAR(unionArea(cut(body, 1.5).solids), 0.25, 1e-9);
}

TEST(CutMeshes, AStepOfOneSurface) {
    // An upright L: its tread at 1 counts at that height; seen from above the riser only.
    Body body;
    Mesh mesh;
    const std::vector<Point2> profile{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const double y : {0.0, 1.0})
        for (const Point2 p : profile) mesh.vertices.push_back({p.x, y, p.y});
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    for (std::uint32_t i = 0; i < 4; ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        mesh.triangles.push_back({a + 6, c + 6, b + 6});
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        const std::uint32_t next = (i + 1) % 6;
        mesh.triangles.push_back({next, i, i + 6});
        mesh.triangles.push_back({next, i + 6, next + 6});
    }
    ASSERT_TRUE(isWatertight(mesh));
    ASSERT_NEAR(testing::volume(mesh), 3, 1e-12);
    body.meshes.push_back(mesh);
    EXPECT_NEAR(unionArea(cut(body, 0.5).solids), 2, 1e-12);
    EXPECT_NEAR(unionArea(cut(body, 1).solids), 2, 1e-12);
    EXPECT_NEAR(unionArea(cut(body, 1.5).solids), 1, 1e-12);
    EXPECT_NEAR(unionArea(cut(body, 2).solids), 1, 1e-12);
    EXPECT_NEAR(unionArea(cut(body, 0).solids), 2, 1e-12);
}

TEST(CutMeshes, RidgeThatJustReachesTheHeightIsALine) {
    // A roof: its ridge from (0,1,2) to (4,1,2).
    TriangleMesh roof;
    roof.vertices = {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}, {0, 1, 2}, {4, 1, 2}};
    roof.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4},
                      {2, 3, 4}, {2, 4, 5}, {0, 4, 3}, {1, 2, 5}};
    const Body body = meshed(roof);
    ASSERT_FALSE(body.meshes[0].open);
    const Slice ridge = cut(body, 2);
    EXPECT_TRUE(ridge.solids.empty());
    ASSERT_EQ(ridge.sheets.size(), 1U);
    EXPECT_EQ(std::min(ridge.sheets[0].a.x, ridge.sheets[0].b.x), 0);
    EXPECT_EQ(std::max(ridge.sheets[0].a.x, ridge.sheets[0].b.x), 4);
    EXPECT_NEAR(unionArea(cut(body, 1).solids), 4, 1e-9);
    // A tip that only touches the plane makes no outline.
    TriangleMesh tip;
    tip.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tip.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    EXPECT_TRUE(cut(meshed(tip), 1).solids.empty());
    EXPECT_TRUE(cut(meshed(tip), 1).sheets.empty());
    EXPECT_EQ(cut(meshed(tip), 0.999).solids.size(), 1U);
}

TEST(CutMeshes, HoleIsReachedByASeamWithinTheSolid) {
    const Body body =
        meshed(joined(boxMesh({0, 0, 0}, {4, 4, 4}), boxMesh({1, 1, 1}, {3, 3, 3}), true));
    const Slice slice = cut(body, 2);
    ASSERT_EQ(slice.solids.size(), 1U);
    EXPECT_NEAR(signedArea(slice.solids[0]), 12, 1e-9);
    EXPECT_NEAR(unionArea(slice.solids), 12, 1e-9);
    EXPECT_TRUE(slice.blocked({0.5, 2}));
    EXPECT_FALSE(slice.blocked({2, 2}));
    // No line stands in the cavity or outside.
    slice.forEachLine([](const Segment2& line) {
        const Point2 middle{(line.a.x + line.b.x) / 2, (line.a.y + line.b.y) / 2};
        EXPECT_FALSE(middle.x > 1 && middle.x < 3 && middle.y > 1 && middle.y < 3);
        EXPECT_FALSE(middle.x < 0 || middle.x > 4 || middle.y < 0 || middle.y > 4);
    });
    EXPECT_NEAR(unionArea(cut(body, 0.5).solids), 16, 1e-9);
    // The cavity is open: at its floor and at its roof the solid counts.
    EXPECT_NEAR(unionArea(cut(body, 1).solids), 16, 1e-9);
    EXPECT_NEAR(unionArea(cut(body, 3).solids), 16, 1e-9);
}

TEST(CutMeshes, ManyHolesAndIslands) {
    TriangleMesh mesh = boxMesh({-10, -10, 0}, {10, 10, 1});
    std::mt19937_64 random(3);
    std::uniform_real_distribution<float> extent(0.1F, 0.4F);
    double expected = 400;
    for (int i = -9; i <= 9; ++i)
        for (int k = -9; k <= 9; ++k) {
            const auto x = static_cast<float>(i), y = static_cast<float>(k);
            const float a = extent(random);
            mesh = joined(mesh, boxMesh({x - a, y - a, -1}, {x + a, y + a, 2}), true);
            expected -= 4.0 * a * a;
            if ((i + k) % 3 != 0) continue;
            // An island in the hole.
            mesh = joined(mesh, boxMesh({x - 0.05F, y - 0.05F, -1}, {x + 0.05F, y + 0.05F, 2}));
            expected += 0.01;
        }
    const Body body = meshed(mesh, "heading=10");
    const Slice slice = cut(body, 0.5);
    EXPECT_NEAR(unionArea(slice.solids), expected, 1e-4);
    expectTrueCut(body, 0.5, 12, 5);
}

TEST(CutMeshes, TorusAtEveryHeight) {
    for (const char* keys : {"", "up=y", "up=x heading=30", "heading=77 at=0.1,0.2,-0.3"}) {
        const Body body = meshed(torusMesh(2, 0.5, 60, 24), keys);
        ASSERT_FALSE(body.meshes[0].open);
        ASSERT_GT(testing::volume(body.meshes[0]), 0);
        double low = 1e9, high = -1e9;
        for (const Point3& p : body.meshes[0].vertices) {
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
        for (int i = 1; i < 10; ++i) expectTrueCut(body, low + (high - low) * i / 10, 3, 11);
    }
}

TEST(CutMeshes, AtTheHeightsOfItsVertices) {
    const Body body = meshed(torusMesh(2, 0.5, 30, 12), "up=y");
    for (const Point3& p : body.meshes[0].vertices) {
        const Slice slice = cut(body, p.z);
        for (const Polygon& solid : slice.solids) EXPECT_GT(signedArea(solid), 0);
        // As much as a plane just beside it, whichever has more.
        const double below = unionArea(cut(body, p.z - 1e-9).solids),
                     above = unionArea(cut(body, p.z + 1e-9).solids);
        EXPECT_NEAR(unionArea(slice.solids), std::max(below, above), 1e-6);
    }
}

TEST(CutMeshes, OpenSurfacesAreSheets) {
    TriangleMesh wall;
    wall.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Body body = meshed(wall);
    ASSERT_TRUE(body.meshes[0].open);
    for (const double height : {0.0, 0.5, 1.0, 2.0}) {
        const Slice slice = cut(body, height);
        EXPECT_TRUE(slice.solids.empty());
        double sum = 0;
        for (const Segment2& line : slice.sheets) {
            EXPECT_EQ(line.a.y, 0);
            EXPECT_EQ(line.b.y, 0);
            sum += distance(line.a, line.b);
        }
        EXPECT_NEAR(sum, 2, 1e-12) << height;
    }
    EXPECT_TRUE(cut(body, 2.1).sheets.empty());
    // A level surface with a rim has no height to be met at, like a plate.
    TriangleMesh level;
    level.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    level.triangles = {{0, 1, 2}};
    EXPECT_TRUE(cut(meshed(level), 1).sheets.empty());
    EXPECT_TRUE(cut(meshed(level), 1).solids.empty());
}

TEST(CutMeshes, BoxWithoutLidIsClosedAllTheSame) {
    TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    box.triangles.erase(box.triangles.begin() + 2, box.triangles.begin() + 4);
    const Body body = meshed(box);
    EXPECT_TRUE(body.meshes[0].open);
    EXPECT_NEAR(unionArea(cut(body, 0.5).solids), 1, 1e-12);
    EXPECT_TRUE(cut(body, 0.5).sheets.empty());
}

TEST(CutMeshes, TrianglesThatFaceAnyWay) {
    std::mt19937_64 random(17);
    for (int run = 0; run < 20; ++run) {
        TriangleMesh box = boxMesh({0, 0, 0}, {1, 2, 1});
        for (auto& triangle : box.triangles)
            if (random() % 2 == 0) std::swap(triangle[0], triangle[1]);
        const Slice slice = cut(meshed(box), 0.3);
        EXPECT_NEAR(unionArea(slice.solids), 2, 1e-12);
        EXPECT_TRUE(slice.sheets.empty());
    }
}

TEST(CutMeshes, PartsThatAreInsideOut) {
    const TriangleMesh big = boxMesh({0, 0, 0}, {4, 4, 4});
    const TriangleMesh beside = joined(big, boxMesh({5, 0, 0}, {8, 3, 4}), true);
    const Body body = meshed(beside);
    EXPECT_FALSE(body.meshes[0].open);
    EXPECT_NEAR(unionArea(cut(body, 1).solids), 16 + 9, 1e-9);
    for (const Polygon& solid : cut(body, 1).solids) EXPECT_GT(signedArea(solid), 0);
    // A cavity in it, and a cavity in the first edge of another one's way.
    const Body hollow = meshed(joined(joined(beside, boxMesh({6, 1, 0}, {7, 2, 4}), true),
                                      boxMesh({1, 1, 0}, {2, 2, 4}), true));
    const Slice slice = cut(hollow, 1);
    EXPECT_EQ(slice.solids.size(), 2U);
    EXPECT_NEAR(unionArea(slice.solids), 16 - 1 + 9 - 1, 1e-9);
    EXPECT_FALSE(slice.blocked({6.5, 1.5}));
    EXPECT_FALSE(slice.blocked({1.5, 1.5}));
    EXPECT_TRUE(slice.blocked({5.5, 1.5}));
}

TEST(CutMeshes, CavitiesInARowAndOnOneEdge) {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {10, 10, 1});
    for (int i = 1; i < 9; ++i) {
        const auto x = static_cast<float>(i);
        // In a row each looks at the one before; in a column all look at the same edge.
        mesh = joined(mesh, boxMesh({x, 5, 0}, {x + 0.5F, 5.5F, 1}), true);
        mesh = joined(
            mesh, boxMesh({1 + 0.01F * x, 0.1F + 0.4F * x, 0}, {1.5F, 0.3F + 0.4F * x, 1}), true);
    }
    double expected = 100 - 8 * 0.25;
    for (int i = 1; i < 9; ++i) expected -= 0.2 * (0.5 - 0.01 * i);
    const Body body = meshed(mesh);
    ASSERT_EQ(cut(body, 0.5).solids.size(), 1U);
    EXPECT_NEAR(signedArea(cut(body, 0.5).solids[0]), expected, 1e-5);
    EXPECT_NEAR(unionArea(cut(body, 0.5).solids), expected, 1e-5);
    expectTrueCut(body, 0.5, 10, 31);
}

TEST(CutMeshes, RepeatedTrianglesCountOnce) {
    const TriangleMesh box = boxMesh({0, 0, 0}, {1, 2, 1});
    TriangleMesh twice = box;
    for (const auto& [i, j, k] : box.triangles) twice.triangles.push_back({j, k, i});
    TriangleMesh both = box;
    for (const auto& [i, j, k] : box.triangles) both.triangles.push_back({j, i, k});
    for (const TriangleMesh& mesh : {twice, both}) {
        const Slice slice = cut(meshed(mesh), 0.3);
        ASSERT_EQ(slice.solids.size(), 1U);
        EXPECT_NEAR(unionArea(slice.solids), 2, 1e-12);
        EXPECT_TRUE(slice.sheets.empty());
    }
}

TEST(CutMeshes, BoxesThatShareAnEdgeOrOverlap) {
    // Four triangles meet at the common edge.
    const Body side = meshed(joined(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({1, 1, 0}, {2, 2, 1})));
    EXPECT_EQ(side.meshes[0].vertices.size(), 14U);
    EXPECT_NEAR(unionArea(cut(side, 0.5).solids), 2, 1e-12);
    const Body over = meshed(joined(boxMesh({0, 0, 0}, {2, 2, 1}), boxMesh({1, 1, 0}, {3, 3, 1})));
    EXPECT_NEAR(unionArea(cut(over, 0.5).solids), 7, 1e-12);
    // A common face: both sides of it are there.
    const Body face = meshed(joined(boxMesh({0, 0, 0}, {1, 1, 1}), boxMesh({1, 0, 0}, {2, 1, 1})));
    EXPECT_NEAR(unionArea(cut(face, 0.5).solids), 2, 1e-12);
    EXPECT_TRUE(cut(face, 0.5).sheets.empty());
}

TEST(CutMeshes, AgreesWithPrisms) {
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> place(-2.2, 2.2);
    for (const char* line :
         {"desk kind=closed heading=20 at=0.1,0.2", "desk", "table heading=5", "chair heading=-40",
          "boxes heading=33 size=2,2,1.5 count=5", "screen size=3,0.6,2 heading=12",
          "infra size=3,4 rows=3 cols=4 height=1 heading=9", "pillar kind=round size=1",
          "cylinder size=2,1,1 at=0,0,0.25", "barrier"}) {
        const Body body = bodyOf(record(line));
        Body as_mesh;
        as_mesh.meshes = meshesOf(body, Surfaces::Solid);
        std::vector<double> heights{0.15, 0.5, 1.02};
        for (const Prism& prism : body.prisms) {
            heights.push_back(prism.bottom);
            heights.push_back(prism.top);
        }
        for (const double height : heights) {
            Slice expected;
            for (const Prism& prism : body.prisms)
                if (prism.bottom <= height && height <= prism.top)
                    expected.solids.push_back(prism.footprint);
            const Slice found = cut(as_mesh, height);
            EXPECT_TRUE(found.sheets.empty()) << line;
            EXPECT_NEAR(unionArea(found.solids), unionArea(expected.solids), 1e-9)
                << line << height;
            for (int i = 0; i < 200; ++i) {
                const Point2 p{place(random), place(random)};
                if (edgeDistance(expected.solids, p) < 1e-9) continue;
                EXPECT_EQ(found.blocked(p), expected.blocked(p)) << line << ' ' << height;
            }
        }
    }
}

TEST(CutMeshes, AMillionTriangles) {
    const Body body = meshed(torusMesh(2, 0.5, 1000, 500), "up=y");
    ASSERT_EQ(body.meshes[0].triangles.size(), 1'000'000U);
    const auto start = std::chrono::steady_clock::now();
    const Slice slice = cut(body, 0.15);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(slice.solids.size(), 2U);
    RecordProperty("seconds", std::to_string(seconds));
    EXPECT_LT(seconds, 5) << "not linear any more";
}

}  // namespace mesh_cut_test
}  // namespace ispace
