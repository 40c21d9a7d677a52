// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/reading_picture.h"

#include <gtest/gtest.h>

#include "drawing/drawing.h"
#include "support/test_readings.h"

namespace ispace {

namespace reading_picture_test {

TEST(PictureText, RoundSteps) {
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

TEST(PictureText, Words) {
    EXPECT_EQ(metres(3 * 0.1), "0.3 m");
    EXPECT_EQ(metres(20), "20 m");
    EXPECT_EQ(degrees(Angle::degrees(-7.54)), "−7.5°");
    EXPECT_EQ(degrees(Angle::degrees(-0.01)), "0°");
    EXPECT_EQ(degrees(Angle::degrees(270)), "270°");
}

TEST(PictureText, Titles) {
    Pose3 pose;
    pose.heading = Angle::degrees(45);
    EXPECT_EQ(pictureTitle("l1", "urg-04lx", "laser", 3, pose), "l1 (urg-04lx), frame 3");
    EXPECT_EQ(pictureTitle("r1", "", "ranger", 0, pose), "r1 (ranger), frame 0");
    pose.tilt = Angle::degrees(-30);
    pose.roll = Angle::degrees(5);
    EXPECT_EQ(pictureTitle("l1", "", "laser", 0, pose), "l1 (laser), frame 0, tilt −30°, roll 5°");
}

}  // namespace reading_picture_test

namespace reading_picture_test {

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

struct Rgb {
    int red, green, blue;
};
Rgb rgbAt(const Image& image, int x, int y) {
    const std::uint32_t pixel = image.at(x, y);
    return {static_cast<int>(pixel >> 16U), static_cast<int>(pixel >> 8U & 0xFFU),
            static_cast<int>(pixel & 0xFFU)};
}

TEST(ColorDepth, NearIsWarmFarIsColdNoReturnIsBlack) {
    Sensor sensor = smallRanger(Projection::Pinhole, 176, 144);
    DepthFrame frame;
    frame.depths.assign(sensor.as<Ranger>().pixels(), kNone);
    for (std::size_t i = 0; i < frame.depths.size(); ++i) {
        if (i % 176 < 60) frame.depths[i] = 0.3F;
        if (i % 176 > 115) frame.depths[i] = 4.8F;
    }
    const std::string png = colorDepthPng(sensor, frame);
    EXPECT_EQ(png, colorDepthPng(sensor, frame));
    const Image image = decodePng(png);
    ASSERT_GT(image.width, 3 * 176);
    ASSERT_GT(image.height, 3 * 144);
    const int middle = image.height / 2;
    EXPECT_GT(rgbAt(image, 16 + 3 * 30, middle).red, 120);
    EXPECT_LT(rgbAt(image, 16 + 3 * 30, middle).blue, 60);
    EXPECT_EQ(image.at(16 + 3 * 88, middle), 0U);
    EXPECT_GT(rgbAt(image, 16 + 3 * 150, middle).blue, 120);
    EXPECT_LT(rgbAt(image, 16 + 3 * 150, middle).red, 100);
    // Pixels are shown sharp, and no farther than they reach.
    EXPECT_EQ(image.at(16 + 3 * 60 - 1, middle), image.at(16, middle));
    EXPECT_EQ(image.at(16 + 3 * 60, middle), 0U);
    EXPECT_EQ(image.at(16 + 3 * 176, middle), 0xFFFFFFU);
}

TEST(ColorDepth, SpectrumSaysWhichDepthsAreRedAndBlue) {
    const Sensor sensor = smallRanger(Projection::Pinhole, 176, 144);
    DepthFrame frame;
    frame.depths.assign(sensor.as<Ranger>().pixels(), 1.0F);
    for (std::size_t i = 0; i < frame.depths.size(); ++i)
        if (i % 176 >= 88) frame.depths[i] = 2.0F;
    const auto left = [](const Image& image) {
        return rgbAt(image, 16 + 3 * 44, image.height / 2);
    };
    const auto right = [](const Image& image) {
        return rgbAt(image, 16 + 3 * 132, image.height / 2);
    };
    const Image usual = decodePng(colorDepthPng(sensor, frame, DepthSpectrum{1, 2}));
    EXPECT_GT(left(usual).red, left(usual).blue + 100);
    EXPECT_GT(right(usual).blue, right(usual).red + 50);
    const Image turned = decodePng(colorDepthPng(sensor, frame, DepthSpectrum{2, 1}));
    EXPECT_GT(left(turned).blue, left(turned).red + 50);
    EXPECT_GT(right(turned).red, right(turned).blue + 100);
    // What lies beyond the ends has their colours.
    const Image narrow = decodePng(colorDepthPng(sensor, frame, DepthSpectrum{1.4, 1.6}));
    EXPECT_EQ(narrow.at(16 + 3 * 44, narrow.height / 2), usual.at(16 + 3 * 44, usual.height / 2));
}

TEST(ColorDepth, OddRangersAreDrawn) {
    for (const Projection projection : {Projection::Pinhole, Projection::Spherical}) {
        for (const auto& [columns, rows] :
             {std::pair{1, 1}, std::pair{5000, 2}, std::pair{3, 5000}}) {
            Sensor sensor = smallRanger(projection, columns, rows);
            sensor.id = std::string(300, 'x');
            sensor.as<Ranger>().min_range = sensor.as<Ranger>().max_range = 0;
            DepthFrame frame;
            frame.depths.assign(sensor.as<Ranger>().pixels(), 0.0F);
            EXPECT_GT(decodePng(colorDepthPng(sensor, frame)).height, 100);
            sensor.as<Ranger>().max_range = 1e4;
            frame.depths.front() = 1e4F;
            EXPECT_GT(decodePng(colorDepthPng(sensor, frame)).height, 100);
        }
    }
}

}  // namespace reading_picture_test

}  // namespace ispace
