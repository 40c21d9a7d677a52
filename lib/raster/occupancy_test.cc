// SPDX-License-Identifier: GPL-3.0-or-later
#include "raster/occupancy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "raster/test_cells.h"

namespace ispace {
namespace {

using testing::cellsOf;
using testing::rowsOf;

TEST(Occupancy, TrinaryComparesStrictly) {
    OccupancyRule rule;  // 0.65 and 0.196
    EXPECT_EQ(classify(254, 255, rule), Cell::Free);
    EXPECT_EQ(classify(206, 255, rule), Cell::Free);     // 0.1922
    EXPECT_EQ(classify(205, 255, rule), Cell::Unknown);  // 0.19608: map_server's unknown
    EXPECT_EQ(classify(0, 255, rule), Cell::Occupied);
    rule.free_thresh = 0.2;
    rule.occupied_thresh = 0.8;
    EXPECT_EQ(classify(204, 255, rule), Cell::Unknown);  // exactly 0.2
    EXPECT_EQ(classify(205, 255, rule), Cell::Free);
    EXPECT_EQ(classify(51, 255, rule), Cell::Unknown);  // exactly 0.8
    EXPECT_EQ(classify(50, 255, rule), Cell::Occupied);
    rule.mode = OccupancyRule::Mode::Scale;
    EXPECT_EQ(classify(205, 255, rule), Cell::Free);
    EXPECT_EQ(classify(128, 255, rule), Cell::Unknown);
}

TEST(Occupancy, NegateTurnsShadesAround) {
    OccupancyRule rule;
    rule.negate = true;
    EXPECT_EQ(classify(0, 255, rule), Cell::Free);
    EXPECT_EQ(classify(255, 255, rule), Cell::Occupied);
    EXPECT_EQ(classify(50, 255, rule), Cell::Unknown);
}

TEST(Occupancy, SixteenBitsMeanTheSame) {
    EXPECT_EQ(classify(65535, 65535, {}), Cell::Free);
    EXPECT_EQ(classify(205 * 257, 65535, {}), Cell::Unknown);
    EXPECT_EQ(classify(100, 65535, {}), Cell::Occupied);
}

TEST(Occupancy, RawTakesThePixelAsValue) {
    OccupancyRule rule;
    rule.mode = OccupancyRule::Mode::Raw;
    rule.negate = true;  // ignored, as the thresholds are
    EXPECT_EQ(classify(0, 255, rule), Cell::Free);
    EXPECT_EQ(classify(100, 255, rule), Cell::Occupied);
    EXPECT_EQ(classify(99, 255, rule), Cell::Unknown);
    EXPECT_EQ(classify(255, 255, rule), Cell::Unknown);
    EXPECT_EQ(classify(100 * 257, 65535, rule), Cell::Occupied);
}

TEST(Occupancy, TopRowOfThePictureIsTheHighest) {
    GreyPicture image;
    image.width = 2;
    image.height = 2;
    image.samples = {254, 0, 205, 254};
    EXPECT_EQ(rowsOf(freeCells(image, {})), (std::vector<std::string>{".#", "#."}));
    EXPECT_TRUE(freeCells(image, {}).contains(0, 1));
}

}  // namespace
}  // namespace ispace
