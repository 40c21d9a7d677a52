// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/test_layout.h"

namespace ispace {

namespace views_test {

std::optional<Mesh> view(const std::string& line) {
    const Scene scene = testing::scene("ispace size=8,6\n" + line + "\n");
    return viewOf(scene, scene.placed.at(0));
}

struct Extent {
    Point3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    double nearest = 1e9, farthest = 0;
};

Extent extentOf(const Mesh& mesh) {
    Extent e;
    for (const Point3& p : mesh.vertices) {
        e.low = {std::min(e.low.x, p.x), std::min(e.low.y, p.y), std::min(e.low.z, p.z)};
        e.high = {std::max(e.high.x, p.x), std::max(e.high.y, p.y), std::max(e.high.z, p.z)};
        e.nearest = std::min(e.nearest, length(p - Point3{}));
        e.farthest = std::max(e.farthest, length(p - Point3{}));
    }
    return e;
}

TEST(Views, OfALaserIsItsSector) {
    const auto sector = view("laser at=1,1 range=0.5,4 fov=90");
    ASSERT_TRUE(sector);
    EXPECT_EQ(sector->material, Material::View);
    EXPECT_TRUE(sector->open);
    const Extent e = extentOf(*sector);
    EXPECT_NEAR(e.nearest, 0.5, 1e-12);
    EXPECT_NEAR(e.farthest, 4, 1e-12);
    EXPECT_EQ(e.low.z, 0);
    EXPECT_EQ(e.high.z, 0);
    EXPECT_NEAR(e.high.y, 4 * std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(e.low.x, 0.5 * std::sqrt(0.5), 1e-12);
}

TEST(Views, OfASweptLaserIsWhereItsBeamsEnd) {
    const Extent e = extentOf(*view("laser at=1,1,4 tilt=-90 range=5 sweep=heading"));
    EXPECT_NEAR(e.nearest, 5, 1e-12);
    // Looking down, forward is down: half a ball.
    EXPECT_NEAR(e.low.x, 0, 1e-9);
    EXPECT_NEAR(e.high.x, 5, 1e-9);
    EXPECT_NEAR(e.low.y, -5, 1e-9);
    EXPECT_NEAR(e.high.z, 5, 1e-9);
}

TEST(Views, OfARangerIsItsFrustum) {
    const Extent depth = extentOf(*view("ranger at=1,1 fov=90,60 range=1,3 measures=depth"));
    EXPECT_NEAR(depth.low.x, 1, 1e-12);
    EXPECT_NEAR(depth.high.x, 3, 1e-12);
    EXPECT_NEAR(depth.high.y, 3, 1e-12);
    EXPECT_NEAR(depth.high.z, 3 * std::tan(std::acos(-1) / 6), 1e-12);
    const Extent distance = extentOf(*view("ranger at=1,1 fov=90,60 range=1,3"));
    EXPECT_NEAR(distance.farthest, 3, 1e-12);
    EXPECT_NEAR(distance.nearest, 1, 1e-12);
    const Extent around = extentOf(*view("ranger at=1,1 model=vlp-16"));
    EXPECT_NEAR(around.low.x, -around.high.x, 0.1);
    EXPECT_NEAR(around.farthest, 8, 1e-12) << "no farther than the plan is wide";
}

TEST(Views, OfAReceiverIsItsCone) {
    const Extent e = extentOf(*view("ultrasound at=1,1,2.4 tilt=-90 fov=90 range=4"));
    EXPECT_NEAR(e.high.x, 4, 1e-12);
    EXPECT_NEAR(e.high.y, 4 * std::sqrt(0.5), 1e-2);
    EXPECT_NEAR(e.low.x, 0, 1e-12);
    EXPECT_NEAR(e.farthest, 4, 1e-12);
}

TEST(Views, WhatDoesNotSeeHasNone) {
    for (const char* line : {"tag at=1,1", "mat", "robot", "human"})
        EXPECT_FALSE(view(line)) << line;
}

TEST(Views, TrianglesAreWithinTheirVertices) {
    for (const char* line :
         {"laser at=1,1 fov=0", "laser at=1,1 fov=360", "ranger at=1,1",
          "ranger at=1,1 projection=spherical fov=360,180", "ultrasound at=1,1 fov=360",
          "laser at=1,1 sweep=tilt sweep_span=90"}) {
        const auto mesh = view(line);
        ASSERT_TRUE(mesh) << line;
        ASSERT_FALSE(mesh->triangles.empty()) << line;
        for (const auto& triangle : mesh->triangles)
            for (const std::uint32_t i : triangle) EXPECT_LT(i, mesh->vertices.size()) << line;
        for (const Point3& p : mesh->vertices) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z)) << line;
    }
}

}  // namespace views_test

}  // namespace ispace
