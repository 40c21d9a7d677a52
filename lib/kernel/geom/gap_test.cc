// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>

#include "geom/planar_map.h"
#include "support/test_curves.h"

namespace ispace {
namespace gap_test {

/// 8 m x 6 m, the wall opposite the start in two parts with an opening of this width at x = 4.1.
std::vector<Segment2> openRoom(double width) {
    const double left = 4.1 - width / 2, right = 4.1 + width / 2;
    return {{{0, 0}, {8, 0}},
            {{8, 0}, {8, 6}},
            {{8, 6}, {right, 6}},
            {{left, 6}, {0, 6}},
            {{0, 6}, {0, 0}}};
}

void expectGap(const std::optional<Gap>& gap, double width, Point2 place, std::size_t a,
               std::size_t b) {
    ASSERT_TRUE(gap);
    EXPECT_NEAR(gap->width, width, 1e-9);
    EXPECT_NEAR(gap->place.x, place.x, 1e-9);
    EXPECT_NEAR(gap->place.y, place.y, 1e-9);
    EXPECT_EQ(gap->a, a);
    EXPECT_EQ(gap->b, b);
}

TEST(FindGap, namesTheLinesThatDoNotMeet) {
    expectGap(findGap(openRoom(0.12), Point2{1, 1}), 0.12, {4.1, 6}, 2, 3);
    expectGap(findGap(openRoom(0.12), std::nullopt), 0.12, {4.1, 6}, 2, 3);
    expectGap(findGap(openRoom(3e-6), Point2{1, 1}), 3e-6, {4.1, 6}, 2, 3);
}

TEST(FindGap, nothingWhereNothingIsOpen) {
    const auto room = test::edgesOf(test::box(0, 0, 8, 6));
    EXPECT_FALSE(findGap(room, Point2{1, 1}));
    EXPECT_FALSE(findGap(room, std::nullopt));
    EXPECT_FALSE(findGap(openRoom(5e-7), Point2{1, 1})) << "welded";
}

TEST(FindGap, nothingWhereNoGapHelps) {
    EXPECT_FALSE(findGap({}, std::nullopt));
    EXPECT_FALSE(findGap(std::vector<Segment2>{{{0, 0}, {4, 0}}}, Point2{2, 1}));
    EXPECT_FALSE(findGap(openRoom(0.12), Point2{20, 20})) << "outside for good";
    EXPECT_FALSE(findGap(test::edgesOf(test::box(0, 0, 8, 6)), Point2{9, 9}));
}

TEST(FindGap, reportsTheWidestOfThoseThatMatter) {
    auto lines = openRoom(0.12);
    lines[4] = {{0, 5.95}, {0, 0}};  // 0.05 short of the corner
    expectGap(findGap(lines, Point2{1, 1}), 0.12, {4.1, 6}, 2, 3);
    lines[4] = {{0, 5.8}, {0, 0}};  // now this is the wider one
    expectGap(findGap(lines, Point2{1, 1}), 0.2, {0, 5.9}, 3, 4);
}

TEST(FindGap, innerWallsAndOtherPlacesDoNotDistract) {
    auto lines = openRoom(0.12);
    lines.push_back({{3, 0}, {3, 5.5}});   // a partition that ends 0.5 before the wall
    lines.push_back({{5, 2}, {5, 2.05}});  // free-standing
    lines.push_back({{5.03, 2}, {5.03, 2.05}});
    lines.push_back({{20, 0}, {21, 0}});  // two sides of something else
    lines.push_back({{21, 0.01}, {20, 1}});
    expectGap(findGap(lines, Point2{1, 1}), 0.12, {4.1, 6}, 2, 3);
    expectGap(findGap(lines, Point2{7, 1}), 0.12, {4.1, 6}, 2, 3);
}

TEST(FindGap, endThatStopsShortOfTheMiddleOfAWall) {
    // A corridor: its end wall does not reach the side wall.
    const std::vector<Segment2> lines{
        {{0, 0}, {10, 0}}, {{10, 0}, {10, 3}}, {{10, 3}, {0, 3}}, {{2, 3}, {2, 0.12}}};
    expectGap(findGap(lines, Point2{5, 1}), 0.12, {2, 0.06}, 0, 3);
}

TEST(FindGap, shortStubsAtTheOpening) {
    // Door posts: the nearest other line of each end is the wall they stand on.
    auto lines = openRoom(0.9);
    lines.push_back({lines[2].b, lines[2].b + Vec2{0, -0.1}});
    lines.push_back({lines[3].a, lines[3].a + Vec2{0, -0.1}});
    expectGap(findGap(lines, Point2{1, 1}), 0.9, {4.1, 5.9}, 5, 6);
}

TEST(FindGap, openingInACurveOfManyShortLines) {
    // The lines nearest to an end are those of its own arc; the gap is beyond them.
    const Polygon arc = test::circle({0, 0}, 3, 1000);
    auto lines = test::edgesOf(arc);
    lines.erase(lines.begin() + 100, lines.begin() + 106);
    const double width = distance(arc[100], arc[106]);
    const auto gap = findGap(lines, Point2{0, 0});
    ASSERT_TRUE(gap);
    EXPECT_NEAR(gap->width, width, 1e-9);
    EXPECT_EQ(gap->a, 99U);
    EXPECT_EQ(gap->b, 100U);
}

TEST(FindGap, doubledAndOverlappingWallsStillEnd) {
    auto lines = openRoom(0.12);
    lines.push_back(lines[2]);
    lines.push_back({{5, 6}, {4.16, 6}});  // over the end of wall 2
    const auto gap = findGap(lines, Point2{1, 1});
    ASSERT_TRUE(gap);
    EXPECT_NEAR(gap->width, 0.12, 1e-9);
    EXPECT_EQ(gap->a, 2U);
    EXPECT_EQ(gap->b, 3U);
}

TEST(FindGap, manyLooseEndsWhoseClosingsCross) {
    // A room that leaks among loose sticks: their ends could be joined in many ways.
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> x(0.2, 7.8), y(0.2, 5.8), step(-0.15, 0.15);
    auto lines = openRoom(0.12);
    for (int i = 0; i < 300; ++i) {
        const Point2 p{x(random), y(random)};
        lines.push_back({p, p + Vec2{step(random), step(random)}});
    }
    const auto gap = findGap(lines, Point2{0.1, 0.1});
    ASSERT_TRUE(gap);
    EXPECT_LE(gap->width, 0.12 + 1e-9);
}

TEST(FindGap, roomsWithSeveralWallsMissing) {
    // Two parallel walls: both ends have to be closed.
    const std::vector<Segment2> lines{{{0, 0}, {4, 0}}, {{0, 1}, {4, 1}}};
    const auto gap = findGap(lines, Point2{2, 0.5});
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->width, 1);
    EXPECT_EQ(gap->a, 0U);
    EXPECT_EQ(gap->b, 1U);
}

}  // namespace gap_test
}  // namespace ispace
