// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/calibration/plan_fit.h"
#include "support/test_layout.h"
#include "support/test_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "sense/scan.h"

namespace ispace::calibration {
namespace plan_fit_test {

Laser utm(double max_range = 30) {
    Laser laser;
    laser.min_range = 0.1;
    laser.max_range = max_range;
    laser.first = Angle::degrees(-135);
    laser.step = Angle::degrees(0.25);
    laser.beams = 1081;
    laser.noise.sigma = {0.01, 0.0005, 0};
    laser.noise.resolution = 0.001;
    return laser;
}

Sensor laserAt(double x, double y, double heading, double max_range = 30) {
    return {"l1", utm(max_range), {{x, y, 0.3}, Angle::degrees(heading), {}, {}}};
}

std::vector<std::vector<float>> noisyScans(const Scene& scene, const Sensor& truth, int count) {
    RayScenes worlds(scene.environment);
    worlds.prepare(truth.pose);
    const MovingBodies bodies;
    LaserCaster caster(worlds, bodies, truth, false, {.noise_seed = 7});
    std::vector<std::vector<float>> scans;
    for (int i = 0; i < count; ++i) {
        Scan scan;
        scan.frame = i;
        scan.pose = truth.pose;
        caster.cast(scan);
        scans.push_back(scan.ranges);
    }
    return scans;
}

struct Error {
    double metres, degrees;
};
Error errorOf(const Pose3& pose, const Sensor& truth) {
    const Pose3& real = truth.pose;
    return {std::hypot(pose.position.x - real.position.x, pose.position.y - real.position.y),
            std::abs(wrapped(pose.heading - real.heading).degrees())};
}

const std::string kLRoom =
    "fence path=0,0;9,0;9,4;5,4;5,7;0,7 closed=yes height=2.5\ninside at=1,1\n"
    "cube at=7,1.5 size=0.8,0.6,0.7 heading=20\ncylinder at=2,5 size=0.6,0.6,1\n";

TEST(PlanFit, FindsANoisyLaserFromAMetreAndTwentyDegreesAway) {
    const Scene scene = testing::scene(kLRoom);
    const Sensor truth = laserAt(1.234, 3.456, 12.3);
    const auto scans = noisyScans(scene, truth, 200);
    for (const auto& [x, y, turn] : {std::array{0.7, -0.7, 20.0}, std::array{-0.9, 0.4, -20.0}}) {
        const PlanFit fit =
            fitToPlan(scene.environment, laserAt(1.234 + x, 3.456 + y, 12.3 + turn), scans);
        const Error error = errorOf(fit.pose, truth);
        EXPECT_LT(error.metres, 0.001);
        EXPECT_LT(error.degrees, 0.02);
        RecordProperty("metres", std::to_string(error.metres));
        RecordProperty("degrees", std::to_string(error.degrees));
        EXPECT_TRUE(fit.unknown.empty());
        EXPECT_TRUE(fit.equals.empty());
        // The covariance tells how far the pose is off.
        EXPECT_LT(error.metres, 4 * std::sqrt(fit.covariance[0][0] + fit.covariance[1][1]));
        EXPECT_GT(fit.inliers, 0.97);
    }
}

TEST(PlanFit, PeopleInHalfOfTheScansDoNotMatter) {
    const Scene scene = testing::scene(kLRoom);
    const Sensor truth = laserAt(1.234, 3.456, 12.3);
    auto scans = noisyScans(scene, truth, 50);
    for (std::size_t i = 0; i < 20; ++i)
        for (std::size_t k = 300; k < 500; ++k) scans[i][k] = std::min(scans[i][k], 1.1F);
    const Error error =
        errorOf(fitToPlan(scene.environment, laserAt(1, 3.2, 5), scans).pose, truth);
    EXPECT_LT(error.metres, 0.001);
    EXPECT_LT(error.degrees, 0.02);
}

TEST(PlanFit, FurnitureThatThePlanLacksMovesItLittle) {
    const Scene real = testing::scene(kLRoom + "cube at=3,2 size=0.5,0.5,0.8\n");
    const Scene plan = testing::scene(kLRoom);
    const Sensor truth = laserAt(1.234, 3.456, 12.3);
    const PlanFit fit =
        fitToPlan(plan.environment, laserAt(1.5, 3, 0), noisyScans(real, truth, 50));
    const Error error = errorOf(fit.pose, truth);
    EXPECT_LT(error.metres, 0.002);
    EXPECT_LT(error.degrees, 0.05);
}

TEST(PlanFit, ACorridorHasALengthThatIsNotInvented) {
    // 100 m long, at 30 degrees; the ends are out of range.
    const std::string corridor =
        "fence path=0,0;86.6025404,50;85.6025404,51.7320508;-1,1.7320508 closed=yes height=2.5\n"
        "inside at=0,1\n";
    const Scene scene = testing::scene(corridor);
    const Vec2 along = unitVector(Angle::degrees(30)), across = perpendicular(along);
    const Point2 middle = Point2{0, 0} + 50 * along + 0.8 * across;
    const Sensor truth = laserAt(middle.x, middle.y, 40, 10);
    const Point2 off = middle + 0.6 * along + 0.3 * across;
    const PlanFit fit =
        fitToPlan(scene.environment, laserAt(off.x, off.y, 50, 10), noisyScans(scene, truth, 20));
    ASSERT_EQ(fit.unknown.size(), 1U);
    EXPECT_EQ(fit.unknown[0].text(fit.pose), "along the direction 30.0 deg");
    EXPECT_TRUE(std::isinf(fit.covariance[0][0]) && std::isinf(fit.covariance[1][1]));
    EXPECT_LT(std::sqrt(fit.covariance[2][2]), 1e-3);
    const Vec2 moved = fit.pose.position.onFloor() - off;
    EXPECT_NEAR(dot(moved, along), 0, 1e-3);      // stays where the layout has it
    EXPECT_NEAR(dot(moved, across), -0.3, 2e-3);  // is measured
    EXPECT_NEAR(wrapped(fit.pose.heading).degrees(), 40, 0.05);
    ASSERT_EQ(fit.equals.size(), 1U);  // from the other side
    EXPECT_NEAR(wrapped(fit.equals[0].heading).degrees(), -140, 0.05);
}

TEST(PlanFit, ASymmetricRoomHasEqualPoses) {
    const Scene scene = testing::scene("ispace at=0,0 size=8,6,2.5\n");
    const Sensor truth = laserAt(1.5, -1, 100);
    const PlanFit fit =
        fitToPlan(scene.environment, laserAt(1.9, -0.5, 90), noisyScans(scene, truth, 20));
    EXPECT_LT(errorOf(fit.pose, truth).metres, 0.002);
    ASSERT_EQ(fit.equals.size(), 1U);  // turned by half a turn
    EXPECT_NEAR(fit.equals[0].position.x, -1.5, 0.002);
    EXPECT_NEAR(fit.equals[0].position.y, 1, 0.002);
    EXPECT_NEAR(fit.equals[0].heading.degrees(), -80, 0.05);
}

std::string refusal(const Scene& scene, const Sensor& start,
                    const std::vector<std::vector<float>>& scans) {
    try {
        static_cast<void>(fitToPlan(scene.environment, start, scans));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

TEST(PlanFit, RefusesScansThatSayTooLittle) {
    const Scene scene = testing::scene(kLRoom);
    const Sensor start = laserAt(1, 1, 0);
    EXPECT_EQ(refusal(scene, start, {}), "no scans of l1");
    EXPECT_EQ(refusal(scene, start, {std::vector<float>(5)}),
              "scans of l1 have 5 beams, and its record has 1081");
    EXPECT_EQ(refusal(scene, start, {std::vector<float>(1081, INFINITY)}),
              "scans of l1: only 0 beams return in most scans");
    const Scene other = testing::scene("ispace at=0,0 size=16,13,2.5\ncube at=2,2 size=2,1,1\n");
    EXPECT_TRUE(refusal(scene, start, noisyScans(other, laserAt(-1, 1, 70), 5))
                    .starts_with("scans of l1 do not fit the room: at the most likely pose "));
}

}  // namespace plan_fit_test
}  // namespace ispace::calibration
