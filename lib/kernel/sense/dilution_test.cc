// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/dilution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ispace {
namespace dilution_test {

Laser laserWith(double sigma, double angle_degrees) {
    Laser laser;
    laser.step = Angle::degrees(1e-6);  // its rounding is negligible
    laser.noise.sigma = {sigma, 0, 0};
    laser.noise.angle_sigma = Angle::degrees(angle_degrees);
    return laser;
}

Receiver receiverWith(double sigma) {
    Receiver receiver;
    receiver.noise.sigma = {sigma, 0, 0};
    return receiver;
}

TEST(Dilution, TwoDistancesAtARightAngle) {
    // Each coordinate errs as its distance does.
    SpaceInformation sum = informationOf(receiverWith(0.03), {0, 4, 1}, {0, 0, 1});
    sum += informationOf(receiverWith(0.04), {5, 0, 1}, {0, 0, 1});
    EXPECT_NEAR(atKnownHeight(sum).error(), 0.05, 1e-12);
    EXPECT_NEAR(variancesOf(sum).x, 0.0016, 1e-12);
    EXPECT_NEAR(variancesOf(sum).y, 0.0009, 1e-12);
    EXPECT_TRUE(std::isinf(variancesOf(sum).z));
}

TEST(Dilution, TwoDistancesAtAnyAngle) {
    // Errors of sigma each, at an angle a: sqrt(2) sigma / sin(a).
    for (const double degrees : {10.0, 30.0, 60.0, 90.0, 150.0}) {
        const Vec2 to = unitVector(Angle::degrees(degrees));
        SpaceInformation sum = informationOf(receiverWith(0.02), {3, 0, 0}, {0, 0, 0});
        sum += informationOf(receiverWith(0.02), {7 * to.x, 7 * to.y, 0}, {0, 0, 0});
        EXPECT_NEAR(atKnownHeight(sum).error(),
                    std::sqrt(2.0) * 0.02 / std::sin(Angle::degrees(degrees).radians()), 1e-9)
            << degrees;
    }
    SpaceInformation line = informationOf(receiverWith(0.02), {3, 0, 0}, {0, 0, 0});
    line += informationOf(receiverWith(0.02), {-7, 0, 0}, {0, 0, 0});
    EXPECT_TRUE(std::isinf(atKnownHeight(line).error())) << "both on one line";
}

TEST(Dilution, OneLaserMeasuresDistanceAndDirection) {
    const SpaceInformation one = informationOf(laserWith(0.03, 1), {0, 0, 0.3}, {4, 0, 0.3});
    const double across = 4 * Angle::degrees(1).radians();
    EXPECT_NEAR(atKnownHeight(one).error(), std::hypot(0.03, across), 1e-6);
}

TEST(Dilution, ACameraAboveLocatesByTheHeightOfThePlane) {
    Camera camera;
    camera.fx = camera.fy = 1000;
    const double pixel = 0.001 / std::sqrt(12.0);
    // Straight below, both directions count; aside, the distance errs by one over the cosine more.
    EXPECT_NEAR(atKnownHeight(informationOf(camera, {0, 0, 3}, {0, 0, 0})).error(),
                std::sqrt(2.0) * 3 * pixel, 1e-9);
    const double away = std::sqrt(18.0);
    EXPECT_NEAR(atKnownHeight(informationOf(camera, {0, 0, 3}, {3, 0, 0})).error(),
                away * pixel * std::hypot(1, away / 3), 1e-9);
    EXPECT_TRUE(std::isinf(atKnownHeight(informationOf(camera, {0, 0, 0}, {3, 0, 0})).error()))
        << "within the plane it sees a direction alone";
}

TEST(Dilution, RoundingCountsAsUniformNoise) {
    Laser laser = laserWith(0, 0);
    laser.step = Angle::degrees(1);
    laser.noise.resolution = 0.06;
    const double across = 2 * Angle::degrees(1).radians() / std::sqrt(12.0);
    EXPECT_NEAR(atKnownHeight(informationOf(laser, {0, 0, 0}, {2, 0, 0})).error(),
                std::hypot(0.06 / std::sqrt(12.0), across), 1e-12);
    laser.noise.resolution = 0;
    EXPECT_NEAR(atKnownHeight(informationOf(laser, {0, 0, 0}, {2, 0, 0})).error(),
                std::hypot(kMinSigma, across), 1e-12);
}

TEST(Dilution, AnUnknownHeightIsThatOfAllVariances) {
    SpaceInformation sum;
    for (const Point3 at : {Point3{0, 0, 3}, {4, 0, 3}, {0, 3, 2.5}, {4, 3, 3.2}})
        sum += informationOf(receiverWith(0.02), at, {1, 1, 1});
    const Vec3 variances = variancesOf(sum);
    EXPECT_NEAR(atAnyHeight(sum).error(), std::sqrt(variances.x + variances.y), 1e-9);
    EXPECT_LT(atKnownHeight(sum).error(), atAnyHeight(sum).error());
    EXPECT_GE(atKnownHeight(sum).error(), 2 / std::sqrt(atKnownHeight(sum).trace()));
}

TEST(Dilution, WithoutMeasurementsIsUnbounded) {
    EXPECT_TRUE(std::isinf(FloorInformation().error()));
}

}  // namespace dilution_test
}  // namespace ispace
