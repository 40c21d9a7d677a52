// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geom/predicates.h"
#include "io/plan/plan_lines.h"
#include "support/test_import.h"
#include "support/test_work.h"

namespace ispace {

namespace plan_lines_test {

TEST(NearSegments, FindsWhatAllDistancesFind) {
    std::mt19937_64 random(7);
    const auto coordinate = [&] { return static_cast<double>(random() % 1000) / 100; };
    std::vector<Segment2> segments{{{0, 0}, {90000, 1}}};
    for (int i = 0; i < 300; ++i)
        segments.push_back({{coordinate(), coordinate()}, {coordinate(), coordinate()}});
    const NearSegments search(segments, ampleWork());
    for (int i = 0; i < 200; ++i) {
        const Point2 p{coordinate(), coordinate()};
        const std::vector<std::size_t> near = search.near(p, 0.3);
        EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
        for (std::size_t k = 0; k < segments.size(); ++k) {
            if (distance(p, segments[k]) > 0.3) continue;
            EXPECT_TRUE(std::binary_search(near.begin(), near.end(), k));
        }
    }
    EXPECT_EQ(search.near(Point2{50000, 5}, 1), std::vector<std::size_t>{});
    EXPECT_TRUE(NearSegments({}, ampleWork()).near(Point2{0, 0}, 1).empty());
}

TEST(NearSegments, CrowdsSpendTheBudgetOfTheReader) {
    constexpr std::size_t kLines = 6400, kUnitsPerQuery = kLines / NearSegments::kFoundPerUnit;
    const std::vector<Segment2> hatch(kLines, {{0, 0}, {9, 9}});
    Budget work(0, {10 * kUnitsPerQuery});
    const NearSegments search(hatch, work), other(hatch, work);
    for (int i = 0; i < 5; ++i)
        for (const NearSegments* each : {&search, &other})
            EXPECT_EQ(each->near(Point2{4, 4}, 1).size(), kLines);
    EXPECT_EQ(work.left(), 0U);
    EXPECT_EQ(search.near(Point2{20, 0}, 1).size(), 0U) << "what finds none costs none";
    EXPECT_EQ(errorsOf([&] {
                  static_cast<void>(search.near(Point2{4, 4}, 1));
              }),
              "error: lines close to each other make more than 1000 units of work (`--max-work "
              "2000` allows more); leave hatching and doubles out\n");
}

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
    const Paths snug = snapped(lines, 0.005, ampleWork());
    EXPECT_EQ(snug[1].points.front(), (Point2{4, 0}));
    EXPECT_EQ(snug[2].points.front(), (Point2{4.02, 3}));
    EXPECT_EQ(snapped(lines, 0, ampleWork())[1].points.front(), (Point2{4.003, 0.002}));
    // Cells of the search are no border.
    const Paths wide =
        snapped({open({{0.0999, 0}, {5, 5}}), open({{0.1001, 0}, {7, 5}})}, 0.1, ampleWork());
    EXPECT_EQ(wide[1].points.front(), (Point2{0.0999, 0}));
}

TEST(PlanLines, EndsMoveOntoLines) {
    const Paths tee =
        snapped({open({{0, 0}, {10, 0}}), open({{5, 0.004}, {5, 3}})}, 0.005, ampleWork());
    EXPECT_EQ(tee[1].points.front(), (Point2{5, 0}));
    // Not those that others share, and not beyond reach.
    const Paths bent = snapped({open({{0, 0}, {10, 0}}), open({{5, 0.004}, {5, 3}}),
                                open({{5, 0.004}, {6, 3}}), open({{7, 0.006}, {7, 3}})},
                               0.005, ampleWork());
    EXPECT_EQ(bent[1].points.front(), (Point2{5, 0.004}));
    EXPECT_EQ(bent[3].points.front(), (Point2{7, 0.006}));
}

// An even plan is searched by a grid in several threads; a line far away crowds the grid.
TEST(PlanLines, ManyEndsMoveOntoLinesHoweverTheyAreFound) {
    for (const bool crowded : {false, true}) {
        Paths lines;
        for (int i = 0; i < 6000; ++i) {
            const double x = 3.0 * i;
            lines.push_back(open({{x, 0}, {x, 1}}));
            lines.push_back(open({{x + 0.003, 0.5}, {x + 1, 0.75}}));
        }
        if (crowded) lines.push_back(open({{0, 1e5}, {1e5, 1e5}}));
        Paths wanted = lines;
        for (std::size_t i = 0; i < 6000; ++i)
            wanted[2 * i + 1].points.front() = {lines[2 * i].points.front().x, 0.5};
        EXPECT_EQ(snapped(lines, 0.005, ampleWork()), wanted) << crowded;
    }
}

TEST(PlanLines, LeastReachIsNone) {
    const Paths far{open({{800'000, 0}, {0, 0}}), open({{5, 0.000001}, {5, 3}})};
    EXPECT_EQ(snapped(far, 1e-300, ampleWork()), snapped(far, 0, ampleWork()));
    EXPECT_EQ(snapped(far, 1e-7, ampleWork()), far);
}

TEST(PlanLines, WhatHasNoExtentIsDropped) {
    EXPECT_TRUE(snapped({open({{1, 1}, {1, 1}})}, 0, ampleWork()).empty());
    EXPECT_TRUE(
        snapped({open({{1, 1}, {1.001, 1}}), closed({{2, 2}, {2, 2}, {2, 2}})}, 0.005, ampleWork())
            .empty());
    EXPECT_TRUE(snapped({}, 0.005, ampleWork()).empty());
    // Two different points do not close.
    EXPECT_EQ(snapped({closed({{0, 0}, {1, 0}, {1, 0}, {0, 0}})}, 0, ampleWork()),
              (Paths{open({{0, 0}, {1, 0}})}));
    EXPECT_EQ(snapped({closed({{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 0}})}, 0, ampleWork()),
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
        const Paths lines = withoutRepeats(snapped(paths, 0, ampleWork()));
        const auto sorted = [](const Paths& all) {
            std::vector<std::pair<std::pair<double, double>, std::pair<double, double>>> pieces;
            for (auto [a, b] : pathPieces(all)) {
                if (lexLess(b, a)) std::swap(a, b);
                pieces.push_back({{a.x, a.y}, {b.x, b.y}});
            }
            std::sort(pieces.begin(), pieces.end());
            return pieces;
        };
        const Paths joined = joinedAtEnds(lines);
        EXPECT_EQ(sorted(joined), sorted(lines));
        EXPECT_LE(joined.size(), lines.size());
        for (const PlanPath& path : joined) EXPECT_GE(path.points.size(), path.closed ? 3U : 2U);
    }
}

TEST(PlanLines, LooseEndsAreBridged) {
    // The upper right corner is 0.1 m open; all others stay.
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
    EXPECT_EQ(normalisedLines(wall, 0.3, ampleWork()), wall);
}

using Paths = std::vector<PlanPath>;

TEST(PlanSimplify, EndsAndCornersStay) {
    const Paths noisy{open({{0, 0}, {1, 0.01}, {2, -0.01}, {3, 0}, {3, 2}}, 7)};
    EXPECT_EQ(simplifiedPaths(noisy, 0.02, ampleWork()),
              (Paths{open({{0, 0}, {3, 0}, {3, 2}}, 7)}));
    EXPECT_EQ(simplifiedPaths(noisy, 0.005, ampleWork()), noisy);
    EXPECT_EQ(simplifiedPaths(noisy, 0, ampleWork()), noisy);
    EXPECT_TRUE(simplifiedPaths({}, 1, ampleWork()).empty());
    EXPECT_EQ(simplifiedPaths({closed({{2, 0.01}, {4, 0}, {4, 3}, {2, 2.99}, {0, 3}, {0, 0}})},
                              0.02, ampleWork()),
              (Paths{closed({{0, 0}, {4, 0}, {4, 3}, {0, 3}})}));
    // Closed paths do not collapse.
    const Paths flat{closed({{0, 0}, {1, 0.01}, {2, 0}, {1, -0.01}})};
    EXPECT_EQ(simplifiedPaths(flat, 0.1, ampleWork()), flat);
}

TEST(PlanSimplify, JointsStay) {
    // A line ends on the noisy one, another begins at a point of it, a third crosses it.
    const PlanPath noisy = open({{0, 0}, {1, 0.01}, {2, 0}, {3, 0.01}, {4, 0}, {5, 0.01}, {6, 0}});
    EXPECT_EQ(simplifiedPaths({noisy, open({{1, 0.01}, {1, 2}})}, 0.02, ampleWork())[0],
              open({{0, 0}, {1, 0.01}, {6, 0}}));
    EXPECT_EQ(simplifiedPaths({noisy, open({{2.5, 0.005}, {2.5, 2}})}, 0.02, ampleWork())[0],
              open({{0, 0}, {2, 0}, {3, 0.01}, {6, 0}}));
    EXPECT_EQ(simplifiedPaths({noisy, open({{2.5, -1}, {2.5, 0.0051}})}, 0.02, ampleWork())[0],
              open({{0, 0}, {2, 0}, {3, 0.01}, {6, 0}}));
    const std::vector<std::size_t> fixed{1};
    EXPECT_EQ(simplifiedPaths({noisy}, 0.02, ampleWork(), fixed)[0],
              open({{0, 0}, {1, 0.01}, {2, 0}, {6, 0}}));
}

TEST(PlanSimplify, WhatLiesInBetweenStaysOnItsSide) {
    const PlanPath bay = open({{0, 0}, {1, 0.3}, {2, 0}});
    const PlanPath pillar = closed({{1, 0.1}, {1.05, 0.1}, {1, 0.15}});
    EXPECT_EQ(simplifiedPaths({bay}, 0.5, ampleWork())[0], open({{0, 0}, {2, 0}}));
    EXPECT_EQ(simplifiedPaths({bay, pillar}, 0.5, ampleWork())[0], bay);
    // A line that the short cut would cross.
    const PlanPath spike = open({{1, -1}, {1, 0.1}});
    EXPECT_EQ(simplifiedPaths({bay, spike}, 0.5, ampleWork())[0], bay);
}

TEST(PlanSimplify, NewCrossingsDoNotArise) {
    std::mt19937_64 random(11);
    const auto unit = [&] { return static_cast<double>(random() % 10000) / 10000; };
    const auto crossings = [](const Paths& paths) {
        const std::vector<Segment2> all = pathPieces(paths);
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
        const Paths simple = simplifiedPaths(paths, tolerance, ampleWork());
        EXPECT_EQ(crossings(simple), 0U);
        EXPECT_LT(pathPieces(simple).size(), pathPieces(paths).size());
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
    EXPECT_LT(simplifiedPaths({spiral}, 0.01, ampleWork())[0].points.size(), 60'000U);
}

}  // namespace plan_lines_test

}  // namespace ispace
