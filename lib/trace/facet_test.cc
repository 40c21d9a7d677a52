// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/facet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ispace {

namespace {

TEST(Facet, LineIsMetInItsPlane) {
    const Facet line = Facet::ofLine({2, -1}, {2, 3});
    EXPECT_FALSE(line.empty());
    EXPECT_EQ(line.size, 4);
    EXPECT_EQ(line.distanceAlong({0, 0, 0}, {1, 0, 0}), 2);
    EXPECT_DOUBLE_EQ(line.distanceAlong({0, 0, 0}, {std::sqrt(0.5), std::sqrt(0.5), 0}),
                     2 * std::sqrt(2.0));
}

TEST(Facet, DistanceStaysWithinTheFacet) {
    // The ray passes a little beyond the end (2, 3), and almost along the line.
    const Facet line = Facet::ofLine({2, -1}, {2, 3});
    const double grazing = line.distanceAlong({2 - 1e-9, -2, 0}, {0, 1, 0});
    EXPECT_EQ(grazing, 1);
    const double tilted = line.distanceAlong({2 - 1e-9, -2, 0}, {1e-10, 1, 0});
    EXPECT_GE(tilted, 1);
    EXPECT_LE(tilted, 5);
}

TEST(Facet, TriangleIsMetInItsPlane) {
    const Facet triangle = Facet::ofTriangle({0, 0, 1}, {4, 0, 1}, {0, 4, 1});
    EXPECT_EQ(triangle.normal, (Vec3{0, 0, 1}));
    EXPECT_DOUBLE_EQ(triangle.size, 4 * std::sqrt(2.0));
    EXPECT_EQ(triangle.distanceAlong({1, 1, 0}, {0, 0, 1}), 1);
    const double slope = std::sqrt(0.5);
    EXPECT_DOUBLE_EQ(triangle.distanceAlong({1, 1, 0}, {slope, 0, slope}), std::sqrt(2.0));
}

TEST(Facet, NothingWithoutExtent) {
    EXPECT_TRUE(Facet::ofLine({1, 1}, {1, 1}).empty());
    EXPECT_TRUE(Facet::ofTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).empty());
    EXPECT_FALSE(Facet::ofLine({1, 1}, {1, 1 + 1e-12}).empty());
}

TEST(Facet, EdgeOn) {
    const Facet line = Facet::ofLine({0, 0}, {2, 0});
    EXPECT_TRUE(line.isEdgeOn({1, 0, 0}, 1e-6));
    EXPECT_TRUE(line.isEdgeOn({1, 1e-7, 0}, 1e-6));
    EXPECT_FALSE(line.isEdgeOn({1, 1e-6, 0}, 1e-6));
    EXPECT_FALSE(line.isEdgeOn({0, 1, 0}, 1e-6));
    // A speck that faces the ray is not edge-on however small it is.
    EXPECT_FALSE(Facet::ofLine({0, 0}, {1e-9, 0}).isEdgeOn({0, 1, 0}, 1e-6));
}

TEST(Facet, DistanceToLine) {
    const Facet line = Facet::ofLine({0, 0}, {2, 0});
    EXPECT_EQ(line.distanceTo({1, 0, 0}), 0);
    EXPECT_EQ(line.distanceTo({1, -3, 0}), 3);
    EXPECT_EQ(line.distanceTo({5, 4, 0}), 5);
    EXPECT_EQ(line.distanceTo({-3, 4, 0}), 5);
}

TEST(Facet, DistanceToTriangleIsThatOfItsNearestPoint) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-2, 2), share(0, 1);
    const auto point = [&] { return Point3{place(random), place(random), place(random)}; };
    for (int i = 0; i < 200; ++i) {
        const Point3 a = point(), b = point(), c = point(), p = point();
        const double distance = Facet::ofTriangle(a, b, c).distanceTo(p);
        double nearest = 100;
        for (int k = 0; k < 4000; ++k) {
            double u = share(random), v = share(random);
            if (u + v > 1) {
                u = 1 - u;
                v = 1 - v;
            }
            nearest = std::min(nearest, length(p - (a + u * (b - a) + v * (c - a))));
        }
        EXPECT_LE(distance, nearest + 1e-12);
        EXPECT_GE(distance, nearest - 0.15);
    }
}

TEST(Facet, DistanceToTriangleClosedForms) {
    const Facet triangle = Facet::ofTriangle({0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    EXPECT_EQ(triangle.distanceTo({1, 1, 0}), 0);
    EXPECT_EQ(triangle.distanceTo({1, 1, -2}), 2);
    EXPECT_EQ(triangle.distanceTo({-3, -4, 0}), 5);
    EXPECT_EQ(triangle.distanceTo({1, -2, 0}), 2);
    EXPECT_DOUBLE_EQ(triangle.distanceTo({3, 3, 0}), 1.5 * std::sqrt(2.0));
    EXPECT_EQ(triangle.distanceTo({6, 0, 4}), 5);
}

}  // namespace

}  // namespace ispace
