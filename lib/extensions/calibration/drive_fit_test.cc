// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/calibration/drive_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "base/error.h"
#include "base/file.h"

namespace ispace::calibration {
namespace drive_fit_test {

const DriveParameters kReal{0.0206, 0.0207, 0.0883, {{-0.0058, 0.031}, Angle::degrees(-91)}};

/// A drive with turns and straight ways; `noise` scales 1 mm and 0.2 degrees of scan matching.
std::vector<DriveStep> drive(double noise, int count = 600, double turning = 1, double going = 1) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> speed(-2, 2);
    std::vector<DriveStep> steps;
    for (int i = 0; i < count; ++i) {
        const double turn = turning * speed(random), way = going * speed(random);
        DriveStep step{0.8, way - turn, way + turn, {}};
        step.motion = predictedMotion(kReal, step);
        step.motion.position.x += noise * 1e-3 * normal(random);
        step.motion.position.y += noise * 1e-3 * normal(random);
        step.motion.heading = step.motion.heading + Angle::degrees(noise * 0.2 * normal(random));
        steps.push_back(step);
    }
    return steps;
}

std::string refusalOf(const std::vector<DriveStep>& steps) {
    try {
        static_cast<void>(fitDrive(steps, "a.tuple"));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

TEST(DriveFit, IsExactWithoutNoise) {
    const DriveFit fit = fitDrive(drive(0), "a.tuple");
    EXPECT_NEAR(fit.parameters.left_radius, kReal.left_radius, 1e-9);
    EXPECT_NEAR(fit.parameters.right_radius, kReal.right_radius, 1e-9);
    EXPECT_NEAR(fit.parameters.axle, kReal.axle, 1e-9);
    EXPECT_NEAR(fit.parameters.laser.position.x, kReal.laser.position.x, 1e-9);
    EXPECT_NEAR(fit.parameters.laser.position.y, kReal.laser.position.y, 1e-9);
    EXPECT_NEAR(fit.parameters.laser.heading.degrees(), -91, 1e-6);
}

TEST(DriveFit, StatesItsErrorsAndLeavesOutFailedMatches) {
    std::vector<DriveStep> steps = drive(1);
    steps[17].motion.position.x += 0.5;
    steps[300].motion.heading = Angle::degrees(120);
    const DriveFit fit = fitDrive(steps, "a.tuple");
    EXPECT_LT(fit.inliers, steps.size());
    const double sigma_axle = std::sqrt(fit.covariance[2][2]);
    EXPECT_LT(std::abs(fit.parameters.axle - kReal.axle), 3 * sigma_axle);
    EXPECT_LT(sigma_axle, 1e-3);
    EXPECT_LT(std::abs(fit.parameters.laser.position.y - kReal.laser.position.y),
              3 * std::sqrt(fit.covariance[4][4]));
    EXPECT_NEAR(fit.noise[0], 1e-3, 1e-4);
}

TEST(DriveFit, RefusesDrivesThatDoNotDetermineIt) {
    EXPECT_EQ(refusalOf({}), "a drive of 0 steps: wanted at least 10");
    EXPECT_EQ(refusalOf(drive(0, 100, 1, 0)),
              "the speeds of both wheels have one ratio in all steps: wanted turns and straight "
              "ways, to tell the radii apart");
    EXPECT_EQ(refusalOf(drive(0, 100, 0, 1)), refusalOf(drive(0, 100, 1, 0)));
}

TEST(DriveFit, ReadsLinesOfJson) {
    const std::string line =
        "{ \"T\": 0.5, \"phi_l\": 0.1, \"phi_r\": -0.2, \"sm\": [ 0.001, -0.002, 0.03 ] }\n";
    EXPECT_TRUE(isDrive(line));
    EXPECT_FALSE(isDrive("{\"schema\":\"ispace-scan/1\"}\n"));
    const std::vector<DriveStep> steps =
        readDrive("\n" + line.substr(0, line.size() - 1) + line, "a.tuple");
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_EQ(steps[1].right, -0.2);
    EXPECT_NEAR(steps[1].motion.heading.radians(), 0.03, 1e-12);
    for (const char* bad :
         {"{", "[]", "{\"T\":1}", "{\"T\":0,\"phi_l\":1,\"phi_r\":1,\"sm\":[1,2,3]}",
          "{\"T\":1,\"phi_l\":1,\"phi_r\":1,\"sm\":[1,2]}",
          "{\"T\":1,\"phi_l\":\"x\",\"phi_r\":1,\"sm\":[1,2,3]}"})
        EXPECT_THROW(static_cast<void>(readDrive(line + bad, "a.tuple")), FormatError) << bad;
}

TEST(DriveFit, PublishedDrivesGiveThePublishedParameters) {
    const char* const data = std::getenv("ISPACE_TEST_DATA");
    if (data == nullptr) GTEST_SKIP() << "ISPACE_TEST_DATA is not set";
    for (const std::string drive : {"l90", "lmov", "lstraight"}) {
        const std::string file = std::string(data) + "/logs/censi-calibration/" + drive;
        const DriveFit fit = fitDrive(readDrive(readAll(file + ".tuple"), file), file);
        const auto published = nlohmann::json::parse(readAll(file + "_results.json"));
        const auto value = [&](const char* key) { return published[key].get<double>(); };
        // In the order of the published covariance: radii come first.
        const std::array<double, 6> theirs{value("l_diam") / 2, value("r_diam") / 2,
                                           value("axle"),       value("l_x"),
                                           value("l_y"),        value("l_theta")};
        const DriveParameters& p = fit.parameters;
        const std::array<double, 6> ours{
            p.left_radius,      p.right_radius,     p.axle,
            p.laser.position.x, p.laser.position.y, p.laser.heading.radians()};
        for (std::size_t i = 0; i < 6; ++i) {
            const double sigma = std::sqrt(published["covariance"][i][i].get<double>());
            EXPECT_LT(std::abs(ours[i] - theirs[i]), 3 * sigma) << drive << " parameter " << i;
            EXPECT_LT(std::abs(ours[i] - theirs[i]), 3 * std::sqrt(fit.covariance[i][i]));
        }
    }
}

}  // namespace drive_fit_test
}  // namespace ispace::calibration
