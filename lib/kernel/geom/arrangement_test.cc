// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/arrangement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "geom/planar_map.h"
#include "geom/pose.h"
#include "geom/predicates.h"
#include "support/test_curves.h"

namespace ispace {
namespace arrangement_test {

using Lines = std::vector<Segment2>;

void append(Lines& lines, const Polygon& curve) {
    forEachEdge(curve, [&](const Segment2& e) { lines.push_back(e); });
}

/// The faces, the same to the last bit as those of an exact arrangement.
std::vector<Region> facesByBoth(const Lines& lines, const Lines& passages = {}) {
    const auto faces = boundedFaces(lines, passages);
    const auto exact = test::exactFaces(lines, passages);
    EXPECT_EQ(faces.size(), exact.size());
    for (std::size_t i = 0; i < std::min(faces.size(), exact.size()); ++i) {
        EXPECT_EQ(faces[i].outline, exact[i].outline);
        EXPECT_EQ(faces[i].holes, exact[i].holes);
    }
    return faces;
}

TEST(Faces, NothingFromNothing) {
    EXPECT_TRUE(facesByBoth({}).empty());
    EXPECT_TRUE(facesByBoth({{{0, 0}, {0, 0}}}).empty());
    EXPECT_TRUE(facesByBoth({{{0, 0}, {1, 0}}}).empty());
    EXPECT_TRUE(facesByBoth({{{0, 0}, {1, 0}}, {{1, 0}, {0, 0}}, {{1, 0}, {2, 1}}}).empty());
}

TEST(Faces, OfLinesThatMeetElsewhereThanAtEnds) {
    Lines lines = test::edgesOf(test::box(0, 0, 4, 4));
    const auto with = [&lines](const Lines& more) {
        Lines all = lines;
        all.insert(all.end(), more.begin(), more.end());
        return facesByBoth(all).size();
    };
    EXPECT_EQ(with({{{0, 0}, {4, 4}}, {{0, 4}, {4, 0}}}), 4U) << "cross";
    EXPECT_EQ(with({{{0, 2}, {4, 2}}, {{1, 2}, {1, 5}}}), 3U) << "touch";
    EXPECT_EQ(with({{{0, 1}, {3, 1}}, {{2, 1}, {6, 1}}}), 2U) << "overlap";
    EXPECT_EQ(with({{{0, 1}, {3, 1}}, {{0, 1}, {4, 1}}}), 2U) << "from a common end";
    EXPECT_EQ(with({{{-1, 1}, {4, 1}}, {{4, 1}, {2, 1}}}), 2U) << "to a common end";
    EXPECT_EQ(with({{{1, 0}, {1, 3}}, {{1, 2}, {1, 4}}}), 2U) << "upright";
}

TEST(Faces, OfRandomLinesAreThoseOfAnExactArrangementButForRounding) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-10, 10);
    for (int run = 0; run < 40; ++run) {
        Lines lines;
        for (int i = 0; i < 5 + 2 * run; ++i)
            lines.push_back({{place(random), place(random)}, {place(random), place(random)}});
        const auto faces = boundedFaces(lines, {});
        const auto exact = test::exactFaces(lines);
        ASSERT_EQ(faces.size(), exact.size());
        for (std::size_t i = 0; i < faces.size(); ++i)
            EXPECT_NEAR(faces[i].area(), exact[i].area(), 1e-12);
    }
}

TEST(Faces, IslandsBridgesAndAntennas) {
    Lines lines = test::edgesOf(test::box(0, 0, 8, 6));
    append(lines, test::box(3, 2, 5, 4));
    lines.push_back({{8, 6}, {9, 7}});  // antenna outside
    lines.push_back({{5, 4}, {6, 5}});  // and on the island
    lines.push_back({{6, 5}, {6.5, 5}});
    lines.push_back({{1, 5}, {2, 5}});  // by itself
    append(lines, test::box(3.5, 2.5, 4, 3));
    lines.push_back({{0, 0}, {3, 2}});  // bridge from the outline to the island
    append(lines, test::box(20, 0, 21, 1));
    const auto faces = facesByBoth(lines);
    ASSERT_EQ(faces.size(), 4U);
    EXPECT_EQ(totalArea(faces), 49);
}

TEST(Faces, CurvesThatTouchAtPoints) {
    Lines lines = test::edgesOf({{0, 0}, {2, 2}, {4, 0}, {4, 4}, {2, 2}, {0, 4}});
    append(lines, {{2, 2}, {2.5, 2.2}, {2.5, 1.8}});
    append(lines, {{2, 2}, {3, 2.5}, {3.5, 2}, {3, 1.5}});
    const auto faces = facesByBoth(lines);
    ASSERT_EQ(faces.size(), 4U);
    EXPECT_EQ(totalArea(faces), 8);
}

TEST(Faces, IslandsUnderSlopesAndUprightLines) {
    // Islands whose leftmost vertex lies above, below and beside vertices of the ring around them.
    Lines lines = test::edgesOf({{0, 0}, {4, -3}, {8, 0}, {8, 6}, {4, 9}, {0, 6}});
    for (const double x : {1.0, 4.0, 6.0}) {
        append(lines, test::box(x, 1, x + 1, 2));
        append(lines, {{x, 3}, {x + 0.5, 2.5}, {x + 1, 3}, {x + 0.5, 3.5}});
        append(lines, {{x, 4.5}, {x + 1, 4.5}, {x, 5.5}});
    }
    append(lines, test::box(4.25, 1.25, 4.5, 1.5));
    const auto faces = facesByBoth(lines);
    EXPECT_EQ(faces.size(), 11U);
    EXPECT_EQ(faces.front().holes.size(), 9U);
}

TEST(Faces, PixelMaps) {
    std::mt19937_64 random(21);
    for (int round = 0; round < 40; ++round) {
        const test::PixelMap map(random, 40, 30, 0.3 + 0.01 * round);
        facesByBoth(map.boundary());
    }
}

TEST(Faces, RandomTrianglesOfALattice) {
    // Edges of a lattice with diagonals, some left out, turned and scaled: islands, antennas,
    // bridges and vertices of every degree.
    std::mt19937_64 random(22);
    std::uniform_real_distribution<double> turn(0, 6.3), shift(-100, 100);
    for (int round = 0; round < 60; ++round) {
        const Pose2 frame{{shift(random), shift(random)}, Angle::radians(turn(random))};
        const int side = 12;
        std::bernoulli_distribution kept(0.2 + 0.013 * round), is_passage(0.2);
        Lines lines, passages;
        const auto add = [&](double x, double y, double to_x, double to_y) {
            if (!kept(random)) return;
            Segment2 line{frame * Point2{x, y}, frame * Point2{to_x, to_y}};
            if (random() % 2 == 0) std::swap(line.a, line.b);
            (is_passage(random) ? passages : lines).push_back(line);
        };
        for (int i = 0; i < side; ++i) {
            for (int k = 0; k < side; ++k) {
                add(i, k, i + 1, k);
                add(i, k, i, k + 1);
                if (random() % 2 == 0)
                    add(i, k, i + 1, k + 1);
                else
                    add(i + 1, k, i, k + 1);
            }
        }
        facesByBoth(lines);
        facesByBoth(lines, passages);
    }
}

TEST(Passages, JoinBoundedFaces) {
    // Three rooms in a row and one apart.
    Lines lines{{{0, 0}, {9, 0}}, {{9, 0}, {9, 3}}, {{9, 3}, {0, 3}}, {{0, 3}, {0, 0}}};
    const auto wall = [&](double x) {
        lines.push_back({{x, 0}, {x, 1}});
        lines.push_back({{x, 2}, {x, 3}});
    };
    wall(3), wall(6);
    append(lines, test::box(20, 0, 21, 1));
    lines = weld(lines).pieces;
    const Segment2 first{{3, 1}, {3, 2}}, second{{6, 2}, {6, 1}};
    EXPECT_EQ(facesByBoth(lines).size(), 2U) << "holes in the walls join all";
    Lines closed = lines;
    closed.insert(closed.end(), {first, second});
    EXPECT_EQ(facesByBoth(closed).size(), 4U);

    Lines with_second = lines;
    with_second.push_back(second);
    const auto two = facesByBoth(with_second, {first});
    ASSERT_EQ(two.size(), 3U);
    EXPECT_EQ(two[0].area(), 18);
    EXPECT_EQ(two[0].boundaryLength(), 18) << "the wall beside the passage bounds nothing";
    EXPECT_EQ(facesByBoth(lines, {first, second}).size(), 2U);
    EXPECT_EQ(facesByBoth(closed, {first, second}).size(), 4U) << "lines lie on the passages";
    EXPECT_EQ(facesByBoth(with_second, {first, second}).size(), 3U);
}

TEST(Passages, ToTheOutsideJoinNothing) {
    const Lines lines{
        {{0, 0}, {4, 0}}, {{4, 0}, {4, 1}}, {{4, 2}, {4, 3}}, {{4, 3}, {0, 3}}, {{0, 3}, {0, 0}}};
    const auto faces = facesByBoth(lines, {{{4, 1}, {4, 2}}});
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_EQ(faces[0].area(), 12);
}

TEST(Passages, OpenABoothInARoom) {
    Lines lines = test::edgesOf(test::box(0, 0, 8, 6));
    append(lines, test::box(3, 2, 5, 4));
    ASSERT_EQ(facesByBoth(lines).size(), 2U);
    lines.erase(lines.begin() + 4);
    const auto faces = facesByBoth(lines, {{{3, 2}, {5, 2}}});
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_TRUE(faces[0].holes.empty());
    EXPECT_EQ(faces[0].area(), 48);
    // A free-standing passage joins a face with itself.
    EXPECT_EQ(facesByBoth(test::edgesOf(test::box(0, 0, 8, 6)), {{{3, 2}, {5, 2}}}).size(), 1U);
}

TEST(Passages, JoinFacesWhereLinesCross) {
    Lines lines;
    for (int i = 0; i < 4; ++i) {
        lines.push_back({{i + 0.0, -1}, {i + 0.0, 4}});
        if (i != 1) lines.push_back({{-1, i + 0.0}, {4, i + 0.0}});
    }
    lines.push_back({{-1, 1}, {1, 1}});
    lines.push_back({{2, 1}, {4, 1}});
    const auto faces = boundedFaces(lines, Lines{{{1, 1}, {2, 1}}});
    EXPECT_EQ(faces.size(), 8U);
    EXPECT_EQ(totalArea(faces), 9);
}

TEST(Faces, OfCrowdsInTime) {
    // Ten thousand lines through one cell: not compared pair by pair.
    Lines lines;
    for (int i = 0; i < 10000; ++i) lines.push_back({{0, i * 1e-3}, {1000, i * 1e-3}});
    lines.push_back({{0, 0}, {0, 1000}});
    EXPECT_TRUE(boundedFaces(lines, {}).empty());
}

TEST(Faces, OfCombsThatCrowdTheCells) {
    // Teeth an inch apart along a long wall, and a room far away.
    std::vector<Segment2> lines;
    for (int i = 0; i < 20000; ++i) {
        lines.push_back({{0.04 * i, 0}, {0.04 * (i + 1), 0}});
        lines.push_back({{0.04 * i, 0}, {0.04 * i, 50}});
    }
    for (const Segment2& edge : test::edgesOf(test::box(9000, 9000, 9004, 9003)))
        lines.push_back(edge);
    const auto faces = boundedFaces(lines, {});
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_NEAR(faces[0].area(), 12, 1e-6);
}

/// Pieces lie on their lines, cover them, and meet in common ends alone.
void expectCut(const std::vector<Segment2>& lines, const std::vector<LinePiece>& pieces) {
    for (const LinePiece& piece : pieces) {
        const auto& [segment, line] = std::pair(piece.segment, piece.line);
        EXPECT_LT(distance(segment.a, lines[line]), 1e-11);
        EXPECT_LT(distance(segment.b, lines[line]), 1e-11);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Segment2& s = pieces[i].segment;
        for (std::size_t k = i + 1; k < pieces.size(); ++k) {
            const Segment2& t = pieces[k].segment;
            for (const Point2 end : {t.a, t.b})
                EXPECT_TRUE(end == s.a || end == s.b || distance(end, s) > 1e-13);
            for (const Point2 end : {s.a, s.b})
                EXPECT_TRUE(end == t.a || end == t.b || distance(end, t) > 1e-13);
            const bool share = s.a == t.a || s.a == t.b || s.b == t.a || s.b == t.b;
            EXPECT_TRUE(share || !intersects(s, t));
        }
    }
    // A twentieth of each line after another lies on some piece.
    for (const auto& [a, b] : lines) {
        for (int step = 0; step <= 20 && a != b; ++step) {
            const Point2 p = a + step / 20.0 * (b - a);
            double least = 1;
            for (const LinePiece& piece : pieces)
                least = std::min(least, distance(p, piece.segment));
            EXPECT_LT(least, 1e-11);
        }
    }
}

TEST(Noding, StarsTakeNoTimeForEachPairOfTheirLines) {
    // Some of the lines lie on each other.
    constexpr int kLines = 24'000;
    Lines lines;
    for (int i = 0; i < kLines; ++i) {
        const auto [c, s] = cosSin(Angle::degrees(360.0 * i / kLines));
        lines.push_back({{0, 0}, {10 * c, 10 * s}});
        if (i % 1000 == 0) lines.push_back({{5 * c, 5 * s}, {0, 0}});
    }
    const auto pieces = noded(linePieces(lines));
    std::size_t inner = 0;
    for (const LinePiece& piece : pieces)
        inner += distance(piece.segment.a, piece.segment.b) < 6 ? 1 : 0;
    EXPECT_EQ(pieces.size(), kLines + kLines / 1000U);
    EXPECT_EQ(inner, 2 * (kLines / 1000U));
}

TEST(Noding, CrossTouchAndOverlap) {
    const std::vector<Segment2> lines{{{0, 0}, {4, 0}}, {{2, -1}, {2, 1}}, {{3, 0}, {3, 2}},
                                      {{1, 0}, {6, 0}}, {{4, 0}, {0, 0}},  {{5, 5}, {5, 5}}};
    const std::vector<LinePiece> pieces = noded(linePieces(lines));
    expectCut(lines, pieces);
    EXPECT_EQ(pieces.size(), 8U);
    EXPECT_TRUE(noded({}).empty());
}

TEST(Noding, ManyLinesOnAGridTurned) {
    // Many cross in one point, but for rounding.
    std::mt19937_64 random(1);
    for (int round = 0; round < 60; ++round) {
        const Pose2 turned{{1, 2}, Angle::degrees(round * 7.3)};
        const auto any = [&] {
            const auto x = static_cast<double>(random() % 5);
            return turned * Point2{x, static_cast<double>(random() % 5)};
        };
        std::vector<Segment2> lines;
        for (int i = 0; i < 20; ++i) {
            const Point2 from = any();
            lines.push_back({from, any()});
        }
        expectCut(lines, noded(linePieces(lines)));
    }
}

TEST(Noding, KeepsWindingNumbersAndPassages) {
    // Upon each other: two of one way, one of the other, a passage on a line.
    const std::vector<LinePiece> lines{{{{0, 0}, {4, 0}}, 0, 1, 0, false},
                                       {{{3, 0}, {1, 0}}, 1, 1, 2, false},
                                       {{{0, 0}, {1, 0}}, 2, 0, 0, true},
                                       {{{4, 0}, {5, 0}}, 3, 0, 0, true}};
    const std::vector<LinePiece> pieces = noded(lines);
    ASSERT_EQ(pieces.size(), 4U);
    EXPECT_EQ(pieces[0].added, 1);
    EXPECT_FALSE(pieces[0].is_passage);
    EXPECT_EQ(pieces[1].segment, (Segment2{{1, 0}, {3, 0}}));
    EXPECT_EQ(pieces[1].added, 0);
    EXPECT_EQ(pieces[1].removed, -2);
    EXPECT_EQ(pieces[2].line, 0U);
    EXPECT_TRUE(pieces[3].is_passage);
}

TEST(Noding, EndsKeepTheirDoubles) {
    const std::vector<Segment2> lines{{{0.1, 0.2}, {0.7, 0.3}}, {{0.4, 0.1}, {0.35, 0.9}}};
    const std::vector<LinePiece> pieces = noded(linePieces(lines));
    ASSERT_EQ(pieces.size(), 4U);
    for (const Segment2& line : lines)
        for (const Point2 end : {line.a, line.b})
            EXPECT_EQ(std::count_if(pieces.begin(), pieces.end(),
                                    [end](const LinePiece& piece) {
                                        return piece.segment.a == end || piece.segment.b == end;
                                    }),
                      1);
}

}  // namespace arrangement_test
}  // namespace ispace
