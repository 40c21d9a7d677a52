// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/obstacle_map.h"

#include <gtest/gtest.h>

#include "draw/picture.h"
#include "sense/sample_readings.h"

namespace ispace {
namespace {

/// Mean place of the pixels of returns, and how many there are.
struct Returns {
    double x = 0, y = 0;
    int count = 0;
};
Returns returnsOf(const Image& image) {
    Returns returns;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (image.at(x, y) != 0xC0392B) continue;
            returns.x += x + 0.5;
            returns.y += y + 0.5;
            ++returns.count;
        }
    }
    if (returns.count > 0) {
        returns.x /= returns.count;
        returns.y /= returns.count;
    }
    return returns;
}

constexpr int kPixels = 600;

Returns returnsOf(const Sensor& sensor, std::vector<float> ranges) {
    const std::string png = obstacleMapPng(sensor, scanOf(sensor.pose, std::move(ranges)), kPixels);
    const Image image = decodePng(png);
    EXPECT_EQ(image.width, kPixels);
    EXPECT_EQ(image.height, kPixels);
    return returnsOf(image);
}

TEST(ObstacleMap, BearingZeroIsUpAndPositiveOnesAreLeft) {
    Sensor sensor = threeBeams();
    const Returns up = returnsOf(sensor, {kNone, 3, kNone});
    const Returns left = returnsOf(sensor, {kNone, kNone, 3});
    const Returns right = returnsOf(sensor, {3, kNone, kNone});
    ASSERT_GT(up.count, 3);
    EXPECT_NEAR(up.x, kPixels / 2.0, 0.6);
    EXPECT_NEAR(left.y, right.y, 0.6);
    EXPECT_NEAR(left.x + right.x, kPixels, 0.6);
    // The sensor in the middle, and the same scale each way.
    const double reach = kPixels / 2.0 - left.x;
    EXPECT_GT(reach, 100);
    EXPECT_NEAR(left.y - up.y, reach, 1);
    // Where the sensor stands and faces does not matter.
    sensor.pose = {{5, -3, 0.2}, Angle::degrees(77), {}, {}};
    EXPECT_NEAR(returnsOf(sensor, {kNone, kNone, 3}).x, left.x, 1e-9);
}

TEST(ObstacleMap, RangesAreToScale) {
    Sensor sensor = threeBeams();
    sensor.as<Laser>().max_range = 30;
    // Beam 0 sets the scale; beam 2 is measured.
    const auto reach = [&](float range) {
        const Returns all = returnsOf(sensor, {3.9F, kNone, range});
        const Returns first = returnsOf(sensor, {3.9F, kNone, kNone});
        return kPixels / 2.0 -
               (all.x * all.count - first.x * first.count) / (all.count - first.count);
    };
    EXPECT_NEAR(reach(3) / reach(1), 3, 0.03);
    EXPECT_NEAR(reach(2) / reach(1), 2, 0.03);
}

TEST(ObstacleMap, EqualInputGivesEqualBytes) {
    const Sensor sensor = threeBeams();
    const Scan scan = scanOf(sensor.pose, {1, 2, 3});
    EXPECT_EQ(obstacleMapPng(sensor, scan, 300), obstacleMapPng(sensor, scan, 300));
}

TEST(ObstacleMap, OddScansAreDrawn) {
    Sensor sensor = threeBeams();
    for (const double limit : {0.0, 0.02, 4.0, 1e5}) {
        sensor.as<Laser>().max_range = limit;
        for (const int pixels : {1, 20, 300}) {
            for (const std::vector<float>& ranges :
                 {std::vector<float>{kNone, kNone, kNone}, {}, {0, 0, static_cast<float>(limit)}})
                EXPECT_EQ(decodePng(obstacleMapPng(sensor, scanOf({}, ranges), pixels)).width,
                          pixels);
        }
    }
    EXPECT_EQ(returnsOf(sensor, {kNone, kNone, kNone}).count, 0);
}

}  // namespace
}  // namespace ispace
