// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/cut_lines.h"

#include <gtest/gtest.h>

#include <random>

namespace ispace {
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
