// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "support/test_triangles.h"

namespace ispace {

using namespace testing;

namespace embree_scene_test {

/// A globe with bumps; its triangles share positions, but no vertices.
void addGlobe(TriangleSoup& soup, Point3 middle, int rings, int sectors, std::mt19937_64& random) {
    std::uniform_real_distribution<double> bump(0.45, 0.55);
    std::vector<Point3> places;
    for (int i = 0; i <= rings; ++i) {
        for (int k = 0; k < sectors; ++k) {
            const double a = std::numbers::pi * (i + 0.5) / (rings + 1);
            const double b = 2 * std::numbers::pi * k / sectors, radius = bump(random);
            places.push_back(middle + radius * Vec3{std::sin(a) * std::cos(b),
                                                    std::sin(a) * std::sin(b), std::cos(a)});
        }
    }
    const auto at = [&](int i, int k) {
        return soup.add(places[static_cast<std::size_t>(i) * static_cast<std::size_t>(sectors) +
                               static_cast<std::size_t>(k % sectors)]);
    };
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < sectors; ++k) {
            soup.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k)});
            soup.triangles.push_back({at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
        }
    }
}

/// A room 8 m by 6 m with boxes, globes and round bodies that touch no other.
TriangleSoup furnished() {
    std::mt19937_64 random(30);
    TriangleSoup soup;
    addBox(soup, {0, 0, 1.25}, {4, 3, 1.25}, 0);
    for (int i = 0; i < 4; ++i) {
        addBox(soup, {2.0 * i - 3, -1.5, 0.8}, {0.4, 0.3, 0.4}, 0.7 * i);
        addGlobe(soup, {2.0 * i - 3, 1.5, 1}, 12, 18, random);
        soup.rounds.push_back(
            {Ellipse({2.0 * i - 3, 0.3}, 0.9, 0.3 + 0.2 * i, Angle::degrees(25.0 * i)), 0.3 * i,
             1.1 + 0.2 * i});
    }
    return soup;
}

/// Beams of all kinds: any directions, neighbours, through edges, through corners.
void aimAll(Beams& beams, const TriangleSoup& soup, Point3 origin, int kind,
            std::mt19937_64& random) {
    std::uniform_real_distribution<double> any(-1, 1), hair(-1e-7, 1e-7);
    const Vec3 ahead{any(random), any(random), any(random)}, aside{any(random), any(random), 0.1};
    for (std::size_t k = 0; k < beams.ranges.size(); ++k) {
        const auto& [a, b, c] = soup.triangles[random() % soup.triangles.size()];
        const Point3 p = soup.vertices[a], q = soup.vertices[b];
        const double share = kind == 2 ? 0.5 + 0.5 * any(random) : 0;
        const double off = k % 3 == 0 ? 0 : hair(random);
        if (kind == 0)
            beams.aim(k, {any(random), any(random), any(random)});
        else if (kind == 1)
            beams.aim(k, Point3{} + ahead + 0.001 * static_cast<double>(k) * aside - Point3{});
        else
            beams.aim(k, (p + share * (q - p)) + Vec3{off, -off, off} - origin);
    }
}

TEST(EmbreeScene, EveryWidthFindsTheSameAsAllTrianglesInDoubles) {
    const TriangleSoup soup = furnished();
    const TriangleSet set(soup);
    std::vector<EmbreeScene> scenes;
    for (const int width : kWidths) scenes.emplace_back(soup, kTouching, width);
    std::mt19937_64 random(31);
    std::uniform_real_distribution<double> x(-3.9, 3.9), y(-2.9, 2.9), z(0.1, 2.4);
    for (int i = 0; i < 80; ++i) {
        const Point3 origin{x(random), y(random), z(random)};
        Beams beams(997);
        aimAll(beams, soup, origin, i % 4, random);
        for (const EmbreeScene& scene : scenes) {
            beams.cast(scene, origin);
            for (std::size_t k = 0; k < 997; k += 10) {
                const Ray ray{origin, beams.directions[k], 60};
                if (beams.ranges[k] == static_cast<float>(bruteForce(set, ray))) continue;
                // A ray at a rim hits the surface on one of its sides.
                EXPECT_GE(i % 4, 2) << i << ' ' << k;
                EXPECT_TRUE(isWithinTolerance(set, ray, beams.ranges[k], set.tolerance()))
                    << i << ' ' << k;
            }
        }
    }
}

TEST(EmbreeScene, ARayDoesNotDependOnItsPacket) {
    const TriangleSoup soup = furnished();
    const TriangleSet set(soup);
    const EmbreeScene scene(soup, kTouching, 0);
    std::mt19937_64 random(32);
    for (int kind = 0; kind < 4; ++kind) {
        const Point3 origin{0.3, -0.2, 1.1};
        Beams all(500);
        aimAll(all, soup, origin, kind, random);
        all.cast(scene, origin);
        for (std::size_t k = 0; k < 500; ++k) {
            Beams one(1);
            one.directions.set(0, all.directions[k]);
            one.cast(scene, origin);
            if (one.ranges[0] == all.ranges[k] && one.cosines[0] == all.cosines[k]) continue;
            EXPECT_GE(kind, 2);  // aimed at a rim
            const Ray ray{origin, all.directions[k], 60};
            EXPECT_TRUE(isWithinTolerance(set, ray, one.ranges[0], set.tolerance()));
            EXPECT_TRUE(isWithinTolerance(set, ray, all.ranges[k], set.tolerance()));
        }
    }
}

TEST(EmbreeScene, PlanesAreMetToTheLastBit) {
    TriangleSoup soup;
    addBox(soup, {0, 0, 0}, {4, 3, 2}, 0);
    const EmbreeScene scene(soup, kTouching, 0);
    std::mt19937_64 random(33);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 200; ++i) {
        const Point3 origin{3.9 * any(random), 2.9 * any(random), 1.9 * any(random)};
        Beams beams(100);
        for (std::size_t k = 0; k < 100; ++k)
            beams.aim(k, {any(random), any(random), 0.01 * any(random)});
        beams.cast(scene, origin);
        for (std::size_t k = 0; k < 100; ++k) {
            const Vec3 d = beams.directions[k];
            const double walls[] = {((d.x > 0 ? 4 : -4) - origin.x) / d.x,
                                    ((d.y > 0 ? 3 : -3) - origin.y) / d.y,
                                    ((d.z > 0 ? 2 : -2) - origin.z) / d.z};
            const double* const first = std::min_element(walls, walls + 3);
            EXPECT_NEAR(beams.ranges[k], *first, 3e-7 * *first);
            const double cosines[] = {std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
            EXPECT_NEAR(beams.cosines[k], cosines[first - walls], 1e-6);
        }
    }
}

TEST(EmbreeScene, FarAndNearEndsOfRays) {
    TriangleSoup soup;
    addBox(soup, {0, 0, 0}, {1, 1, 1}, 0);
    const EmbreeScene scene(soup, kTouching, 0);
    Beams one(1);
    one.aim(0, {1, 0, 0});
    one.cast(scene, {}, 1);
    EXPECT_EQ(one.ranges[0], 1);
    one.cast(scene, {}, 1 - 1e-7);  // within the slack, but written as no more
    EXPECT_EQ(one.ranges[0], static_cast<float>(1 - 1e-7));
    one.cast(scene, {}, 1 - 1e-5);
    EXPECT_EQ(one.ranges[0], kNoReturn);
    EXPECT_EQ(one.cosines[0], 1);
    one.cast(scene, {}, kInfinity);
    EXPECT_EQ(one.ranges[0], 1);
    one.cast(scene, {2, 0, 0}, kInfinity);
    EXPECT_EQ(one.ranges[0], kNoReturn);
    // From the surface, along it, and from a little beyond.
    one.cast(scene, {-1, 0.1, 0.2});
    EXPECT_EQ(one.ranges[0], 2);
    one.cast(scene, {-1 - 0.9e-4, 0.1, 0.2});
    EXPECT_NEAR(one.ranges[0], 2 + 0.9e-4, 1e-6);
    one.cast(scene, {-1 - 1.1e-4, 0.1, 0.2});
    EXPECT_NEAR(one.ranges[0], 1.1e-4, 1e-9);
    one.cast(scene, {0.1, 1, 0.2});
    EXPECT_NEAR(one.ranges[0], 0.9, 1e-7);
}

TEST(EmbreeScene, OriginsOfEachRay) {
    const TriangleSoup soup = furnished();
    const EmbreeScene scene(soup, kTouching, 0);
    std::mt19937_64 random(34);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 40; ++i) {
        // Free, along a wall at its contact distance, from one side of it to the other, and in
        // runs of equal origins, of which one touches it.
        const Point3 begin =
            i % 4 == 0 ? Point3{2 * any(random), 0, 1} : Point3{-4, any(random), 1};
        const int run = i % 4 == 3 ? 5 : 1;
        const Vec3 step{i % 4 == 2 ? 2e-6 : i % 4 == 3 ? 0.01 : 0, 1e-4 * any(random), 0};
        Beams moving(211), still(1);
        aimAll(moving, soup, begin, 0, random);
        std::vector<Point3> origins;
        origins.reserve(211);
        for (int k = 0; k < 211; ++k)
            origins.push_back(begin + static_cast<double>((k - 105) / run) * step);
        scene.cast(origins, moving.directions, 60, {moving.ranges, moving.cosines});
        for (std::size_t k = 0; k < origins.size(); ++k) {
            still.directions.set(0, moving.directions[k]);
            still.cast(scene, origins[k]);
            EXPECT_EQ(moving.ranges[k], still.ranges[0]) << i << ' ' << k;
            EXPECT_EQ(moving.cosines[k], still.cosines[0]) << i << ' ' << k;
        }
    }
}

TEST(EmbreeScene, PicturesOfAnySizeAreTheirRays) {
    const TriangleSoup soup = furnished();
    const EmbreeScene scene(soup, kTouching, 0);
    const std::pair<int, int> sizes[] = {{1, 1}, {17, 3}, {3, 17}, {4, 4}, {64, 50}, {1, 100}};
    for (const auto& [columns, rows] : sizes) {
        for (const Point3 origin : {Point3{0, 0, 1}, Point3{-4, 0.3, 1.2}}) {
            const RayGrid grid{
                {2, 1.0307, 0.6113}, {0, -2.0 / columns, 0}, {0, 0, -1.5 / rows}, columns, rows};
            std::vector<float> multiples(grid.size(), -1), cosines(grid.size(), -1);
            scene.cast(origin, grid, 100, {multiples, cosines});
            Beams beams(grid.size());
            std::size_t next = 0;
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column)
                    beams.aim(next++, grid.ray(column, row));
            beams.cast(scene, origin, 1000);
            for (std::size_t k = 0; k < grid.size(); ++k) {
                const auto column = static_cast<int>(k) % columns;
                const double size = length(grid.ray(column, static_cast<int>(k) / columns));
                EXPECT_NEAR(multiples[k] * size, beams.ranges[k], 1e-6 * beams.ranges[k]);
                EXPECT_NEAR(cosines[k], beams.cosines[k], 1e-6);
            }
            // The same without cosines, on one thread, and with the depth as the limit.
            std::vector<float> again(grid.size(), -1);
            const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
            scene.cast(origin, grid, 100, {again, {}});
            EXPECT_EQ(again, multiples);
            scene.cast(origin, grid, 1.5, {again, {}});
            for (std::size_t k = 0; k < grid.size(); ++k)
                EXPECT_EQ(again[k], multiples[k] <= 1.5F ? multiples[k] : kNoReturn);
        }
    }
}

TEST(EmbreeScene, SightEndsWhereItIsTold) {
    TriangleSoup soup;
    addBox(soup, {0, 0, 0}, {1, 1, 1}, 0);
    const EmbreeScene scene(soup, kTouching, 0);
    std::vector<Point3> targets;
    targets.reserve(20);
    for (int i = 0; i < 20; ++i) targets.push_back({0.2, 0.1 * i + 0.05, 0.1});
    std::vector<std::uint8_t> seen(20, 7);
    scene.query({0.2, 0, 0.1}, targets, seen);
    for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(seen[i], targets[i].y < 1 ? 1 : 0);
}

TEST(EmbreeScene, ManyRoundBodiesStopRaysAsFewDo) {
    const TriangleSoup few = furnished();
    TriangleSoup many = few;
    for (int i = 0; i < 200; ++i)
        many.rounds.push_back({Ellipse({0.01 * i, 0}, 2, 2, {}), -0.2, -0.1});
    std::mt19937_64 random(35);
    std::uniform_real_distribution<double> x(-3.9, 3.9), y(-2.9, 2.9), z(0.1, 2.4);
    for (const int width : kWidths) {
        const EmbreeScene scene(few, kTouching, width), other(many, kTouching, width);
        for (int i = 0; i < 40; ++i) {
            const Point3 origin{x(random), y(random), z(random)};
            Beams beams(997);
            aimAll(beams, few, origin, i % 2, random);
            Beams again = beams;
            beams.cast(scene, origin);
            again.cast(other, origin);
            EXPECT_EQ(again.ranges, beams.ranges) << i;
            EXPECT_EQ(again.cosines, beams.cosines) << i;
            other.cast(origin, beams.directions, 60, {again.ranges, {}});
            EXPECT_EQ(again.ranges, beams.ranges) << i;
            std::vector<Point3> targets;
            for (std::size_t k = 0; k < 997; ++k)
                targets.push_back(origin + 3 * beams.directions[k]);
            std::vector<std::uint8_t> seen(997), seen_again(997);
            scene.query(origin, targets, seen);
            other.query(origin, targets, seen_again);
            EXPECT_EQ(seen_again, seen) << i;
        }
    }
}

TEST(EmbreeScene, RoundBodiesStopRaysOnTheirCurves) {
    TriangleSoup soup;
    addQuad(soup, {3, -2, -1}, {0, 4, 0}, {0, 0, 4});
    addQuad(soup, {1, -1, 1}, {1, 0, 0}, {0, 2, 0});  // at the height of the body's top
    soup.rounds.push_back({Ellipse({0, 0}, 1, 1, {}), 0, 1});
    // Alone, and among so many that they are a tree of their own.
    TriangleSoup many = soup;
    for (int i = 0; i < 200; ++i) many.rounds.push_back({Ellipse({9, 9}, 1, 1, {}), -3, -2});
    EXPECT_EQ(TriangleSet(soup).rounds().size(), 0U);
    EXPECT_EQ(TriangleSet(many).rounds().size(), 201U);
    for (const bool is_few : {true, false})
        for (const int width : kWidths) {
            const EmbreeScene scene(is_few ? soup : many, kTouching, width);
            const auto expect = [&](Point3 origin, Vec3 way, float range, float cosine) {
                // As a packet of their like, and alone; with an origin for each.
                for (const std::size_t count : {std::size_t{1}, std::size_t{17}}) {
                    Beams beams(count);
                    for (std::size_t k = 0; k < count; ++k) beams.aim(k, way);
                    beams.cast(scene, origin);
                    EXPECT_NEAR(beams.ranges.back(), range, 1e-6 * range) << width;
                    EXPECT_NEAR(beams.cosines.back(), cosine, 1e-6) << width;
                    std::vector<float> plain(count), own(count);
                    scene.cast(origin, beams.directions, 60, {plain, {}});
                    EXPECT_EQ(plain, beams.ranges);
                    scene.cast(std::vector<Point3>(count, origin), beams.directions, 60, {own, {}});
                    EXPECT_EQ(own, beams.ranges);
                    const Point3 target = origin + (0.999 * range) * beams.directions[0];
                    std::uint8_t seen = 7;
                    scene.query(origin, {&target, 1}, {&seen, 1});
                    EXPECT_EQ(seen, 1);
                }
            };
            expect({-2, 0, 0.5}, {1, 0, 0}, 1.5F, 1);
            expect({-2, 0.3, 0.5}, {1, 0, 0}, 1.6F, 0.8F);
            expect({-2, 0.5, 0.5}, {1, 0, 0}, 2, 0);  // a tangent
            expect({-2, 0.5 + 1e-9, 0.5}, {1, 0, 0}, 5, 1);
            expect({0, 0, 3}, {0, 0, -1}, 2, 1);
            expect({-2, 0, 1 + 1e-9}, {1, 0, 0}, 5, 1);  // over it, and the sheet seen edge-on
            expect({0.1, 0, 0.5}, {1, 0, 0}, 0.4F, 1);   // from inside
            expect({0.5, 0, 0.5}, {-1, 0, 0}, 1, 1);     // from its side, through it
            expect({0.5, 0, 0.5}, {1, 0, 0}, 2.5F, 1);
            // From its top, whose plane the sheet continues.
            expect({0.2, 0, 1 + 9e-5}, {1, 0, -6e-5}, 2.8F, 1);
            expect({0.2, 0, 1 + 2e-4}, {1, 0, -1.5e-4}, 2e-4F / 1.5e-4F, 1.5e-4F);
        }
}

TEST(EmbreeScene, EmptyOrWithoutAreaStopsNothing) {
    TriangleSoup points;
    for (int i = 0; i < 3; ++i) points.add({1, 0, 0});
    points.triangles.push_back({0, 1, 2});
    for (const TriangleSoup& soup : {TriangleSoup(), points}) {
        const EmbreeScene scene(soup, kTouching, 0);
        Beams one(3);
        for (std::size_t k = 0; k < 3; ++k) one.aim(k, {1, 0, 0});
        one.cast(scene, {});
        EXPECT_EQ(one.ranges, std::vector<float>(3, kNoReturn));
        EXPECT_EQ(one.cosines, std::vector<float>(3, 1));
        const std::vector<Point3> origins(3);
        scene.cast(origins, one.directions, 5, {one.ranges, {}});
        EXPECT_EQ(one.ranges, std::vector<float>(3, kNoReturn));
        std::vector<float> picture(6);
        scene.cast({}, RayGrid{{1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}, 3, 2}, 5, {picture, {}});
        EXPECT_EQ(picture, std::vector<float>(6, kNoReturn));
    }
}

}  // namespace embree_scene_test

}  // namespace ispace
