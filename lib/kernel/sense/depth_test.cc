// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/number.h"
#include "support/test_readings.h"

namespace ispace {

namespace depth_test {

/// A room of 8 m x 6 m x 2.5 m about (4, 3), closed above.
const std::string kRoom = "ispace at=4,3 size=8,6,2.5 ceiling=yes\n";

DepthFrame frameOf(const Scene& scene, std::size_t ranger = 0, const TakerOptions& options = {}) {
    return std::get<DepthFrame>(testing::readings(scene, options).at(ranger));
}

/// How many times a vector leads from inside the room to its walls.
double multipleInRoom(Point3 from, Vec3 ray) {
    const auto leave = [](double place, double way, double low, double high) {
        if (way == 0) return 1e9;
        return ((way > 0 ? high : low) - place) / way;
    };
    return std::min(
        {leave(from.x, ray.x, 0, 8), leave(from.y, ray.y, 0, 6), leave(from.z, ray.z, 0, 2.5)});
}

TEST(Depth, OfPlanesAtAnyPoseWithinAMillimetre) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> x(0.2, 7.8), y(0.2, 5.8), z(0.1, 2.4), turn(-180, 180),
        tilt(-90, 90), fov(5, 120);
    const char* const kinds[] = {"measures=depth", "", "projection=spherical"};
    for (int i = 0; i < 120; ++i) {
        std::string line = "ranger range=50 pixels=21,17 ";
        line += kinds[i % 3];
        for (const auto& [key, value] : {std::pair{" at=", x(random)},
                                         {",", y(random)},
                                         {",", z(random)},
                                         {" heading=", turn(random)},
                                         {" tilt=", tilt(random)},
                                         {" roll=", i % 2 == 0 ? 0 : turn(random)},
                                         {" fov=", fov(random)}})
            line += key + formatDouble(value);
        const Scene scene = testing::scene(kRoom, line + "\n");
        const Sensor& sensor = scene.sensors.front();
        const DepthFrame frame = frameOf(scene);
        ASSERT_EQ(frame.depths.size(), 21U * 17U);
        for (int row = 0; row < 17; ++row)
            for (int column = 0; column < 21; ++column) {
                const Vec3 ray = sensor.as<Ranger>().ray(column, row);
                const double exact =
                    multipleInRoom(sensor.pose.position, Frame3(sensor.pose) * ray);
                const double found = frame.depths[static_cast<std::size_t>(row * 21 + column)];
                EXPECT_NEAR(found * length(ray), exact * length(ray), 1e-3)
                    << line << ' ' << column << ' ' << row;
            }
    }
}

TEST(Depth, OfATiltedPlaneFollowsItsEquation) {
    // The wall x = 8 seen from x = 5 at an angle: n . p = 3 with p = depth * ray.
    const Scene scene = testing::scene(kRoom, "ranger at=5,3,1.2 heading=25 fov=40,30 range=9\n");
    const Ranger& ranger = scene.sensors.front().as<Ranger>();
    const DepthFrame frame = frameOf(scene);
    const double c = std::cos(25 * std::acos(-1) / 180), s = std::sin(25 * std::acos(-1) / 180);
    const Vec3 normal{c, -s, 0};  // of the wall, in the sensor's frame
    for (int row = 60; row < 84; ++row)
        for (int column = 0; column < ranger.columns; ++column) {
            const double exact = 3 / dot(normal, ranger.ray(column, row));
            EXPECT_NEAR(frame.depths[static_cast<std::size_t>(row) *
                                         static_cast<std::size_t>(ranger.columns) +
                                     static_cast<std::size_t>(column)],
                        exact, 1e-5);
        }
}

TEST(Depth, LimitsAreOfWhatIsMeasured) {
    // 3 m ahead; the corner's ray is longer by a half.
    const auto corner = [](const std::string& keys) {
        const Scene scene =
            testing::scene(kRoom, "ranger at=5,3,1.25 fov=60,70 pixels=3,3 " + keys + "\n");
        return frameOf(scene).depths;
    };
    const auto depth = corner("measures=depth range=1,3"), distance = corner("range=1,3");
    EXPECT_EQ(depth[4], 3) << "the greatest range included";
    EXPECT_EQ(distance[4], 3);
    EXPECT_EQ(depth[3], 3);
    EXPECT_TRUE(std::isinf(distance[3]));
    EXPECT_TRUE(std::isinf(corner("measures=depth range=3.001,9")[4]));
    EXPECT_EQ(corner("measures=depth range=3,9")[4], 3) << "the least range included";
    EXPECT_EQ(corner("range=9")[3], 3) << "given as depth whatever is measured";
}

TEST(Depth, WhatIsBeyondTheAmbiguityWraps) {
    const std::string hall = "ispace at=10,0 size=30,6,5\ninside at=0,0\n";
    const auto middle = [&](const std::string& ranger) {
        const Scene scene = testing::scene(hall, "ranger pixels=3,3 fov=2 " + ranger + "\n");
        return frameOf(scene).depths[4];
    };
    // The wall is at x = 25: 8 m away it reads 0.5 m, 16 m away 1 m.
    EXPECT_NEAR(middle("model=sr-3000 at=17,0,1"), 0.5, 1e-6);
    EXPECT_NEAR(middle("model=sr-3000 at=9,0,1"), 1, 1e-6);
    EXPECT_NEAR(middle("model=sr-3000 at=20,0,1"), 5, 1e-6);
    EXPECT_NEAR(middle("model=sr-3000 ambiguity=3.75 at=20,0,1"), 1.25, 1e-6);
    EXPECT_TRUE(std::isinf(middle("model=sr-3000 ambiguity=0 at=17,0,1")));
    EXPECT_TRUE(std::isinf(middle("model=sr-3000 at=17,0,1 range=0.6,7.5")))
        << "too near, it reads";
}

TEST(Depth, WholeUnitsAreWhatTheDeviceSays) {
    const Scene scene = testing::scene(
        kRoom, "ranger at=5,3,1.25 fov=30,20 pixels=20,15 ambiguity=1.0001 resolution=0.01\n");
    const Ranger& ranger = scene.sensors.front().as<Ranger>();
    const DepthFrame noisy = frameOf(scene, 0, {.noise_seed = 1});
    for (std::size_t i = 0; i < noisy.depths.size(); ++i) {
        const Vec3 ray = ranger.ray(static_cast<double>(i % 20), static_cast<double>(i / 20));
        const double units = noisy.depths[i] * length(ray) / 0.01;
        EXPECT_NEAR(units, std::round(units), 1e-3);
    }
}

TEST(Depth, LimitsHoldBeforeNoise) {
    // The wall is 3 m ahead of all pixels.
    const auto returns = [](const std::string& keys) {
        const Scene scene = testing::scene(kRoom,
                                           "ranger at=5,3,1.25 fov=30,20 pixels=160,120 "
                                           "measures=depth sigma=0.05 " +
                                               keys + "\n");
        const DepthFrame frame = frameOf(scene, 0, {.noise_seed = 1});
        for (const float depth : frame.depths) {
            if (!std::isfinite(depth)) continue;
            EXPECT_GE(depth, static_cast<float>(scene.sensors[0].as<Ranger>().min_range));
            EXPECT_LE(depth, static_cast<float>(scene.sensors[0].as<Ranger>().max_range));
        }
        return std::count_if(frame.depths.begin(), frame.depths.end(),
                             [](float depth) { return std::isfinite(depth); });
    };
    constexpr std::ptrdiff_t kAll = 160 * 120;
    EXPECT_EQ(returns("range=3.01,9"), 0);
    EXPECT_EQ(returns("range=2.99,9"), kAll);
    EXPECT_EQ(returns("range=1,2.99"), 0);
    EXPECT_EQ(returns("range=1,3.01"), kAll);
    // By phase it reads 1 m.
    EXPECT_EQ(returns("range=1.01,1.9 ambiguity=2"), 0);
    EXPECT_EQ(returns("range=0.99,1.9 ambiguity=2"), kAll);
    EXPECT_EQ(returns("range=0.1,0.99 ambiguity=2"), 0);
    EXPECT_EQ(returns("range=0.1,1.01 ambiguity=2"), kAll);
}

TEST(Depth, NoiseGoesRoundThePhase) {
    // The wall 3 m ahead reads 0 m or, with noise the other way, nearly the whole ambiguity.
    const Scene scene = testing::scene(kRoom,
                                       "ranger at=5,3,1.25 fov=30,20 pixels=160,120 range=1.5 "
                                       "measures=depth sigma=0.05 ambiguity=1.5\n");
    std::size_t near = 0, far = 0;
    for (const float depth : frameOf(scene, 0, {.noise_seed = 1}).depths) {
        if (depth < 0.3F) ++near;
        if (depth > 1.2F && depth <= 1.5F) ++far;
    }
    EXPECT_EQ(near + far, 160U * 120U);
    EXPECT_NEAR(static_cast<double>(near), 9600, 5 * std::sqrt(4800));
}

TEST(Depth, SeesRobotsAndPeople) {
    const Scene scene = testing::scene(kRoom,
                                       "ranger at=1,3,0.1 pixels=41,31 range=9\n"
                                       "robot id=r1 at=3,3 size=0.4,0.4,0.3\nhuman at=5,2.2\n"
                                       "ranger on=r1 at=0,0,0.1 heading=180 pixels=3,3 range=9\n");
    const DepthFrame frame = frameOf(scene);
    EXPECT_NEAR(frame.depths[15 * 41 + 20], 1.8, 1e-5) << "the front of the robot";
    const DepthFrame bare =
        frameOf(testing::scene(kRoom, "ranger at=1,3,0.1 pixels=41,31 range=9\n"));
    EXPECT_NEAR(bare.depths[15 * 41 + 20], 7, 1e-5);
    std::size_t nearer = 0;
    for (std::size_t i = 0; i < frame.depths.size(); ++i) {
        EXPECT_LE(frame.depths[i], bare.depths[i]);
        if (frame.depths[i] < bare.depths[i]) ++nearer;
    }
    EXPECT_GT(nearer, 40U);
    EXPECT_NEAR(frameOf(scene, 1).depths[4], 3, 1e-5) << "not the robot that carries it";
}

TEST(Depth, NoiseIsOfTheDepthOrOfTheDistance) {
    for (const std::string measured : {"depth", "distance"}) {
        const Scene scene = testing::scene(
            kRoom,
            "ranger at=5,3,1.25 fov=30,20 pixels=200,150 range=9 bias=0.1 sigma=0.02 measures=" +
                measured + "\n");
        const Ranger& ranger = scene.sensors.front().as<Ranger>();
        const DepthFrame clean = frameOf(scene), noisy = frameOf(scene, 0, {.noise_seed = 1});
        double sum = 0, squares = 0;
        const auto n = static_cast<double>(clean.depths.size());
        for (std::size_t i = 0; i < clean.depths.size(); ++i) {
            const Vec3 ray = ranger.ray(static_cast<double>(i % 200), static_cast<double>(i / 200));
            const double scale = measured == "depth" ? 1 : length(ray);
            const double error = scale * (static_cast<double>(noisy.depths[i]) -
                                          static_cast<double>(clean.depths[i]));
            sum += error;
            squares += (error - 0.1) * (error - 0.1);
        }
        EXPECT_NEAR(sum / n, 0.1, 5 * 0.02 / std::sqrt(n)) << measured;
        EXPECT_NEAR(std::sqrt(squares / n), 0.02, 5 * 0.02 / std::sqrt(2 * n)) << measured;
    }
}

TEST(Depth, StrayRaysOfAFlatWallSpreadAsTheirBearings) {
    // Straight ahead at 3 m: a bearing off by e reads 3 / cos(e), which is longer, never shorter.
    const Scene scene =
        testing::scene(kRoom, "ranger at=5,3,1.25 fov=1 pixels=50,50 range=9 angle_sigma=3\n");
    const DepthFrame noisy = frameOf(scene, 0, {.noise_seed = 1});
    double sum = 0;
    for (const float depth : noisy.depths) {
        EXPECT_GE(depth, 2.999F);
        sum += std::acos(std::min(1.0, 3 / static_cast<double>(depth)));
    }
    const double mean = sum / static_cast<double>(noisy.depths.size()) * 180 / std::acos(-1);
    EXPECT_NEAR(mean, 3 * std::sqrt(2 / std::acos(-1)), 0.15) << "of a half normal distribution";
}

TEST(Depth, StrayRaysOfADepthMeterStillMeasureDepth) {
    // However rays stray across a wall that stands across the axis, its depth is the same.
    const Scene scene = testing::scene("ispace at=0,0 size=10,100,50\n",
                                       "ranger at=0,0,20 fov=90,60 pixels=40,30 range=90 "
                                       "angle_sigma=2 measures=depth\n");
    for (const float depth : frameOf(scene, 0, {.noise_seed = 1}).depths)
        EXPECT_NEAR(depth, 5, 1e-4);
}

}  // namespace depth_test

}  // namespace ispace
