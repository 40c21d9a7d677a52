// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan_simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geom/predicates.h"

namespace ispace {
namespace {

using Paths = std::vector<PlanPath>;

PlanPath open(Polygon points, int line = 0) { return {std::move(points), false, line}; }
PlanPath closed(Polygon points) { return {std::move(points), true, 0}; }

TEST(PlanSimplify, EndsAndCornersStay) {
    const Paths noisy{open({{0, 0}, {1, 0.01}, {2, -0.01}, {3, 0}, {3, 2}}, 7)};
    EXPECT_EQ(simplifiedPaths(noisy, 0.02), (Paths{open({{0, 0}, {3, 0}, {3, 2}}, 7)}));
    EXPECT_EQ(simplifiedPaths(noisy, 0.005), noisy);
    EXPECT_EQ(simplifiedPaths(noisy, 0), noisy);
    EXPECT_TRUE(simplifiedPaths({}, 1).empty());
    EXPECT_EQ(
        simplifiedPaths({closed({{2, 0.01}, {4, 0}, {4, 3}, {2, 2.99}, {0, 3}, {0, 0}})}, 0.02),
        (Paths{closed({{0, 0}, {4, 0}, {4, 3}, {0, 3}})}));
    // Closed paths do not collapse.
    const Paths flat{closed({{0, 0}, {1, 0.01}, {2, 0}, {1, -0.01}})};
    EXPECT_EQ(simplifiedPaths(flat, 0.1), flat);
}

TEST(PlanSimplify, JointsStay) {
    // A line ends on the noisy one, another begins at a point of it, a third crosses it.
    const PlanPath noisy = open({{0, 0}, {1, 0.01}, {2, 0}, {3, 0.01}, {4, 0}, {5, 0.01}, {6, 0}});
    EXPECT_EQ(simplifiedPaths({noisy, open({{1, 0.01}, {1, 2}})}, 0.02)[0],
              open({{0, 0}, {1, 0.01}, {6, 0}}));
    EXPECT_EQ(simplifiedPaths({noisy, open({{2.5, 0.005}, {2.5, 2}})}, 0.02)[0],
              open({{0, 0}, {2, 0}, {3, 0.01}, {6, 0}}));
    EXPECT_EQ(simplifiedPaths({noisy, open({{2.5, -1}, {2.5, 0.0051}})}, 0.02)[0],
              open({{0, 0}, {2, 0}, {3, 0.01}, {6, 0}}));
    const std::vector<std::size_t> fixed{1};
    EXPECT_EQ(simplifiedPaths({noisy}, 0.02, fixed)[0], open({{0, 0}, {1, 0.01}, {2, 0}, {6, 0}}));
}

TEST(PlanSimplify, WhatLiesInBetweenStaysOnItsSide) {
    const PlanPath bay = open({{0, 0}, {1, 0.3}, {2, 0}});
    const PlanPath pillar = closed({{1, 0.1}, {1.05, 0.1}, {1, 0.15}});
    EXPECT_EQ(simplifiedPaths({bay}, 0.5)[0], open({{0, 0}, {2, 0}}));
    EXPECT_EQ(simplifiedPaths({bay, pillar}, 0.5)[0], bay);
    // A line that the short cut would cross.
    const PlanPath spike = open({{1, -1}, {1, 0.1}});
    EXPECT_EQ(simplifiedPaths({bay, spike}, 0.5)[0], bay);
}

TEST(PlanSimplify, NewCrossingsDoNotArise) {
    std::mt19937_64 random(11);
    const auto unit = [&] { return static_cast<double>(random() % 10000) / 10000; };
    const auto crossings = [](const Paths& paths) {
        const std::vector<Segment2> all = piecesOf(paths);
        std::size_t count = 0;
        for (std::size_t i = 0; i < all.size(); ++i)
            for (std::size_t k = i + 1; k < all.size(); ++k)
                if (all[i].a != all[k].a && all[i].b != all[k].b && all[i].a != all[k].b &&
                    all[i].b != all[k].a && intersects(all[i], all[k]))
                    ++count;
        return count;
    };
    for (int round = 0; round < 60; ++round) {
        Paths paths;  // wavy lines, one above the other, that do not meet
        for (int row = 0; row < 6; ++row) {
            PlanPath path;
            for (int i = 0; i < 40; ++i)
                path.points.push_back({0.1 * i, 0.1 * row + 0.095 * unit()});
            paths.push_back(path);
        }
        ASSERT_EQ(crossings(paths), 0U);
        const double tolerance = 0.02 + 0.2 * unit();
        const Paths simple = simplifiedPaths(paths, tolerance);
        EXPECT_EQ(crossings(simple), 0U);
        EXPECT_LT(piecesOf(simple).size(), piecesOf(paths).size());
        for (std::size_t i = 0; i < paths.size(); ++i)
            for (const Point2 p : paths[i].points) {
                double nearest = 1e9;
                for (std::size_t k = 0; k < simple[i].pieceCount(); ++k)
                    nearest = std::min(nearest, distance(p, simple[i].piece(k)));
                EXPECT_LE(nearest, tolerance);
            }
    }
}

TEST(PlanSimplify, LongRunsTakeNoSquare) {
    PlanPath spiral;
    for (int i = 0; i < 200'000; ++i) {
        const double t = 0.001 * i;
        spiral.points.push_back({t * std::cos(t), t * std::sin(t)});
    }
    EXPECT_LT(simplifiedPaths({spiral}, 0.01)[0].points.size(), 60'000U);
}

}  // namespace
}  // namespace ispace
