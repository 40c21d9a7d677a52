// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ispace {
namespace {

TEST(Angle, isExactAtQuarterTurns) {
    for (int turn = -8; turn <= 8; ++turn) {
        const Angle angle = Angle::degrees(90.0 * turn);
        const int quadrant = ((turn % 4) + 4) % 4;
        const double cosines[] = {1, 0, -1, 0}, sines[] = {0, 1, 0, -1};
        EXPECT_EQ(cos(angle), cosines[quadrant]) << turn;
        EXPECT_EQ(sin(angle), sines[quadrant]) << turn;
        EXPECT_FALSE(std::signbit(cos(angle)) && cos(angle) == 0) << turn;
        EXPECT_FALSE(std::signbit(sin(angle)) && sin(angle) == 0) << turn;
    }
    EXPECT_EQ(tan(Angle::degrees(180)), 0);
    EXPECT_NEAR(tan(Angle::degrees(45)), 1, 1e-15);
}

TEST(Angle, convertsUnits) {
    EXPECT_DOUBLE_EQ(Angle::degrees(180).radians(), std::numbers::pi);
    EXPECT_DOUBLE_EQ(Angle::radians(std::numbers::pi / 2).degrees(), 90);
    EXPECT_EQ((Angle::degrees(30) + 2.0 * Angle::degrees(15) - Angle::degrees(10)).degrees(), 50);
    EXPECT_EQ(-Angle::degrees(30), Angle::degrees(-30));
    EXPECT_LT(Angle::degrees(30), Angle::degrees(31));
}

TEST(Angle, agreesWithTheStandardLibrary) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> degrees(-1000, 1000);
    for (int i = 0; i < 1000; ++i) {
        const Angle angle = Angle::degrees(degrees(random));
        EXPECT_NEAR(cos(angle), std::cos(angle.radians()), 1e-13);
        EXPECT_NEAR(sin(angle), std::sin(angle.radians()), 1e-13);
    }
}

TEST(Angle, wrapsToHalfOpenTurn) {
    EXPECT_EQ(wrapped(Angle::degrees(180)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(-180)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(540)).degrees(), 180);
    EXPECT_EQ(wrapped(Angle::degrees(-190)).degrees(), 170);
    EXPECT_EQ(wrapped(Angle::degrees(360)).degrees(), 0);
    EXPECT_EQ(wrapped(Angle::degrees(359.5)).degrees(), -0.5);
}

TEST(Angle, directionOfVector) {
    EXPECT_EQ(directionOf(0, 0).degrees(), 0);
    EXPECT_EQ(directionOf(2, 0).degrees(), 0);
    EXPECT_DOUBLE_EQ(directionOf(0, 3).degrees(), 90);
    EXPECT_DOUBLE_EQ(directionOf(-1, 0).degrees(), 180);
    EXPECT_DOUBLE_EQ(directionOf(-1, -0.0).degrees(), 180);
    EXPECT_DOUBLE_EQ(directionOf(1, -1).degrees(), -45);
}

}  // namespace
}  // namespace ispace
