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

TEST(LabelPlacer, ALineJoinsAMarkAndItsDistantLabel) {
    const TextStyle style{kEm, true, Align::Center, palette::kInk, {}};
    Picture near(400, 400), far(400, 400);
    drawMarkLabel(near, {200, 200}, {170, 200}, "camera1", style);
    drawMarkLabel(far, {200, 200}, {100, 200}, "camera1", style);
    EXPECT_EQ(far.list().shapes.size(), near.list().shapes.size() + 1);
}

}  // namespace
}  // namespace ispace
