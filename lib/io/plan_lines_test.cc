// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geom/predicates.h"

namespace ispace {
namespace {

using Paths = std::vector<PlanPath>;

PlanPath open(Polygon points, int line = 0) { return {std::move(points), false, line}; }
PlanPath closed(Polygon points) { return {std::move(points), true, 0}; }

TEST(PlanLines, WholeMicrometres) {
    EXPECT_EQ(wholeMicrometres(0.1 + 0.2), 0.3);
    EXPECT_EQ(wholeMicrometres(1.23456789), 1.234568);
    EXPECT_FALSE(std::signbit(wholeMicrometres(-1e-9)));
}

TEST(PlanLines, PointsInReachAreOne) {
    const Paths lines{open({{0, 0}, {4, 0}}), open({{4.003, 0.002}, {4, 3}}),
                      open({{4.02, 3}, {0, 3}})};
    const Paths snug = snapped(lines, 0.005);
    EXPECT_EQ(snug[1].points.front(), (Point2{4, 0}));
    EXPECT_EQ(snug[2].points.front(), (Point2{4.02, 3}));
    EXPECT_EQ(snapped(lines, 0)[1].points.front(), (Point2{4.003, 0.002}));
    // Cells of the search are no border.
    const Paths wide = snapped({open({{0.0999, 0}, {5, 5}}), open({{0.1001, 0}, {7, 5}})}, 0.1);
    EXPECT_EQ(wide[1].points.front(), (Point2{0.0999, 0}));
}

TEST(PlanLines, EndsMoveOntoLines) {
    const Paths tee = snapped({open({{0, 0}, {10, 0}}), open({{5, 0.004}, {5, 3}})}, 0.005);
    EXPECT_EQ(tee[1].points.front(), (Point2{5, 0}));
    // Not those that others share, and not beyond reach.
    const Paths bent = snapped({open({{0, 0}, {10, 0}}), open({{5, 0.004}, {5, 3}}),
                                open({{5, 0.004}, {6, 3}}), open({{7, 0.006}, {7, 3}})},
                               0.005);
    EXPECT_EQ(bent[1].points.front(), (Point2{5, 0.004}));
    EXPECT_EQ(bent[3].points.front(), (Point2{7, 0.006}));
}

TEST(PlanLines, LeastReachIsNone) {
    const Paths far{open({{800'000, 0}, {0, 0}}), open({{5, 0.000001}, {5, 3}})};
    EXPECT_EQ(snapped(far, 1e-300), snapped(far, 0));
    EXPECT_EQ(snapped(far, 1e-7), far);
}

TEST(PlanLines, WhatHasNoExtentIsDropped) {
    EXPECT_TRUE(snapped({open({{1, 1}, {1, 1}})}, 0).empty());
    EXPECT_TRUE(
        snapped({open({{1, 1}, {1.001, 1}}), closed({{2, 2}, {2, 2}, {2, 2}})}, 0.005).empty());
    EXPECT_TRUE(snapped({}, 0.005).empty());
    // Two different points do not close.
    EXPECT_EQ(snapped({closed({{0, 0}, {1, 0}, {1, 0}, {0, 0}})}, 0),
              (Paths{open({{0, 0}, {1, 0}})}));
    EXPECT_EQ(snapped({closed({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 0}})}, 0),
              (Paths{closed({{0, 0}, {1, 0}, {1, 1}})}));
}

TEST(PlanLines, PiecesCanBeTakenOut) {
    const Paths square{closed({{0, 0}, {1, 0}, {1, 1}, {0, 1}})};
    EXPECT_EQ(withPieces(square, {true, true, true, true}), square);
    EXPECT_TRUE(withPieces(square, {false, false, false, false}).empty());
    // What is left runs through the first point.
    EXPECT_EQ(withPieces(square, {true, false, true, true}),
              (Paths{open({{1, 1}, {0, 1}, {0, 0}, {1, 0}})}));
    EXPECT_EQ(withPieces(square, {true, false, true, false}),
              (Paths{open({{1, 1}, {0, 1}}), open({{0, 0}, {1, 0}})}));
    EXPECT_EQ(withPieces({open({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, 7)}, {true, false, true}),
              (Paths{open({{0, 0}, {1, 0}}, 7), open({{2, 0}, {3, 0}}, 7)}));
}

TEST(PlanLines, RepeatsGo) {
    const Paths once = withoutRepeats({open({{0, 0}, {1, 0}, {2, 0}}), open({{2, 0}, {1, 0}}),
                                       open({{0, 0}, {1, 0}}), open({{1, 0}, {1, 1}, {1, 0}})});
    EXPECT_EQ(once, (Paths{open({{0, 0}, {1, 0}, {2, 0}}), open({{1, 0}, {1, 1}})}));
}

TEST(PlanLines, LinesThatMeetAreOnePath) {
    // A square drawn line by line, in any direction.
    EXPECT_EQ(joinedAtEnds({open({{0, 0}, {1, 0}}, 3), open({{1, 1}, {1, 0}}, 1),
                            open({{0, 1}, {0, 0}}, 2), open({{0, 1}, {1, 1}}, 4)}),
              (Paths{{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, true, 3}}));
    // Where three meet each stays.
    EXPECT_EQ(joinedAtEnds({open({{0, 0}, {1, 0}}), open({{1, 0}, {2, 0}}), open({{1, 0}, {1, 1}})})
                  .size(),
              3U);
    // From the middle both ways.
    EXPECT_EQ(
        joinedAtEnds({open({{1, 0}, {2, 0}}), open({{0, 0}, {1, 0}}), open({{3, 0}, {2, 0}})}),
        (Paths{open({{0, 0}, {1, 0}, {2, 0}, {3, 0}})}));
    // A loop with a stalk.
    const Paths loop =
        joinedAtEnds({open({{0, 0}, {1, 0}, {1, 1}, {0, 0}}), open({{0, 0}, {-1, 0}})});
    EXPECT_EQ(loop, (Paths{closed({{0, 0}, {1, 0}, {1, 1}}), open({{0, 0}, {-1, 0}})}));
    EXPECT_EQ(joinedAtEnds({closed({{0, 0}, {1, 0}, {1, 1}})}).size(), 1U);
    EXPECT_TRUE(joinedAtEnds({}).empty());
}

TEST(PlanLines, JoiningKeepsEveryPiece) {
    std::mt19937_64 random(4);
    for (int round = 0; round < 200; ++round) {
        Paths paths;
        for (auto n = random() % 30; n > 0; --n) {
            Polygon points;
            for (auto k = 2 + random() % 3; k > 0; --k)
                points.push_back(
                    {static_cast<double>(random() % 5), static_cast<double>(random() % 5)});
            paths.push_back({points, random() % 3 == 0, 0});
        }
        const Paths tidy = withoutRepeats(snapped(paths, 0));
        const auto sorted = [](const Paths& all) {
            std::vector<std::pair<std::pair<double, double>, std::pair<double, double>>> pieces;
            for (auto [a, b] : piecesOf(all)) {
                if (lexLess(b, a)) std::swap(a, b);
                pieces.push_back({{a.x, a.y}, {b.x, b.y}});
            }
            std::sort(pieces.begin(), pieces.end());
            return pieces;
        };
        const Paths joined = joinedAtEnds(tidy);
        EXPECT_EQ(sorted(joined), sorted(tidy));
        EXPECT_LE(joined.size(), tidy.size());
        for (const PlanPath& path : joined) EXPECT_GE(path.points.size(), path.closed ? 3U : 2U);
    }
}

TEST(PlanLines, LooseEndsAreBridged) {
    // The upper right corner is 0.1 m open; nothing else moves.
    const Paths room{open({{0, 0}, {4, 0}}), open({{4, 0}, {4, 2.9}}), open({{4, 3}, {0, 3}}),
                     open({{0, 3}, {0, 0}})};
    const Paths joined = bridged(room, 0.2);
    ASSERT_EQ(joined.size(), 5U);
    for (std::size_t i = 0; i < room.size(); ++i) EXPECT_EQ(joined[i], room[i]);
    EXPECT_EQ(joined[4].points, (Polygon{{4, 2.9}, {4, 3}}));
    EXPECT_EQ(bridged(room, 0.05), room);
    EXPECT_TRUE(bridged({}, 1).empty());
    // An end before the middle of a line.
    const Paths tee = bridged({open({{0, 0}, {10, 0}}), open({{5, 0.1}, {5, 3}})}, 0.2);
    ASSERT_EQ(tee.size(), 3U);
    EXPECT_EQ(tee[2].points, (Polygon{{5, 0.1}, {5, 0}}));
}

TEST(PlanLines, WideSnappingLosesNoWalls) {
    // A thin wall drawn as a rectangle survives a snap that is wider than it is thick.
    const Paths wall{closed({{0, 0}, {3, 0}, {3, 0.1}, {0, 0.1}})};
    EXPECT_EQ(tidyLines(wall, 0.3), wall);
}

}  // namespace
}  // namespace ispace
