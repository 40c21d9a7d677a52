// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/refine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "base/error.h"
#include "support/test_scenes.h"

namespace ispace {
namespace exact_gain_test {

const char* const kRoom =
    "ispace size=8,6\ndesk at=2,1 heading=30 size=1.2,0.8,0.7\ncube at=-2,-1 size=0.6,0.6,1\n"
    "cylinder at=0,2 size=0.8,0.8,1\n";

Laser laserOfRange(double range, double fov = 180) {
    Laser laser;
    laser.max_range = range;
    laser.first = Angle::degrees(-fov / 2);
    laser.beams = static_cast<int>(fov) + 1;
    return laser;
}

Sensor at(const std::string& id, const SensorModel& device, double x, double y, double heading,
          double z = kScanHeight, double tilt = 0) {
    return {id, device, {{x, y, z}, Angle::degrees(heading), Angle::degrees(tilt), {}}};
}

NamedZone zoneOf(const Polygon& outline) { return {"z", outline, interiorPoint({outline, {}})}; }

NamedZone box(double x, double y, double to_x, double to_y) {
    return zoneOf({{x, y}, {to_x, y}, {to_x, to_y}, {x, to_y}});
}

/// The same scene with the sensors standing in it, as coverage sees it.
CoverageReport reportOf(Scene scene, const std::vector<Sensor>& sensors) {
    scene.sensors.insert(scene.sensors.end(), sensors.begin(), sensors.end());
    return coverageOf(scene, 10, 10).report;
}

/// An ExactGain with its room.
struct Gain {
    VisibleArea sight;
    ExactGain gain;

    Gain(const Scene& scene, const std::vector<Sensor>& sensors, const FloorWeights& weights = {},
         int multiplicity = 1)
        : sight(scene.environment, 0), gain(scene, sight, sensors, weights, multiplicity) {}
};

double seenByAtLeast(const CoverageReport& report, std::size_t times) {
    double share = 0;
    for (std::size_t k = times; k < report.redundancy_exact->size(); ++k)
        share += (*report.redundancy_exact)[k];
    return share * report.indoor_area;
}

std::vector<Sensor> threeLasers() {
    return {at("a", laserOfRange(4), -3, 2, -40), at("b", laserOfRange(3, 270), 1, -1, 70),
            at("c", laserOfRange(5, 360), 3, 2.5, 0)};
}

TEST(ExactGain, IsWhatCoverageMeasures) {
    const Scene scene = sceneOf(kRoom);
    const std::vector<Sensor> sensors = threeLasers();
    const CoverageReport report = reportOf(scene, sensors);
    for (const int demand : {1, 2, 3}) {
        const Gain made(scene, sensors, {}, demand);
        const ExactGain& gain = made.gain;
        EXPECT_NEAR(gain.value(), seenByAtLeast(report, static_cast<std::size_t>(demand)), 1e-5);
        EXPECT_NEAR(gain.total(), 48, 1e-9);
    }
    EXPECT_GT(seenByAtLeast(report, 3), 0.5);
}

TEST(ExactGain, SensorsThatStandCount) {
    const Scene scene = sceneOf(std::string(kRoom) + "laser id=b at=1,-1 heading=70 range=3\n");
    const std::vector<Sensor> one = {at("a", laserOfRange(4), -3, 2, -40)};
    EXPECT_NEAR(Gain(scene, one, {}).gain.value(), seenByAtLeast(reportOf(scene, one), 1), 1e-5);
}

TEST(ExactGain, TargetsAndWeightsOfWhichTheLastDecides) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const std::vector<Sensor> whole = {at("a", laserOfRange(20, 360), 0, 0, 0),
                                       at("b", laserOfRange(20, 360), 1, 0, 180)};
    FloorWeights floor;
    floor.weights = {{box(-1, -1, 1, 1), 3}, {box(0, 0, 2, 2), 5}, {box(3, 3, 9, 9), 0}};
    // 64 of which 4 weigh 5, 3 weigh 3, 1 weighs 0.
    EXPECT_NEAR(Gain(scene, whole, floor).gain.total(), 56 + 20 + 9, 1e-5);
    EXPECT_NEAR(Gain(scene, whole, floor).gain.value(), 56 + 20 + 9, 1e-5);
    floor.targets = {box(-2, -2, 0, 0), box(-1, -1, 1, 1)};  // 4 + 4 - 1
    EXPECT_NEAR(Gain(scene, whole, floor).gain.value(), 3 + 9 + 5, 1e-5);
    floor.weights.clear();
    EXPECT_NEAR(Gain(scene, whole, floor).gain.value(), 7, 1e-5);
    floor.targets = {box(7, 7, 8, 8)};  // outside
    EXPECT_EQ(Gain(scene, whole, floor).gain.value(), 0);
    EXPECT_EQ(Gain(scene, whole, floor).gain.total(), 0);
}

TEST(ExactGain, SixtyWeightsAndNoMore) {
    const Scene scene = sceneOf("ispace size=80,8\n");
    const std::vector<Sensor> one = {at("a", laserOfRange(100, 360), 0, 0, 0),
                                     at("b", laserOfRange(100, 360), 1, 0, 180)};
    FloorWeights floor;
    double wanted = 640;
    for (int i = 0; i < 60; ++i) {
        floor.weights.emplace_back(box(-39 + i, -1, -38 + i, 1), 2 + i);
        wanted += 2 * (1 + i);
    }
    EXPECT_NEAR(Gain(scene, one, floor).gain.value(), wanted, 1e-3);
    floor.weights.emplace_back(box(-39, -1, -38, 1), 2);
    EXPECT_THROW(Gain(scene, one, floor), UsageError);
}

TEST(ExactGain, GainsAreDifferencesOfValues) {
    const Scene scene = sceneOf(std::string(kRoom) + "laser at=3.5,-2.5 heading=120 range=2\n");
    FloorWeights floor;
    floor.weights = {{box(-2, -2, 3, 1), 4}, {box(0, 0, 4, 3), 0.5}};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> x(-3.9, 3.9), y(-2.9, 2.9), h(-180, 180);
    for (const int demand : {1, 2}) {
        std::vector<Sensor> sensors = threeLasers();
        for (int i = 0; i < 20; ++i) {
            const auto which = static_cast<std::size_t>(i) % 3;
            std::vector<double> values, gains;
            std::vector<Pose3> poses;
            Gain made(scene, sensors, floor, demand);
            ExactGain& moving = made.gain;
            for (int k = 0; k < 2; ++k) {
                Sensor& own = sensors[which];
                own.pose.position.x = x(random);
                own.pose.position.y = y(random);
                own.pose.heading = Angle::degrees(h(random));
                poses.push_back(own.pose);
                values.push_back(Gain(scene, sensors, floor, demand).gain.value());
            }
            moving.take(which);
            gains = moving.gains(poses);
            EXPECT_NEAR(gains[1] - gains[0], values[1] - values[0], 1e-5);
            moving.put(poses[0]);
            EXPECT_NEAR(moving.value(), values[0], 1e-5);
        }
    }
}

TEST(ExactGain, FourReceiversAreOneSensor) {
    const Scene scene = sceneOf("ispace size=8,8 height=3\n");
    Receiver receiver;
    std::vector<Sensor> sensors;
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0})
            sensors.push_back(
                at("u" + std::to_string(sensors.size()), receiver, x, y, 0, 2.5, -90));
    sensors.push_back(at("u4", receiver, 0.5, 0.2, 0, 2.5, -90));
    sensors.push_back(at("a", laserOfRange(3), 2, 0, 30));
    const CoverageReport report = reportOf(scene, sensors);
    for (const int demand : {1, 2})
        EXPECT_NEAR(Gain(scene, sensors, {}, demand).gain.value(),
                    seenByAtLeast(report, static_cast<std::size_t>(demand)), 1e-5);
    Gain made(scene, sensors);
    ExactGain& gain = made.gain;
    const double before = gain.value();
    Pose3 moved = sensors[1].pose;
    moved.position.y = 0.3;
    gain.take(1);
    const std::vector<double> gains = gain.gains(std::vector<Pose3>{sensors[1].pose, moved});
    gain.put(moved);
    EXPECT_NEAR(gain.value() - before, gains[1] - gains[0], 1e-5);
    EXPECT_GT(std::abs(gains[1] - gains[0]), 0.1);
    EXPECT_FALSE(gain.turns(0));
    EXPECT_TRUE(gain.turns(5));
}

TEST(ExactGain, RangersAndTiltedLasersCoverThePlane) {
    const Scene scene = sceneOf(kRoom);
    const std::vector<Sensor> sensors = {at("r", Ranger(), -3, 0, 10, 1.5, -30),
                                         at("t", laserOfRange(6), 3, -2, 140, 1.2, -20),
                                         at("buried", Ranger(), -2, -1, 0, 0.5, -30)};
    const double value = Gain(scene, sensors, {}).gain.value();
    EXPECT_NEAR(value, seenByAtLeast(reportOf(scene, sensors), 1), 1e-5);
    EXPECT_GT(value, 2);
}

TEST(ExactGain, UnknownRegionsAreRefused) {
    Laser sweeping = laserOfRange(4);
    sweeping.sweep = SweepAxis::Tilt;
    sweeping.sweep_span = Angle::degrees(30);
    const std::vector<Sensor> sensors = {at("n", sweeping, 0, 0, 0, 1, -20)};
    try {
        const Scene scene = sceneOf(kRoom);
        const Gain gain(scene, sensors);
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "n cannot be refined: its exact region is not known");
    }
}

TEST(ExactGain, WholeTurnsDoNotTurn) {
    Laser whole = laserOfRange(4, 360);
    Ranger head;
    head.projection = Projection::Spherical;
    head.fov_x = Angle::degrees(360);
    const std::vector<Sensor> sensors = {at("w", whole, 0, 0, 0),
                                         at("v", whole, 0, 0, 0, 1, -20),
                                         at("h", laserOfRange(4, 358), 0, 0, 0),
                                         at("c", laserOfRange(4, 359), 0, 0, 0),
                                         at("r", head, 1, 1, 0, 1),
                                         at("p", Ranger(), 1, 1, 0, 2, -90)};
    const Scene scene = sceneOf(kRoom);
    const Gain made(scene, sensors);
    const ExactGain& gain = made.gain;
    const std::vector<bool> turns = {false, true, true, false, false, true};
    for (std::size_t i = 0; i < turns.size(); ++i) EXPECT_EQ(gain.turns(i), turns[i]) << i;
}

}  // namespace exact_gain_test
}  // namespace ispace
