// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/figure_parts.h"

#include "draw/picture.h"

#include <gtest/gtest.h>

namespace ispace {
namespace {

TEST(FigureParts, RoundSteps) {
    EXPECT_DOUBLE_EQ(roundStep(1), 1);
    EXPECT_DOUBLE_EQ(roundStep(1.01), 2);
    EXPECT_DOUBLE_EQ(roundStep(2.5), 5);
    EXPECT_DOUBLE_EQ(roundStep(5.5), 10);
    EXPECT_DOUBLE_EQ(roundStep(0.1 * 3), 0.5);
    EXPECT_DOUBLE_EQ(roundStep(0.2), 0.2);
    EXPECT_DOUBLE_EQ(roundStep(1000), 1000);
    EXPECT_DOUBLE_EQ(roundStep(0.0011), 0.002);
    for (double least = 1e-6; least < 1e6; least *= 1.07) {
        EXPECT_GE(roundStep(least), least * (1 - 1e-8));
        EXPECT_LE(roundStep(least), 2.5 * least);
    }
}

TEST(FigureParts, Words) {
    EXPECT_EQ(metres(3 * 0.1), "0.3 m");
    EXPECT_EQ(metres(20), "20 m");
    EXPECT_EQ(degrees(Angle::degrees(-7.54)), "−7.5°");
    EXPECT_EQ(degrees(Angle::degrees(-0.01)), "0°");
    EXPECT_EQ(degrees(Angle::degrees(270)), "270°");
}

TEST(FigureParts, Titles) {
    Pose3 pose;
    pose.heading = Angle::degrees(45);
    EXPECT_EQ(figureTitle("l1", "urg-04lx", "laser", 3, pose), "l1 (urg-04lx), frame 3");
    EXPECT_EQ(figureTitle("r1", "", "ranger", 0, pose), "r1 (ranger), frame 0");
    pose.tilt = Angle::degrees(-30);
    pose.roll = Angle::degrees(5);
    EXPECT_EQ(figureTitle("l1", "", "laser", 0, pose), "l1 (laser), frame 0, tilt −30°, roll 5°");
}

}  // namespace
}  // namespace ispace
