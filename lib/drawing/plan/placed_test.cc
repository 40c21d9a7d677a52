// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "drawing/plan/plan.h"

namespace ispace {
namespace {

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

TEST(LabelPlacer, ALineJoinsAMarkAndItsDistantLabel) {
    const TextStyle style{kEm, true, Align::Center, palette::kInk, {}};
    Picture near(400, 400), far(400, 400);
    drawMarkLabel(near, {200, 200}, {170, 200}, "camera1", style);
    drawMarkLabel(far, {200, 200}, {100, 200}, "camera1", style);
    EXPECT_EQ(far.list().shapes.size(), near.list().shapes.size() + 1);
}

}  // namespace
}  // namespace ispace
