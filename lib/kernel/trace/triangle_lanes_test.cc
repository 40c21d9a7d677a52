// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace ispace {
namespace triangle_lanes_test {

using Corners = std::array<Point3, 3>;

/// Triangles of all sizes and shapes, far and near, some along the axes.
std::vector<Corners> triangles() {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(-1, 1);
    std::vector<Corners> out;
    for (const double size : {1e-6, 1e-3, 1.0, 300.0})
        for (const double away : {0.0, 1e3})
            for (int i = 0; i < 201; ++i) {
                Corners corners{};
                for (Point3& p : corners) {
                    p = {away + size * share(random), size * share(random), size * share(random)};
                    if (i % 3 == 0) p.z = std::round(share(random));
                    if (i % 5 == 0) p.x = away;
                }
                out.push_back(corners);
            }
    return out;
}

TriangleSoup soupOf(const std::vector<Corners>& triangles) {
    TriangleSoup soup;
    for (const auto& [a, b, c] : triangles)
        soup.triangles.push_back({soup.add(a), soup.add(b), soup.add(c)});
    return soup;
}

Vec3 unit(Vec3 v) { return (1 / length(v)) * v; }

/// One corner after the other, with the library's functions.
Corners enlarged(const Corners& corners, double tolerance) {
    Corners moved{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 p = corners[i];
        const Vec3 left = unit(corners[(i + 1) % 3] - p), right = unit(corners[(i + 2) % 3] - p);
        const double sine = length(Vec3{left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
        const Vec3 between{left.x + right.x, left.y + right.y, left.z + right.z};
        moved[i] = p + (-tolerance / std::max(sine, 1.0 / 16)) * unit(between);
    }
    return moved;
}

TEST(TriangleLanes, PlanesAreThoseOfOneTriangleAfterTheOther) {
    const std::vector<Corners> given = triangles();
    const TriangleSet set(soupOf(given));
    std::size_t next = 0;
    for (std::size_t i = 0; i < given.size(); ++i) {
        const auto& [a, b, c] = given[i];
        const Vec3 across = cross(b - a, c - a);
        const double longest = std::max({length(b - a), length(c - b), length(a - c)});
        const double thin = length(across) / longest;
        if (!(thin > 1e-9)) continue;
        ASSERT_LT(next, set.size());
        EXPECT_EQ(set.source(next), i);
        const Vec3 normal = (1 / length(across)) * across;
        const Plane& plane = set.planes()[next];
        EXPECT_TRUE(plane.normal == normal);
        EXPECT_EQ(plane.offset, normal.x * a.x + normal.y * a.y + normal.z * a.z);
        EXPECT_EQ(set.margins()[next], 2.5 * set.tolerance() / thin);
        ++next;
    }
    EXPECT_EQ(next, set.size());
    EXPECT_LT(next, given.size());  // some are none
}

TEST(TriangleLanes, EnlargedOnesAreThoseOfOneTriangleAfterTheOther) {
    for (const std::size_t left_out : {0U, 1U, 5U}) {
        std::vector<Corners> given = triangles();
        given.resize(given.size() - left_out);
        const TriangleSet set(soupOf(given));
        std::vector<TriangleSet::FloatTriangle> found(set.size());
        set.enlarge(found);
        for (std::size_t i = 0; i < set.size(); ++i) {
            const Corners wanted = enlarged(given[set.source(i)], set.tolerance());
            for (std::size_t k = 0; k < 3; ++k) {
                EXPECT_EQ(found[i][k][0], static_cast<float>(wanted[k].x)) << i;
                EXPECT_EQ(found[i][k][1], static_cast<float>(wanted[k].y)) << i;
                EXPECT_EQ(found[i][k][2], static_cast<float>(wanted[k].z)) << i;
            }
        }
    }
}

}  // namespace triangle_lanes_test
}  // namespace ispace
