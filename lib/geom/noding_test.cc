// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/noding.h"

#include <gtest/gtest.h>

#include <random>

#include "geom/pose.h"
#include "geom/predicates.h"

namespace ispace {

namespace {

/// Pieces lie on their lines, cover them, and meet in common ends alone.
void expectCut(const std::vector<Segment2>& lines, const std::vector<LinePiece>& pieces) {
    for (const auto& [segment, line] : pieces) {
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

TEST(VisibilityPieces, CrossTouchAndOverlap) {
    const std::vector<Segment2> lines{{{0, 0}, {4, 0}}, {{2, -1}, {2, 1}}, {{3, 0}, {3, 2}},
                                      {{1, 0}, {6, 0}}, {{4, 0}, {0, 0}},  {{5, 5}, {5, 5}}};
    const std::vector<LinePiece> pieces = piecesOf(lines);
    expectCut(lines, pieces);
    EXPECT_EQ(pieces.size(), 8U);
    EXPECT_TRUE(piecesOf({}).empty());
}

TEST(VisibilityPieces, HeapsOfLinesOnAGridTurned) {
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
        expectCut(lines, piecesOf(lines));
    }
}

}  // namespace

namespace {

double areaOf(const std::vector<Region>& faces) {
    double area = 0;
    for (const Region& face : faces) area += face.area();
    return area;
}

TEST(CutLines, CutsBothWhereTheyCross) {
    const std::vector<Segment2> cross{{{-1, 0}, {1, 0}}, {{0, -1}, {0, 1}}, {{5, 5}, {6, 6}}};
    const WeldedLines cut = cutAtCrossings(cross);
    ASSERT_EQ(cut.pieces.size(), 5U);
    EXPECT_EQ(cut.pieces[0], (Segment2{{-1, 0}, {0, 0}}));
    EXPECT_EQ(cut.pieces[1], (Segment2{{0, 0}, {1, 0}}));
    EXPECT_EQ(cut.pieces[3], (Segment2{{0, 0}, {0, 1}}));
    EXPECT_EQ(cut.source, (std::vector<std::size_t>{0, 0, 1, 1, 2}));
    EXPECT_EQ(cutAtCrossings({}).pieces.size(), 0U);
    // An end on a line cuts it; lines upon each other are left to the weld.
    const std::vector<Segment2> touch{{{0, 0}, {2, 0}}, {{2, 0}, {2, 2}}, {{1, 0}, {3, 0}}};
    EXPECT_EQ(cutAtCrossings(touch).pieces.size(), 4U);
}

TEST(CutLines, FacesAreThoseOfTheLines) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-10, 10);
    for (int run = 0; run < 40; ++run) {
        std::vector<Segment2> lines;
        for (int i = 0; i < 5 + run; ++i)
            lines.push_back({{place(random), place(random)}, {place(random), place(random)}});
        const auto exact = boundedFaces(weld(lines));
        const auto cut = boundedFaces(weld(cutAtCrossings(lines).pieces));
        EXPECT_EQ(exact.size(), cut.size());
        EXPECT_NEAR(areaOf(exact), areaOf(cut), 1e-6);
    }
}

TEST(CutLines, HeapsStayWhole) {
    std::vector<Segment2> lines;
    for (int i = 0; i < 300; ++i) {
        lines.push_back({{i * 0.01, -10}, {i * 0.01, 10}});
        lines.push_back({{-10, i * 0.01}, {10, i * 0.01}});
    }
    EXPECT_EQ(cutAtCrossings(lines).pieces, lines);
}

}  // namespace

}  // namespace ispace
