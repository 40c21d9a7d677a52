// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/odometry.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "base/number.h"
#include "sim/world.h"
#include "sim/world_state.h"
#include "support/test_layout.h"

namespace ispace {
namespace motion_noise_test {

using std::chrono::milliseconds;
using testing::scene;

constexpr int kSide = 30, kRobots = kSide * kSide;

/// Robots two metres apart, with these keys.
Scene field(const std::string& keys) {
    std::string layout;
    for (int i = 0; i < kRobots; ++i)
        layout += "robot id=r" + std::to_string(i) + " at=" + std::to_string(2 * (i % kSide) - 29) +
                  "," + std::to_string(2 * (i / kSide) - 29) + " " + keys + "\n";
    return scene("ispace size=64,64\n", layout);
}

World driven(const Scene& room, const Command& command, SimTime step, SimTime until) {
    World world(room, step, {.seed = 5, .noise = true});
    for (std::size_t i = 0; i < world.robots().size(); ++i) world.command(i, command);
    while (world.time() < until) world.step();
    return world;
}

/// The sum of squares of as many normal numbers of this variance has a chi-square distribution:
/// within 3.3 of its standard deviations but once in a thousand.
void expectVariance(const std::vector<double>& errors, double variance, const char* what) {
    double sum = 0;
    for (const double error : errors) sum += error * error / variance;
    const auto count = static_cast<double>(errors.size());
    EXPECT_NEAR(sum, count, 3.3 * std::sqrt(2 * count)) << what;
}

std::vector<double> errorsOf(const World& world, const std::function<double(std::size_t)>& error) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < world.robots().size(); ++i) errors.push_back(error(i));
    return errors;
}

TEST(MotionNoise, OdometryAfterAMetreSpreadsAsItsModel) {
    const Scene room = field("odometry_noise=0.01,0.004,0.002,0.001");
    for (const SimTime step : {milliseconds(5), milliseconds(100)}) {
        const World world = driven(room, {Verb::Forward, 1}, step, std::chrono::seconds(5));
        for (std::size_t i = 0; i < world.robots().size(); ++i)
            ASSERT_NEAR(world.status(i).pose.position.x - world.robots()[i].pose.position.x, 1,
                        1e-9)
                << "the truth does not stray";
        const auto pose = [&](std::size_t i) { return world.odometry(i).pose; };
        expectVariance(errorsOf(world, [&](std::size_t i) { return pose(i).heading.radians(); }),
                       0.004, "heading");
        expectVariance(errorsOf(world, [&](std::size_t i) { return pose(i).position.x - 1; }),
                       0.002, "along");
        // The integral of a random walk: a third.
        expectVariance(errorsOf(world, [&](std::size_t i) { return pose(i).position.y; }),
                       0.004 / 3, "aside");
    }
}

TEST(MotionNoise, OdometryAfterATurnSpreadsAsItsModel) {
    const Scene room = field("odometry_noise=0.01,0.004,0.002,0.001");
    const World world = driven(room, {Verb::Left, 90}, milliseconds(10), std::chrono::seconds(4));
    expectVariance(
        errorsOf(world,
                 [&](std::size_t i) {
                     return wrapped(world.odometry(i).pose.heading - Angle::degrees(90)).radians();
                 }),
        0.01 * std::numbers::pi / 2, "heading");
    double square = 0;
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const Vec2 way = world.odometry(i).pose.position - Point2{};
        square += dot(way, way) / kRobots;
    }
    EXPECT_NEAR(square, 0.001 * std::numbers::pi / 2, 0.1 * 0.001 * std::numbers::pi / 2);
}

/// Returns e' P^-1 e for the errors of odometry against the truth: chi-square with three degrees of
/// freedom if they are normal with this covariance.
double normalisedError(const World& world, std::size_t robot) {
    const Odometry odometry = world.odometry(robot);
    const Pose2 truth = relativePose(world.robots()[robot].pose, world.status(robot).pose);
    const Vec2 way = odometry.pose.position - truth.position;
    const Eigen::Vector3d error(way.x, way.y,
                                wrapped(odometry.pose.heading - truth.heading).radians());
    const PoseCovariance& p = odometry.covariance;
    Eigen::Matrix3d covariance;
    covariance << p.xx, p.xy, p.xh, p.xy, p.yy, p.yh, p.xh, p.yh, p.hh;
    return error.dot(covariance.ldlt().solve(error));
}

TEST(MotionNoise, ErrorsOfDrivesAgreeWithTheirCovariance) {
    constexpr double kFreedoms = 3;
    const auto expect_consistent = [](const std::string& keys, const std::vector<Command>& drive,
                                      SimTime step) {
        const Scene room = field(keys);
        World world(room, step, {.seed = 7, .noise = true});
        for (const Command& command : drive) {
            for (std::size_t i = 0; i < world.robots().size(); ++i) world.command(i, command);
            const SimTime end = world.time() + std::chrono::seconds(8);
            while (world.time() < end) world.step();
        }
        double sum = 0;
        for (std::size_t i = 0; i < world.robots().size(); ++i) {
            ASSERT_FALSE(world.status(i).stall);
            sum += normalisedError(world, i);
        }
        EXPECT_NEAR(sum, kFreedoms * kRobots, 3.3 * std::sqrt(2 * kFreedoms * kRobots)) << keys;
    };
    const Command ahead{Verb::Forward, 0.5}, left{Verb::Left, 120}, right{Verb::Right, 90};
    const std::vector<Command> triangle = {ahead, left, ahead, left, ahead, left},
                               bend = {ahead, right, ahead};
    expect_consistent(
        "motion_noise=0.001,0.0001,0.00006,0.00005 "
        "odometry_noise=0.001,0.0001,0.00006,0.00005",
        triangle, milliseconds(20));
    expect_consistent("odometry_noise=0.001,0.004,0.002,0.001", bend, milliseconds(10));
    expect_consistent("motion_noise=0.001,0.004,0.002,0.001", bend, milliseconds(50));
}

TEST(MotionNoise, CovariancesOfOdometryHaveClosedForms) {
    // Ahead: a walk of the heading, its integral, and errors of the length.
    constexpr double kTurn = 0.004, kPath = 0.002;
    const Scene room =
        scene("ispace size=9,9\n", "robot id=r1 odometry_noise=0.01,0.004,0.002,0.001\n");
    World world(room, milliseconds(5), {.seed = 5, .noise = true});
    EXPECT_EQ(world.odometry(0).covariance, PoseCovariance());
    world.command(0, {Verb::Forward, 1});
    while (world.time() < std::chrono::seconds(5)) world.step();
    const PoseCovariance ahead = world.odometry(0).covariance;
    EXPECT_NEAR(ahead.hh, kTurn, 1e-9);
    EXPECT_NEAR(ahead.yh, kTurn / 2, 0.02 * kTurn);
    EXPECT_NEAR(ahead.yy, kTurn / 3, 0.02 * kTurn);
    EXPECT_NEAR(ahead.xx, kPath, 0.02 * kPath);
    // On the spot: errors of the turn add, those of the way do not shrink.
    world.command(0, {Verb::Left, 90});
    while (world.time() < std::chrono::seconds(9)) world.step();
    EXPECT_NEAR(world.odometry(0).covariance.hh, kTurn + 0.01 * std::numbers::pi / 2, 1e-6);
    EXPECT_GT(world.odometry(0).covariance.xx, ahead.xx);
    World exact(room, milliseconds(5), {.seed = 5});
    exact.command(0, {Verb::Forward, 1});
    while (exact.time() < std::chrono::seconds(5)) exact.step();
    EXPECT_EQ(exact.odometry(0).covariance, PoseCovariance());
    EXPECT_EQ(exact.odometry(0).alphas, MotionAlphas());
}

TEST(MotionNoise, TwistsErrAsMuchAsPosesGrow) {
    const MotionAlphas alphas{0.01, 0.004, 0.002, 0.001};
    constexpr double kSeconds = 0.02;
    const PoseCovariance twist = twistCovariance({0.5, 0}, Angle::radians(0.2), alphas, kSeconds);
    const PoseCovariance pose =
        covarianceOf({{0.5 * kSeconds, 0}, Angle::radians(0.2 * kSeconds)}, alphas);
    EXPECT_NEAR(twist.xx * kSeconds * kSeconds, pose.xx, 1e-15);
    EXPECT_NEAR(twist.hh * kSeconds, 0.01 * 0.2 + 0.004 * 0.5, 1e-12);
    EXPECT_EQ(twistCovariance({}, {}, alphas, kSeconds), PoseCovariance()) << "it stands";
}

TEST(MotionNoise, TruthStraysFromTheWheelsTheOdometryCounts) {
    const Scene room = field("motion_noise=0.01,0.004,0.002,0.001");
    const World world = driven(room, {Verb::Forward, 1}, milliseconds(10), std::chrono::seconds(5));
    for (std::size_t i = 0; i < world.robots().size(); ++i) {
        const Pose2 pose = world.odometry(i).pose;
        ASSERT_NEAR(pose.position.x, 1, 1e-9);
        ASSERT_NEAR(pose.position.y, 0, 1e-9);
    }
    const auto truth = [&](std::size_t i) {
        return world.status(i).pose.position - world.robots()[i].pose.position;
    };
    expectVariance(errorsOf(world, [&](std::size_t i) { return truth(i).x - 1; }), 0.002, "along");
    expectVariance(errorsOf(world, [&](std::size_t i) { return truth(i).y; }), 0.004 / 3, "aside");
}

TEST(MotionNoise, OffItIsTheTruthSeenFromTheStart) {
    const Scene room = scene("ispace size=8,6\n",
                             "robot id=r1 at=1,1 heading=90 odometry_noise=1,1,1,1 "
                             "motion_noise=1,1,1,1 start_noise=1,30\n");
    World world(room, milliseconds(5));
    EXPECT_EQ(world.odometry(0).pose, Pose2());
    world.command(0, {Verb::Forward, 1});
    while (world.time() < std::chrono::seconds(1)) world.step();
    EXPECT_GT(world.odometry(0).speed, 0.2);
    while (world.time() < std::chrono::seconds(5)) world.step();
    EXPECT_NEAR(world.odometry(0).pose.position.x, 1, 1e-9);
    EXPECT_NEAR(world.odometry(0).pose.position.y, 0, 1e-9);
    EXPECT_NEAR(world.status(0).pose.position.y, 2, 1e-9);
}

TEST(MotionNoise, StartsSpreadWhereThereIsRoom) {
    const Scene room = field("start_noise=0.1,5");
    const World world(room, milliseconds(5), {.seed = 3, .noise = true});
    const auto away = [&](std::size_t i) {
        return world.status(i).pose.position - world.robots()[i].pose.position;
    };
    expectVariance(errorsOf(world, [&](std::size_t i) { return away(i).x; }), 0.01, "x");
    expectVariance(errorsOf(world, [&](std::size_t i) { return away(i).y; }), 0.01, "y");
    expectVariance(
        errorsOf(world, [&](std::size_t i) { return world.status(i).pose.heading.degrees(); }), 25,
        "heading");
    EXPECT_EQ(world.odometry(0).pose, Pose2()) << "which it does not know";
    // Between walls it stays clear of them.
    const Scene narrow = scene("ispace size=4,0.7\n", "robot id=r1 start_noise=1\n");
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const World tight(narrow, milliseconds(5), {.seed = seed, .noise = true});
        EXPECT_LE(std::abs(tight.status(0).pose.position.y), 0.05 + 1e-9);
    }
}

TEST(MotionNoise, ACollisionStopsTheWheels) {
    const Scene room = scene("ispace size=4,4\n", "robot id=r1 odometry_noise=0,0,1e-6,0\n");
    World world(room, milliseconds(5), {.seed = 1, .noise = true});
    world.command(0, {Verb::Forward, 9});
    while (world.time() < std::chrono::seconds(9)) world.step();
    EXPECT_TRUE(world.status(0).stall);
    EXPECT_NEAR(world.odometry(0).pose.position.x, world.status(0).pose.position.x, 0.01);
}

TEST(MotionNoise, AStartIsDrawnUntilThereIsRoom) {
    // One place in fifteen is in the room.
    const Scene room = scene("ispace size=12,8\n", "robot id=r1 at=1,2 start_noise=15\n");
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const World world(room, milliseconds(5), {.seed = seed, .noise = true});
        EXPECT_TRUE(world.keptStarts().empty()) << seed;
        const Point2 p = world.status(0).pose.position;
        EXPECT_NE(p, (Point2{1, 2})) << seed;
        EXPECT_TRUE(std::abs(p.x) <= 6 - 0.3 && std::abs(p.y) <= 4 - 0.3) << seed;
    }
}

TEST(MotionNoise, AStartThatLeadsNowhereIsToldOf) {
    const Scene room = scene("ispace size=1,1\n",
                             "robot id=r1 at=0,0 start_noise=50\n"
                             "robot id=r2 at=9,0 start_noise=0.1\nhuman id=h1 at=20,0\n");
    const World world(room, milliseconds(5), {.seed = 1, .noise = true});
    ASSERT_EQ(world.keptStarts().size(), 1U);
    EXPECT_EQ(world.keptStarts()[0], 0U);
    EXPECT_EQ(world.status(0).pose.position, (Point2{0, 0}));
    EXPECT_EQ(startWarnings(world), std::vector<std::string>({"the start_noise of r1 leads nowhere "
                                                              "free: it starts where its record "
                                                              "says"}));
    EXPECT_EQ(startWarnings(world, "r1").size(), 1U);
    EXPECT_TRUE(startWarnings(world, "r2").empty());
    EXPECT_TRUE(World(room, milliseconds(5), {.seed = 1}).keptStarts().empty());
}

/// Drives sixteen robots about a room, back when they stall, and expects that no two ever overlap.
/// \param keys of the robots of even and of odd columns
void expectNoOverlap(const std::string& even, const std::string& odd) {
    std::string layout;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            layout += "robot id=r" + std::to_string(4 * i + k) +
                      " at=" + formatDouble(1.5 * i - 2.25) + ',' + formatDouble(1.5 * k - 2.25) +
                      " heading=" + std::to_string(53 * i + 90 * k) + (k % 2 == 0 ? even : odd) +
                      "\n";
    const Scene room = scene("ispace size=7,7\n", layout);
    int bumps = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        World world(room, milliseconds(50), {.seed = seed, .noise = true});
        const std::size_t robots = world.robots().size();
        for (int step = 0; step < 100; ++step) {
            for (std::size_t i = 0; i < robots; ++i) {
                bumps += world.isStalled(i) ? 1 : 0;
                if (step == 0 || world.isStalled(i))
                    world.command(i, {Verb::Speed, (step % 2 == 0 ? 0.5 : -0.5) *
                                                       world.movers()[i].model.max_speed});
            }
            world.step();
            for (std::size_t i = 0; i < robots; ++i)
                for (std::size_t k = 0; k < i; ++k) {
                    const double gap =
                        distance(world.status(i).pose.position, world.status(k).pose.position);
                    ASSERT_GE(
                        gap, world.movers()[i].model.radius + world.movers()[k].model.radius - 1e-6)
                        << seed << ' ' << step << ' ' << i << ' ' << k;
                }
        }
    }
    EXPECT_GT(bumps, 100);
}

TEST(MotionNoise, MovesThatItLengthensMeetNoOther) {
    // Steps of 25 mm whose noise is a quarter of a metre: far beyond what one at top speed reaches.
    const std::string noise = " motion_noise=3,0.1,3,0.1";
    expectNoOverlap(noise, noise);
    // The fastest are the smallest, and only the large and slow ones stray.
    expectNoOverlap(" radius=0.1 max_speed=8 accel=50", " radius=0.6" + noise);
}

}  // namespace motion_noise_test
}  // namespace ispace
