// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "trace/test_triangles.h"

namespace ispace {

using namespace testing;

namespace {

/// How far within the triangle a place in its plane lies, negative outside.
double depthIn(const std::array<std::array<float, 3>, 3>& corners, Vec3 normal, Point3 p) {
    double least = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto at = [&](std::size_t k) {
            const auto& [x, y, z] = corners[k % 3];
            return Point3{x, y, z};
        };
        const Vec3 side = at(i + 1) - at(i);
        const double inwards = dot(cross(side, at(i + 2) - at(i)), normal) > 0 ? 1 : -1;
        const double aside = dot(cross(side, p - at(i)), normal) / length(side);
        least = std::min(least, inwards * aside);
    }
    return least;
}

/// Triangles of all shapes, down to needles and caps a hundredth of a micrometre thin.
TriangleSoup allShapes(std::mt19937_64& random) {
    std::uniform_real_distribution<double> place(-5, 5), share(-0.2, 1.2), exponent(-8, 0);
    TriangleSoup soup;
    for (int i = 0; i < 600; ++i) {
        const Point3 p{place(random), place(random), place(random)};
        const Vec3 e = Point3{place(random), place(random), place(random)} - p;
        const Vec3 f = cross(e, {place(random), place(random), place(random)});
        const double thin = std::pow(10, exponent(random));
        const auto a = soup.add(p), b = soup.add(p + e);
        const auto c = soup.add(p + share(random) * e + thin / length(f) * f);
        soup.triangles.push_back({a, b, c});
    }
    return soup;
}

TEST(TriangleSet, EnlargedTrianglesHoldTheirSlack) {
    std::mt19937_64 random(35);
    std::uniform_real_distribution<double> share(0, 1);
    const TriangleSet set(allShapes(random));
    int splinters = 0;
    for (std::size_t i = 0; i < set.size(); ++i) {
        // The halves of a splinter lie behind each other.
        const bool is_splinter = std::isinf(set.margins()[i]);
        const auto first = set.enlarged(i), second = set.enlarged(is_splinter ? ++i : i);
        splinters += is_splinter ? 1 : 0;
        const Vec3 normal = set.planes()[i].normal;
        const Point3 a = set.corner(i, 0), b = set.corner(i, 1), c = set.corner(i, 2);
        for (int k = 0; k < 100; ++k) {
            // Around corners, and about all else.
            double u = k % 2 == 0 ? 0 : share(random), v = k % 4 < 2 ? share(random) : 0;
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const Point3 inside = a + u * (b - a) + v * (c - a);
            const Vec3 out = cross(normal, Vec3{share(random) - 0.5, share(random) - 0.5, 0.4});
            const Point3 p = inside + 0.8 * set.slack() / length(out) * out;
            EXPECT_GE(std::max(depthIn(first, normal, p), depthIn(second, normal, p)), 0)
                << i << ' ' << set.margins()[i];
        }
        // But no more than is needed.
        for (const auto& half : {first, second})
            for (const auto& [x, y, z] : half)
                EXPECT_LE(set.distance(i, {x, y, z}),
                          std::max({length(b - a), length(c - b), length(a - c)}));
    }
    EXPECT_GE(splinters, 200);
    EXPECT_GE(set.size(), 600U + 200);
}

TEST(TriangleSet, SplintersComeTwiceButAreOne) {
    TriangleSoup soup;
    addQuad(soup, {-5, -5, 0}, {10, 0, 0}, {0, 10, 0});
    const auto a = soup.add({0, 0, 1}), b = soup.add({1, 0, 1}), c = soup.add({0, 1e-6, 1});
    soup.triangles.insert(soup.triangles.begin(), {a, b, c});
    soup.triangles.push_back({a, b, a});  // none
    const TriangleSet set(soup);
    ASSERT_EQ(set.size(), 4U);
    for (std::size_t i = 2; i < 4; ++i) {
        EXPECT_EQ(set.meet(i, {{0.5, 2e-7, 3}, {0, 0, -1}, 10}), 2);
        EXPECT_EQ(set.meet(i, {{0.5, 2e-6, 3}, {0, 0, -1}, 10}), kInfinity);
        EXPECT_NEAR(set.distance(i, {0.5, 0, 3}), 2, 1e-12);
    }
}

TEST(TriangleSet, RaysFromAfarAreMetAsFromNearby) {
    std::mt19937_64 random(36);
    std::uniform_real_distribution<double> any(-1, 1);
    TriangleSoup soup;
    addBox(soup, {0, 0, 0}, {1, 1, 1}, 0.4);
    const TriangleSet set(soup);
    for (int i = 0; i < 1000; ++i) {
        const Point3 target{any(random), any(random), any(random)};
        const Vec3 way{any(random), any(random), any(random)};
        const double far = std::pow(10, 7 * std::fabs(any(random)));
        const Vec3 direction = (2 / length(way)) * way;
        const Ray near{target + -3.0 * direction, direction, kInfinity};
        const Ray ray{near.origin + -far * direction, direction, kInfinity};
        const double ahead = set.ball().ahead(ray.origin, direction);
        EXPECT_GE(ahead, 0);
        for (std::size_t k = 0; k < set.size(); ++k) {
            const double met = set.meet(k, near), again = set.meet(k, ray);
            if (std::isinf(met) || std::isinf(again)) {
                EXPECT_EQ(met, again);
            } else {
                EXPECT_NEAR(again - far, met, 1e-8);
                EXPECT_LE(ahead, again);
            }
        }
        EXPECT_EQ(set.ball().ahead(target, direction), 0);
    }
    // Without a direction, and behind.
    EXPECT_EQ(set.ball().ahead({50, 0, 0}, {0, 0, 0}), 0);
    EXPECT_EQ(set.ball().ahead({50, 0, 0}, {1, 0, 0}), 0);
}

}  // namespace

}  // namespace ispace
