// SPDX-License-Identifier: GPL-3.0-or-later
// Sensors that move while they scan, against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/test_readings.h"

namespace ispace {

namespace motion_test {

const std::string kRoom = "ispace at=4,3 size=8,6,2.5\n";

/// Distance to the walls of the room.
double rangeInRoom(Point2 from, Vec2 way) {
    const auto leave = [](double place, double step, double high) {
        if (step == 0) return 1e9;
        return ((step > 0 ? high : 0) - place) / step;
    };
    return std::min(leave(from.x, way.x, 8), leave(from.y, way.y, 6));
}

std::vector<Scan> drive(const Scene& scene, const std::vector<TimedPose>& way, double time) {
    const Sensors sensors = sensorsOf(scene, {});
    RayScenes worlds(scene.environment);
    const MovingBodies bodies(bodiesOf(scene));
    ReadingSampler taker(sensors, worlds, bodies, {.follows_poses = true});
    const ReadingJob job{0, 0, time, poseAlong(way, time), way};
    taker.prepare(job);
    return std::get<std::vector<Scan>>(taker.take(job));
}

TimedPose at(double time, double x, double y, double heading, double tilt = 0) {
    return {time, {{x, y, 0.15}, Angle::degrees(heading), Angle::degrees(tilt), {}}};
}

TEST(Motion, EachBeamComesFromWhereTheSensorThenIs) {
    // 2 m/s aslant and 90 degrees a second while the beam turns once in 0.2 s.
    const Scene scene =
        testing::scene(kRoom, "laser at=0,0 fov=359 step=1 range=20 rate=5 spin=5\n");
    const std::vector<Scan> scans = drive(scene, {at(0, 2, 2, 10), at(1, 3.2, 3.6, 100)}, 0.25);
    ASSERT_EQ(scans.size(), 1U);
    ASSERT_EQ(scans[0].beam_poses.size(), 360U);
    double moved = 0;
    for (int k = 0; k < 360; ++k) {
        const double t = 0.25 + k / 360.0 / 5;
        const Point2 place{2 + 1.2 * t, 2 + 1.6 * t};
        const Angle bearing = Angle::degrees(10 + 90 * t - 179.5 + k);
        const double exact = rangeInRoom(place, unitVector(bearing));
        EXPECT_NEAR(scans[0].ranges[static_cast<std::size_t>(k)], exact, 1e-5) << k;
        const double still = rangeInRoom({2.3, 2.4}, unitVector(Angle::degrees(32.5 - 179.5 + k)));
        moved = std::max(moved, std::fabs(exact - still));
    }
    EXPECT_GT(moved, 0.3) << "motion matters here";
}

TEST(Motion, TiltedAndAcrossSeveralPoses) {
    // The floor, seen 20 degrees down from a height of 0.15 m while it speeds up.
    const Scene scene =
        testing::scene(kRoom, "laser at=0,0 fov=90 step=0.5 range=20 rate=5 spin=2\n");
    const std::vector<TimedPose> way = {at(0, 1, 3, 0, -20), at(0.03, 1.1, 3, 0, -20),
                                        at(0.06, 1.3, 3, 0, -20), at(0.2, 3, 3, 0, -20)};
    const std::vector<Scan> scans = drive(scene, way, 0);
    for (int k = 0; k <= 180; ++k) {
        const auto beam = static_cast<std::size_t>(k);
        const double t = k * 0.5 / 360 / 2;
        const double x = t < 0.03   ? 1 + 0.1 * t / 0.03
                         : t < 0.06 ? 1.1 + 0.2 * (t - 0.03) / 0.03
                                    : 1.3 + 1.7 * (t - 0.06) / 0.14;
        EXPECT_NEAR(scans[0].beam_poses[beam].position.x, x, 1e-9);
        const double down =
            std::sin(20 * std::acos(-1) / 180) * std::cos((k * 0.5 - 45) * std::acos(-1) / 180);
        EXPECT_NEAR(scans[0].ranges[beam], 0.15 / down, 1e-4) << k;
    }
}

TEST(Motion, WithoutTimePerBeamAScanIsOfOneMoment) {
    const Scene scene = testing::scene(kRoom, "laser at=0,0 range=20\n");
    const std::vector<Scan> scans = drive(scene, {at(0, 2, 2, 10), at(1, 3, 4, 100)}, 0.5);
    EXPECT_TRUE(scans[0].beam_poses.empty());
    EXPECT_EQ(scans[0].pose.position, (Point3{2.5, 3, 0.15}));
    EXPECT_NEAR(scans[0].ranges[90], rangeInRoom({2.5, 3}, unitVector(Angle::degrees(55))), 1e-6);
}

TEST(Sweep, ATurningLaserFillsTheHemisphere) {
    // Table 5.4: 4 m high, looking down, a scan each degree, beams each degree, 7 m.
    const Scene scene = testing::scene("ispace size=9,9,4.5 ceiling=yes\n",
                                       "laser at=0,0,4 tilt=-90 range=7 sweep=heading\n");
    const std::vector<Scan> scans = testing::scans(scene);
    ASSERT_EQ(scans.size(), 360U);
    for (std::size_t j = 0; j < scans.size(); ++j) {
        EXPECT_EQ(scans[j].number, static_cast<int>(j));
        EXPECT_NEAR(scans[j].time, static_cast<double>(j) / 10, 1e-9);
        EXPECT_EQ(scans[j].ranges[90], 4) << "straight down";
        for (int k = 0; k <= 180; ++k) {
            const Angle bearing = Angle::degrees(k - 90),
                        heading = Angle::degrees(static_cast<double>(j));
            const double across = sin(bearing), down = cos(bearing);
            const Vec2 side = perpendicular(unitVector(heading));
            const double walls =
                4.5 / std::max(std::fabs(across * side.x), std::fabs(across * side.y));
            const double exact = std::min(walls, down > 0 ? 4 / down : 1e9);
            const float found = scans[j].ranges[static_cast<std::size_t>(k)];
            if (exact > 7.0001) {
                EXPECT_TRUE(std::isinf(found)) << j << ' ' << k;
            } else if (exact < 6.9999) {
                EXPECT_NEAR(found, exact, 1e-4) << j << ' ' << k;
            }
        }
    }
}

TEST(Sweep, ALaserThatSpinsTurnsOnWhileItScans) {
    const Scene scene = testing::scene(
        kRoom, "laser at=4,3 fov=359 range=20 rate=10 spin=10 sweep=heading sweep_step=10\n");
    const std::vector<Scan> scans = testing::scans(scene);
    ASSERT_EQ(scans.size(), 36U);
    // Within the 0.1 s of scan 1 it turns from 10 to almost 20 degrees.
    const Scan& scan = scans[1];
    ASSERT_EQ(scan.beam_poses.size(), 360U);
    EXPECT_NEAR(scan.beam_poses[180].heading.degrees(), 15, 1e-9);
    for (int k = 0; k < 360; ++k)
        EXPECT_NEAR(scan.ranges[static_cast<std::size_t>(k)],
                    rangeInRoom({4, 3}, unitVector(Angle::degrees(10 + k / 36.0 - 179.5 + k))),
                    1e-5);
}

TEST(Sweep, OfTiltGoesThroughTheLevel) {
    const Scene scene = testing::scene(
        kRoom, "laser at=4,3,1 tilt=-10 range=20 sweep=tilt sweep_span=20 sweep_step=5\n");
    const std::vector<Scan> scans = testing::scans(scene);
    ASSERT_EQ(scans.size(), 5U);
    EXPECT_EQ(scans[2].pose.tilt, Angle());
    EXPECT_EQ(scans[2].ranges[90], 4);
    EXPECT_NEAR(scans[1].ranges[90], 4 / cos(Angle::degrees(5)), 1e-5);
    EXPECT_NEAR(scans[4].ranges[90], 4 / cos(Angle::degrees(10)), 1e-5);
}

}  // namespace motion_test

}  // namespace ispace
