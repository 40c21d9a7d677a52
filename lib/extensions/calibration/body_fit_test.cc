// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/calibration/body_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "base/error.h"
#include "scene/bodies.h"
#include "sense/scan.h"
#include "sense/selection.h"
#include "support/test_layout.h"

namespace ispace::calibration {
namespace body_fit_test {

Sensor laserAt(const std::string& id, double x, double y, double heading, double z = 0.3) {
    Laser laser;
    laser.min_range = 0.1;
    laser.max_range = 30;
    laser.first = Angle::degrees(-135);
    laser.step = Angle::degrees(0.25);
    laser.beams = 1081;
    laser.noise.sigma = {0.01, 0.0005, 0};
    laser.noise.resolution = 0.001;
    return {id, laser, {{x, y, z}, Angle::degrees(heading), {}, {}}};
}

/// A walk through the room, at about 1 m/s.
struct Step {
    Pose2 pose;
    Angle swing;
};
Step walk(double t, double wide) {
    const double a = 0.29 * t, b = 0.43 * t + 0.4;
    const Point2 place{4 + 2.6 * std::sin(a), 3 + wide * std::sin(b)};
    const Vec2 speed{2.6 * 0.29 * std::cos(a), wide * 0.43 * std::cos(b)};
    return {{place, directionOf(speed.x, speed.y)},
            Angle::degrees(kMaxSwingDegrees * std::sin(2 * std::numbers::pi * t / 1.1))};
}

struct WalkOptions {
    double seconds = 300, rate = 10, height = 1.8, wide = 1.8;
    bool is_still = false;
    double later = 0;  ///< seconds from laser to laser at which they scan
    double robot = 0;  ///< radius of a robot instead of a person
    double hurry = 1;
    double spin = 0;
};

std::vector<MovingBody> bodyAt(const WalkOptions& how, const Step& step) {
    if (how.robot == 0) return humanBodies(how.height, step.pose, 0, step.swing);
    MovingBody body;
    body.pose = step.pose;
    body.radius = how.robot;
    body.top = 0.6;
    return {body};
}

/// Records the scans of lasers while a person walks.
std::vector<WatchingLaser> recorded(const std::vector<Sensor>& sensors, const WalkOptions& how) {
    const Scene scene =
        testing::scene("ispace at=4,3 size=8,6,2.5\ncube at=7.4,0.5 size=0.8,0.6,0.7\n");
    RayScenes worlds(scene.environment);
    std::vector<WatchingLaser> lasers;
    for (const Sensor& sensor : sensors) {
        worlds.prepare(sensor.pose);
        lasers.push_back({sensor, {}, {}});
    }
    const int count = static_cast<int>(how.seconds * how.rate);
    for (int i = 0; i < count; ++i)
        for (std::size_t k = 0; k < lasers.size(); ++k) {
            WatchingLaser& laser = lasers[k];
            const double t = i / how.rate + static_cast<double>(k) * how.later;
            const bool is_empty = i < count / 50 && how.is_still;
            const MovingBodies bodies(
                is_empty ? std::vector<MovingBody>()
                         : bodyAt(how, walk(how.is_still ? 0 : how.hurry * t, how.wide)));
            Scan scan;
            scan.frame = i;
            scan.pose = laser.sensor.pose;
            LaserCaster(worlds, bodies, laser.sensor, false, {.noise_seed = 3}).cast(scan);
            laser.times.push_back(t);
            laser.scans.push_back(scan.ranges);
        }
    for (WatchingLaser& laser : lasers) laser.sensor.as<Laser>().spin = how.spin;
    return lasers;
}

std::vector<Sensor> three() {
    return {laserAt("l1", 0.2, 0.3, 40), laserAt("l2", 7.8, 5.6, -140),
            laserAt("l3", 0.3, 5.7, -50)};
}

/// Errors of the poses relative to that of the first laser.
void expectPoses(const BodyFit& fit, const std::vector<Sensor>& truth, double metres,
                 double degrees) {
    for (std::size_t i = 1; i < truth.size(); ++i) {
        const Pose3 &found = fit.poses[i], &real = truth[i].pose;
        const double off = distance(found.position.onFloor(), real.position.onFloor());
        const double turn = std::abs(wrapped(found.heading - real.heading).degrees());
        EXPECT_LT(off, metres) << truth[i].id;
        EXPECT_LT(turn, degrees) << truth[i].id;
    }
}

TEST(BodyFit, FiveMinutesOfOnePersonJoinThreeLasers) {
    std::vector<WatchingLaser> lasers = recorded(three(), {});
    // Poses of the layout do not matter, but that of the first laser.
    lasers[1].sensor.pose = {{0, 0, 0.3}, {}, {}, {}};
    lasers[2].sensor.pose = {{3, 3, 0.3}, Angle::degrees(123), {}, {}};
    const BodyFit fit = fitToBodies(lasers);
    // Asked for are 5 mm and 0.1 degrees; the middle of the points ends at 36 mm or more.
    expectPoses(fit, three(), 0.002, 0.02);
    EXPECT_NEAR(fit.height, 1.8, 0.05);
    EXPECT_NEAR(fit.scatter, 1, 0.2);
}

TEST(BodyFit, LasersAtDifferentHeightsCompareTheMiddleOfBothLegs) {
    std::vector<Sensor> sensors = three();
    sensors[1].pose.position.z = 0.15;
    sensors[2].pose.position.z = 0.5;
    expectPoses(fitToBodies(recorded(sensors, {})), sensors, 0.003, 0.03);
}

TEST(BodyFit, LasersThatScanAtDifferentTimesCompareTheMiddleOfBothLegs) {
    // At 1.5 m/s the body moves by 6 cm between the scans, a leg by twice as much. Two lasers that
    // face each other tell the size of legs worst.
    std::vector<Sensor> sensors = three();
    sensors.pop_back();
    const BodyFit fit = fitToBodies(recorded(
        sensors, {.seconds = 120, .height = 1.7, .later = 0.04, .hurry = 1.4, .spin = 1e6}));
    expectPoses(fit, sensors, 0.005, 0.05);
    EXPECT_NEAR(fit.height, 1.7, 0.15);
}

TEST(BodyFit, ARoundRobotJoinsThreeLasers) {
    std::vector<WatchingLaser> lasers = recorded(three(), {.seconds = 120, .robot = 0.22});
    lasers[1].sensor.pose = {{0, 0, 0.3}, {}, {}, {}};
    lasers[2].sensor.pose = {{3, 3, 0.3}, Angle::degrees(123), {}, {}};
    const BodyFit fit = fitToBodies(lasers, {.radius = 0.2});
    expectPoses(fit, three(), 0.002, 0.02);
    EXPECT_NEAR(fit.radius, 0.22, 0.001);
    EXPECT_EQ(fit.height, 0);
}

TEST(PeopleSeen, FollowAPersonToATime) {
    const std::vector<Sensor> sensors = three();
    const auto seen = peopleSeen(recorded(sensors, {.seconds = 20}), 1.8);
    int found = 0;
    for (double t = 1; t < 19; t += 0.37) {
        const std::vector<Point2> places = peopleAt(seen, t);
        ASSERT_LE(places.size(), 1U) << t;
        if (places.empty()) continue;
        ++found;
        EXPECT_LT(distance(places[0], walk(t, 1.8).pose.position), 0.03) << t;
    }
    EXPECT_GT(found, 45);
    EXPECT_TRUE(peopleAt(seen, 100).empty());
}

std::string refusalOf(const std::vector<WatchingLaser>& lasers) {
    try {
        static_cast<void>(fitToBodies(lasers));
    } catch (const FormatError& error) {
        return error.diagnostics().front().message;
    }
    return "";
}

TEST(BodyFit, RefusesWhatDeterminesNoPose) {
    const std::vector<Sensor> sensors = three();
    EXPECT_EQ(refusalOf({}), "wanted two lasers or more that see the same people");
    EXPECT_EQ(refusalOf(recorded({sensors[0], sensors[1]}, {.seconds = 10, .is_still = true})),
              "people walk too little in sight of l2 and another laser at one time");
    std::vector<Sensor> high = sensors;
    high[1].pose.position.z = 1.2;
    EXPECT_EQ(refusalOf(recorded({high[0], high[1]}, {.seconds = 1})),
              "l2 scans at 1.20 m: wanted legs, below 0.67 m");
}

}  // namespace body_fit_test
}  // namespace ispace::calibration
