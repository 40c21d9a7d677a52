// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "arrange/placement_rules.h"
#include "base/error.h"
#include "support/test_problems.h"
#include "support/test_scenes.h"

namespace ispace {
namespace refine_test {

Laser laserOfRange(double range, double fov = 180) {
    Laser laser;
    laser.max_range = range;
    laser.first = Angle::degrees(-fov / 2);
    laser.beams = static_cast<int>(fov) + 1;
    return laser;
}

Pose3 poseAt(double x, double y, double heading = 0) {
    return {{x, y, kScanHeight}, Angle::degrees(heading), {}, {}};
}

Refined refined(const Scene& scene, const std::vector<Sensor>& sensors,
                const FloorWeights& floor = {}, const RefineOptions& options = {}) {
    SilentProgress progress;
    return refine(scene, VisibleArea(scene.environment, 0), sensors, floor, options, progress);
}

/// Accepts the sites that these rules allow.
RefineOptions within(const SiteValidity& validity) {
    return {.is_valid = [&](std::size_t, Point2 place) { return validity.isValid(place); }};
}

double valueOf(const Scene& scene, const std::vector<Sensor>& sensors) {
    return ExactGain(scene, VisibleArea(scene.environment, 0), sensors, {}, 1).value();
}

NamedZone box(double x, double y, double to_x, double to_y) {
    return {"z", {{x, y}, {to_x, y}, {to_x, to_y}, {x, to_y}}, {(x + to_x) / 2, (y + to_y) / 2}};
}

bool isOnLattice(double value, double per_unit) {
    return std::abs(value * per_unit - std::round(value * per_unit)) < 1e-6;
}

TEST(ExactGain, OfAllAtOnceIsThatOfEach) {
    const Scene scene = sceneOf("ispace size=12,9\ncube at=1,1 size=1,2,1\ncube at=-3,-1 size=1\n");
    const VisibleArea sight(scene.environment, 0);
    std::vector<Sensor> sensors;
    for (int i = 0; i < 12; ++i)
        sensors.push_back({std::to_string(i), laserOfRange(3 + i % 3, i % 2 == 0 ? 360 : 120),
                           poseAt(-5 + i % 4 * 3.1, -4 + i / 4 * 3.7, 37.0 * i)});
    FloorWeights weights;
    weights.weights = {{box(-2, -2, 3, 3), 2.5}};
    for (const FloorWeights& floor : {FloorWeights(), weights}) {
        ExactGain each(scene, sight, sensors, floor, 1), at_once(scene, sight, sensors, floor, 1);
        ASSERT_TRUE(at_once.prepareAll());
        for (std::size_t i = 0; i < sensors.size(); ++i) {
            std::vector<Pose3> poses = {sensors[i].pose};
            for (int turn = 30; turn < 360; turn += 60)
                poses.push_back(
                    poseAt(sensors[i].pose.position.x + 0.3, sensors[i].pose.position.y, turn));
            each.take(i);
            at_once.take(i);
            const auto wanted = each.gains(poses), gains = at_once.gains(poses);
            for (std::size_t k = 0; k < poses.size(); ++k) {
                EXPECT_NEAR(gains[k], wanted[k], 1e-6) << i << ' ' << k;
                EXPECT_LE(gains[k] - gains[0], at_once.mostMore(poses[k]) + 1e-6);
            }
            EXPECT_TRUE(std::isinf(each.mostMore(poses[0])));
        }
        // One that moves makes the others' gains anew.
        each.take(3);
        each.put(poseAt(2, 2, 10));
        at_once.take(3);
        at_once.put(poseAt(2, 2, 10));
        each.take(4);
        at_once.take(4);
        EXPECT_NEAR(at_once.gains(std::span(&sensors[4].pose, 1))[0],
                    each.gains(std::span(&sensors[4].pose, 1))[0], 1e-6);
    }
    EXPECT_FALSE(ExactGain(scene, sight, sensors, {}, 2).prepareAll());
}

TEST(Refine, ADiscComesOutOfItsCorner) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    const SiteValidity validity(scene.environment, {});
    const std::vector<Sensor> one = {{"a", laserOfRange(1.5, 360), poseAt(-3.9, -2.91234567)}};
    const Refined result = refined(scene, one, {}, within(validity));
    EXPECT_LT(result.before, 0.4 * result.after);
    EXPECT_NEAR(result.after, std::numbers::pi * 1.5 * 1.5, 1e-4);
    const Point3 place = result.poses[0].position;
    EXPECT_LE(std::abs(place.x), 2.505);
    EXPECT_LE(std::abs(place.y), 1.505);
    EXPECT_TRUE(isOnLattice(place.x, 1e4) && isOnLattice(place.y, 1e4));
    EXPECT_EQ(place.z, kScanHeight);
    EXPECT_EQ(result.poses[0].heading, Angle());
    EXPECT_LT(result.evaluations, 600U);
}

TEST(Refine, HalfATurnTurnsToItsBestHeading) {
    const Scene scene = sceneOf("ispace size=4,4\n");
    // In a corner, with all moves rejected: only a heading towards the room sees all of it.
    const std::vector<Sensor> one = {{"a", laserOfRange(10, 90), poseAt(-1.99, -1.99, 80)}};
    const auto stays = [](const std::vector<Pose3>& poses) {
        return poses[0].position == poseAt(-1.99, -1.99).position;
    };
    const Refined result = refined(scene, one, {}, {.accepts = stays});
    EXPECT_NEAR(result.poses[0].heading.degrees(), 45, 0.1);
    EXPECT_NEAR(result.after, 3.99 * 3.99, 0.01);
    // On a wall, a laser of 180 degrees sees all once it faces away from the wall; a sensor free to
    // move finds such a pose.
    const Pose3 on_wall = poseAt(0, -1.9995, 33.3);
    const std::vector<Sensor> half = {{"a", laserOfRange(10), on_wall}};
    const Refined turned =
        refined(scene, half, {}, {.accepts = [&](const std::vector<Pose3>& poses) {
                    return poses[0].position == on_wall.position;
                }});
    EXPECT_NEAR(turned.after, 16, 0.01);
    EXPECT_NEAR(turned.poses[0].heading.degrees(), 90, 0.1);
    EXPECT_NEAR(refined(scene, half).after, 16, 0.01);
}

TEST(Refine, NeverWorseAndEachStepHelped) {
    const Scene scene = sceneOf(
        "ispace size=8,6\ndesk at=2,1 heading=30 size=1.2,0.8,0.7\ncube at=-2,-1 size=0.6,0.6,1\n");
    const SiteValidity validity(scene.environment, {});
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(-3.9, 3.9), y(-2.9, 2.9), h(-180, 180);
    for (int round = 0; round < 6; ++round) {
        std::vector<Sensor> sensors;
        while (sensors.size() < 2) {
            const Pose3 pose = poseAt(x(random), y(random), h(random));
            if (validity.isValid(pose.position.onFloor()))
                sensors.push_back({std::to_string(sensors.size()), laserOfRange(3), pose});
        }
        const Refined result = refined(scene, sensors, {}, within(validity));
        EXPECT_GE(result.after, result.before);
        EXPECT_NEAR(result.before, valueOf(scene, sensors), 1e-9);
        for (std::size_t i = 0; i < sensors.size(); ++i) {
            sensors[i].pose = result.poses[i];
            EXPECT_TRUE(validity.isValid(result.poses[i].position.onFloor()));
            EXPECT_LE(std::abs(result.poses[i].heading.degrees()), 180);
        }
        EXPECT_NEAR(result.after, valueOf(scene, sensors), 1e-9);
        // From there on hardly any gain is left.
        EXPECT_NEAR(refined(scene, sensors, {},
                            {.step = 0.001,
                             .turn = Angle::degrees(0.05),
                             .is_valid = within(validity).is_valid})
                        .after,
                    result.after, 1e-4);
    }
}

TEST(Refine, StaysWhereNothingHelps) {
    const Scene scene = sceneOf("ispace size=8,8\n");
    const Pose3 pose = poseAt(0.123456789, -0.5, 12.3456789);
    const std::vector<Sensor> one = {{"a", laserOfRange(2, 360), pose}};
    const Refined result = refined(scene, one);
    EXPECT_EQ(result.poses[0], pose);  // not even rounded
    EXPECT_EQ(result.after, result.before);
}

TEST(Refine, SameForAnyNumberOfThreads) {
    const Scene scene = sceneOf("ispace size=8,6\ncube at=-2,-1 size=0.6,0.6,1\n");
    const std::vector<Sensor> two = {{"a", laserOfRange(4), poseAt(-3, 2, 10)},
                                     {"b", laserOfRange(3), poseAt(2, -2, 200)}};
    const Refined many = refined(scene, two);
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const Refined one = refined(scene, two);
    EXPECT_EQ(many.poses, one.poses);
    EXPECT_EQ(many.after, one.after);
    EXPECT_EQ(many.evaluations, one.evaluations);
}

TEST(Refine, AllSensorsTakeTheirTurns) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    const std::vector<Sensor> three = {{"a", laserOfRange(1, 360), poseAt(-3.9, -2.9)},
                                       {"b", laserOfRange(1, 360), poseAt(3.9, -2.9)},
                                       {"c", laserOfRange(1, 360), poseAt(3.9, 2.9)}};
    EXPECT_NEAR(refined(scene, three).after, 3 * std::numbers::pi, 1e-4);
}

TEST(Refine, AcceptMayRefuse) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    const std::vector<Sensor> one = {{"a", laserOfRange(1.5, 360), poseAt(-3.9, -2.9)}};
    const auto nothing = [](const std::vector<Pose3>&) { return false; };
    EXPECT_EQ(refined(scene, one, {}, {.accepts = nothing}).poses[0], one[0].pose);
    const auto left_half = [](const std::vector<Pose3>& poses) {
        return poses[0].position.x <= -3.5;
    };
    const Refined result = refined(scene, one, {}, {.accepts = left_half});
    EXPECT_NEAR(result.poses[0].position.x, -3.5, 0.002);
    EXPECT_GT(result.after, result.before);
}

TEST(Refine, InvalidPlacesAreNeverTaken) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    SiteRules rules;
    rules.keep_out = {{{-3.5, -3}, {4, -3}, {4, 3}, {-3.5, 3}}};
    const SiteValidity validity(scene.environment, std::move(rules));
    const std::vector<Sensor> one = {{"a", laserOfRange(1.5, 360), poseAt(-3.9, -2.9)}};
    const Refined result = refined(scene, one, {}, within(validity));
    EXPECT_LT(result.poses[0].position.x, -3.5);
    EXPECT_NEAR(result.poses[0].position.x, -3.5, 0.002);
    EXPECT_GT(std::abs(result.poses[0].position.y), -1.51);
}

TEST(Refine, GoesWhereWeightsAreHigher) {
    const Scene scene = sceneOf("ispace size=12,6\n");
    const std::vector<Sensor> one = {{"a", laserOfRange(1, 360), poseAt(0.5, 0)}};
    FloorWeights floor;
    floor.weights = {{box(1, -2, 5, 2), 3}};
    const Refined weighted = refined(scene, one, floor);
    EXPECT_NEAR(weighted.after, 3 * std::numbers::pi, 1e-4);
    floor = {};
    floor.targets = {box(-5, -2, 0, 2)};
    const Refined targeted = refined(scene, one, floor);
    EXPECT_NEAR(targeted.after, std::numbers::pi, 1e-4);
    EXPECT_LE(targeted.poses[0].position.x, -0.99);
}

TEST(Refine, DemandDrawsTogetherWhatElsePartsFromEachOther) {
    const Scene scene = sceneOf("ispace size=12,6\nlaser id=s at=0,0 range=1 fov=359\n");
    const std::vector<Sensor> one = {{"a", laserOfRange(1, 360), poseAt(1, 0.3)}};
    const Refined apart = refined(scene, one);
    EXPECT_NEAR(apart.after, 2 * std::numbers::pi, 0.02);
    EXPECT_GE(length(apart.poses[0].position.onFloor() - Point2{}), 1.98);
    const Refined together = refined(scene, one, {}, {.multiplicity = 2});
    EXPECT_NEAR(together.after, std::numbers::pi, 0.02);
    EXPECT_LE(length(together.poses[0].position.onFloor() - Point2{}), 0.03);
}

TEST(Refine, EndsWhenItIsToldTo) {
    const Scene scene = sceneOf("ispace size=8,6\n");
    const std::vector<Sensor> one = {{"a", laserOfRange(1.5, 360), poseAt(-3.9, -2.9)}};
    StopWhen progress(always);
    const Refined result = refine(scene, VisibleArea(scene.environment, 0), one, {}, {}, progress);
    EXPECT_EQ(result.poses[0], one[0].pose);
    EXPECT_EQ(progress.begun, 1);
    EXPECT_EQ(progress.ended, 1);
    EXPECT_TRUE(refined(scene, {}).poses.empty());
}

}  // namespace refine_test
}  // namespace ispace
