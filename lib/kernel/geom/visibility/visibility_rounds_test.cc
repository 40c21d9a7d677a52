// SPDX-License-Identifier: GPL-3.0-or-later
// What is seen past round bodies, against closed forms and dense rays.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/test_visibility.h"

namespace ispace {
namespace visibility_rounds_test {

using test::expectSound;
using test::kInfinity;

std::vector<Segment2> room(double width, double depth) {
    std::vector<Segment2> lines;
    forEachEdge(Polygon{{0, 0}, {width, 0}, {width, depth}, {0, depth}},
                [&](const Segment2& line) { lines.push_back(line); });
    return lines;
}

/// Distance along a unit vector to where a ray from outside enters the ellipse.
double entry(const Ellipse& round, Point2 from, Vec2 ray) {
    const Vec2 q = round.toUnit(from - round.center), d = round.toUnit(ray);
    const double a = dot(d, d), b = dot(q, d), root = a - cross(q, d) * cross(q, d);
    if (root < 0 || b > 0) return kInfinity;
    return (-b - std::sqrt(root)) / a;
}

/// The area of a room seen past one ellipse that stands clear of its walls, in closed form.
double areaPast(const Ellipse& round, Point2 v, double width, double depth) {
    const Vec2 q = round.toUnit(v - round.center);
    const double squared = dot(q, q), half = std::acos(1 / std::sqrt(squared));
    const Vec2 foot = (1 / squared) * q;
    const Vec2 aside = std::sqrt(squared - 1) / squared * perpendicular(q);
    const Vec2 right = round.center + round.fromUnit(foot + aside) - v;
    const Vec2 left = round.center + round.fromUnit(foot - aside) - v;
    // The room less the wedge between both tangents, plus what lies before the body: a kite less a
    // sector of the disc.
    const auto at_wall = [&](Vec2 way) {
        const double x = way.x > 0 ? (width - v.x) / way.x : -v.x / way.x;
        const double y = way.y > 0 ? (depth - v.y) / way.y : -v.y / way.y;
        return v + std::min(x, y) * way;
    };
    Polygon wedge{v, at_wall(right)};
    std::vector<Point2> corners{{0, 0}, {width, 0}, {width, depth}, {0, depth}};
    std::erase_if(corners,
                  [&](Point2 p) { return cross(right, p - v) <= 0 || cross(p - v, left) <= 0; });
    std::sort(corners.begin(), corners.end(),
              [&](Point2 a, Point2 b) { return cross(a - v, b - v) > 0; });
    wedge.insert(wedge.end(), corners.begin(), corners.end());
    wedge.push_back(at_wall(left));
    const double before = round.half_length * round.half_width * (std::sqrt(squared - 1) - half);
    return width * depth - signedArea(wedge) + before;
}

TEST(VisibilityRounds, AreaPastOneIsClosedForm) {
    std::mt19937_64 random(20);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    double worst = 0;
    for (int i = 0; i < 3000; ++i) {
        const double width = uniform(4, 12), depth = uniform(4, 12);
        const double radius = std::exp(uniform(std::log(0.05), 0));
        const double other = i % 3 == 0 ? radius * uniform(0.2, 1) : radius;
        const Ellipse round({uniform(radius, width - radius), uniform(radius, depth - radius)},
                            2 * radius, 2 * other, Angle::degrees(uniform(0, 360)));
        Point2 v{uniform(0.01, width - 0.01), uniform(0.01, depth - 0.01)};
        if (i % 7 == 0)  // close to the body
            v = round.center +
                round.fromUnit((1 + uniform(0.002, 0.1)) * unitVector(Angle::degrees(i)));
        if (round.heightOf(v) < 2e-4 || v.x < 0.001 || v.y < 0.001 || v.x > width - 0.001 ||
            v.y > depth - 0.001)
            continue;
        const VisibilityMap map(room(width, depth), {&round, 1});
        const VisibleRegion seen = map.query(v, i % 2 == 0 ? 50 : kInfinity);
        expectSound(seen);
        const double error = std::fabs(area(seen) - areaPast(round, v, width, depth));
        EXPECT_LE(error, 1e-6) << i << ' ' << radius << ' ' << other;
        worst = std::max(worst, error);
    }
    RecordProperty("worst_e9", static_cast<int>(worst * 1e9));
}

/// The area by dense rays that lines and rounds stop.
double byRays(const std::vector<Segment2>& lines, const std::vector<Ellipse>& rounds, Point2 v,
              double range, int rays) {
    return test::areaByRays(rays, [&](Vec2 ray) {
        double reach = test::reachAlong(lines, v, ray, range);
        for (const Ellipse& round : rounds) reach = std::min(reach, entry(round, v, ray));
        return reach;
    });
}

TEST(VisibilityRounds, ManyThatHideAndCutEachOther) {
    std::mt19937_64 random(21);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 40; ++i) {
        std::vector<Segment2> lines = room(8, 6);
        lines.push_back({{uniform(0, 8), uniform(0, 6)}, {uniform(0, 8), uniform(0, 6)}});
        std::vector<Ellipse> rounds;
        for (int k = 0; k < 12; ++k) {
            const double size = uniform(0.1, 1.5);
            // Some stand in walls, some across the line, some in others.
            rounds.emplace_back(Point2{uniform(0, 8), uniform(0, 6)}, size,
                                k % 2 == 0 ? size : uniform(0.1, 1) * size,
                                Angle::degrees(uniform(0, 360)));
        }
        const Point2 v{uniform(0.1, 7.9), uniform(0.1, 5.9)};
        bool is_clear = distance(v, lines.back()) > 0.01;
        for (const Ellipse& round : rounds) is_clear = is_clear && round.heightOf(v) > 0.001;
        if (!is_clear) continue;
        const double range = i % 2 == 0 ? 20 : uniform(1, 5);
        const VisibleRegion seen = VisibilityMap(lines, rounds).query(v, range);
        expectSound(seen);
        constexpr int kRays = 400'000;
        EXPECT_NEAR(area(seen), byRays(lines, rounds, v, range, kRays), 4e-4) << i;
    }
}

TEST(VisibilityRounds, BehindWallsAndInTheirGap) {
    std::mt19937_64 random(23);
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int i = 0; i < 30; ++i) {
        const double gap = uniform(0, 5);
        std::vector<Segment2> lines = room(12, 6);
        lines.push_back({{5, 0}, {uniform(5, 7), gap}});
        lines.push_back({{uniform(5, 7), gap + 1}, {7, 6}});
        const Point2 v{uniform(0.1, 4.9), uniform(0.1, 5.9)};
        std::vector<Ellipse> rounds;
        while (rounds.size() < 40) {
            const Ellipse round({uniform(0.5, 11.5), uniform(0.5, 5.5)}, uniform(0.1, 0.9),
                                uniform(0.1, 0.9), Angle::degrees(uniform(0, 360)));
            if (round.heightOf(v) > 0.05) rounds.push_back(round);
        }
        const VisibleRegion seen = VisibilityMap(lines, rounds).query(v, 9);
        expectSound(seen);
        EXPECT_NEAR(area(seen), byRays(lines, rounds, v, 9, 20'000), 0.01) << i;
    }
}

TEST(VisibilityRounds, WithinRangeOnly) {
    // A disc that the greatest range just reaches, passes through, and does not reach.
    const Ellipse disc({3, 0}, 2, 2, {});
    const std::vector<Segment2> walls = room(0.5, 0.5);
    const VisibilityMap map({}, {&disc, 1});
    EXPECT_NEAR(area(map.query({0, 0}, 1.9)), std::numbers::pi * 1.9 * 1.9, 1e-9);
    EXPECT_NEAR(area(map.query({0, 0}, 2)), std::numbers::pi * 4, 1e-6);
    // Both circles cut out a lens: r = 1 about (3, 0), R = 2.5 about the viewpoint; and nothing
    // lies in the body's shadow nearer than R but between lens and tangents.
    const VisibleRegion seen = map.query({0, 0}, 2.5);
    expectSound(seen);
    const double a = std::acos((9 + 2.5 * 2.5 - 1) / (2 * 3 * 2.5));
    const double b = std::acos((9 + 1 - 2.5 * 2.5) / (2 * 3));
    const double lens = 2.5 * 2.5 * (a - std::sin(2 * a) / 2) + (b - std::sin(2 * b) / 2);
    EXPECT_NEAR(area(seen), std::numbers::pi * 2.5 * 2.5 - lens, 1e-6);
}

TEST(VisibilityRounds, TouchingAWall) {
    // Half of a disc of 0.5 m stands in the room, or all of it, in contact with the wall.
    for (const double y : {0.0, 0.5}) {
        const Ellipse disc({4, y}, 1, 1, {});
        const VisibilityMap map(room(8, 6), {&disc, 1});
        const VisibleRegion seen = map.query({4, 5}, 20);
        expectSound(seen);
        const double far = 5 - y, reach = std::sqrt(far * far - 0.25);
        const double turn = std::asin(0.5 / far);
        // Of the strip below each tangent there is a triangle, up to where it meets the wall.
        const double wedge = 25 * std::tan(turn);
        const double before = 0.5 * reach - 0.25 * std::acos(0.5 / far);
        const double expected = y == 0 ? 0 : 48 - wedge + before;
        if (y > 0) {
            EXPECT_NEAR(area(seen), expected, 1e-6);
        } else {
            EXPECT_NEAR(area(seen), 48 - wedge + before, 1e-6);
        }
    }
}

TEST(VisibilityRounds, FromItsSurface) {
    const Ellipse disc({4, 3}, 1, 1, Angle::degrees(10));
    const VisibilityMap map(room(8, 6), {&disc, 1});
    for (const double height : {0.0, 5e-5, -5e-5, 9.9e-5}) {
        const VisibleRegion seen = map.query({4, 3.5 + height}, 20);
        expectSound(seen);
        // The half of the room on this side of the tangent; and the inside of the body.
        const double free = 8 * (2.5 - height), inside = std::numbers::pi * 0.25;
        EXPECT_NEAR(area(seen), free + inside, 2e-4) << height;
        EXPECT_TRUE(holds(seen, {4, 2.6}));
        EXPECT_FALSE(holds(seen, {4, 2.4}));
        EXPECT_FALSE(holds(seen, {4.6, 3.4}));
    }
    EXPECT_TRUE(map.query({4, 3.3}, 20).edges.empty());
    EXPECT_NEAR(area(map.query({4, 3.5 + 1.1e-4}, 20)), areaPast(disc, {4, 3.5 + 1.1e-4}, 8, 6),
                1e-6);
}

TEST(VisibilityRounds, HiddenByAWallAndInFrontOfIt) {
    std::vector<Segment2> lines = room(8, 6);
    const double before = area(VisibilityMap(lines).query({1, 1}, 20));
    lines.push_back({{4, 0}, {4, 6}});
    const Ellipse hidden({6, 3}, 1, 1, {}), seen({2.5, 3}, 1, 1, {});
    EXPECT_EQ(area(VisibilityMap(lines, {&hidden, 1}).query({1, 1}, 20)),
              area(VisibilityMap(lines).query({1, 1}, 20)));
    EXPECT_NEAR(area(VisibilityMap(lines, {&seen, 1}).query({1, 1}, 20)),
                areaPast(seen, {1, 1}, 4, 6), 1e-6);
    EXPECT_NEAR(before, 48, 1e-9);
}

}  // namespace visibility_rounds_test
}  // namespace ispace
