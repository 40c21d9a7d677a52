// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <algorithm>
#include <random>

#include "env/body.h"
#include "env/level.h"
#include "env/slice.h"
#include "geom/arrangement.h"
#include "support/test_mesh.h"
#include "support/test_scene.h"

namespace ispace {
namespace slice_test {

using testing::boxMesh;
using testing::cut;
using testing::meshed;
using testing::torusMesh;
using testing::unionArea;
using testing::withMesh;

Slice bandOf(const Body& body, double bottom, double top) {
    Slice band;
    bandOfMeshes(body, bottom, top, band, 7);
    EXPECT_EQ(band.solid_owners, std::vector<std::size_t>(band.solids.size(), 7));
    EXPECT_EQ(band.sheet_owners, std::vector<std::size_t>(band.sheets.size(), 7));
    for (const Polygon& solid : band.solids) EXPECT_GT(signedArea(solid), 0);
    return band;
}

TEST(BandOfMeshes, BoxWithinThroughAndBeside) {
    const Body body = meshed(boxMesh({0, 0, 0.2F}, {2, 1, 1}));
    for (const auto& [bottom, top] : {std::pair{0.0, 2.0},
                                      {0.0, 0.5},
                                      {0.5, 0.6},
                                      {0.9, 3.0},
                                      {1.0, 2.0},
                                      {0.5, 0.5},
                                      {-1.0, 0.25}}) {
        EXPECT_NEAR(unionArea(bandOf(body, bottom, top).solids), 2, 1e-6) << bottom << ' ' << top;
    }
    EXPECT_TRUE(bandOf(body, 1.1, 2).solids.empty());
    EXPECT_TRUE(bandOf(body, 0, 0.1).solids.empty());
    EXPECT_TRUE(bandOf(body, 0, 0.1).sheets.empty());
}

TEST(BandOfMeshes, IsTheShadowOfTheCutsWithin) {
    const Body body = meshed(torusMesh(2, 0.5, 60, 24), "up=x heading=20");
    const Slice band = bandOf(body, 0.4, 0.9);
    std::mt19937_64 random(29);
    std::uniform_real_distribution<double> place(-3, 3);
    std::vector<Slice> slices;
    for (int k = 0; k <= 50; ++k) slices.push_back(cut(body, 0.4 + 0.01 * k));
    const auto blocked = [&](Point2 p) {
        return std::any_of(band.solids.begin(), band.solids.end(),
                           [p](const Polygon& s) { return locate(s, p) != Side::Outside; });
    };
    int inside = 0, outside = 0;
    for (int i = 0; i < 2000; ++i) {
        const Point2 p{place(random), place(random)};
        const bool met =
            std::any_of(slices.begin(), slices.end(), [p](const Slice& s) { return s.blocked(p); });
        // The steps of the cuts leave little out.
        EXPECT_TRUE(!met || blocked(p));
        inside += met ? 1 : 0;
        outside += !met && blocked(p) ? 1 : 0;
    }
    EXPECT_GT(inside, 80);
    EXPECT_LT(outside, 20);
}

TEST(BandOfMeshes, UprightSurfacesWithARimAreSheets) {
    TriangleMesh wall;
    wall.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}};
    wall.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Slice band = bandOf(meshed(wall), 0.5, 1);
    EXPECT_TRUE(band.solids.empty());
    double low = 9, high = -9;
    for (const Segment2& line : band.sheets) {
        low = std::min({low, line.a.x, line.b.x});
        high = std::max({high, line.a.x, line.b.x});
    }
    EXPECT_EQ(low, 0);
    EXPECT_EQ(high, 2);
    EXPECT_TRUE(bandOf(meshed(wall), 2.5, 3).sheets.empty());
}

TEST(BandOfMeshes, AMillionTriangles) {
    const Body body = meshed(torusMesh(2, 0.5, 1000, 500), "up=y");
    EXPECT_GT(bandOf(body, 0, 0.3).solids.size(), 10'000U);
    EXPECT_GT(bandOf(body, -9, 9).solids.size(), 999'000U) << "all but slivers";
}

TEST(BandOfMeshes, PartOfTheEnvironment) {
    std::vector<Record> records =
        testing::document("ispace size=8,6\nwall from=1,-1 to=1,1\n").records;
    records.push_back(
        withMesh("mesh file=a.stl at=-2,0,0.1 scale=2", boxMesh({0, 0, 0}, {1, 1, 1})));
    const Environment room = testing::environment(records);
    const Slice slice = room.slice(kScanHeight);
    EXPECT_EQ(slice.sheets.size(), 5U);
    ASSERT_EQ(slice.solids.size(), 1U);
    EXPECT_TRUE(slice.blocked({-1, 1}));
    EXPECT_NEAR(totalArea(room.level(kScanHeight)->freeFloor()), 48 - 4, 1e-9);
    EXPECT_TRUE(room.slice(0.05).solids.empty());
    const Slice band = room.band(0, 0.3);
    EXPECT_FALSE(band.solids.empty());
    for (const std::size_t owner : band.solid_owners) EXPECT_EQ(owner, 2U);
    EXPECT_EQ(band.sheet_owners.size(), band.sheets.size());
    EXPECT_TRUE(room.band(0, 0.05).solids.empty());
    EXPECT_EQ(room.height(), 2.5) << "of the walls";
}

}  // namespace slice_test
}  // namespace ispace
