// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/point_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace ispace {
namespace point_map_test {

TEST(PointMap, HoldsWhatAMapHolds) {
    PointMap<int> points;
    std::map<std::pair<double, double>, int> expected;
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
        // Whole numbers and small fractions, on both sides of zero.
        const double scale = i % 2 == 0 ? 1 : 1e-6;
        const Point2 p{scale * (static_cast<int>(random() % 100) - 50),
                       scale * (static_cast<int>(random() % 100) - 50)};
        const int* found = points.find(p);
        const auto known = expected.find({p.x, p.y});
        ASSERT_EQ(found == nullptr, known == expected.end());
        if (found != nullptr) {
            ASSERT_EQ(*found, known->second);
        }
        points[p] += i;
        expected[{p.x, p.y}] += i;
    }
    for (const auto& [point, value] : expected)
        EXPECT_EQ(*points.find({point.first, point.second}), value);
}

TEST(PointMap, ZeroHasNoSign) {
    PointMap<int> points;
    points[{0.0, -0.0}] = 7;
    EXPECT_EQ(points[(Point2{-0.0, 0.0})], 7);
    EXPECT_EQ(points.find({0, 1}), nullptr);
}

/// Grids of whole numbers, large or small, spread over the table: else this takes hours.
TEST(PointMap, GridsAreSpread) {
    constexpr int kSide = 1000;
    for (const double step : {1.0, 0.001, 4096.0, 2.5e-6}) {
        PointMap<int> points;
        for (int x = 0; x < kSide; ++x)
            for (int y = 0; y < kSide; ++y) points[{x * step, y * step}] = x - y;
        EXPECT_EQ(*points.find({700 * step, 3 * step}), 697);
    }
}

}  // namespace point_map_test
}  // namespace ispace
