// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/body_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

namespace ispace {

namespace body_rays_test {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kNoOwner = MovingBodies::kNoOwner;

MovingBody box(Point2 place, double heading, double length, double width, double bottom,
               double top) {
    MovingBody body;
    body.pose = {place, Angle::degrees(heading)};
    body.half_length = length / 2;
    body.half_width = width / 2;
    body.bottom = bottom;
    body.top = top;
    return body;
}

MovingBody cylinder(Point2 place, double radius, double bottom, double top) {
    MovingBody body;
    body.pose = {place, {}};
    body.radius = radius;
    body.bottom = bottom;
    body.top = top;
    return body;
}

/// A picture as a camera with this pose has it, its focal length as long as it is wide.
RayGrid picture(const Pose3& pose, int columns, int rows) {
    const Vec3 ahead = pose.beam({}), left = pose.beam(Angle::degrees(90));
    const Vec3 up = cross(ahead, left);
    RayGrid grid{{}, (-1.0 / columns) * left, (-1.0 / columns) * up, columns, rows};
    const double i = -0.5 * (columns - 1), j = -0.5 * (rows - 1);
    grid.corner = Point3{} + ahead + i * grid.right + j * grid.down - Point3{};
    return grid;
}

struct View {
    std::vector<float> multiples, cosines;

    explicit View(const RayGrid& grid)
        : multiples(grid.size(), kNoReturn), cosines(grid.size(), 1) {}
    friend bool operator==(const View&, const View&) = default;
};

/// Every body and every pixel.
View viewSlowly(const MovingBodies& bodies, Point3 origin, const RayGrid& grid, double most,
                std::uint32_t own) {
    View view(grid);
    for (const MovingBody& body : bodies.bodies()) {
        if (body.owner == own) continue;
        const BodyFrame from(body, cosSin(body.pose.heading), origin);
        for (std::size_t k = 0; k < grid.size(); ++k) {
            const auto columns = static_cast<std::size_t>(grid.columns);
            const Vec3 ray = grid.ray(static_cast<int>(k % columns), static_cast<int>(k / columns));
            const RayHit met = from.meet(ray);
            const auto multiple = static_cast<float>(met.multiple);
            if (!(multiple <= static_cast<float>(most) && multiple < view.multiples[k])) continue;
            view.multiples[k] = multiple;
            view.cosines[k] =
                std::min(1.0F, static_cast<float>(met.slope / std::sqrt(dot(ray, ray))));
        }
    }
    return view;
}

TEST(BodyPicture, AgreesWithEveryBodyAndPixel) {
    std::mt19937_64 random(41);
    std::uniform_real_distribution<double> unit(0, 1), place(-5, 5), turn(-180, 180);
    std::size_t shortened = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<MovingBody> made;
        for (std::uint32_t i = 0; i < 12; ++i) {
            const double bottom = unit(random) - 0.2, top = bottom + 2 * unit(random);
            made.push_back(
                i % 2 == 0 ? box({place(random), place(random)}, turn(random),
                                 0.1 + 2 * unit(random), 0.1 + unit(random), bottom, top)
                           : cylinder({place(random), place(random)}, unit(random), bottom, top));
            made.back().owner = i / 2;
            if (i % 4 == 3) made.back().lean = unit(random) - 0.5;
            made.back().is_ball = i % 8 == 5;
            if (i % 8 == 5) made.back().top = bottom + 2 * made.back().radius;
        }
        const MovingBodies bodies(made);
        Pose3 pose{{place(random), place(random), 2 * unit(random)},
                   Angle::degrees(turn(random)),
                   Angle::degrees(turn(random) / 2),
                   Angle::degrees(round % 3 == 0 ? turn(random) : 0)};
        // Some stand on a body, in it, or look along its side.
        if (round % 10 == 0)
            pose.position = {made[1].pose.position.x, made[1].pose.position.y, 0.5};
        if (round % 10 == 5) pose.position.z = made[0].top;
        const int columns = 1 + static_cast<int>(40 * unit(random));
        const int rows = 1 + static_cast<int>(30 * unit(random));
        RayGrid grid = picture(pose, columns, rows);
        if (round % 20 == 7) grid.right = {};
        const double most = round % 4 == 0 ? 3 : std::numeric_limits<double>::infinity();
        const std::uint32_t own = round % 2 == 0 ? kNoOwner : 3;
        View view(grid);
        bodies.shorten(pose.position, grid, most, own, view.multiples, view.cosines);
        EXPECT_EQ(view, viewSlowly(bodies, pose.position, grid, most, own)) << round;
        for (const float multiple : view.multiples) shortened += multiple < kNoReturn ? 1 : 0;
    }
    EXPECT_GT(shortened, 10000U);
}

TEST(BodyPicture, OneBodyDoesNotCostAWholeFrame) {
    const Pose3 pose{{0, 0, 1}, {}, {}, {}};
    const RayGrid grid = picture(pose, 640, 480);
    const BodyPicture frame(pose.position, grid, 10, {10, {}, {}});
    const auto area = [&](const MovingBody& body) {
        const PixelBox box = frame.pixelsOf(body, {cosSin(body.pose.heading), body.reach()});
        return std::max(0, box.right - box.left) * std::max(0, box.bottom - box.top);
    };
    // 0.4 m seen at 4 m by a lens of 640 pixels: a tenth of the width, and its near face a little
    // more.
    const int small = area(cylinder({4, 0}, 0.2, 0.9, 1.1));
    EXPECT_GE(small, 64 * 32);
    EXPECT_LE(small, 70 * 36);
    EXPECT_EQ(area(cylinder({-4, 0}, 0.2, 0, 2)), 0);
    EXPECT_EQ(area(cylinder({4, 8}, 0.2, 0, 2)), 0);
    EXPECT_EQ(area(cylinder({0.1, 0}, 0.2, 0, 2)), 640 * 480);
    EXPECT_GT(area(box({0, -1}, 0, 4, 0.1, 0, 2)), 100);  // from behind the picture to its front
}

TEST(BodyPicture, CosinesOfFacesAndRounds) {
    const MovingBodies bodies({box({3, 0}, 0, 1, 1, 0, 1), cylinder({0, 3}, 0.5, 0, 1)});
    const auto cosine = [&](Point3 origin, Vec3 way) {
        const Vec3 d = (1 / length(way)) * way;
        const Directions one{{d.x}, {d.y}, {d.z}};
        float range = kNoReturn, found = -1;
        bodies.shorten(origin, one, 10, kNoOwner, {&range, 1}, {&found, 1});
        float moved = kNoReturn, again = -1;
        bodies.shorten({&origin, 1}, one, 0, 1, 10, kNoOwner, {&moved, 1}, {&again, 1});
        EXPECT_EQ(moved, range);
        EXPECT_EQ(again, found);
        const RayGrid grid{way, {1, 0, 0}, {0, 1, 0}, 1, 1};
        View view(grid);
        bodies.shorten(origin, grid, 100, kNoOwner, view.multiples, view.cosines);
        EXPECT_NEAR(view.multiples[0] * length(way), range, 1e-6);
        EXPECT_NEAR(view.cosines[0], found, 1e-6);
        return found;
    };
    EXPECT_NEAR(cosine({0, 0, 0.5}, {2, 0, 0}), 1, 1e-7);
    EXPECT_NEAR(cosine({0, 0, 0.5}, {2, 0.2, 0}), 1 / std::sqrt(1.01), 1e-7);
    EXPECT_NEAR(cosine({3, 0, 2}, {0.1, 0, -1}), 1 / std::sqrt(1.01), 1e-7);
    EXPECT_NEAR(cosine({3, 2, 0.5}, {0.1, -1, 0.1}), 1 / std::sqrt(1.02), 1e-7);
    // A quarter of its width beside the axis of the round: the angle whose sine is a half.
    EXPECT_NEAR(cosine({0.25, 0, 0.5}, {0, 3, 0}), std::sqrt(0.75), 1e-7);
    EXPECT_NEAR(cosine({0.25, 0, 0}, {0, 3, 0.3}), std::sqrt(0.75) / std::sqrt(1.01), 1e-7);
    EXPECT_NEAR(cosine({0.1, 3, 3}, {0, 0, -2}), 1, 1e-7);
    // Rays with a nearer hit, and rays that miss the body, keep their range.
    const Directions one{{1}, {0}, {0}};
    for (const float nearer : {2.0F, 2.5F}) {
        float range = nearer, kept = 0.25F;
        bodies.shorten({0, 0, 0.5}, one, 10, kNoOwner, {&range, 1}, {&kept, 1});
        EXPECT_EQ(range, nearer);
        EXPECT_EQ(kept, 0.25F);
    }
}

TEST(MovingBodies, OriginsOfEachRay) {
    std::mt19937_64 random(42);
    std::uniform_real_distribution<double> place(-3, 3), any(-1, 1);
    for (int round = 0; round < 50; ++round) {
        MovingBody slanted = cylinder({place(random), place(random)}, 0.2, 0.1, 2);
        slanted.lean = any(random);
        MovingBody ball = cylinder({place(random), place(random)}, 0.4, 0.2, 1);
        ball.is_ball = true;
        const MovingBodies bodies({box({place(random), place(random)}, 20, 1, 2, 0, 1),
                                   cylinder({place(random), place(random)}, 0.5, 0.2, 1.5), slanted,
                                   ball});
        Directions directions;
        directions.resize(100);
        std::vector<Point3> origins;
        for (std::size_t k = 0; k < 100; ++k) {
            Vec3 way{any(random), any(random), round % 2 == 0 ? 0 : 0.3 * any(random)};
            // Of those that turn, most pass by both sides of all rays together.
            const Vec2 turned =
                unitVector(Angle::degrees(0.7 * static_cast<double>(k) + 7 * round));
            if (round % 4 >= 2) way = {turned.x, turned.y, way.z};
            directions.set(k, (1 / length(way)) * way);
            origins.push_back({0.01 * static_cast<double>(k), 0.3, 0.5});
        }
        std::vector<float> ranges(100, kNoReturn), cosines(100, 1);
        const auto begin = static_cast<std::size_t>(round % 3);
        const std::size_t end = 100 - begin;
        bodies.shorten(origins, directions, begin, end, 4, kNoOwner, ranges, cosines);
        for (std::size_t k = begin; k < end; ++k) {
            float range = kNoReturn, cosine = 1;
            const Vec3 d = directions[k];
            bodies.shorten(origins[k], Directions{{d.x}, {d.y}, {d.z}}, 4, kNoOwner, {&range, 1},
                           {&cosine, 1});
            EXPECT_EQ(ranges[k], range);
            EXPECT_EQ(cosines[k], cosine);
        }
    }
}

TEST(MovingBodies, Between) {
    MovingBody mine = cylinder({3, 0}, 0.5, 0, 1);
    mine.owner = 4;
    const MovingBodies bodies({mine, box({0, 5}, 0, 1, 1, 0, 1)});
    EXPECT_TRUE(bodies.between({0, 0, 0.5}, {6, 0, 0.5}, kNoOwner));
    EXPECT_TRUE(bodies.between({6, 0, 0.5}, {0, 0, 0.5}, kNoOwner));
    EXPECT_FALSE(bodies.between({0, 0, 0.5}, {6, 0, 0.5}, 4));
    EXPECT_FALSE(bodies.between({0, 0, 0.5}, {2.49, 0, 0.5}, kNoOwner));
    EXPECT_TRUE(bodies.between({0, 0, 0.5}, {2.5, 0, 0.5}, kNoOwner));
    EXPECT_FALSE(bodies.between({4, 0, 0.5}, {6, 0, 0.5}, kNoOwner));
    EXPECT_FALSE(bodies.between({0, 0, 1.2}, {6, 0, 1.2}, kNoOwner));
    EXPECT_TRUE(bodies.between({0, 0, 0}, {6, 0, 1.6}, kNoOwner));     // through its side
    EXPECT_FALSE(bodies.between({0, 0, 2}, {2.9, 0, 1.1}, kNoOwner));  // ends over it
    EXPECT_TRUE(bodies.between({3, 0, 3}, {3, 0, 0.5}, kNoOwner));     // from above into it
    EXPECT_TRUE(bodies.between({3, 0, 0.4}, {3, 0.1, 0.5}, kNoOwner));
    EXPECT_TRUE(bodies.between({0, 0, 0.5}, {0, 9, 0.5}, 4));
    EXPECT_FALSE(MovingBodies().between({0, 0, 0}, {1, 0, 0}, kNoOwner));
}

TEST(MovingBodies, BetweenAsEachBodyAlone) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-9, 9), height(0, 2), turn(0, 6);
    for (int round = 0; round < 20; ++round) {
        std::vector<MovingBody> all;
        for (int i = 0; i < 8 * round; ++i) {
            const Point2 at{place(random), place(random)};
            all.push_back(i % 2 == 0 ? cylinder(at, 0.1, 0, height(random))
                                     : box(at, turn(random), 0.3, 0.1, 0, height(random)));
            all.back().owner = static_cast<std::uint32_t>(i / 3);
        }
        const MovingBodies bodies(all);
        for (int k = 0; k < 200; ++k) {
            const Point3 a{place(random), place(random), height(random)};
            // Some along an axis, some beyond all bodies.
            const double far = k % 5 == 0 ? 3 : 1;
            const Point3 b{k % 7 == 0 ? a.x : far * place(random),
                           k % 7 == 1 ? a.y : far * place(random), height(random)};
            const auto own = static_cast<std::uint32_t>(k % 4);
            const bool is_between = std::any_of(all.begin(), all.end(), [&](const MovingBody& one) {
                return MovingBodies({one}).between(a, b, own);
            });
            EXPECT_EQ(bodies.between(a, b, own), is_between) << round << ' ' << k;
        }
    }
}

TEST(MovingBodies, VisitsOnlyBodiesAlongASegment) {
    std::vector<MovingBody> all;
    all.reserve(10'000);
    for (int row = 0; row < 100; ++row)
        for (int column = 0; column < 100; ++column)
            all.push_back(cylinder({column + 0.5, row + 0.5}, 0.1, 0, 1));
    const MovingBodies bodies(all);
    for (const auto& [a, b] : {std::pair<Point3, Point3>{{0, 0, 0.5}, {100, 100, 0.5}},
                               {{100, 3, 0.5}, {0, 4, 0.5}},
                               {{7, 100, 0.5}, {7, 0, 0.5}}}) {
        std::size_t visited = 0;
        EXPECT_FALSE(bodies.anyAlong(a, b, [&visited](std::size_t /*i*/) {
            ++visited;
            return false;
        }));
        EXPECT_GT(visited, 90U);
        EXPECT_LT(visited, 700U);
        std::size_t first = 0;
        EXPECT_TRUE(bodies.anyAlong(a, b, [&first](std::size_t /*i*/) { return ++first > 0; }));
        EXPECT_EQ(first, 1U);
    }
    const std::vector<std::uint32_t> near = bodies.bodiesNear({50, 50}, 3);
    EXPECT_GE(near.size(), 36U);
    EXPECT_LE(near.size(), 100U);
    EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
}

}  // namespace body_rays_test

}  // namespace ispace
