// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors on walls and solids, inside of them, and outside of the room.
#include <gtest/gtest.h>

#include <numbers>
#include <random>
#include <string>

#include "base/number.h"
#include "coverage/coverage.h"
#include "support/test_scenes.h"

namespace ispace {
namespace coverage_places_test {

constexpr double kPi = std::numbers::pi;

TEST(CoveragePlaces, SensorOnAWallSeesBothSidesOfIt) {
    for (const double heading : {0.0, 31.0, 90.0}) {
        const Pose2 turn{{0.1, 0.2}, Angle::degrees(heading)};
        const Point2 a = turn * Point2{2, -2}, b = turn * Point2{2, 2}, s = turn * Point2{2, 0.3};
        const auto text = [](Point2 p) { return formatDouble(p.x) + "," + formatDouble(p.y); };
        const CoverageReport report =
            coverageOf(sceneOf("ispace size=20,20\nfence path=" + text(a) + ";" + text(b) +
                               "\nlaser fov=360 range=3 at=" + text(s) + "\n"))
                .report;
        EXPECT_NEAR(*report.sensors[0].area.exact, 9 * kPi, 1e-6) << heading;
        EXPECT_NEAR(*report.sensors[0].area.grid, 9 * kPi, 0.5) << heading;
    }
}

// The scan's first and last beams run along the face, where ends of sight begin by rounding.
TEST(CoveragePlaces, SensorOnAFaceSeesTheHalfBeforeIt) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> at(-2, 2), size(0.2, 1.5), share(-0.5, 0.5);
    for (int trial = 0; trial < 400; ++trial) {
        const double x = at(random), y = at(random), width = size(random), depth = size(random);
        const double along = share(random);
        const int side = trial % 4;
        const Point2 p = side == 0   ? Point2{x + along * width, y + depth / 2}
                         : side == 1 ? Point2{x - width / 2, y + along * depth}
                         : side == 2 ? Point2{x + along * width, y - depth / 2}
                                     : Point2{x + width / 2, y + along * depth};
        const CoverageReport report =
            coverageOf(
                sceneOf("ispace size=8,6\ncube at=" + formatDouble(x) + "," + formatDouble(y) +
                        " size=" + formatDouble(width) + "," + formatDouble(depth) +
                        ",1\nlaser at=" + formatDouble(p.x) + "," + formatDouble(p.y) +
                        " range=20 heading=" + std::to_string(90 + 90 * side) + "\n"),
                10, 10)
                .report;
        const double expected = side == 0   ? 8 * (3 - p.y)
                                : side == 1 ? 6 * (p.x + 4)
                                : side == 2 ? 8 * (p.y + 3)
                                            : 6 * (4 - p.x);
        EXPECT_NEAR(*report.sensors[0].area.exact, expected, 1e-6) << trial;
    }
}

TEST(CoveragePlaces, SensorInASolidSeesNothing) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=8,8\ncube at=1,1 size=1,1,1\nlaser at=1,1 fov=360\n"))
            .report;
    EXPECT_EQ(report.sensors[0].area.exact, 0.0);
    EXPECT_EQ(report.coverage.exact, 0.0);
    EXPECT_EQ(report.coverage.grid, 0.0);
    EXPECT_EQ(report.pieces, 0U);
    EXPECT_EQ(report.largest_piece, 0);
}

TEST(CoveragePlaces, SensorOutsideCoversNoneOfTheRoom) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=8,8\nlaser at=9,0 fov=360 range=5\n")).report;
    EXPECT_EQ(report.coverage.exact, 0.0);
    EXPECT_EQ(report.total_effective_area.exact, 0.0);
    EXPECT_GT(*report.outside, 30);
}

TEST(CoveragePlaces, NothingIsSeenInASolidThatTheSensorTouches) {
    for (const double into : {-5e-5, 0.0, 5e-5}) {
        const CoverageReport report =
            coverageOf(sceneOf("ispace size=8,8\ncube at=1,0 size=2,2,1\nlaser at=" +
                               formatDouble(into) + ",0 fov=360 range=3\n"),
                       200, 200)
                .report;
        EXPECT_NEAR(*report.sensors[0].area.exact, 4.5 * kPi, 1e-3) << into;
        EXPECT_NEAR(*report.sensors[0].area.grid, 4.5 * kPi, 0.1) << into;
        EXPECT_NEAR(*report.free_coverage.exact * report.free_area, 4.5 * kPi, 1e-3);
        const CoverageReport inwards =
            coverageOf(sceneOf("ispace size=8,8\ncube at=1,0 size=2,2,1\nlaser at=" +
                               formatDouble(into) + ",0 range=3\n"))
                .report;
        EXPECT_NEAR(*inwards.sensors[0].area.exact, 0, 1e-3) << into;
        EXPECT_NEAR(*inwards.coverage.grid, 0, 1e-2) << into;
    }
}

// Arcs of one circle, laid out once to take the solid away, and again for the union.
TEST(CoveragePlaces, FansAtOnePlaceOnASolidAddUp) {
    const std::string room = "ispace size=60,60\ncube at=1,0 size=2,2,1\n";
    for (const double range : {2.0, 4.0, 10.0, 20.0}) {
        const auto laser = [range](int heading, int fov) {
            return "laser at=0,0 heading=" + std::to_string(heading) +
                   " fov=" + std::to_string(fov) + " range=" + formatDouble(range) + "\n";
        };
        const CoverageReport two =
            coverageOf(sceneOf(room + laser(180, 180) + laser(180, 90))).report;
        const double half = kPi / 2 * range * range;
        EXPECT_NEAR(*two.total_effective_area.exact, half, 1e-6) << range;
        EXPECT_NEAR(*two.overlap.exact, half / 2, 1e-6) << range;
        const CoverageReport turned =
            coverageOf(sceneOf(room + laser(195, 270) + laser(240, 180))).report;
        EXPECT_NEAR(*turned.total_effective_area.exact, half, 2e-6) << range;
    }
}

TEST(CoveragePlaces, RangersInASolidSeeNothing) {
    const CoverageReport report =
        coverageOf(sceneOf("ispace size=8,8\ncube at=1,1 size=1,1,1\n"
                           "ranger at=1,1,0.5 tilt=-60\nlaser at=1,1,0.9 tilt=-45 range=4\n"))
            .report;
    for (const SensorMetrics& sensor : report.sensors) {
        EXPECT_EQ(sensor.area.grid, 0.0);
        EXPECT_EQ(sensor.area.exact, 0.0);
    }
}

}  // namespace coverage_places_test
}  // namespace ispace
