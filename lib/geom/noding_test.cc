// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/noding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "geom/pose.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

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

}  // namespace

}  // namespace ispace
