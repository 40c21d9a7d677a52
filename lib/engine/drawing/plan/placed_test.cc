// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "drawing/plan/plan.h"

namespace ispace {
namespace placed_test {

constexpr double kEm = 10, kTextWidth = 50;

std::vector<Point2> labelsAt(int count, Point2 mark, bool crowd) {
    LabelPlacer placer({{0, 0}, {400, 400}}, kEm);
    std::vector<Point2> middles;
    for (int i = 0; i < count; ++i) {
        placer.addMark(mark, Angle());
        if (const auto middle = placer.placeLabel(mark, Angle(), kTextWidth, kEm, crowd))
            middles.push_back(*middle);
    }
    return middles;
}

TEST(LabelPlacer, LabelsWithoutSpaceBesideTheirMarksLieFartherAway) {
    const std::vector<Point2> middles = labelsAt(12, {200, 200}, false);
    ASSERT_EQ(middles.size(), 12U) << "each sensor on a sheet is named";
    for (std::size_t i = 0; i < middles.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_TRUE(std::abs(middles[i].x - middles[k].x) >= kTextWidth ||
                        std::abs(middles[i].y - middles[k].y) >= kEm)
                << i << " and " << k << " overlap";
    EXPECT_LT(labelsAt(12, {200, 200}, true).size(), 12U) << "in a crowd some have none";
    // In a corner of the page, where half of the positions lie outside.
    EXPECT_GE(labelsAt(3, {398, 398}, false).size(), 2U);
}

TEST(LabelPlacer, LabelsLieBesideWallsAndMarks) {
    // A wall runs behind the mark, where the label would lie.
    LabelPlacer free({{0, 0}, {400, 400}}, kEm), walled({{0, 0}, {400, 400}}, kEm);
    walled.addLine({{0, 195}, {190, 205}});
    const auto behind = free.placeLabel({200, 200}, Angle(), kTextWidth, kEm, false);
    const auto aside = walled.placeLabel({200, 200}, Angle(), kTextWidth, kEm, false);
    ASSERT_TRUE(behind && aside);
    EXPECT_LT(behind->x, 200 - kTextWidth / 2);
    EXPECT_EQ(behind->y, 200);
    EXPECT_GT(std::abs(aside->y - 200), kEm / 2);
    // Only where a line is asked not to count.
    const Box2 on_wall{{100, 195}, {120, 205}};
    EXPECT_FALSE(walled.take(on_wall));
    EXPECT_TRUE(walled.take(on_wall, true));
    EXPECT_FALSE(walled.take(on_wall, true)) << "taken";
    // A line that ends before a box, or passes a corner, does not cross it.
    LabelPlacer near({{0, 0}, {400, 400}}, kEm);
    near.addLine({{0, 0}, {90, 90}});
    near.addLine({{90, 140}, {140, 190}});
    EXPECT_TRUE(near.take({{100, 100}, {120, 120}}));
}

/// Boxes and lines of all sizes, also at and beyond the edges of the frame.
TEST(LabelPlacer, ABoxIsFreeIfNoShapeAtAllLiesInIt) {
    std::mt19937_64 random(11);
    const auto within = [&random](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (int round = 0; round < 20; ++round) {
        const Box2 frame{{-50, 10}, {within(-40, 400), 410}};
        LabelPlacer placer(frame, kEm);
        std::vector<Box2> boxes;
        std::vector<Segment2> lines;
        for (int i = 0; i < 20; ++i) {
            const Point2 mark{within(-80, 450), within(-20, 450)};
            placer.addMark(mark, std::nullopt);
            boxes.push_back(Box2{mark, mark}.expanded(0.45 * kEm));
            const Point2 from{within(-900, 900), within(-900, 900)};
            const double way = within(0, round % 2 == 0 ? 3000 : 60), turn = within(0, 6.3);
            lines.push_back({from, from + way * Vec2{std::cos(turn), std::sin(turn)}});
            placer.addLine(lines.back());
        }
        for (int i = 0; i < 300; ++i) {
            const Point2 low{within(-60, 400), within(0, 400)};
            const Box2 box{low, low + Vec2{within(1, 60), within(1, 20)}};
            const bool over_lines = i % 3 == 0;
            const bool is_free =
                frame.contains(box) &&
                std::none_of(boxes.begin(), boxes.end(),
                             [&](const Box2& other) { return other.overlaps(box); }) &&
                (over_lines || std::none_of(lines.begin(), lines.end(), [&](const Segment2& line) {
                     return crosses(line, box);
                 }));
            ASSERT_EQ(placer.take(box, over_lines), is_free) << round << ' ' << i;
            if (is_free) boxes.push_back(box);
        }
    }
}

TEST(LabelPlacer, ALineJoinsAMarkAndItsDistantLabel) {
    const TextStyle style{kEm, true, Align::Center, palette::kInk, {}};
    Picture near(400, 400), far(400, 400);
    drawMarkLabel(near, {200, 200}, {170, 200}, "camera1", style);
    drawMarkLabel(far, {200, 200}, {100, 200}, "camera1", style);
    EXPECT_EQ(far.list().shapes.size(), near.list().shapes.size() + 1);
}

}  // namespace placed_test
}  // namespace ispace
