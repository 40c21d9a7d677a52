// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace ispace {
namespace in_circle_test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

int exactly(Point2 a, Point2 b, Point2 c, Point2 d) {
    const auto at = [](Point2 p) { return Kernel::Point_2(p.x, p.y); };
    return static_cast<int>(
        Kernel().side_of_oriented_circle_2_object()(at(a), at(b), at(c), at(d)));
}

TEST(InCircle, CornersOfUprightRectanglesAreNotTold) {
    EXPECT_EQ(surelyInCircle({0, 0}, {4, 0}, {4, 3}, {0, 3}), 0);
    EXPECT_EQ(surelyInCircle({0.1, 0.2}, {7.3, 0.2}, {7.3, 5.9}, {0.1, 5.9}), 0);
}

/// On the circle exactly, with numbers of which products do not fit into pairs of doubles.
TEST(InCircle, CornersOfTurnedRectanglesAreNotTold) {
    std::mt19937_64 random(8);
    const auto whole = [&random](unsigned bits) {
        return static_cast<double>(random() >> (64 - bits));
    };
    for (int i = 0; i < 10'000; ++i) {
        const double x = whole(40), y = whole(40), share = whole(11) + 1;
        const Vec2 along{x, y}, across{-share * y, share * x};
        const Point2 a{whole(20), -whole(20)};
        ASSERT_EQ(surelyInCircle(a, a + along, a + along + across, a + across), 0) << i;
        ASSERT_EQ(exactly(a, a + along, a + along + across, a + across), 0) << i;
    }
}

TEST(InCircle, ToldApartByOneUnitInTheLastPlace) {
    const double high = std::nextafter(3.0, 4), low = std::nextafter(3.0, 2);
    EXPECT_EQ(surelyInCircle({0, 0}, {4, 0}, {4, 3}, {0, high}), -1);
    EXPECT_EQ(surelyInCircle({0, 0}, {4, 0}, {4, 3}, {0, low}), 1);
    EXPECT_EQ(surelyInCircle({4, 3}, {4, 0}, {0, 0}, {0, low}), -1) << "clockwise";
}

TEST(InCircle, FarTooLargeOrSmallNumbersAreNotTold) {
    for (const double s : {1e-120, 1e-300, 1e160, 1e300})
        EXPECT_EQ(surelyInCircle({0, 0}, {4 * s, 0}, {4 * s, 3 * s}, {s, s}), 0) << s;
}

/// A decided sign is right, and corners of turned rectangles mostly are decided.
TEST(InCircle, AgreesWithExactNumbersNextToCircles) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int told = 0, off = 0;
    constexpr int kRounds = 100'000;
    for (int i = 0; i < kRounds; ++i) {
        const double scale = std::pow(10, 12 * unit(random) - 6), far = 300 * unit(random);
        const double angle = 2 * std::numbers::pi * unit(random);
        const double x = scale * std::cos(angle), y = scale * std::sin(angle);
        const double share = unit(random);
        const Point2 a{far, -far};
        const Point2 b{a.x + x, a.y + y}, d{a.x - share * y, a.y + share * x};
        const Point2 c{b.x - share * y, b.y + share * x};
        const int side = surelyInCircle(a, b, c, d), exact = exactly(a, b, c, d);
        if (side != 0) {
            ASSERT_EQ(side, exact) << i;
        }
        told += side != 0 ? 1 : 0;
        off += exact != 0 ? 1 : 0;
    }
    EXPECT_GT(off, kRounds / 2);
    EXPECT_GT(told, off * 99 / 100);
}

}  // namespace in_circle_test
}  // namespace ispace
